//! What a run took.

pub mod memory;
