//! Files on the disk, whatever they hold: outputs that are whole or not there, what a signal takes away, whether somebody
//! reads what is written, which names mean one file, and what is said of mistakes in those that people write.

pub mod identity;
mod names;
pub mod output;
pub mod reader;
pub mod signals;
pub mod typed;

pub use identity::{Identity, Taken};
pub use names::{relative, straight};
pub use output::Output;
