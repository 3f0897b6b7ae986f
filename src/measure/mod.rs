//! Yardsticks: trials of a method against truth, what a frame must move and compute, and what else the device does in that
//! time.
//!
//! [`Comparison`] makes trials of methods at levels and tells what it finds; [`costs`] says what the passes of a frame must
//! move; [`Floor`] times a bare copy and a hardware draw beside it; [`Growth`] is time against size, judged by what was
//! promised. The clock itself stands in [`gpu::clock`](crate::gpu::clock): it stamps passes while they are recorded.

pub mod chains;
pub mod compare;
pub mod copy;
pub mod cost;
pub mod curves;
pub mod depth_draw;
pub mod figures;
pub mod floor;
mod floors;
pub mod growth;
pub mod kept;
mod looks;
pub mod memory;
pub mod popped;
mod rendered;
pub mod sequence;
pub mod trial;
pub mod truths;

pub use compare::Comparison;
pub use copy::BareCopy;
pub use depth_draw::DepthDraw;
pub use floor::{Floor, costs};
pub use growth::{Growth, Promise};
pub use sequence::Sequence;
