//! What a frame is asked for beside its facets: a method, a border, and whether work may be left out.

use super::registry::{self, MethodEntry, Raster};

/// How silhouettes are found. What each is called, takes and looks like stands in the [registry](Self::entry).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// Walk the lattice between neighbouring pixels and look for away facets. Complete.
    #[default]
    Walk,
    /// Follow the curve along which the surface turns away (Hertzmann, Zorin 2000): it yields curves, its mask is drawn of
    /// them.
    Contour,
    /// Compare the nearest toward with the nearest away depth (Mower 2015, algorithm 2).
    TowardAway {
        /// Away surface counts wherever it touches the pixel or the neighbour that it is compared with.
        wide: bool,
    },
    /// Compare the facets of neighbouring pixels (Mower 2015, algorithm 1).
    Adjacency {
        /// What facets must have in common to be neighbours.
        share: SharedVertices,
    },
}

/// What two facets must share for adjacency to draw no line between them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SharedVertices {
    /// Two lattice vertices.
    #[default]
    Edge,
    /// One lattice vertex: the vertex-storage variant.
    Corner,
}

/// Whether the visible rim of the DEM and of its voids is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Border {
    /// Draw it.
    #[default]
    On,
    /// Leave it out.
    Off,
}

/// Whether the curves of a frame are found, of which strokes are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Curves {
    /// All of them, as true behind nearer land as before it.
    All,
    /// Those that the eye may see.
    On,
    /// The mask is all that is asked for.
    #[default]
    Off,
}

/// Whether lines on the land are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LandLines {
    /// Those that a renderer was given.
    On,
    /// None.
    #[default]
    Off,
}

/// Whether a frame leaves out what cannot change the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Culling {
    /// Chunks outside the frustum or behind nearer land, walks where nothing is away.
    #[default]
    On,
    /// Everything is computed: the measure of the other.
    Off,
}

/// What the raster keeps of each pixel, and how.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Visibility {
    /// Depth and ID in one 64-bit atomic.
    Key64,
    /// Depth, then ID, in two passes of 32-bit atomics.
    Key32,
    /// Nearest toward and nearest away depth, no ID.
    TwoDepths,
}

impl Method {
    /// Every method, its variants behind it, in the order of lists and reports.
    pub const ALL: [Self; 6] = [
        Self::Walk,
        Self::Contour,
        Self::TowardAway { wide: false },
        Self::TowardAway { wide: true },
        Self::Adjacency { share: SharedVertices::Edge },
        Self::Adjacency { share: SharedVertices::Corner },
    ];

    /// What the registry says of it.
    pub const fn entry(self) -> &'static MethodEntry {
        match self {
            Self::Walk => &registry::WALK,
            Self::Contour => &registry::CONTOUR,
            Self::TowardAway { wide: false } => &registry::TOWARD_AWAY,
            Self::TowardAway { wide: true } => &registry::TOWARD_AWAY_WIDE,
            Self::Adjacency { share: SharedVertices::Edge } => &registry::ADJACENCY,
            Self::Adjacency { share: SharedVertices::Corner } => &registry::ADJACENCY_CORNER,
        }
    }

    /// The method that comparisons and reports call so.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.entry().name == name)
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Method {
    /// How its raster is made on a device with or without 64-bit atomics.
    pub fn visibility(self, int64: bool) -> Visibility {
        match self.entry().raster {
            Raster::TwoDepths => Visibility::TwoDepths,
            Raster::Facets if int64 => Visibility::Key64,
            Raster::Facets => Visibility::Key32,
        }
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Visibility {
    /// How often the facets are rasterized.
    pub fn rounds(self) -> u32 {
        if self == Self::Key32 { 2 } else { 1 }
    }
}
