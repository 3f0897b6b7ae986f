//! Every tolerance of the integration tests, each with its unit and a worked example.

/// How far an inked pixel's centre may lie from the true line, px: k + 0.5 with k = 1.
///
/// Example: a true line runs along a row's upper edge, y = 10.0. Pixels of rows 9 and 10 (centres 9.5 and 10.5) are the
/// line itself, rows 8 and 11 (centres 8.5 and 11.5) lie at 1.5 and still count as within one pixel of it.
pub const REACH_PX: f64 = 1.5;

/// Share of the true line's length that must lie within [`REACH_PX`] of ink.
///
/// Example: of a line of 500 px at most 5 px may be missed.
pub const RECALL: f64 = 0.99;

/// The same for plain toward-away, which leaves gaps where the away slope is thinner than a pixel.
///
/// Example: of a line of 500 px at most 50 px may be missed.
pub const RECALL_TOWARD_AWAY: f64 = 0.90;

/// How far facets may lie from the mathematical surface, px on the page.
///
/// Example: seen with 330 px per unit of tangent from 1 000 m, 0.25 px are 0.76 m.
pub const GRID_ERROR_PX: f64 = 0.25;

/// Longest piece of a true line, px: visibility is decided once a piece.
///
/// Example: where a hill cuts a line off, the true line ends at most 0.125 px wrong.
pub const TRUTH_PIECE_PX: f64 = 0.25;

/// How far a stored gradient may be from the one in f64, as a share of it: one unit in the last place of f32.
///
/// Example: a slope of 0.5 may be stored 6e-8 off.
pub const GRADIENT: f64 = 1.2e-7;

/// How far a true line may lie from its closed form (sphere, cone, saddle), as a share of the scene's size.
///
/// Example: on a sphere of 400 m radius 1e-6 are 0.4 mm.
pub const CLOSED_FORM: f64 = 1e-6;

/// The same distance for wide toward-away: the line runs through the pixel or through the neighbour that away surface
/// touches, 1.5 sqrt 2 px away at most.
///
/// Example: a line ends in the far corner of a pixel. The neighbour across from that corner (2.12 px) may be ink.
pub const WIDE_REACH_PX: f64 = 2.122;

/// Least share of ink within [`REACH_PX`] for wide toward-away; the other methods have no ink beyond.
///
/// Example: of 460 inked pixels one at either end of a line may be its lengthening.
pub const WIDE_PRECISION: f64 = 0.995;

/// Least precision and recall of adjacency by corners on coarse facets.
///
/// Example: of 925 inked pixels 185 may lie beside the line, where facets are seen edge-on.
pub const ADJACENCY_CORNER: [f64; 2] = [0.8, 0.95];

/// Mean distance of the walk's sub-pixel places from the true line, px.
///
/// Example: places are kept in 1/64 px; rounding alone is 0.004 px off on average.
pub const PLACE_MEAN_PX: f64 = 0.02;

/// Least ratio of the mean distance of pixel centres to that of sub-pixel places.
///
/// Example: centres 0.66 px off (lines are two pixels wide), places at most 0.033 px off.
pub const PLACE_GAIN: f64 = 20.0;

/// How far inked pixels may be from the published or measured number, as a share of it.
///
/// Example: 4 215 pixels: 4 089 to 4 341 pass.
pub const COUNT_SHARE: f64 = 0.03;

/// How far from the mathematical place a hidden part of a line on the land may begin or end, px.
///
/// Example: a line over a crest ends on the contour of facets of a quarter cell, which lies up to .2 px from that of the form, and a
/// chain tells no more than 2 px: behind a flat crest it comes out half of that late.
pub const COVER_PX: f64 = 1.0;

/// How far a line on the land may lie from its place on the form, px.
///
/// Example: 10 m cells at level 4 seen from 400 m: a facet's chord of 2.5 m sags .02 m, .02 px of a page 384 px wide.
pub const LAID_PX: f64 = 0.1;

/// How much the weight of a line on the land may change where the eye moves a thousandth of its way.
///
/// Example: of a branch of 60 px, in the middle of the ramp from 10 to 120 px, a thousandth nearer .06 px more are seen: .001.
pub const FADE_STEP: f32 = 0.02;

/// Steps of a flight, m, and the share of drawn length of lines on the land that may come or go in one but for hiding.
///
/// Example: 30 000 px of line, of which 300 px fade by a tenth: .1 %.
pub const LAND_POPS: [(f64, f64); 2] = [(1.0, 0.005), (10.0, 0.02)];

