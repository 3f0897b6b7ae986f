//! Curves laid out on the page by hand, for what follows extraction.

use glam::{DVec2, DVec3};
use hachure::line::{Bound, Curve, CurvePoint, Sight, Stretch};

/// Side of a page on which curves are laid out, px.
pub const PAGE: [u32; 2] = [240, 180];
/// Metres along the view axis at depth 1, which are as many px there.
const NEAR: f64 = 100.0;
/// Metres of the world in a cell of level 1: no stretch is longer than one.
const CELL: f64 = 40.0;

/// The point of a curve that is seen there.
pub fn seen(place: DVec2, depth: f64) -> CurvePoint {
    let distance = NEAR / depth;
    let world = DVec3::new(place.x / NEAR * distance, distance, -place.y / NEAR * distance);
    let at = [world.x, world.y].map(|v| (v / CELL * 64.0 * 256.0).round() as i32);
    CurvePoint { place, depth, world, at, weight: 1.0, black: 1.0 }
}

/// A convex, free contour against land at depth 0.1 through points (x, y, depth), the surface on the left, in stretches of
/// at most a pixel; closed where the first point is given last, too.
pub fn through(corners: &[[f64; 3]]) -> Curve {
    let mut points = Vec::new();
    for pair in corners.windows(2) {
        let [a, b] = [pair[0], pair[1]].map(DVec3::from);
        let steps = (b - a).truncate().length().ceil().max(1.0);
        points.extend((0..steps as u32).map(|i| a.lerp(b, f64::from(i) / steps)));
    }
    let closed = corners[0] == corners[corners.len() - 1];
    if !closed {
        points.push(corners[corners.len() - 1].into());
    }
    let points: Vec<CurvePoint> = points.into_iter().map(|p| seen(p.truncate(), p.z)).collect();
    let count = points.len() - usize::from(!closed);
    let stretches = (0..count).map(|i| {
        let along = points[(i + 1) % points.len()].place - points[i].place;
        let outward = DVec2::new(-along.y, along.x).normalize_or_zero();
        Stretch { bound: Bound::Contour, sight: Sight::Free, behind: 0.1, fall: 1.0, outward }
    });
    Curve { stretches: stretches.collect(), points, closed }
}

/// The curve with its stretches as the function makes them, given the middle of each on the page.
pub fn with(mut curve: Curve, mut change: impl FnMut(DVec2, &mut Stretch)) -> Curve {
    for i in 0..curve.stretches.len() {
        let [a, b] = curve.ends(i).map(|end| end.place);
        change(a.midpoint(b), &mut curve.stretches[i]);
    }
    curve
}

/// A disc of constant depth, the surface inside.
pub fn disc(middle: DVec2, radius: f64, depth: f64) -> Curve {
    let sides = (std::f64::consts::TAU * radius).ceil() as u32;
    let corner = |i: u32| {
        // From the east over the north to the west: rows run down.
        let angle = f64::from(i % sides) / f64::from(sides) * std::f64::consts::TAU;
        [middle.x + radius * angle.cos(), middle.y - radius * angle.sin(), depth]
    };
    through(&(0..=sides).map(corner).collect::<Vec<_>>())
}
