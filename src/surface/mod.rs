//! The smooth surface: vertex normals on the CPU, PN-triangle patches, and the integer lattice that names facets.

pub mod bounds;
pub mod lattice;
pub mod normals;
pub mod patch;
pub mod rim;

pub use lattice::{Chunk, Lattice, LatticePoint, Level};
pub use patch::{Patch, Surface, SurfaceBand};
