//! The silhouette methods and what each asks of the raster.

/// How silhouettes are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Walk the lattice between neighbouring pixels and look for away facets. Complete.
    Walk,
    /// Compare the nearest toward with the nearest away depth (Mower 2015, algorithm 2).
    TowardAway {
        /// Away surface counts wherever it touches the pixel or the neighbour that it is compared with.
        wide: bool,
    },
    /// Compare the facets of neighbouring pixels (Mower 2015, algorithm 1).
    Adjacency {
        /// What facets must have in common to be neighbours.
        share: Share,
    },
}

/// What two facets must share for adjacency to draw no line between them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum Share {
    /// Two lattice vertices.
    #[default]
    Edge,
    /// One lattice vertex: the vertex-storage variant.
    Corner,
}

/// Whether the visible rim of the DEM and of its voids is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum Border {
    /// Draw it.
    #[default]
    On,
    /// Leave it out.
    Off,
}

/// Whether a frame leaves out what cannot change the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Thrift {
    /// Chunks beside the page, walks where nothing is away.
    #[default]
    LeaveOut,
    /// Everything is computed: the measure of the other.
    Nothing,
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
    /// What this method needs of the raster on a device with or without 64-bit atomics.
    pub fn visibility(self, int64: bool) -> Visibility {
        match self {
            Self::TowardAway { .. } => Visibility::TwoDepths,
            Self::Walk | Self::Adjacency { .. } if int64 => Visibility::Key64,
            Self::Walk | Self::Adjacency { .. } => Visibility::Key32,
        }
    }

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Walk => "walk",
            Self::TowardAway { .. } => "toward-away",
            Self::Adjacency { .. } => "adjacency",
        }
    }
}

impl Visibility {
    /// How often the facets are rasterized.
    pub fn rounds(self) -> u32 {
        if self == Self::Key32 { 2 } else { 1 }
    }
}
