//! The smooth surface: vertex normals on the CPU, PN-triangle patches, and the integer lattice that names facets.

mod bounds;
mod drape;
pub(crate) mod folds;
pub(crate) mod lattice;
pub(crate) mod limits;
pub(crate) mod normals;
pub(crate) mod patch;
mod prepared;
pub(crate) mod pyramid;
pub(crate) mod quadtree;
pub(crate) mod ray;
pub(crate) mod rim;
mod slopes;
pub(crate) mod tile;

pub(crate) use drape::Drape;
pub(crate) use folds::Fold;
pub use lattice::Level;
pub(crate) use lattice::{Chunk, Lattice, LatticePoint};
pub(crate) use limits::Moved;
pub use patch::Surface;
pub(crate) use patch::{Patch, SurfaceBand};
pub(crate) use pyramid::{Pyramid, PyramidBuilder};
pub(crate) use ray::Met;
pub(crate) use tile::Tile;
