//! The order in which a plotter draws.

use super::Stroke;

/// The strokes of a layer of one width.
pub fn planned(strokes: Vec<Stroke>) -> Vec<Stroke> {
    strokes
}
