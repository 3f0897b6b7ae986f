//! From lines to pen strokes: the drawing.
//!
//! Lines are data until the last step. The chains of a page's [`Lines`](crate::line::Lines) are stroked: a [`Drawing`] is
//! a page with layers, a layer has a pen and strokes. Only the writers know file formats.

pub mod drawing;
pub mod mask;
pub mod png;

pub use drawing::{Drawing, Layer, Pen, Stroke, StrokePoint, Style, draw};
pub use mask::write_mask;
pub use png::write_png;
