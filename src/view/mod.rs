//! The camera, how it sees, the choice of a view where none is given, and flights; lines on its page, cut.

pub(crate) mod camera;
pub(crate) mod choose;
pub(crate) mod cut;
pub mod flight;
pub(crate) mod perspective;

pub use camera::{Camera, direction};
pub use choose::{Fixed, choose};
pub use flight::Flight;
pub use perspective::Perspective;
