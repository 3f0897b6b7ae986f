//! Polylines of the world, drawn over the hidden-surface cover.
//!
//! Method: each segment is clipped to the near plane and to the page, then sampled every half pixel; reversed depth is
//! linear on the page, so samples in between need no division. Runs of samples that the cover does not hide are chains.
//! Cost: one look at five pixels a sample. Does not handle: a surface that is thinner on the page than a pixel.

use glam::{DVec2, DVec3};

use super::{Chain, ChainPoint, InkRaster, Kind, Line, Pixel};
use crate::view::Perspective;
use crate::view::cut::share_within;

/// How much nearer than a line the cover must be to hide it, as a share of the distance.
///
/// Example: a drainage line follows the samples of a DEM while the drawn facets between them bulge 4 m over it, 2 km
/// away: 0.2 %, drawn. A ridge that hides it stands at least tens of metres before it: 20 m of 2 km are 1 %, hidden.
const COVER_TOLERANCE: f64 = 0.004;
/// Distance of samples on the page, px.
const SAMPLE: f64 = 0.5;

/// Whether the surface hides the lines behind it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cover {
    /// It does.
    On,
    /// Lines show through.
    Off,
}

/// The visible parts of a line of the (exaggerated) world, given in metres, as chains on the page. The raster's depths are
/// those of the perspective.
pub fn project_polyline(
    points: &[DVec3],
    line: Line,
    perspective: &Perspective,
    raster: &InkRaster,
    cover: Cover,
) -> Vec<Chain> {
    let mut chains = Vec::new();
    let mut run: Vec<ChainPoint> = Vec::new();
    for segment in points.windows(2) {
        let samples = clip_near(segment[0], segment[1], perspective)
            .map(|ends| ends.map(|p| perspective.project(p)))
            .and_then(|[a, b]| clip_page(a, b, perspective.size()))
            .map_or(Vec::new(), |(a, b)| samples(a, b, line, perspective));
        for point in samples {
            if run.last().is_some_and(|last| last.place.distance(point.place) > 2.0 * SAMPLE) {
                finish(&mut run, &mut chains);
            }
            if cover == Cover::On && hidden(raster, point) {
                finish(&mut run, &mut chains);
            } else if run.last().is_none_or(|last| last.place != point.place) {
                run.push(point);
            }
        }
    }
    finish(&mut run, &mut chains);
    chains
}

/// Makes a chain of a run of visible samples, unless it is a single one.
fn finish(run: &mut Vec<ChainPoint>, chains: &mut Vec<Chain>) {
    let points = std::mem::take(run);
    if points.len() > 1 {
        chains.push(Chain { id: None, points, closed: false });
    }
}

/// The part of a segment beyond the near plane.
fn clip_near(a: DVec3, b: DVec3, perspective: &Perspective) -> Option<[DVec3; 2]> {
    let near = perspective.near();
    let (wa, wb) = (perspective.distance(a), perspective.distance(b));
    let crossing = a.lerp(b, (near - wa) / (wb - wa));
    match (wa >= near, wb >= near) {
        (true, true) => Some([a, b]),
        (true, false) => Some([a, crossing]),
        (false, true) => Some([crossing, b]),
        (false, false) => None,
    }
}

/// The part of a segment on the page.
fn clip_page(a: (DVec2, f64), b: (DVec2, f64), page: DVec2) -> Option<((DVec2, f64), (DVec2, f64))> {
    let at = |t: f64| (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t);
    share_within([DVec2::ZERO, page], a.0, b.0).map(|[enter, leave]| (at(enter), at(leave)))
}

/// Points from a to b, both included, at most [`SAMPLE`] px apart.
fn samples(a: (DVec2, f64), b: (DVec2, f64), line: Line, perspective: &Perspective) -> Vec<ChainPoint> {
    let steps = (a.0.distance(b.0) / SAMPLE).ceil().max(1.0);
    let at = |i: u64| i as f64 / steps;
    let point = |t: f64| ChainPoint::seen(a.0.lerp(b.0, t), line, (a.1 + (b.1 - a.1) * t) as f32, perspective);
    (0..=steps as u64).map(|i| point(at(i))).collect()
}

/// Whether the cover is nearer than the point, in its pixel and all four neighbours: a line that lies on a slope seen at
/// a grazing angle is not eaten by the nearer half of its own pixel.
fn hidden(raster: &InkRaster, point: ChainPoint) -> bool {
    let (column, row) = (point.place.x.floor() as i64, point.place.y.floor() as i64);
    let around = [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)].map(|(dx, dy)| raster.at(column + dx, row + dy));
    let depth = |p: Pixel| if p.kind() == Kind::Sky { 0.0 } else { f64::from(p.depth()) };
    let farthest = around.into_iter().flatten().map(depth).min_by(f64::total_cmp);
    farthest.is_some_and(|depth| depth > f64::from(point.depth) * (1.0 + COVER_TOLERANCE))
}
