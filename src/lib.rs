//! hachure

pub mod dem;
pub mod error;
pub mod view;
