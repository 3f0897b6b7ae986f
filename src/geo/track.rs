//! A way over the land as a file has it.

use std::path::{Path, PathBuf};

use glam::DVec2;

use crate::dem::Crs;

/// The points of a line, or points in order, and how high they lie.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Track {
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

/// The file and the layer in a name, `FILE:LAYER` where no file is called so. Either may hold colons: the longest name of a file
/// is the file.
pub fn with_layer(path: &Path) -> (PathBuf, Option<String>) {
    let text = path.to_str().filter(|_| !path.exists()).unwrap_or_default();
    let mut parts = text.rmatch_indices(':').map(|(colon, _)| (Path::new(&text[..colon]), &text[colon + 1..]));
    match parts.find(|(file, _)| file.is_file()) {
        Some((file, layer)) => (file.to_owned(), Some(layer.to_owned())),
        None => (path.to_owned(), None),
    }
}
