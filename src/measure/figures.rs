//! What is measured of a truth and of a run. `results.json` holds it under the same names.
//!
//! Lengths on the page are pixels (`_px`), on the ground metres (`_m`), times milliseconds (`_ms`), memory mebibytes
//! (`_mib`). Shares run from 0 to 1.

use std::fmt::Display;

use serde::{Serialize, Serializer};

use crate::plan::Detail;

/// How truth was made and how sure it is of itself.
#[derive(Debug, Clone, Serialize)]
pub struct TruthReport {
    /// Subdivisions of a cell's edge.
    pub level: u32,
    /// Visible line on the page.
    pub length_px: f64,
    /// Of it, border lines.
    pub border_px: f64,
    /// Of 8-connected pixel sets of truth drawn one pixel wide, the share with fewer than 6 px.
    pub fragments: f64,
    /// Of the chains that this drawing is traced to, the share with less than 6 px of length.
    pub short_chains: f64,
    /// Facets whose facing was computed one by one; all others were proven to face one way by bounds.
    pub facets: u64,
    /// Rays cast.
    pub rays: u64,
    /// Time it took, or took when it was made.
    pub truth_ms: f64,
    /// Truth of half the level, drawn one pixel wide, against it: figures at 1 px.
    pub self_precision: f64,
    /// Share of the line found by the truth of half the level.
    pub self_recall: f64,
    /// Harmonic mean of the two.
    pub self_f: f64,
    /// Median distance of the curves of half the level from these, no pixels between.
    /// `None` where half the level shows no line.
    pub self_offset_px: Option<f64>,
}

/// How coarser levels close in on truth: the distances of their flip edges, and the straight line through the logarithms
/// of the medians.
#[derive(Debug, Clone, Serialize)]
pub struct Convergence {
    /// Levels below truth's.
    pub levels: Vec<LevelOffset>,
    /// Levels the line was fitted to: those above truth's own error.
    pub fitted_levels: Vec<u32>,
    /// d log2(median) / d log2(level): -2 is second order; `None` with fewer than two levels to fit.
    pub slope: Option<f64>,
}

/// Distances of the visible flip edges of a level from truth, by length, no pixels between.
#[derive(Debug, Clone, Serialize)]
pub struct LevelOffset {
    /// Subdivisions of a cell's edge.
    pub level: u32,
    /// Half the line is no farther.
    pub median_px: f64,
    /// Mean.
    pub mean_px: f64,
    /// 95 % of the line is no farther.
    pub p95_px: f64,
}

/// The level of a run's facets: a number in JSON, or "auto". Finer ones come later, the adaptive one last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(untagged)]
pub enum DrawnLevel {
    /// Subdivisions of a cell's edge, everywhere.
    Of(u32),
    /// Each chunk at its own.
    #[serde(serialize_with = "auto")]
    Auto,
}

fn auto<S: Serializer>(to: S) -> std::result::Result<S::Ok, S::Error> {
    to.serialize_str("auto")
}

impl From<Detail> for DrawnLevel {
    fn from(detail: Detail) -> Self {
        match detail {
            Detail::Uniform(level) => Self::Of(level.subdivisions()),
            Detail::Adaptive { .. } => Self::Auto,
        }
    }
}

impl Display for DrawnLevel {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Of(level) => level.fmt(to),
            Self::Auto => to.write_str("auto"),
        }
    }
}

/// A method at a level in a scene.
#[derive(Debug, Clone, Serialize)]
pub struct Run {
    /// Name of its scene.
    pub scene: String,
    /// Its name in the registry of methods.
    pub method: &'static str,
    /// Subdivisions of a cell's edge, or `auto`.
    pub level: DrawnLevel,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Share of inked pixels within 1 px of truth.
    pub precision: f64,
    /// Share of truth within 1 px of ink.
    pub recall: f64,
    /// Harmonic mean of precision and recall.
    pub f: f64,
    /// Missed stretches of truth of at least 3 px.
    pub gaps: usize,
    /// 8-connected sets of ink wholly farther than 2 px from truth.
    pub spurious: usize,
    /// Mean of the mean distances from ink to truth and from truth to ink; `None` without ink.
    pub chamfer_px: Option<f64>,
    /// Larger of the two directed 95 % distances; `None` without ink.
    pub h95_px: Option<f64>,
    /// Share of 8-connected sets of ink with fewer than 6 px.
    pub fragments: f64,
    /// Share of the pixels of truth, drawn one pixel wide, that have ink within 1 px.
    pub pixel_recall: f64,
    /// Of its chains, keys of their own.
    #[serde(flatten)]
    pub of_chains: ChainFigures,
    /// Share of ink without ink of the next frame (the eye 1 m on) within 1 px, less the same for truth.
    pub excess_pop: f64,
    /// The same figures at other distances.
    pub at: Vec<AtDistance>,
    /// The same figures in bands of depth, a third of truth's length each.
    pub bands: Vec<DepthBand>,
    /// Distance from truth of the places of methods that know better than to a pixel where the line runs.
    pub place: Option<PlaceOffsets>,
    /// Facets of the whole DEM.
    pub facets: u64,
    /// Inked pixels.
    pub inked: usize,
    /// Median of the warm frames, camera to mask.
    pub frame_ms: f64,
    /// Shortest and longest warm frame.
    pub frame_range_ms: [f64; 2],
    /// The first frame after the scene was uploaded and the passes compiled.
    pub first_frame_ms: f64,
    /// Uploading the scene and compiling the passes.
    pub setup_ms: f64,
    /// Times of the passes of one more frame, and what each moved and computed.
    pub passes: Vec<PassFigures>,
    /// The limits beside which the frame's time stands; not there unless they were asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub floor: Option<FloorFigures>,
    /// Most memory the process held while this run was made; `None` where the system does not tell.
    pub peak_mib: Option<f64>,
    /// Bytes of the run's buffers on the device, as they were asked for.
    pub buffers_bytes: u64,
    /// Whether no run of the scene is both faster and better.
    #[serde(skip)]
    pub pareto: bool,
    /// Hash of the mask of each frame, the eye 1 m farther on each time.
    pub mask_hashes: Vec<String>,
    /// File name of the mask.
    pub mask: String,
    /// File name of the difference picture.
    pub difference: String,
}

