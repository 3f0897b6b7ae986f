//! Reports of comparisons: JSON, CSV, a plot, and a page to read with every picture in it.
//!
//! [`Results`] is what a comparison found; the writers turn it into text and know nothing else.

pub mod results;

pub use results::Results;
