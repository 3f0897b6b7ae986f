//! hachure

pub mod dem;
pub mod error;
pub mod gpu;
pub mod ink;
pub mod plan;
pub mod render;
pub mod surface;
pub mod view;