/// By how much the ink of hachures on a map may differ from what slopes of a class want, as a share of the paper: up to 40 degrees,
/// and above, where strokes must touch.
///
/// Example: slopes of 20 to 25 degrees want half of the paper to be ink, and .42 is.
pub const HACHURE_INK: f64 = 0.045;
pub const HACHURE_INK_DARK: f64 = 0.11;

/// The same on real land, where slopes are not one from a stroke's top to its foot.
///
/// Example: slopes of 45 to 50 degrees want all of the paper to be ink, and .78 is: lines end at every crest and channel.
pub const HACHURE_INK_LAND: f64 = 0.24;

/// Distances from a stroke to the nearest other one, in spacings that its tone wants, and the least share that keeps them.
///
/// Example: where strokes should stand 7 px apart, from 4.2 to 11.2 px.
pub const HACHURES_APART: [f64; 2] = [0.6, 1.6];
pub const HACHURES_APART_SHARE: f64 = 0.95;
/// The same on real land, where lines end at every crest and channel.
pub const HACHURES_APART_SHARE_LAND: f64 = 0.85;

/// Steps of a flight, m, and the share of length of strokes broader than a tenth of a millimetre that may come or go in one but
/// for hiding.
///
/// Example: of 20 000 px of strokes 100 px are gone: .5 %.
pub const HACHURE_POPS: [(f64, f64); 2] = [(1.0, 0.005), (10.0, 0.02)];
/// The same of a turn, degrees.
pub const HACHURE_POPS_TURN: (f64, f64) = (0.5, 0.002);
/// Of all that is seen, the most that may be gone and was of full width.
///
/// Example: of 1 000 000 px of strokes 10 px, where a line begins that was not looked for.
pub const HACHURE_POPS_BROAD: f64 = 1e-5;

/// Of places of a view where land is dark and no other line is near, the least share with a hachure within a spacing and a quarter.
///
/// Example: 960 of 1 000 places; channels and crests that are not drawn, at which strokes end, are among them.
pub const HACHURES_IN_VIEW: f64 = 0.95;

/// Width of a pen, mm: within half of it lines of two sheets of a map join.
///
/// Example: a stream that leaves a sheet 12.00 mm from its corner enters the next at 12.14 mm.
pub const PEN_MM: f64 = 0.3;

/// Crossings of strokes with lines of nearer hills, for each pixel of stroke.
///
/// Example: none on a page with 20 000 px of strokes.
pub const HACHURE_CROSSINGS: f64 = 0.0;

/// Share of ink of one level that may lie farther than [`REACH_PX`] from any ink of the next finer level.
///
/// Example: of 400 px at most 4 px between level 16 and level 32.
pub const LEVEL_STRAYS: f64 = 0.01;

/// Least number of facets that a walk over a plain passes for each node it visits.
///
/// Example: two neighbouring pixels 200 cells apart at level 4 have 1 600 facets between them: at most 160 nodes.
pub const FACETS_A_LEAP: f64 = 10.0;

/// Share of border pixels that may lie on the rim where something hides it: a rim is drawn where its pixel or one of the
/// four beside it shows something farther, so that it runs on for a pixel square to the silhouette, more at a slant.
///
/// Example: of 816 border pixels at most 24, six at each of four places where a hill hides the rim.
pub const HIDDEN_SHARE: f64 = 0.03;

/// What the rasterizer may differ by.
pub mod raster {
    /// Distance on the page between a vertex of the GPU and its f64 evaluation, px.
    ///
    /// Reason: places are rounded to 1/256 px, which alone is up to sqrt(2) / 512 = 0.0028 px; the rest is f32.
    /// Example: with 1109 px per unit of tangent, f32 coordinates of a vertex 20 km away have steps of 0.002 m, which
    /// are 0.0001 px; the unit vectors of the camera in f32 add up to 1109 * 2^-24 * 2 = 0.0001 px.
    pub const VERTEX_PX: f64 = 1.0 / 64.0;

    /// Relative difference of a vertex's depth from its f64 evaluation.
    ///
    /// Reason: a few f32 roundings of 2^-24 each, on top of those of the eye-relative position.
    /// Example: 10 km along the view axis, 2^-20 are 1 cm.
    pub const VERTEX_DEPTH: f64 = 1.0 / (1 << 20) as f64;

