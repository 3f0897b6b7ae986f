//! A way over the land as a file has it.

use std::path::{Path, PathBuf};

use glam::DVec2;

use crate::dem::Crs;

/// The points of a line, or points in order, and how high they lie.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// The system of the places; `None` where the file names none.
    pub crs: Option<Crs>,
    /// X first, at least two.
    pub places: Vec<DVec2>,
    /// Of each place; `None` where the file has none, or zeros alone.
    pub heights: Option<Vec<f64>>,
    /// Whether heights are above the ground, not above zero.
    pub above_ground: bool,
    /// What was taken of the file, in words.
    pub taken: String,
}

/// The file and the layer in the name of a track, `FILE:LAYER` where no file is called so.
pub fn with_layer(path: &Path) -> (PathBuf, Option<String>) {
    let parts = path.to_str().and_then(|text| text.rsplit_once(':')).filter(|_| !path.exists());
    match parts.map(|(file, layer)| (PathBuf::from(file), layer)) {
        Some((file, layer)) if file.is_file() => (file, Some(layer.to_owned())),
        _ => (path.to_owned(), None),
    }
}
