//! The smooth surface: vertex normals on the CPU, PN-triangle patches, and the integer lattice that names facets.

mod bounds;
mod drape;
pub mod lattice;
pub mod normals;
pub mod patch;
mod prepared;
pub mod pyramid;
pub mod quadtree;
pub mod ray;
pub mod rim;
mod slopes;
pub mod tile;

pub use drape::Drape;
pub use lattice::{Chunk, Lattice, LatticePoint, Level};
pub use patch::{Patch, Surface, SurfaceBand};
pub use pyramid::{Pyramid, PyramidBuilder};
pub use ray::Met;
pub use tile::Tile;