    /// Half the width of the cross of five rays that must all hit before an uncovered pixel is a pinhole, px: what a
    /// vertex may be off by, see [`VERTEX_PX`].
    ///
    /// Example: the rim of the DEM passes 0.01 px from a pixel's centre: one of the five rays misses, no pinhole.
    pub const RAY_PX: f64 = 1.0 / 64.0;

    /// Share of covered pixels whose facet may differ from the hardware's.
    ///
    /// Reason: two facets at one depth, which the two rasterizers interpolate with different roundings.
    /// Example: of 262 144 covered pixels, 131 may show the other facet.
    pub const HARDWARE_IDS: f64 = 0.0005;

    /// Relative difference of the two depths where the facet differs.
    ///
    /// Example: two facets that meet 10 km along the view axis: 2^-20 are 1 cm.
    pub const HARDWARE_DEPTH: f64 = 1.0 / (1 << 20) as f64;
}

/// How far a warped sample may lie from a wave of 18 cells and 40 m, m: cubic convolution rounds it, a half-cell shift
/// would move it by 7 m.
///
/// Example: on a crest of 1 540 m the warped sample may be 1 539.9 m.
pub const WARP_METRES: f64 = 0.1;

/// By which share distances on a map may be off those on the ground: what UTM is at its meridian, and a hundred-thousandth.
///
/// Example: 10 km on the ground may be 9.996 km on the map, or 60 km of Mars 59.7 near a pole, where the map is UPS.
pub const MAP_SHARE: f64 = 0.0061;

/// How far a sample resampled on a plane may lie from it, m: weights that add up to 1 but for rounding.
///
/// Example: on a slope of 0.36 with cells of 30 m 0.02 m are a five-hundredth of a cell.
pub const PLANE_METRES: f64 = 0.02;

/// Memory that a filed DEM may take beside its budget, MiB: GDAL's cache, a few tiles on their way, a band at work with its
/// normals, the thinned DEM.
///
/// Example: 27 million samples read within 16 MiB take 70 MiB, held 320.
pub const FILED_MIB_BESIDE: u64 = 80;

/// Memory that reading may take beside the grid and its normals, bytes a sample.
///
/// Example: 18.8 million samples take 244 MB, and 113 MB beside them while they are read and warped.
pub const READ_BYTES_BESIDE: f64 = 6.0;

/// The same while heights become the smoothest within their steps, band by band: all at once it took 15.
///
/// Example: of 19.4 million samples that are read 18.8 million are left, and 46 MB are taken beside those and their normals.
pub const SMOOTH_BYTES_BESIDE: f64 = 8.0;

/// Least share of ink within a pixel between two samplings of the same ground, drawn from afar.
///
/// Example: of 20 000 inked pixels 400 may have no partner: bits of ridges that one grid of 30 m has and another has not.
pub const SAME_TERRAIN_SHARE: f64 = 0.98;

/// The same for the same samples in other units.
///
/// Example: of 20 000 inked pixels 20 may have no partner, where heights round to another f32.
pub const SAME_GRID_SHARE: f64 = 0.999;

/// How far the kernel's count of resident memory may lag, bytes: each CPU keeps a few hundred pages to itself.
///
/// Example: of 128 MiB taken on a machine of 64 CPUs, up to 128 pages of 4 KiB on each may not be counted yet.
pub const RESIDENT_BYTES: u64 = 32 << 20;

/// How much more memory a process may hold after as many frames again, bytes: allocators keep what is freed.
///
/// Example: buffers of a page that are never dropped take 36 bytes for each pixel, 220 KB for one of 96 x 64.
pub const GROWN_BYTES: u64 = 2 << 20;

/// Sines, shares of a ray and of a facet that are decided by less are doubtful: rounding may decide otherwise.
///
/// Example: on a facet of 5 m a ray that passes its side at 5 nm may be held up or not.
pub const DOUBT: f64 = 1e-9;

/// Share of pieces that may be doubtful: those are not compared.
///
/// Example: of 100 000 pieces at most 100.
pub const DOUBTFUL_SHARE: f64 = 0.001;

/// How far the ends of a piece may lie from those that the slow program finds, px; and relative difference of depths.
///
/// Example: two orders of the same sums, seen from 1 m, differ by 1e-12 m, which are 1e-10 px on a page 48 px wide.
pub const SAME_PIECE_PX: f64 = 1e-6;

/// How far sums and shares may be from the same ones in another order.
///
/// Example: 400 pieces of a quarter pixel add up to 100 px within 1e-13.
pub const SUM: f64 = 1e-9;