/// A method at a level over a run of frames, each one step farther on.
#[derive(Debug, Clone, Serialize)]
pub struct SequenceRun {
    /// Name of the sequence.
    pub scene: String,
    /// Its name in the registry of methods.
    pub method: &'static str,
    /// Subdivisions of a cell's edge, or `auto`.
    pub level: DrawnLevel,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// From one eye to the next.
    pub step_m: f64,
    /// Frames.
    pub frames: usize,
    /// Subdivisions of a cell's edge of truth.
    pub truth_level: u32,
    /// Share of ink without ink of the next frame within 1 px, mean over the frames.
    pub pop: f64,
    /// The same of truth, drawn one pixel wide.
    pub truth_pop: f64,
    /// The one less the other.
    pub excess_pop: f64,
    /// Share of truth within 1 px of ink, mean over the frames.
    pub recall: f64,
    /// In the frame where it is least.
    pub least_recall: f64,
    /// Share of the darkness of strokes that the frame before or the one after has not, where the land is that they draw.
    pub strokes_lost: f64,
    /// What of that share truth has in both frames.
    pub strokes_excess_pop: f64,
    /// Share of the length of chains over 12 px that is called the same in the next frame, mean over the frames; `None` of
    /// chains without names.
    pub ids_kept: Option<f64>,
    /// Inked pixels, mean over the frames.
    pub inked: usize,
    /// From the camera to the drawing, mean over the frames.
    pub frame_ms: f64,
    /// What all truths took, to make or to read where they were kept.
    pub truth_ms: f64,
}

/// The chains of a run on the page: the curves that it yields, or what its ink is traced to, before any is smoothed or left
/// out. Between lines, so without the half pixel that is added for the centres of pixels.
#[derive(Debug, Clone, Serialize)]
pub struct ChainFigures {
    /// Chains.
    pub chains: usize,
    /// Their length.
    pub chains_px: f64,
    /// Share of chains with less than 6 px of length.
    pub short_chains: f64,
    /// Mean distance from truth, every quarter pixel along them; `None` without chains of some length.
    pub chain_mean_px: Option<f64>,
    /// 95 % of their length is no farther.
    pub chain_p95_px: Option<f64>,
    /// Share of their length within 1 px of truth.
    pub chain_precision: f64,
    /// Share of truth's length within 1 px of a chain.
    pub chain_recall: f64,
    /// Share of truth's length within 1 px of a chain and not of one that economy leaves half its width or more; `None` of
    /// chains that are traced.
    pub economy_removed: Option<f64>,
    /// Share of the length of chains over 12 px that is called the same in the next frame, the eye 1 m on; `None` of chains
    /// without names.
    pub ids_kept: Option<f64>,
}

/// What a pass took; how bytes and operations are counted says [`cost`](super::cost).
#[derive(Debug, Clone, Serialize)]
pub struct PassFigures {
    /// The pass; `clear` stands for clears and copies.
    pub name: &'static str,
    /// Milliseconds.
    pub ms: f64,
    /// Read and written, each value once.
    pub bytes: u64,
    /// Additions, multiplications, divisions and comparisons of one number.
    pub operations: u64,
}

/// What else the device did in turn with the warm frames, by the same clock: medians of as many.
#[derive(Debug, Clone, Serialize)]
pub struct FloorFigures {
    /// Sum of those of the passes.
    pub bytes: u64,
    /// A bare copy from buffer to buffer that moves as many: half is read, half is written.
    pub copy_ms: Option<f64>,
    /// One indexed hardware draw of the facets that the frame rasterizes, with depth and facet ID, from the vertices the
    /// frame left: finding those, passes `tessellate`, `seam` and `project`, is not in it.
    pub draw_ms: Option<f64>,
    /// Why one of the two is `None`.
    pub lacking: Option<&'static str>,
    /// The median frame over the copy: 1 is the limit.
    pub frame_per_copy: Option<f64>,
    /// The median frame over the draw.
    pub frame_per_draw: Option<f64>,
}

/// Precision and recall at a distance.
#[derive(Debug, Clone, Serialize)]
pub struct AtDistance {
    /// The distance in px, to which half a pixel is added.
    pub px: f64,
    /// Share of ink that near truth.
    pub precision: f64,
    /// Share of truth that near ink.
    pub recall: f64,
    /// Harmonic mean.
    pub f: f64,
}

/// Precision and recall of a band of depth, at 1 px.
#[derive(Debug, Clone, Serialize)]
pub struct DepthBand {
    /// `near`, `middle` or `far`.
    pub name: &'static str,
    /// Where it ends, metres along the view axis; `None` for the last one.
    pub to_m: Option<f64>,
    /// Length of truth in it.
    pub truth_px: f64,
    /// Inked pixels in it.
    pub inked: usize,
    /// Share of its ink near any truth.
    pub precision: f64,
    /// Share of its truth near any ink.
    pub recall: f64,
    /// Harmonic mean.
    pub f: f64,
}

/// Distances of sub-pixel places from truth's curve.
#[derive(Debug, Clone, Serialize)]
pub struct PlaceOffsets {
    /// Mean.
    pub mean_px: f64,
    /// 95 % are no farther.
    pub p95_px: f64,
}
