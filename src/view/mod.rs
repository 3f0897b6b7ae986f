//! The camera, how it sees, the choice of a view where none is given, and flights; lines on its page, cut.

pub mod camera;
pub mod choose;
pub mod cut;
pub mod flight;
pub mod perspective;

pub use camera::{Camera, direction};
pub use choose::{Fixed, choose};
pub use flight::Flight;
pub use perspective::Perspective;