/// How far offsets of a circle of 200 px moved by up to 4 px may lie from d |cos|, px.
///
/// Example: its top lies 200.04 px from where the middle was, 0.04 px off, but as many points lie nearer as farther: the
/// mean is off by the square of that.
pub const CIRCLE_PX: f64 = 0.005;

/// The same for shares of its pixels, which lie up to 0.7 px beside the circle, as often outside as inside.
///
/// Example: moved by 4 px, 0.224 of its pixels lie within 1.5 px; 0.204 to 0.244 pass.
pub const CIRCLE_SHARE: f64 = 0.02;

/// How far distances between a line and pixels may lie from those between two lines, px: half a pixel.
///
/// Example: a line 4 px away is drawn in pixels whose centres lie 3.5 to 4.5 px away.
pub const PIXEL_PX: f64 = 0.5;

/// How far precision, recall and F of toward-away and walk may be from those of an independent study of the same view.
///
/// Example: precision .998 and recall .942: .932 to .952 pass as recall.
pub const STUDY: f64 = 0.01;

/// The same for adjacency, whose ink depends on which of two facets wins a pixel.
///
/// Example: precision .206: .176 to .236 pass.
pub const STUDY_ADJACENCY: f64 = 0.03;

/// The same for the length of the true line, as a share of it.
///
/// Example: of 3 785 px, 3 748 to 3 822 pass.
pub const STUDY_LENGTH: f64 = 0.01;

/// Least F of truth of half the level, drawn one pixel wide, against truth.
///
/// Example: of 3 785 px of line and as many pixels, 4 px may lie more than a pixel off.
pub const SELF_F: f64 = 0.999;

/// Seconds that truth of the seed scene at level 16 may take on two cores, and that of three million cells at level 8.
///
/// Example: 400 000 rays of 10 us each take 2 s on two cores.
pub const TRUTH_SECONDS: [f64; 2] = [20.0, 120.0];

/// Bytes that a process may take that finds the truth of three million cells.
///
/// Example: grid, normals and bounds take 29 bytes a sample, 87 MB; what is found another 50 MB.
pub const TRUTH_BYTES: u64 = 2 << 30;

/// How far 95 % of truth at level 16 may lie from the contour of mathematics, and of that from truth, px.
///
/// Example: samples 10 m apart hold a sphere of 400 m to 2 cm; seen edge-on from 1 000 m they are 0.007 px, most less.
pub const CONTOUR_H95_PX: f64 = 0.005;

/// Share by which the pixels of the two, drawn one pixel wide, may differ.
///
/// Example: a line along a diagonal of 500 px crosses the corners of up to 25 more, which the middle of a piece may miss.
pub const CONTOUR_PIXELS: f64 = 0.05;

/// How far the slope of offsets over levels, both as logarithms, may be from -2.
///
/// Example: level 1 lies 0.0027 px off, level 4 a sixteenth of that, 0.00017 px; 0.00013 to 0.00022 px pass.
pub const SECOND_ORDER: f64 = 0.2;

/// How far the place where a walk enters a facet may lie from the exact one, steps of the facet's chunk.
///
/// Example: on a way of 2^25 walk units f32 shares are 2 units off, at the finest level a hundredth of a step.
pub const ENTERED_STEPS: f64 = 0.05;

/// How many times as far as the pyramid says facets may leave the surface: between sides that bend to different sides.
///
/// Example: facets that are said to leave the surface by 1 m leave it by 1.3 m at most.
pub const DEVIATION_MOST: f64 = 1.3;

/// Least share of what the pyramid says facets deviate by that they do deviate by, median of the squares of a level.
///
/// Example: facets that are said to leave the surface by 1 m leave it by 20 cm or more in half of the squares.
pub const DEVIATION_SHARE: f64 = 0.2;

/// Share of ink of coarse facets that may lie farther than [`REACH_PX`] from ink of fine ones: where a line ends, a small
/// error across it is a long way along it.
///
/// Example: of 400 px at most 24, two or three at each end of eight lines.
pub const COARSE_STRAYS: f64 = 0.06;

/// How far the place in the world of a point of a chain may lie on the page from the point's own, px.
///
/// Example: coordinates of 4 000 000 m are told to 1e-9 m in f64; 100 m away, at 1 000 px per unit of tangent, 1e-8 px.
pub const REPROJECTED_PX: f64 = 1e-5;

