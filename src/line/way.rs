//! A line on the land as a page shows it, before it is known what of it the eye sees.

use glam::{DVec2, DVec3};

use super::Line;

/// A line on the land.
#[derive(Debug, Clone, PartialEq)]
pub struct LandWay {
    /// What it draws.
    pub line: Line,
    /// At least two.
    pub points: Vec<WayPoint>,
    /// Whether the last point is joined to the first, which is not repeated.
    pub closed: bool,
}

/// A point of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WayPoint {
    /// Column and row of the DEM, fractional.
    pub at: DVec2,
    /// Metres of the exaggerated world.
    pub world: DVec3,
    /// How strongly it is shown, 0 to 1.
    pub weight: f32,
    /// Of a hachure the share of the paper about it that is to be ink; 1 of all else.
    pub black: f32,
}
