//! What is wrong with a planned layer, found without any code of the plan.

use std::collections::HashSet;

use glam::DVec2;
use hachure::ink::{Stroke, StrokePoint};
use rstar::primitives::Line;
use rstar::{PointDistance, RTree};

/// How far a planned line may lie from the one that was there, mm.
///
/// Example: points .02 mm from the last one kept are left out, so that a line with a corner there is cut by .02 mm.
pub const MOVED: f64 = 0.03;
/// Shortest segment, mm, as files have it.
pub const SEGMENT: f64 = 0.02;
/// Shortest stroke, mm, as files have it.
pub const STROKE: f64 = 0.05;
/// From one place to the next where lines are compared, mm.
const STEP: f64 = 0.01;

/// A stroke of full width through these places.
pub fn open(places: &[(f64, f64)]) -> Stroke {
    let point = |&(x, y): &(f64, f64)| StrokePoint { place: DVec2::new(x, y), width: 1.0 };
    Stroke { chain: None, piece: 0, points: places.iter().map(point).collect(), closed: false }
}

/// The same, led back to its first place.
pub fn ring(places: &[(f64, f64)]) -> Stroke {
    Stroke { closed: true, ..open(places) }
}

/// The segments of a stroke; of a dot one without length.
pub fn segments(stroke: &Stroke) -> Vec<[DVec2; 2]> {
    let mut places: Vec<DVec2> = stroke.points.iter().map(|point| point.place).collect();
    if stroke.closed || places.len() == 1 {
        places.push(places[0]);
    }
    places.windows(2).map(|pair| [pair[0], pair[1]]).collect()
}

/// Way along a stroke, mm.
pub fn length(stroke: &Stroke) -> f64 {
    segments(stroke).iter().map(|[a, b]| a.distance(*b)).sum()
}

/// A place as files have it, in micrometres.
fn filed(place: DVec2) -> [i64; 2] {
    (place * 1000.0).to_array().map(|coordinate| coordinate.round() as i64)
}

/// Places along `lines` that lie too far from all of `others`.
pub fn uncovered(lines: &[Stroke], others: &[Stroke]) -> Vec<DVec2> {
    let line = |[a, b]: [DVec2; 2]| Line::new(a.to_array(), b.to_array());
    let tree = RTree::bulk_load(others.iter().flat_map(segments).map(line).collect());
    let along = |[a, b]: [DVec2; 2]| {
        let steps = (a.distance(b) / STEP).ceil() as u32;
        (0..=steps).map(move |step| a.lerp(b, f64::from(step) / f64::from(steps.max(1))))
    };
    let is_far = |place: &DVec2| {
        let nearest = tree.nearest_neighbor(place.to_array());
        nearest.is_none_or(|line| line.distance_2(&place.to_array()) > MOVED * MOVED)
    };
    lines.iter().flat_map(segments).flat_map(along).filter(is_far).collect()
}

/// Segments and strokes that are too short, as files have them.
pub fn short(strokes: &[Stroke]) -> Vec<f64> {
    let way = |[a, b]: [DVec2; 2]| {
        let [a, b] = [a, b].map(|place| DVec2::from(filed(place).map(|micrometres| micrometres as f64 / 1000.0)));
        a.distance(b)
    };
    let ways = |stroke: &Stroke| segments(stroke).into_iter().map(way).collect::<Vec<_>>();
    let too_short = |stroke: &Stroke| {
        let ways = ways(stroke);
        let whole: f64 = ways.iter().sum();
        let segments = ways.into_iter().filter(|way| *way < SEGMENT);
        segments.chain(Some(whole).filter(|whole| *whole < STROKE)).collect::<Vec<_>>()
    };
    strokes.iter().flat_map(too_short).collect()
}

/// Segments that are drawn again.
pub fn twice(strokes: &[Stroke]) -> Vec<[DVec2; 2]> {
    let mut seen = HashSet::new();
    let is_new = |segment: &[DVec2; 2]| {
        let mut ends = segment.map(filed);
        ends.sort();
        seen.insert(ends)
    };
    let (_, again) = strokes.iter().flat_map(segments).partition::<Vec<_>, _>(is_new);
    again
}

/// Everything that a plan of `found` may not be.
pub fn faults(found: &[Stroke], planned: &[Stroke]) -> Vec<String> {
    let lost = uncovered(found, planned);
    let added = uncovered(planned, found);
    let (short, twice) = (short(planned), twice(planned));
    let said = |what: &str, first: Option<String>| first.map(|first| format!("{what}, at first {first}"));
    let whats = [
        said("lost", lost.first().map(|place| place.to_string())),
        said("added", added.first().map(|place| place.to_string())),
        said("too short", short.first().map(|way| way.to_string())),
        said("drawn twice", twice.first().map(|segment| format!("{segment:?}"))),
    ];
    whats.into_iter().flatten().collect()
}

/// Way in the air from the corner through the strokes, mm.
pub fn travel(strokes: &[Stroke]) -> f64 {
    let mut at = DVec2::ZERO;
    let to = |stroke: &Stroke| {
        let way = at.distance(stroke.points[0].place);
        at = segments(stroke)[segments(stroke).len() - 1][1];
        way
    };
    strokes.iter().map(to).sum()
}