/// How far a traced silhouette may lie from the surface, square to it, px at its distance: a pixel has the depth of its
/// centre, and its chain runs up to a pixel from there and is smoothed by 0.6 px.
///
/// Example: seen with 330 px per unit of tangent from 1 000 m, 2 px are 6 m.
pub const CHAIN_OFF_SURFACE_PX: f64 = 2.0;

/// How far a north may be from its closed form on the sphere, degrees.
///
/// Example: places of 6e6 m in f64 are 1e-9 m off, which turns differences over 2 m by 3e-8 degrees.
pub const NORTH_DEGREES: f64 = 1e-6;

/// How far the convergence of UTM's meridians may be from that on the sphere, degrees.
///
/// Example: 2.9 degrees from the middle at 65 degrees north it is 2.628695 on the ellipsoid, 2.628693 on the sphere.
pub const CONVERGENCE_DEGREES: f64 = 1e-4;

/// How far from the middle column a peak due north may stand, px.
///
/// Example: the top of a smooth peak is a row of some 10 px, whose mean may be a pixel off.
pub const DUE_NORTH_PX: f64 = 1.5;

/// How far the height of fine land laid in coarse may be from that in its file, m: it is that, but between samples.
///
/// Example: four samples 10 m apart have 488.7 m on average where the land between them has 488.75 m.
pub const FINE_METRES: f64 = 0.1;

/// How far smooth land of 90 m may lie from the truth in cells of 10 m, m: what cubic convolution does not know between.
///
/// Example: on a hill of 1 200 m with flanks of 2 km 0.3 m.
pub const ENLARGED_METRES: f64 = 1.0;

/// How far a slope may be off where two files with other cells meet, m: a membrane between their outermost samples.
///
/// Example: on a slope of 0.15 cells of 10 and 30 m leave a gap of 20 m, and half a cell of clamped heights 2.2 m.
pub const NEIGHBOURS_METRES: f64 = 0.1;

/// Steepest step of a seam's weight, as a multiple of an even one: 1.875 for the smooth step of fifth degree, and one more
/// sample of rounding.
///
/// Example: 20 m over 36 samples are 0.56 m a sample on average, at most 1.04 m in the middle.
pub const SEAM_SLOPE: f64 = 1.95;

/// Most facets of coarse land in fine cells, as a multiple of those that it takes in its own.
///
/// Example: 100 000 facets of the wide file alone may be 130 000.
pub const MIXED_FACETS: f64 = 1.3;

/// How far the smoothest surface within the steps of a plane may lie from it, as a share of a step, away from the DEM's
/// border: there half a step is left open.
///
/// Example: a plane rounded to whole metres comes back to 10 cm.
pub const PLANE_OF_STEPS: f64 = 0.1;

/// Least and most ink of hills without their steps, as a share of that of the hills before they were rounded.
///
/// Example: of 900 px at least 720 and at most 1 125.
pub const STEPLESS_INK: [f64; 2] = [0.8, 1.25];

/// Least F, within a pixel, of the ink of the one against that of the other.
///
/// Example: 900 px each, of which 135 lie elsewhere.
pub const STEPLESS_F: f64 = 0.85;

/// Least share of its height that a crest keeps when heights are generalised.
///
/// Example: of a roof of 100 m at least 98 m.
pub const CREST: f64 = 0.98;

/// Most of the energy of noise and trees that may be left, as a share of it.
///
/// Example: trees and noise of 1 m, root mean square, leave 0.14 m.
pub const NOISE_LEFT: f64 = 0.02;

/// How far a generalised plane may lie from itself, m: heights of 1 000 m are stored to 0.00006 m.
///
/// Example: a plane at 1 000 m comes back to 1 mm.
pub const PLANE_M: f64 = 1e-3;

/// Most that the weight of a line may change where points move by 0.05 px, or jumps by 1 %.
///
/// Example: a line of 1 px that lies between two others is 0.8 to 1.2 px wide in the next frame.
pub const WEIGHT_STEP: f32 = 0.2;

/// Weight from which a line counts as drawn: 0.25 px of a pen of 1 px, a gray line.
///
/// Example: of 100 px of line with weight 1 on 60, 0.3 on 20 and 0.1 on 20 px, 80 px are drawn.
pub const VISIBLE_WEIGHT: f32 = 0.25;

/// Most darkness of a block of 12 x 12 px of far land, a share of black.
///
/// Example: seven lines of 0.6 px across a block are 0.35.
pub const BLOCK_DARKNESS: f64 = 0.35;

