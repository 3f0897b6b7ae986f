//! By how much the flat Earth of a drawing lifts what lies far away.
//!
//! Method: the surface of a sphere of the Earth's mean radius R falls below its tangent plane by d^2 / 2R at the
//! distance d. Light bends downwards and takes back some 13 % of it on most days, which is left out. Cost: one look at
//! each inked pixel.

use serde::Serialize;

use super::blank::length;
use crate::line::Marks;
use crate::view::Camera;

/// Mean radius of the Earth, metres.
const RADIUS: f64 = 6_371_008.8;
/// Nearer land is lifted by less than 20 m, and that is not worth a line: metres.
const FAR: f64 = 16_000.0;

/// The farthest land that is drawn, and how far too high it stands.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct FlatEarth {
    /// From the eye to it on the map, metres.
    farthest_m: f64,
    /// Metres of height, before any exaggeration.
    lifted_m: f64,
}

impl FlatEarth {
    /// Of what is inked on a page, `near` metres being the near plane of its depths; `None` where all of it is near.
    pub(crate) fn of(marks: &Marks, camera: &Camera, near: f64) -> Option<Self> {
        let distances = marks.ink().map(|mark| {
            let place = glam::DVec2::new(f64::from(mark.column), f64::from(mark.row)) + 0.5;
            // Depths are along the view axis.
            (camera.ray(place) * mark.pixel.distance(near)).truncate().length()
        });
        Self::at(distances.filter(|distance| distance.is_finite()).fold(0.0, f64::max))
    }

    /// At a distance in metres.
    fn at(farthest_m: f64) -> Option<Self> {
        (farthest_m > FAR).then(|| Self { farthest_m, lifted_m: farthest_m.powi(2) / (2.0 * RADIUS) })
    }

    /// One line.
    pub(crate) fn words(&self) -> String {
        let Self { farthest_m, lifted_m } = *self;
        let farthest = length(farthest_m);
        format!("the Earth is drawn flat: the farthest land drawn, {farthest} away, stands {lifted_m:.0} m too high")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_drop_at_50_km_is_196_m() {
        let at = FlatEarth::at(50e3).expect("far");
        assert_eq!(at.lifted_m.round(), 196.0);
        assert!(at.words().contains("50.0 km away, stands 196 m too high"), "{}", at.words());
        assert_eq!(FlatEarth::at(16e3), None);
    }
}
