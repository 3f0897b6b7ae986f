//! From lines to pen strokes: the drawing.
//!
//! Lines are data until the last step. The chains of a page's [`Lines`](crate::line::Lines) are stroked as a [`Style`] says:
//! a [`Drawing`] is a [`Sheet`] with layers, a layer has a pen and strokes, all in millimetres. Only the writers know file
//! formats.

mod colour;
mod draw;
pub(crate) mod drawing;
pub(crate) mod furniture;
mod hachures;
mod inked;
pub(crate) mod letters;
pub(crate) mod mask;
pub(crate) mod outline;
mod paths;
pub(crate) mod pdf;
pub mod plot;
pub(crate) mod png;
mod preview;
mod seal;
pub(crate) mod sheet;
pub(crate) mod strokes;
pub mod style;
pub mod styles;
pub(crate) mod svg;
pub(crate) mod unstroked;
mod wobble;

pub use colour::Colour;
pub use draw::draw;
pub use drawing::{Area, Drawing, Layer, Pen, Stroke, StrokeForm, StrokePoint};
pub use furniture::Furniture;
pub use hachures::{HachureStyle, LightStyle};
pub(crate) use inked::InkedNear;
pub use mask::write_mask;
pub use pdf::write_pdf;
pub use png::write_png;
pub(crate) use preview::Preview;
pub use seal::Seal;
pub use sheet::{Placement, Sheet, Surround};
pub use style::Style;
pub use svg::write_svg;
pub(crate) use unstroked::unstroked;
