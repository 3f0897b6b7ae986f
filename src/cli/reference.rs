//! What `--help` says below the flags, and man pages behind them: how files are read, what drawings hold, what figures mean.
//!
//! A paragraph is one line, which help wraps; items of lists begin with spaces, so that man pages keep them apart.

use crate::stress::Promise;

/// What stands below the flags in long help, with empty lines between.
pub(crate) fn of(parts: &[&str]) -> String {
    parts.join("\n\n")
}

/// Of every subcommand.
pub(crate) const ALL: &str = "\
Exit codes: 0 done; 1 failed, with one line that says what, where and the remedy; 2 wrong usage; 75 ended by a signal, or the \
device was lost: try again.

Files get their final name only when they are whole. None takes the place of a file that the DEM is made of: parts of VRTs, \
archives, headers, world files, masks, links to any of them. Names of files are printed with control characters, marks that \
turn text around and bytes that are no UTF-8 escaped.

One output may be `-`: standard output, which then gets the whole file and nothing else, at the end; lines go to standard \
error. A reader that goes away is no error.";

/// Of `hachure info`: what is read.
pub(crate) const READ: &str = "\
Formats, with what each was tested in:
  - GeoTIFF, BigTIFF: metres, feet, degrees; int16, float32, float64; Deflate, LZW; tiles, masks, scale and offset
  - Esri ASCII grid: .asc, .asc.gz; with and without .prj
  - Esri float grid, BIL: .flt, .bil; degrees
  - ENVI: degrees; a file cut short is noticed, unless a VRT names it
  - USGS DEM: .dem; NAD27 UTM, degrees
  - SRTM: .hgt, .hgt.zip; 1\" and 3\"; the place is the name, and a copy such as `N45E006 (1).hgt` is told which one it \
    needs
  - netCDF: one grid; one of several as NETCDF:file.nc:grid
  - VRT: scale, nested, mosaics; sources are inspected, see below
  - PNG of 16 bits: with a world file, or with --cell M
  - Idrisi: .rst; metres
  - archives: .zip, .tar, .tar.gz, .tgz, .gz of these: the one raster inside is taken, and said; of several name one: \
    /vsizip/x.zip/a.tif, /vsitar/x.tar.gz/a.tif

Others that GDAL reads, such as COG, DTED, HFA, JPEG 2000, HDF5 and GeoPackage, are let in and not tested.

Several files: those on one grid are laid together, the last on top. Those on several grids are drawn in the cells of the \
finest whose samples fit --memory: each is warped straight to them, cubic, the finest on top whatever the order, seams blended \
over four cells of the coarser, at most half the radius of the largest disk in the finer part; neighbours that only touch are \
joined across the gap between their outermost samples; small holes of the finer are filled with the coarser, moved to meet \
their rims. Where the finest does not fit, a warning names both cells, and the --crop or --memory that would draw it. \
Thousands of files need no more than some dozens of open ones.

What is done with a file is printed, and stands in `draw --json`; what had to be assumed is a warning that says how to say \
otherwise:
  - projected, north up: taken as it is, sample by sample
  - south-up, mirrored, west or south axes: turned by reading backwards or rows for columns, sample by sample; --eye and \
    --crop stay in the file's own coordinates (EPSG:5513, 2065, 2048)
  - a map off the ground by over 1 % (sinusoidal, plate carree, web Mercator): warped to the UTM zone of its middle \
    where the outcome fits --memory, else drawn as it is with a warning that names scale and shear
  - degrees: warped to the UTM zone of the middle of what is drawn (near the poles: UPS), cubic, square cells as large \
    as the file's, cut to the largest rectangle inside the data
  - rotated: the same, in its own projection
  - another body than the Earth: mapped on the ellipsoid of its system; --lonlat is longitude and latitude there
  - a local system: drawn as it is; --lonlat is refused
  - heights in steps (whole metres or feet, tenths, 8-bit maps): the smoothest surface within half a step of them (thin \
    plate; no height leaves that band), before any warp, so that hills have no stairs; lakes and the sea stay flat. Relief \
    lower than a step that shows in no contour is lost; steps below 10 cm are none
  - feet, other units: turned into metres, on the map and upward, by the units of its CRS and its band
  - depths: turned over where `positive: down`, or depth in the standard or long name, says so
  - several bands: --band says which is taken; their names are told
  - pictures: refused unless --band names a band; heights in the colours of Terrain-RGB or Terrarium are recognised, \
    --encoding decodes them; 8 bits are warned of
  - heights that cannot be: off the Earth, one number far from all others, the largest of its type, signs lost in \
    unsigned numbers: told with number, share and the flag that helps; nothing is changed without it
  - voids: holes: declared nodata, masks, NaN, and undeclared marks (at or below -32767, above 100 000 m), marked before \
    anything is resampled
  - no system of coordinates: metres, or degrees where cells are tiny; a warning
  - no place at all (an image): --cell M gives the size of its cells
  - a place that cannot be: degrees beyond a pole or a turn, cells under a millimetre, degrees under the name of a map: \
    refused, with the command that mends the file
  - curvilinear (geolocation arrays): refused with the `gdalwarp -geoloc` line that makes a grid

