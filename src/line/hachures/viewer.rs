//! How lines on the land are seen: by an eye, or from above as on a map.

use glam::{DVec2, DVec3, UVec2};

use super::BESIDE;
use crate::line::Overhead;
use crate::line::cover::Cover;
use crate::view::Perspective;

/// What sees the lines.
#[derive(Debug, Clone, Copy)]
pub enum Viewer<'a> {
    /// An eye, the azimuth to which it looks, degrees, and what its page is known to hide.
    By(&'a Perspective, f64, Option<&'a Cover>),
    /// A frame over the land.
    Above(&'a Overhead),
}

impl Viewer<'_> {
    /// Most pixels that a metre takes in a box of the world; 0 beside the page.
    pub(super) fn most_px_per_metre(self, [low, high]: [DVec3; 2]) -> f64 {
        match self {
            Self::By(perspective, ..) => perspective.most_px_per_metre([low, high]),
            Self::Above(overhead) => {
                if overhead.is_beside([low, high].map(DVec3::truncate)) {
                    0.0
                } else {
                    overhead.px_per_metre
                }
            }
        }
    }

    /// The least and the most metres that a pixel takes across in a box of the world, wherever the eye looks; none of a map.
    pub(super) fn metres_per_px(self, [low, high]: [DVec3; 2]) -> [f64; 2] {
        let Self::By(perspective, ..) = self else { return [0.0; 2] };
        let eye = perspective.eye();
        let farthest = (low - eye).abs().max((high - eye).abs());
        [eye.clamp(low, high).distance(eye), farthest.length()].map(|metres| metres / perspective.focal())
    }

    /// How many times as large a page shows land at its corners as in its middle.
    pub(super) fn stretch(self) -> f64 {
        let Self::By(perspective, ..) = self else { return 1.0 };
        1.0 + (perspective.size() / 2.0 / perspective.focal()).length_squared()
    }

    /// How far a place of the world is from the eye, metres; of a map that is no matter.
    pub(super) fn distance(self, world: DVec3) -> f64 {
        if let Self::By(perspective, ..) = self { perspective.distance(world) } else { 0.0 }
    }

    /// Where a place of the world stands, px; `None` behind the eye.
    pub(super) fn place(self, world: DVec3) -> Option<DVec2> {
        match self {
            Self::By(perspective, ..) => {
                (perspective.distance(world) > perspective.near()).then(|| perspective.project(world).0)
            }
            Self::Above(overhead) => Some(overhead.place(world.truncate())),
        }
    }

    /// Whether the page is known not to show a place of the world.
    pub(super) fn hides(self, world: DVec3) -> bool {
        let Self::By(perspective, _, Some(cover)) = self else { return false };
        let (place, depth) = perspective.project(world);
        let is_beside = place.cmplt(DVec2::splat(-BESIDE)).any() || place.cmpgt(perspective.size() + BESIDE).any();
        is_beside || cover.hides(place, depth)
    }

    /// Whether a place of the world, px on the page, may be seen there.
    pub(super) fn may_show(self, place: DVec2, world: DVec3) -> bool {
        let size = match self {
            Self::By(perspective, ..) => perspective.size(),
            Self::Above(overhead) => UVec2::from(overhead.size).as_dvec2(),
        };
        place.cmpge(DVec2::ZERO).all() && place.cmple(size).all() && !self.hides(world)
    }

    /// How a place before the eye moves on the page where it moves so in the world, px.
    pub(super) fn moves(self, world: DVec3, by: DVec3) -> DVec2 {
        match self {
            Self::By(perspective, ..) => perspective.moves(world, by),
            Self::Above(overhead) => by.truncate() * DVec2::new(1.0, -1.0) * overhead.px_per_metre,
        }
    }

    /// Whether land of this gradient turns away.
    pub(super) fn is_away(self, world: DVec3, gradient: DVec2) -> bool {
        match self {
            Self::By(perspective, ..) => (-gradient).extend(1.0).dot(perspective.eye() - world) <= 0.0,
            Self::Above(_) => false,
        }
    }
}
