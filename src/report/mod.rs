//! Reports of comparisons: JSON, CSV, a plot, pictures, and a page to read.

pub mod cache;
pub mod compare;
pub mod folder;
pub mod memory;
pub mod pictures;
pub mod results;

pub use compare::Comparison;
pub use results::Results;