A file cannot make hachure reach for anything else: only the formats of a list are opened; names on a network and VRTs that \
refer to files outside their folder are refused without --allow-remote; Python in VRTs is never run. Not inspected: HFA and \
HDF5 files that keep samples in another local file. Sizes and memory are checked before memory is taken; of a huge file --crop \
reads a part, and nothing else is touched. How DEMs that do not fit --memory are read, `hachure cache --help` says.";

/// Of `hachure cache`: large DEMs.
pub(crate) const KEPT: &str = "\
Kept are truths, drainage and ridges, slope lines of first views, and of a DEM that stays in its files what takes a look at \
every sample; on Linux in ~/.cache/hachure. A file may be removed at any time; one that is damaged, or no plain file, is noticed \
and made anew. One process makes what others wait for. Beyond --cache-size what is in use or just made stays.

A DEM of more than 33 554 432 samples, or of more than --memory holds at 12 bytes each, stays in its files. `hachure info` goes \
through it in bands, on every core (its range is that of the file's numbers, before they are smoothed), and keeps no more than \
half of --memory of what it read; `hachure draw --level auto` reads the windows that the page shows. Once for a file, in one \
pass, is found and kept:
  - its figures, which samples are void, steps and flat water
  - smoothed heights: 4 bytes a sample
  - bounds of all squares, and overviews (every 2nd, 4th ... 64th sample, from which facets coarser than the grid are \
    drawn): 1.9 bytes a sample

A later view reads of the file only what it shows at level 1 and finer. What is kept depends on every file the DEM is made of \
(path, size, time, both ends), on band, crop and way of reading; bounds, which take one more look, on the exaggeration and on limits \
of folds too. A file that changes or breaks while it is drawn fails the frame.

`compare` holds all samples: take a part with --crop. What is warped or filled must be held, for GDAL then needs all samples at \
once: warp it to a map first (gdalwarp), or fill it (gdal_fillnodata.py). Tiled files come in best.";

/// Of `hachure draw`: what its files hold.
pub(crate) const DRAWN: &str = "\
A drawing is a sheet with layers; a layer has one pen and strokes, all in millimetres. From bottom to top, which is the order of \
plotting, stand hidden lines, hachures, lines of the land (shores, drainage, ridges, your own), the border, and silhouettes; \
--split parts each by distance, pens of one width part it by width. Names begin with the number: `2 silhouette 0.5 mm`. No \
stroke leaves the margins: lines are cut half a pen inside; of a plan, whose border is the edge, half a pen lies in them. What \
the lines are and how a style draws them, `hachure styles --help` says; what is read and how, `hachure info --help`.
  - SVG: one unit is one millimetre; a group a layer, as Inkscape and plotters know them; a path a stroke, named after \
    its chain, `c` and a number that stays with the line when the eye moves a little, then which piece of it. Nothing is \
    clipped, masked or transformed: what is in the file is what is drawn
  - PDF: the same, compressed, with layers that readers list
  - PNG: with its size in metres

Furniture (--title, --neatline, --view-line, --credits) stands on top, in a layer of its own, or one a pen: rules and letters as areas, in the outlines of Old Standard (SIL Open Font License); for plotters as single strokes, Hershey's Roman simplex. No reader needs a font. Sizes grow more slowly than sheets: a title is 7.6 mm an em on A4, a view line 3.1, credits 2.5. What is too long is set smaller, view line and credits in two lines, down to 1.8 mm (2.4 for pens); beyond that, or with a letter that the font lacks, nothing is drawn. Old Standard has Latin, Greek and Cyrillic; single strokes have Latin. The title is told in the file too, as the title of an SVG or a PDF.

Lines of varying width are written as the areas they cover; those of one width, and with `centre-lines = true` in [plot] all, as \
the lines that a pen follows. The same input gives the same bytes.

Each line of the mask of 6 pixels and more has its stroke, unless economy or the pens leave it out: `without_stroke` in --json \
says which, and why. Ink of the walk that no contour accounts for, and that of other methods, is traced.

A page without a line is warned of, with flags of a view that has lines. Of land beyond 16 km is said by how much it stands too \
high on a flat Earth: d^2 / 2R, 196 m at 50 km (`flat_earth` in --json).";

/// Of `hachure styles`: files of styles, and what they draw.
pub(crate) const STYLES: &str = "\
A style of your own is a TOML file, which may say as little as
  base = \"atlas\"
  min-gap = 0.6            # millimetres, as all lengths

  [pens.silhouette]
  width = 0.25
  colour = \"#5a3a1e\"
  opacity = 0.8            # of the layer: where its lines cross, nothing is darker

Mistakes are told with line, column and the key that was meant. --schema says what each key means.

Silhouettes are thinned by distance and taper; they fade where what lies behind is hardly farther (min-jump) and where a \
stronger line is near (min-gap): by jump, kind, length and nearness. The skyline does not.

Creases are lines of the land whatever the eye, each kind in a layer with a pen of its own, hidden as silhouettes are and weaker \
than they: where both would stand side by side the silhouette stays.
  - drainage: where water runs, in the bottoms of valleys; broader by Strahler's order. Channels begin where the falls of the \
    streams tell (25 to 100 cells of land), or where --channel-area says; no height changes. Voids are outlets: a river ends at a \
    hole (--fill-voids closes it)
  - ridges: where water parts: the same on the land turned upside down, as far as the waters on both sides run on before \
    they meet; broader by their length
  - shores: rims of flat water, the sea at 0 and lakes that lie level. No channel is drawn over them; without them streams \
    run through lakes
  - your own (--lines): cut at voids and at the DEM's edge. Each layer of a file is one of the drawing, called after \
    itself or, the only one, after its file; its pen is [pens.lines.NAME], else [pens.own]

A branch is drawn as far as the page shows why: by its length, its fall, how far the land beside it stands up and at which slope; \
streams of over 4 km through plains too. It fades by width, always reaches what it joins, and nothing of it depends on where the \
eye looks. Of a DEM that stays in its file creases are found on at most 8 388 608 blocks of samples, lowest samples for water and \
highest for crests, shores where half of a block is water. Lines that a crop begins or ends may run otherwise than those of the whole.

Hachures are strokes down the slope, which give the tone by their width and by how close they stand: lehmann that of slope \
(share of ink = slope / 45 degrees, Lehmann 1799; black-at 50 is Mueffling, 60 Bavaria, 80 Austria), shadow that of light against \
level land, which stays blank, both their mean. A style has them in [hachures], [light] (azimuth of the world; else 45 degrees \
left of where the eye looks, in a flight at its first frame, and the north-west in plans) and [pens.hachure]. They end half a \
spacing short of silhouettes and of lines of the land before them. Far from the eye they run down land at a smaller scale, \
halved with each doubling of the distance, as a hand would draw it; maps show it as it is. Land so near that they would stand closer than an eighth of a \
cell gets none, which is warned of. Of a DEM that stays in its file they run on every so-manieth sample.

For plotters (style `plotter`) strokes of a layer that meet are joined, none is drawn twice, dots are 0.05 mm long and nothing \
shorter is left; they stand in an order with little travel. What the pen will do is printed: length on paper and in the air, \
before and after, and the time at the style's speeds.";

/// Of `hachure fly`: the way.
pub(crate) const FLOWN: &str = "\
The way is a centripetal Catmull-Rom spline, flown at constant ground speed or in the times of its keys; heights above ground \
follow the smoothed land, and the eye is lifted smoothly where it would come nearer to the drawn surface than --clearance. A \
camera depends on the flight and its number alone, so that frames drawn on different machines agree. Motion pictures are made \
of the frames' files, which stay: .gif with the ramps from the paper to each pen as its palette and delays that add up.";

/// Of `hachure batch`: its file.
pub(crate) const LIST: &str = "\
The file is TOML. Its keys are the flags of `hachure draw` without their dashes, its paths count from the folder in which the \
command runs:

  [defaults]
  dem = \"dem/golden-gate.tif\"
  style = \"atlas\"
  size = \"1600x700\"

  [[drawing]]
  name = \"from the north\"
  output = [\"north.png\", \"north.svg\"]
  eye = \"547500,4190300,+300\"
  azimuth = 190

A drawing that says false to a key leaves the default out. The manifest stands in the folder of the first drawing.";

/// Of subcommands that make many drawings.
pub(crate) const JOBS: &str = "\
Each file bears the name of all that it is made of: what the DEM's files hold, how they are read, way or view, style, page, and \
the program's sources (PNG: text chunks, SVG: metadata, PDF: document information). A file that is whole and bears the right \
name is not made again, without a look at the DEM: a run that was cut off goes on where it ended. The adapter is noted there, \
and is no part of the name. SIGTERM and Ctrl-C finish what is at hand and give 75 (asked twice they end at once), as does a lost \
device: try again. What failed by itself costs itself alone, is told at the end and gives 1, as do a full disk and too little \
memory; wrong flags give 2.

Each process leaves a manifest in the folder (hachure-0-of-4.json); `hachure merge DIR` holds all of them against the files. A \
folder takes one sequence: another way, DEM or number of frames is refused.

With --serve a bad job costs itself alone; DEM, land and shaders stay on the device from job to job. The process ends with \
standard input, by itself when nobody reads its answers any more, and with 75 when the device is lost: jobs without an answer \
are sent to another. What --list says holds for two cores and a software driver.";

/// Of `hachure compare`: truth and figures.
pub(crate) const COMPARED: &str = "\
Each drawing is measured against truth, an independent reference, and by its time. report.html needs no network: the plot of \
error against time, which method to use when, a table that sorts, every picture at full size to lay over another, how sure truth \
is of itself. Beside it stand results.json, results.csv, error-time.svg, the mask of each run (_mask.png), its difference from \
truth in three inks (_difference.png) and truth drawn one pixel wide (_truth.png).

Truth is the PN surface at a high level in double precision on the CPU: the convex edges between facets toward the eye and \
facets away from it, and the rim where border lines are drawn; a piece of line, a quarter pixel long, is visible if a ray from \
the eye reaches it past every facet. Whole cells are proven to face one way, or to be out of the ray's way, by bounds; no level \
is stored. With the drawing passes it shares the DEM, the vertex normals and the camera, nothing else. Truth of half the level, \
drawn one pixel wide, is measured against it: self_f. Its lengths are those of edges, which run to and fro along a line: where \
that lies aslant to the grid, recall weighs it up to twice. For tens of millions of samples seen from within, give --truth-level.

Figures, each beside the time and what was computed:
  - precision, recall: share of inked pixels whose centre lies within k + 0.5 px of truth; share of truth's length \
    within k + 0.5 px of an inked centre. k = 1; also 0.5, 2 and 3, and in three bands of depth
  - F: their harmonic mean
  - gaps, spurious: 8-connected sets of at least 3 missed truth pixels; 8-connected sets of ink wholly farther than 2.5 \
    px from truth
  - chamfer, H95: mean of the two directed mean distances; larger of the two directed 95 % distances, px
  - fragments: share of 8-connected sets of ink with fewer than 6 px, beside truth's own
  - recall by pixels: share of the pixels of truth, drawn one pixel wide, with ink within 1 px: it does not weigh up \
    lines that run to and fro
  - chains: curves, or what ink is traced to, every quarter pixel: how many, how long, mean and 95 % distance from \
    truth, precision and recall within 1 px, the share of truth that economy removes, the share under 6 px beside that of \
    truth's drawing, and ids kept: the share of the length of chains over 12 px that is called the same when the eye has \
    gone on by 1 m
  - excess pop: share of ink without ink of the next frame (1 m on) within 1 px, less the same for truth
  - sequences (--path): of masks excess pop, mean over the frames, with recall beside it; of strokes in the default \
    style the darkness (width times length, followed where the land is) that the frame before or after lacks though truth \
    has it in both; the share of length that keeps its id
  - place: mean and 95 % distance of the walk's sub-pixel places from truth, px
  - convergence: distances of the flip edges of coarser levels from truth, and the slope of their medians over the \
    level, both in logarithms: -2 is second order
  - frame, first frame: milliseconds, camera to mask: by the wall clock on software drivers, by the device's timestamps \
    on GPUs. Medians of warm frames, each of which moves the eye 1 m on; the first frame stands apart
  - bytes, operations of a pass: what it must move and compute, counted from what the frame worked through: each value \
    that it reads or writes once, both ways where it does both; additions, multiplications, divisions and comparisons of \
    one number

With --floor the device does two other things in turn with the warm frames, by the same clock and as often, so that every time \
has its distance from the limit beside it: a bare copy of as many bytes as the frame's passes move, and one hardware draw of the \
facets that the frame rasterizes.

The keys of results.json are described in the crate's documentation, under report::results and measure::figures. Two runs of one \
comparison differ in `..._ms`, `..._mib`, `passes` and `floor` alone.

A file of views is JSON: {\"views\": [{\"name\": \"crater\", \"dem\": \"st-helens.tif\", \"eye\": [560374, 5124979, 1223], \
\"azimuth\": 170, \"altitude\": -3, \"fov\": 60}, ...]}; \"lonlat\": [LON, LAT, HEIGHT] may stand for \"eye\", \"+200\" for a \
height of 200 m above the ground; \"north\": \"true\" has azimuths count from true north, not grid north. Its views of the DEMs \
given are drawn, each DEM by itself.";

/// Of `hachure stress`: cases and promises.
pub(crate) fn stressed() -> String {
    let promise = |promise: Promise| format!("  - {}: {}", promise.name(), promise.says());
    let promises = Promise::ALL.map(promise).join("\n");
    format!("{STRESSED}\n\nPromises:\n{promises}\n\n{STRESSED_FILES}")
}

const STRESSED: &str = "\
A case is land made for it, the same on every machine, with its views and what it promises: land of slopes up to 10 000, a needle \
of 10 km, planes that hold the eye, fields of view of 0.001 to 179.9 degrees, cells of a millimetre and of 10 km, pages of one \
pixel, voids of every shape; and ordinary hills beside them. Every method draws each view; what is promised is measured, and \
stands beside its limit and the time of the frame. Promises are those of the walk and the contour; other methods are held to \
them where their line says so, and told in any case.";

const STRESSED_FILES: &str = "\
A broken promise gives 1 and a line that names case, view, method, promise and figure; the report is whole all the same. It needs no \
network: what is promised and what came nearest to breaking it, the plot of error against time with ordinary land ringed, a table \
of all runs that sorts, and a picture a view: land, ink of the walk on truth (black), missed (blue), astray (red-orange), rings \
about the places where promises are measured worst. Beside it stand results.json (cases, runs, checks), results.csv (a row a \
promise), error-time.svg and the pictures. Amplification is the change of lines over the change of the eye, both in pixels of the \
page: 1 is what projection does by itself.";
