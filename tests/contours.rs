//! Contours, curves on the surface where it turns from toward to away: an independent program that finds them on any
//! lattice, how they must hang together, and where mathematics puts them.

mod closed;
mod cusps;
mod device;
mod linked;
mod topology;
pub mod twin;
