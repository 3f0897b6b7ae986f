//! Curves on the surface: where it turns from toward to away, where it ends, and lines that lie on it.
//!
//! What faces the eye is bounded by contours and by the rim: its boundary, walked with the surface that faces the eye on
//! the left (seen from above), is a set of curves that neither branch nor cross. A curve has open ends only where what is
//! certainly hidden or beside the page was left out.

use glam::{DVec2, DVec3};

use super::Line;

/// A place on the lattice, in 1/256 of its finest step, x east and y south of the north-west sample.
pub(crate) type LatticePlace = [i32; 2];

/// A point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// Pixels from the page's top left corner, x right, y down.
    pub place: DVec2,
    /// Near / distance along the view axis; larger is nearer.
    pub depth: f64,
    /// Metres of the exaggerated world: east, north, up.
    pub world: DVec3,
    /// Where it lies on the lattice.
    pub at: LatticePlace,
    /// How strongly the page shows what the curve draws, 0 to 1; 1 of what bounds the surface.
    pub weight: f32,
    /// Of a hachure the share of the paper about it that is to be ink; 1 of all else.
    pub black: f32,
}

/// Which boundary of the toward surface a stretch is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Bound {
    /// The surface turns away.
    Contour,
    /// The surface ends.
    Rim,
    /// Nothing: a line that lies on it.
    Nothing(Line),
}

/// What is known of whether the eye sees a stretch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Sight {
    /// From all four pixel centres about its middle nothing stands before it.
    Free,
    /// From all four something does.
    Hidden,
    /// They differ; what the nearest says.
    Doubt {
        /// Nothing stands before it there.
        free: bool,
    },
}

/// What lies between a point of a curve and the next, at most about a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// What it bounds.
    pub bound: Bound,
    /// Whether it is seen.
    pub sight: Sight,
    /// Depth of what lies behind it, on the far side; 0 is sky.
    pub behind: f32,
    /// How steeply facing falls along the view direction: sine of the angle between the stretch and the ray through it, seen
    /// from the outside of the surface. Above 0: convex, the surface folds out of sight behind it; below 0: concave, it hides
    /// itself. 0 at a cusp. 1 for all but contours.
    pub fall: f32,
    /// On the page, the unit vector from the surface outwards, to what lies behind.
    pub outward: DVec2,
}

/// A curve on the surface: `points.len() - 1` stretches, as many as points where it is closed.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// At least two.
    pub points: Vec<CurvePoint>,
    /// Stretch `i` leads from point `i` to the next.
    pub stretches: Vec<Stretch>,
    /// Whether the last stretch leads to the first point.
    pub closed: bool,
}

impl Curve {
    /// The points that a stretch leads from and to.
    pub fn ends(&self, stretch: usize) -> [&CurvePoint; 2] {
        let next = if stretch + 1 == self.points.len() { 0 } else { stretch + 1 };
        [&self.points[stretch], &self.points[next]]
    }

    /// Length of a stretch on the page, px.
    pub fn length(&self, stretch: usize) -> f64 {
        let [a, b] = self.ends(stretch);
        a.place.distance(b.place)
    }

    /// The point after so many stretches and a share of one; a closed curve goes round.
    pub fn at(&self, along: f64) -> CurvePoint {
        let whole = along as usize;
        let share = along - whole as f64;
        let i = if self.closed { whole % self.stretches.len() } else { whole };
        if share == 0.0 {
            return self.points[i];
        }
        let [a, b] = self.ends(i);
        // Depth is linear on the page, the world is where divided by distance.
        let depth = a.depth + (b.depth - a.depth) * share;
        let at = [0, 1].map(|axis| {
            let [from, to] = [a, b].map(|end| f64::from(end.at[axis]));
            (from + (to - from) * share).round() as i32
        });
        CurvePoint {
            place: a.place.lerp(b.place, share),
            depth,
            world: a.world.lerp(b.world, share * b.depth / depth),
            at,
            weight: a.weight + (b.weight - a.weight) * share as f32,
            black: a.black + (b.black - a.black) * share as f32,
        }
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Curve {
    /// Lets a closed curve begin at another of its points.
    pub fn turn(&mut self, point: usize) {
        self.points.rotate_left(point);
        self.stretches.rotate_left(point);
    }
}