/// Of lines of more than twice the least jump, the share of length that economy leaves at least.
///
/// Example: of 20 000 px at most 6 000 px yield.
pub const LINES_KEPT: f64 = 0.7;

/// How far from the skyline the stroke of a column may run, px.
///
/// Example: land begins at y = 300.0; a stroke at 298.6 is near enough.
pub const SKYLINE_PX: f64 = 1.5;

/// How far contours may lie from those of mathematics on average, and those from them, px.
///
/// Example: of a cone on samples 12 m apart, 900 m away, lines are 0.007 px off, nearly all of it about the apex.
pub const CONTOUR_MEAN_PX: f64 = 0.02;

/// Least share of pieces of contour with what faces the eye by mathematics on the left, and what does not on the right.
///
/// Example: of 265 pieces at most 5, where a contour bends by more than a cell.
pub const CONTOUR_LEFT: f64 = 0.98;

/// How far from a cusp of mathematics the contour of facets may turn concave, px.
///
/// Example: about a cusp the contour runs along the ray, where 20 m of land are a fifth of a pixel.
pub const CUSP_PX: f64 = 0.25;

/// Shortest run of a contour between two cusps, px: patches meet in kinks, about a cusp contours turn there to and fro.
///
/// Example: three cells of 20 m along the ray are half a pixel.
pub const CUSP_RUN_PX: f64 = 0.5;

/// How far a chain may end from a cusp of mathematics on the page, px.
///
/// Example: where the last hundredth of the contour runs along the ray, it ends half a pixel early.
pub const CHAIN_END_PX: f64 = 1.0;

/// Sine of the angle between surface and ray at a vertex up to which rounding decides which way it faces.
///
/// Example: seen from 1 km a vertex 1 cm off turns a surface by 1e-5.
pub const TURNING_SINE: f64 = 1e-5;

/// How far ends of pieces of contour may lie from those of the twin on the page, px.
///
/// Example: on a facet of 4 px seen nearly edge-on a crossing may slide by a four-hundredth of its edge.
pub const CROSSING_PX: f64 = 0.01;

/// Share of pieces of contour that one program alone may find, on facets with such a vertex.
///
/// Example: of 10 000 pieces at most 20.
pub const TURNING_SHARE: f64 = 0.002;

/// How far the end of a part of a curve may lie from the start of the next on the page, px: on either side of a lattice edge
/// its place is found anew.
///
/// Example: f32 shares of a facet of 10 px are off by 1e-6 px; vertices of two chunks are the same.
pub const JOINT_PX: f64 = 1e-3;

/// Largest distance of a hidden line from where the same line is seen without the land before it, px.
///
/// Example: both are found on lattices that deviate by 0.15 px where chunks differ; hidden 0.3 px off would be another line.
pub const HIDDEN_PX: f64 = 0.1;

/// How far a chain may end from the nearer line it ends on, px: rounding of places on the page in f64.
///
/// Example: at x = 2000 a place is rounded to 2.3e-13; an intersection loses some digits more.
pub const ON_LINE_PX: f64 = 1e-9;

/// Least share of the length of chains that keeps its name when what the chains hold changes by some 3 %.
///
/// Example: of chains of 1 000 px in all, at most 100 px are called otherwise in the next frame.
pub const NAMES_KEPT: f64 = 0.9;

/// How far a mean over lines may be from the same over their pieces, px: where a line leaves the page, the piece is cut.
///
/// Example: of 500 px of line 0.02 px off, four pieces of a quarter pixel, 0.02 px off, too, lie half beside the page.
pub const CUT_PX: f64 = 1e-4;

/// Pixels of chains without ink, and of ink without a chain, as shares of all ink.
///
/// Example: of 10 872 px of ink on steep land 19 px have no chain: folds narrower than a facet.
pub const STRAYS: f64 = 0.005;

/// The same of hills so far that no ridge is nearer than another by a share worth speaking of.
///
/// Example: of 2 725 px of ink; chains have 54 px more, 785 px where what is hidden counts as seen.
pub const FAR_STRAYS: f64 = 0.04;

/// Least precision and recall of the walk where a spire as thin as a pixel stands against the sky.
///
/// Example: of 560 px of skyline at most 5 have no ink within a pixel; it was .63 and less.
pub const SPIRE: f64 = 0.99;

