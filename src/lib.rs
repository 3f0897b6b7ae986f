//! Pen-and-ink landscapes from digital elevation models.
//!
//! The folders stand in the order in which the data flows, and import only what stands above them:
//!
//! | module | does |
//! |---|---|
//! | [`dem`] | reads and holds the grid; alone knows GDAL |
//! | [`surface`] | vertex normals, PN patches, the lattice and its IDs, bounds of chunks |
//! | [`view`] | the camera, and a view where none is given |
//! | [`plan`] | what a frame needs: method, batches |
//! | [`gpu`] | device, buffers, one adapter a pass; the mathematics stands in `shaders/` |
//! | [`ink`] | mask to chains to strokes to pictures |
//! | [`render`] | the whole algorithm on one screen |
//! | [`cli`] | flags as typed become options checked |
//!
//! A frame: [`render::Renderer::frame`] draws it on the device, [`render::Renderer::read`] brings it back,
//! [`ink::draw`] makes lines of it, [`ink::write_png`] a picture.

#![deny(missing_docs)]

pub mod cli;
pub mod dem;
pub mod error;
pub mod gpu;
pub mod ink;
pub mod plan;
pub mod render;
pub mod surface;
pub mod view;
