//! The camera, how it sees, and the choice of a view where none is given; lines on its page, cut.

pub mod camera;
pub mod choose;
pub mod cut;
pub mod perspective;

pub use camera::{Camera, direction};
pub use choose::{Fixed, choose};
pub use perspective::Perspective;
