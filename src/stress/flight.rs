//! A short flight over a case: frames owe nothing to those before them, and little pops from one to the next.
//!
//! Three frames from the case's first view on, the eye each time a four-thousandth of its distance from the middle of the land
//! farther: of 4 km one metre. The last two are drawn by the renderer that has drawn all others, and by a new one, over land whose
//! lines are found anew: every facet and depth of a pixel, ink, point of a chain, crease and stroke is to be the same.

use super::conditioning::moved;
use crate::truth::Mask;
use crate::view::Camera;

/// Frames after the first.
const STEPS: u32 = 2;
/// A step as a share of the distance.
const STEP: f64 = 2.5e-4;

/// The cameras after a first one, `distance` metres from what it looks at.
pub fn cameras(first: &Camera, distance: f64) -> Vec<Camera> {
    (1..=STEPS).map(|step| moved(first, f64::from(step) * distance * STEP)).collect()
}

/// Share of ink that pops from each mask to the next, mean.
pub fn popped(masks: &[&Mask]) -> f64 {
    masks.windows(2).map(|pair| pair[0].pop(pair[1])).sum::<f64>() / (masks.len().max(2) - 1) as f64
}
