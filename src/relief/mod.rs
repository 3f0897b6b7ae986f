//! Lines and places on the land that do not depend on the eye: where water gathers and runs, where it parts, where land meets
//! water, peaks, and lines that users give.
//!
//! All lines are [`SurfaceLine`]s: polylines on the map of a DEM that lie on its surface, with what of the relief about each point tells
//! whether a page can show it.

mod across;
pub(crate) mod area;
pub(crate) mod bits;
mod branches;
pub(crate) mod channels;
pub(crate) mod coarse;
mod crease;
mod flat_water;
mod flood;
pub(crate) mod flow;
pub(crate) mod frame;
mod gathered;
pub(crate) mod grid;
mod heap;
pub(crate) mod kept;
mod lines;
mod net;
mod own;
mod parting;
mod peaks;
mod prune;
mod shores;
pub(crate) mod slope;
mod smooth;
mod steepest;
pub(crate) mod threshold;
mod tops;
mod trace;
mod water;
pub(crate) mod whole;

use glam::DVec2;

pub(crate) use coarse::spacing;
pub(crate) use crease::{Crease, LandWanted};
pub use flat_water::FlatWater;
pub(crate) use gathered::Gathered;
pub(crate) use kept::FlowLines;
pub use own::own_lines;
pub(crate) use own::own_lines_if_any;
pub use peaks::{Base, Peak, peaks};
pub use shores::Shores;
pub(crate) use slope::{Need, Needed, SlopeLine, SlopePoint};
pub use slope::{SlopeRules, Slopes};
pub(crate) use whole::auto_cells;
pub use whole::{ChannelArea, Relief};

/// What a line of the land is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LineKind {
    /// Where land and water meet.
    Shore,
    /// Where water gathers and runs.
    Drainage,
    /// Where water parts.
    Ridge,
    /// A line that the user gives, of the layer of this number.
    Own(u16),
}

/// A line on the land. Drainage runs from its head down to where it joins another line or ends, a ridge from its outer end to where
/// it joins a higher one.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceLine {
    /// What it is.
    pub kind: LineKind,
    /// Strahler's order of a stream (Strahler 1957) at its end, 1 of all else; of an own line what its file says.
    pub order: u8,
    /// At least two, none twice in a row, the last of a closed line not the first.
    pub points: Vec<SurfacePoint>,
    /// Whether the last point is joined to the first, which is not repeated.
    pub closed: bool,
    /// The line and the point of it that its last point is, to the last bit.
    pub joins: Option<[u32; 2]>,
}

/// Puts lines behind others, each of which joins lines of its own list: what they join moves along.
pub fn append(lines: &mut Vec<SurfaceLine>, more: Vec<SurfaceLine>) {
    let before = lines.len() as u32;
    lines.extend(more.into_iter().map(|line| {
        let joins = line.joins.map(|[onto, at]| [onto + before, at]);
        SurfaceLine { joins, ..line }
    }));
}

/// A point of a line on the land.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// Column and row of the DEM, fractional.
    pub at: DVec2,
    /// How far the land on both sides stands over a valley, or lies below a ridge, on the side where it is less, 3, 6 and 12 cells
    /// away; metres without exaggeration, below 0 where it is no valley or ridge. Infinite of lines that no relief need show,
    /// not a number under flat water, where none is drawn.
    pub across: [f32; 3],
    /// From here up along water to the farthest source, or of the flow that a ridge parts; metres. Grows along the line.
    pub length: f32,
    /// How far that source lies above, or how deep that flow falls; metres without exaggeration. Grows along the line.
    pub drop: f32,
}
