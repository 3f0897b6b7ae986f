//! Files on the disk, whatever they hold: outputs that are whole or not there, what a signal takes away, whether somebody
//! reads what is written, what is read whole, which names mean one file, and what is said of mistakes in those that people write.

pub(crate) mod identity;
mod names;
pub(crate) mod output;
pub(crate) mod reader;
pub(crate) mod regular;
pub(crate) mod signals;
pub(crate) mod typed;

pub(crate) use identity::Taken;
pub(crate) use names::{relative, straight};
pub use output::Output;
