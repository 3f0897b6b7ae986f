//! Lines looked at every quarter pixel: each look knows where it lies on the page and in the world.

use glam::{DVec2, DVec3};

use crate::line::ChainPoint;
use crate::view::Perspective;
use crate::view::cut::steps;

/// A look at a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LineLook {
    /// Px from the page's top left corner.
    pub place: DVec2,
    /// Metres of the exaggerated world.
    pub world: DVec3,
    /// Of the page that it stands for, px.
    pub length: f64,
}

/// Looks between two points of a chain, which is a straight line in the world, where they are on the page.
pub(super) fn along([a, b]: [&ChainPoint; 2], perspective: &Perspective) -> impl Iterator<Item = LineLook> + use<> {
    let (a, b) = (*a, *b);
    let [near, far] = [a, b].map(|point| perspective.distance(point.world));
    steps(perspective.size().as_uvec2().to_array(), a.place, b.place).map(move |step| {
        // Depth turns steps on the page into steps in the world.
        let share = step.middle * near / (far * (1.0 - step.middle) + step.middle * near);
        let (place, world) = (a.place.lerp(b.place, step.middle), a.world.lerp(b.world, share));
        LineLook { place, world, length: step.length }
    })
}

/// Where a place of the world is seen on the page; `None` beside it and behind the eye.
pub(super) fn on_page(perspective: &Perspective, world: DVec3) -> Option<DVec2> {
    let (place, depth) = perspective.project(world);
    let inside = place.cmpge(DVec2::ZERO).all() && place.cmplt(perspective.size()).all();
    (depth > 0.0 && inside).then_some(place)
}
