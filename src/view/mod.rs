//! The camera, and the choice of a view where none is given.

pub mod camera;

pub use camera::Camera;