/// How far from the border of what a stroke covers its outline may be wrong, mm.
///
/// Example: the middle of a chord of an arc lies .004 mm inside it.
pub const OUTLINE_MM: f64 = 0.005;

/// How far a length of 100 mm may be off in a picture, mm.
///
/// Example: at 4 px/mm each end of a bar is a pixel of 64 shades or more: .004 mm.
pub const LENGTH_MM: f64 = 0.1;

/// Side of the blocks in which pictures of two rasterisers are compared, px.
pub const STRANGER_BLOCK_PX: usize = 16;

/// How far the mean of a block may be off in a channel, of 255, where resvg draws.
///
/// Example: a line of 2 px through a block of 16 is 32 of 255 on average; drawn a fourteenth wider it is 2.3 off.
pub const RESVG_DARKNESS: f64 = 3.0;

/// The same where poppler draws, which makes pixels that are covered in part lighter than their share.
///
/// Example: of such a line three pixels in four are black in part; where each is a tenth lighter, the block is 2.4 off.
pub const POPPLER_DARKNESS: f64 = 7.0;

/// How many times as far blocks may be off where lines crowd.
///
/// Example: two lines that cover half a pixel each cover half of it or all, as they lie; laid one over the other, blind, three
/// quarters. Dashes of hidden lines upon each other: a block 3.5 off where resvg draws.
pub const CROWDED: f64 = 1.5;

/// Darkness of a pixel that must be answered by another picture within a pixel, of 255.
pub const DARK: u8 = 96;

/// Darkness that answers.
///
/// Example: a line of one pixel of black that lies half and half in two columns is 128 there, or 255 in one of them.
pub const NEARLY_DARK: u8 = 32;

/// Longest time to write a million short strokes as SVG, s: three times what two idle cores should take at most.
///
/// Example: 1.2 s on two cores.
pub const SVG_SECONDS: f64 = 9.0;

/// Most memory that takes beyond the drawing, bytes.
///
/// Example: two pieces of 1 MB a core, and what the allocator keeps: some 10 MB on two cores.
pub const SVG_BYTES: u64 = 64 << 20;

/// Most that the ink of the walk pops from frame to frame more than truth does, 1 m apart: a share of it.
///
/// Example: of 5 465 px of the sample at 640 x 360 none in 20 frames, .007 % of west-temple's 2 113 px.
pub const MASK_POP: f64 = 0.0005;

/// Most of the darkness of strokes that pops from frame to frame, 1 m apart.
///
/// Example: .06 % on the sample, half of it lines that fade; one line of a thousand that is gone is as much as this.
pub const STROKES_POP: f64 = 0.001;

/// Most of the darkness of two equal lines that one of them loses from frame to frame while its jump falls from 2.5 to .9 times
/// the least in 20 steps.
///
/// Example: two smooth steps one after the other are 2.5 times as steep as even ones, .08 of the least jump a frame: .2 of the line,
/// .1 of the two.
pub const LEAP: f64 = 0.12;

/// How far a line may move between near and far where half a line of a hundred comes to the page.
///
/// Example: .055 where it is twice as far as all others; the depth of the nearest twentieth would go from one ridge to the next,
/// .4 and more.
pub const RECESSION_STEP: f64 = 0.08;

/// How near a line has to come to a valley's bottom or a crest, cells.
///
/// Example: of cells of 30 m, 12 m to either side.
pub const BOTTOM_CELLS: f64 = 0.4;

/// How far lines that come so near may be from it on average, cells.
///
/// Example: of cells of 30 m, 9 m.
pub const BOTTOM_MEAN_CELLS: f64 = 0.3;

/// Least share of the bottom, or crest, with a line so near.
///
/// Example: of a valley of 200 cells, 180.
pub const BOTTOM_SHARE: f64 = 0.9;

/// How far from all bottoms a line is elsewhere, cells.
///
/// Example: two lines beside a meander, 1 cell from it, are not; a spur's of a valley that has none is.
pub const ELSEWHERE_CELLS: f64 = 2.0;

/// Most length of lines elsewhere, as a share of that of all bottoms.
///
/// Example: 20 cells beside a valley of 200.
pub const ELSEWHERE_SHARE: f64 = 0.1;

/// Most cells of line a cell of a rough plane, where none belongs.
///
/// Example: 225 cells of line on 150 x 150 cells; on rough land there are 10 times as many.
pub const PLANE_SHARE: f64 = 0.01;

