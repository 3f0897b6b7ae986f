//! The page as truth sees it: where edges of the world lie on it, in pieces short enough to be judged one by one.

use glam::{DVec2, DVec3};

use crate::view::Camera;
use crate::view::cut::share_within;

/// Longest piece, px.
const PIECE: f64 = 0.25;
/// How far beyond the page pieces are kept, px: ink at the page's edge is looked for within 3.5 px of a line.
const MARGIN: f64 = 4.0;

/// Which line a piece belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TruthLine {
    /// Between surface toward the eye and surface away from it.
    Contour,
    /// The rim of the DEM or of a void.
    Border,
}

/// A visible piece of line on the page.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TruthPiece {
    /// Its ends, px from the page's top left corner.
    pub ends: [DVec2; 2],
    /// Metres along the view axis to its middle.
    pub distance: f64,
    /// Which line.
    pub line: TruthLine,
}

impl TruthPiece {
    /// Its middle on the page, px.
    pub fn middle(&self) -> DVec2 {
        self.ends[0].midpoint(self.ends[1])
    }

    /// Its length on the page, px.
    pub fn length(&self) -> f64 {
        self.ends[0].distance(self.ends[1])
    }

    /// Whether its middle is on a page of this size.
    pub(crate) fn is_on(&self, [width, height]: [u32; 2]) -> bool {
        let middle = self.middle();
        middle.cmpge(DVec2::ZERO).all() && middle.x < f64::from(width) && middle.y < f64::from(height)
    }
}

/// A camera, with what projecting takes worked out.
pub(super) struct Projection {
    axes: [DVec3; 3],
    focal: f64,
    size: DVec2,
    /// Metres along the view axis before which nothing is drawn.
    near: f64,
}

impl Projection {
    pub(super) fn new(camera: &Camera, near: f64) -> Self {
        let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
        Self { axes: camera.axes(), focal: camera.focal(), size, near }
    }

    /// Whether something with these corners, metres from the eye, may show on the page or in its margin.
    pub(super) fn may_show(&self, corners: &[DVec3]) -> bool {
        let [right, up, forward] = self.axes;
        let reach = (self.size / 2.0 + MARGIN) / self.focal;
        let sides = [
            forward,
            forward * reach.x - right,
            forward * reach.x + right,
            forward * reach.y - up,
            forward * reach.y + up,
        ];
        sides.iter().all(|inward| corners.iter().any(|p| inward.dot(*p) >= 0.0))
    }

    /// Length on the page of an edge, metres from the eye; endless where it comes nearer than the near plane.
    pub(super) fn edge_length(&self, edge: [DVec3; 2]) -> f64 {
        let [a, b] = edge.map(|p| self.project(p));
        if a.1 < self.near || b.1 < self.near { f64::INFINITY } else { a.0.distance(b.0) }
    }

    /// The visible pieces of an edge, metres from the eye; `sees` judges a piece by its middle.
    pub(super) fn pieces(
        &self,
        edge: [DVec3; 2],
        line: TruthLine,
        mut sees: impl FnMut(DVec3) -> bool,
        out: &mut Vec<TruthPiece>,
    ) {
        let Some([p, q]) = self.before_eye(edge) else { return };
        let [(a, near_a), (b, near_b)] = [self.project(p), self.project(q)];
        let Some([from, to]) = share_within([DVec2::splat(-MARGIN), self.size + MARGIN], a, b) else { return };
        let count = ((to - from) * a.distance(b) / PIECE).ceil().max(1.0);
        for i in 0..count as u32 {
            let at = |k: f64| from + (to - from) * k / count;
            let [start, middle, end] = [0.0, 0.5, 1.0].map(|k| at(f64::from(i) + k));
            // Depth turns steps on the page into steps along the edge.
            let along = middle * near_a / (near_b * (1.0 - middle) + middle * near_a);
            let place = p.lerp(q, along);
            if sees(place) {
                let distance = place.dot(self.axes[2]);
                out.push(TruthPiece { ends: [a.lerp(b, start), a.lerp(b, end)], distance, line });
            }
        }
    }

    /// Place on the page in px and metres along the view axis.
    fn project(&self, p: DVec3) -> (DVec2, f64) {
        let [right, up, forward] = self.axes;
        let w = p.dot(forward);
        (self.size / 2.0 + DVec2::new(p.dot(right), -p.dot(up)) * (self.focal / w), w)
    }

    /// The part of an edge beyond the near plane.
    fn before_eye(&self, [p, q]: [DVec3; 2]) -> Option<[DVec3; 2]> {
        let [wp, wq] = [p, q].map(|p| p.dot(self.axes[2]) - self.near);
        let cut = || p.lerp(q, wp / (wp - wq));
        match (wp >= 0.0, wq >= 0.0) {
            (true, true) => Some([p, q]),
            (true, false) => Some([p, cut()]),
            (false, true) => Some([cut(), q]),
            (false, false) => None,
        }
    }
}
