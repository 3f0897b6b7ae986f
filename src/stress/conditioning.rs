//! What an eye that hardly moves does to the ink.
//!
//! The eye moves by a millionth of its distance from the middle of the land, aslant to the page. Ink pops where it has no ink of
//! the other mask within 1 px; so does truth, where a line is really born or ends there, and that is subtracted. Amplification is
//! the change of lines over the change of eye, both in px of the page: a line that moves by d px changes about a share d of its
//! pixels, twice, and the eye's step covers `focal * 1e-6` px at its distance. 1 is what projection does by itself.

use glam::DVec3;

use super::invariance::{Difference, alone};
use crate::truth::Mask;
use crate::view::Camera;

/// The step as a share of the distance.
pub const STEP: f64 = 1e-6;
/// Right, up and forward.
const WAY: DVec3 = DVec3::new(0.64, 0.48, 0.6);

/// The camera a step on; `distance` metres from what it looks at.
pub fn stepped(camera: &Camera, distance: f64) -> Camera {
    moved(camera, distance * STEP)
}

/// The camera so many metres on, aslant to the page.
pub fn moved(camera: &Camera, metres: f64) -> Camera {
    let [right, up, forward] = camera.axes();
    let way = right * WAY.x + up * WAY.y + forward * WAY.z;
    Camera { eye: camera.eye + way * metres, ..*camera }
}

/// What a step changed.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// Share of ink that pops, of the two masks the larger.
    pub popped: f64,
    /// Where: column and row.
    pub places: Vec<[u32; 2]>,
    /// Change of lines over change of eye.
    pub amplification: f64,
}

impl Change {
    /// From one mask to that a step on.
    pub fn of(before: &Mask, after: &Mask, camera: &Camera) -> Self {
        let share = |of: &Mask, other: &Mask| alone(of, other).len() as f64 / of.inked.len().max(1) as f64;
        let difference = Difference::of(before, after);
        Self {
            popped: share(before, after).max(share(after, before)),
            amplification: difference.share() / 2.0 / (camera.focal() * STEP),
            places: difference.far,
        }
    }
}
