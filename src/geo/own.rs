//! Lines of the user's own as a file has them.

use std::fmt::Write;
use std::path::Path;

use glam::DVec2;
use xxhash_rust::xxh3::Xxh3;

use super::with_layer;
use crate::dem::Crs;
use crate::error::shown;

/// The lines of a file, layer by layer.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnLines {
    /// Those that hold something.
    pub layers: Vec<OwnLayer>,
}

/// The lines of a layer.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnLayer {
    /// As the file calls it.
    pub name: String,
    /// The system of its places; `None` where the file names none.
    pub crs: Option<Crs>,
    /// Rivers, roads, rims of areas.
    pub lines: Vec<OwnLine>,
    /// Points, which are no lines.
    pub points_left_out: usize,
}

/// A line.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnLine {
    /// X first, at least two, none twice in a row. They may be no finite numbers.
    pub places: Vec<DVec2>,
    /// Whether the last place is joined to the first, which is not repeated.
    pub closed: bool,
    /// What the file says of its weight, 1 where it says nothing.
    pub order: u8,
}

impl OwnLines {
    /// The layers that have lines.
    pub fn drawn(&self) -> impl Iterator<Item = &OwnLayer> {
        self.layers.iter().filter(|layer| !layer.lines.is_empty())
    }

    /// What the layers that have lines are called in a drawing: as in the file, one that nobody named and that is the only one
    /// as the file. `path`: what the user wrote, `FILE` or `FILE:LAYER`.
    pub fn names(&self, path: &Path) -> Vec<String> {
        let (file, layer) = with_layer(path);
        let mut names: Vec<String> = self.drawn().map(|layer| shown(Path::new(&layer.name))).collect();
        if let ([only], None, Some(stem)) = (&mut names[..], layer, file.file_stem()) {
            *only = shown(Path::new(stem));
        }
        names
    }

    /// What was taken and what was left out, in words.
    pub fn taken(&self) -> String {
        let mut words = Vec::new();
        for layer in self.drawn() {
            let count = layer.lines.len();
            words.push(format!("{count} line{} of layer {}", plural(count), layer.name));
        }
        let mut words = words.join(", ");
        let points: usize = self.layers.iter().map(|layer| layer.points_left_out).sum();
        if points > 0 {
            // A string takes all that is written.
            let _ = write!(words, "; {points} point{} left out", plural(points));
        }
        words
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl OwnLines {
    /// A hash of all that lines on a DEM depend on.
    pub fn hash(&self) -> u128 {
        let mut hash = Xxh3::new();
        let mut text = |text: &str| {
            hash.update(&(text.len() as u64).to_le_bytes());
            hash.update(text.as_bytes());
        };
        for layer in &self.layers {
            text(&layer.name);
            text(layer.crs.as_ref().map_or("", Crs::wkt));
            text(&layer.lines.len().to_string());
        }
        for line in self.layers.iter().flat_map(|layer| &layer.lines) {
            hash.update(&(line.places.len() as u64).to_le_bytes());
            hash.update(&[u8::from(line.closed), line.order]);
            // 0 and -0 are one place.
            line.places.iter().flat_map(|place| place.to_array()).for_each(|x| hash.update(&(x + 0.0).to_le_bytes()));
        }
        hash.digest128()
    }
}

fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}
