//! Reports of comparisons: JSON, CSV, a plot, pictures, and a page to read.

pub mod memory;
pub mod results;

pub use results::Results;
