//! hachure

pub mod dem;
pub mod error;
pub mod ink;
pub mod view;