/// Most samples whose water goes over a higher pass than it could, as a share of all: where a way would have crossed another.
///
/// Example: 6 of 6 300.
pub const OVER_THE_LOWEST_PASS: f64 = 0.001;

/// Longest gap between points of a line of the land, cells: half a cell, and what bends to a joint.
///
/// Example: over the last 3 cells a line may be moved by 2.
pub const LINE_SPACING: f64 = 2.0;

/// Most places where ridges and drainage cross, a ridge.
///
/// Example: 3 of 385: both are moved by cells where a valley's side is narrow.
pub const CREASES_CROSS: f64 = 0.01;

/// Most turns by over 30 degrees between pieces of half a cell, as a share of all.
///
/// Example: 15 of 13 000, at joints; stairs of the grid turn by 45 at every second.
pub const BENT: f64 = 0.005;

/// Longest time for flow and areas of a million samples, s: four times what one idle core should take.
///
/// Example: .16 s.
pub const RELIEF_SECONDS: f64 = 1.0;

/// Most memory that takes beside the heights, bytes a sample.
///
/// Example: catchments or areas 4, lengths 4, directions, parents or what waits 1 each, the front.
pub const RELIEF_BYTES: f64 = 16.0;

/// Least share of channels with one of a stranger's within a sample, and the other way.
///
/// Example: of 723 samples of west-temple 651.
pub const STRANGERS_CHANNELS: f64 = 0.9;

/// How far slope lines may run from the gradient of the surface, degrees, and the least share of their length that runs no farther.
///
/// Example: where patches meet in a kink, a line bends within half a cell by up to 10 degrees.
pub const DOWNHILL_DEGREES: f64 = 5.0;
/// See [`DOWNHILL_DEGREES`].
pub const DOWNHILL_SHARE: f64 = 0.95;

/// The same two on waves of ten cells as steep as 60 degrees, where the surface between samples bends sideways.
///
/// Example: .92 of the length is within 2 degrees, .82 of that of lines which take places on the lattice for places on the map.
pub const DOWNHILL_WAVES: (f64, f64) = (2.0, 0.9);

/// How far points of slope lines may lie from the surface, cells: between vertices of level 64 it is taken to be flat.
///
/// Example: in cells of 30 m where two patches meet on a slope of 65 degrees, 30 cm.
pub const ON_SURFACE: f64 = 0.01;

/// By how much places with room for a spacing may lie nearer to each other, as a share of it: lines bend between the middles of
/// pieces, and room is known at points alone.
///
/// Example: at 4 cells, places 3.8 cells apart.
pub const SPACED_TOLERANCE: f64 = 0.05;
/// Least share of places that keep the spacing: what lies ahead of an end and what beside it is a matter of the last piece, which
/// may bend.
///
/// Example: of 10 000 places, 9 870.
pub const KEPT_SHARE: f64 = 0.985;

/// Least share of the middles of lines that have another at most two spacings away.
///
/// Example: of 400 lines, 380.
pub const SPACED_SHARE: f64 = 0.95;

/// Most places of an even slope that are farther than a spacing and a quarter from every slope line, as a share.
///
/// Example: 12 of 4 000, beside ends of lines.
pub const HOLES: f64 = 0.003;

/// By how much the room of a point may be from that by its definition, as a share of it, and the least share of points that are no
/// farther off: where a line comes to be drawn that was not, room leaps.
///
/// Example: of 8 000 points, 140 beside places where another line has just as much room as it is away.
pub const ROOM: f64 = 0.02;
/// See [`ROOM`].
pub const ROOM_SHARE: f64 = 0.98;

/// Longest time for all slope lines of a million samples down to a spacing of a cell, s: ten times what two idle cores take.
///
/// Example: 5 s of one core, beside three other tests 10 s.
pub const SLOPE_SECONDS: f64 = 30.0;

/// How far a place that is told of a pixel may lie from the closed form, metres: heights of samples are f32.
///
/// Example: on a plane that rises by .2, seen 20 degrees from above, a sample of 500 m that is .03 mm off moves the place by .2 mm.
pub const PICKED_M: f64 = 0.002;

/// How far lines that are written on the map may leave the surface, in cells.
///
/// Example: over cells of 25 m lines may run 25 cm above or below the land between their points.
pub const MAPPED_CELLS: f64 = 0.01;

/// How far their places in degrees may lie from those in metres, degrees: ten decimals are written.
///
/// Example: 1e-9 degrees of latitude are .1 mm.
pub const MAPPED_DEGREES: f64 = 1e-9;
