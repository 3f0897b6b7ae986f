//! Yardsticks: trials of a method against truth, what a frame must move and compute, and what else the device does in that
//! time.
//!
//! [`Comparison`] makes trials of methods at levels and tells what it finds; [`costs`] says what the passes of a frame must
//! move; [`Floor`] times a bare copy and a hardware draw beside it; [`Growth`] is time against size, judged by what was
//! promised. The clock itself stands in [`gpu::clock`](crate::gpu::clock): it stamps passes while they are recorded.

pub(crate) mod chains;
pub(crate) mod compare;
pub(crate) mod copy;
pub(crate) mod cost;
pub(crate) mod curves;
pub(crate) mod depth_draw;
pub(crate) mod figures;
pub(crate) mod floor;
mod floors;
pub(crate) mod growth;
pub(crate) mod kept;
mod looks;
pub(crate) mod memory;
pub(crate) mod popped;
mod rendered;
pub(crate) mod sequence;
pub(crate) mod trial;
pub(crate) mod truths;

pub use compare::Comparison;
pub use copy::BareCopy;
pub use depth_draw::DepthDraw;
pub use floor::{Floor, costs};
pub use growth::{Growth, Promise};
pub use sequence::Sequence;
