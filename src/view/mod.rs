//! The camera, and the choice of a view where none is given.

pub mod camera;
pub mod choose;

pub use camera::{Camera, direction};
pub use choose::{Fixed, choose};
