//! Files on the disk, whatever they hold: outputs that are whole or not there, what a signal takes away, and which names
//! mean one file.

pub mod identity;
pub mod output;
pub mod signals;

pub use identity::{Identity, Taken};
pub use output::Output;
