//! Nothing is drawn twice.
//!
//! Two segments are the same where both ends are, in whole micrometres, which is what files hold; the first of them is
//! drawn. Cost: a look into a hash table a segment.
//!
//! Not handled: segments that overlap in part, and a dot on a line.

use glam::{DVec2, I64Vec2};
use rustc_hash::FxHashSet;

use super::segments;
use crate::ink::Stroke;

/// Micrometres in a millimetre.
const FILED: f64 = 1000.0;

/// Both ends of a segment in micrometres, the lesser first.
type Key = [[i64; 2]; 2];

/// The strokes without what an earlier one draws, or the same one has drawn: what is left of them between.
pub(super) fn once(strokes: Vec<Stroke>) -> Vec<Stroke> {
    let mut drawn: FxHashSet<Key> = FxHashSet::default();
    strokes.into_iter().flat_map(|stroke| left_of(stroke, &mut drawn)).collect()
}

fn filed(place: DVec2) -> I64Vec2 {
    (place * FILED).round().as_i64vec2()
}

fn key([a, b]: [DVec2; 2]) -> Key {
    let mut ends = [a, b].map(|end| filed(end).to_array());
    ends.sort_unstable();
    ends
}

/// The parts of a stroke that are not drawn yet; now they are.
fn left_of(mut stroke: Stroke, drawn: &mut FxHashSet<Key>) -> Vec<Stroke> {
    stroke.points.dedup_by_key(|point| filed(point.place));
    let ends_meet =
        |stroke: &Stroke| filed(stroke.points[0].place) == filed(stroke.points[stroke.points.len() - 1].place);
    if stroke.closed && stroke.points.len() > 1 && ends_meet(&stroke) {
        stroke.points.pop();
    }
    if let [dot] = &stroke.points[..] {
        let is_new = drawn.insert(key([dot.place; 2]));
        return Vec::from_iter(is_new.then_some(Stroke { closed: false, ..stroke }));
    }
    let mut is_new: Vec<bool> = segments(&stroke).map(|segment| drawn.insert(key(segment))).collect();
    let Some(old) = is_new.iter().position(|is_new| !is_new) else { return vec![stroke] };
    if stroke.closed {
        // It is open there: the segment that leads back to the first point is one of those left out.
        stroke.points.rotate_left((old + 1) % is_new.len());
        is_new.rotate_left((old + 1) % stroke.points.len());
        is_new.pop();
    }
    let mut first = 0;
    let parts = is_new.chunk_by(|a, b| a == b).map(|part| {
        let points = first..=first + part.len();
        first += part.len();
        (part[0], points)
    });
    let left = parts.filter(|(is_new, _)| *is_new);
    left.map(|(_, points)| Stroke { points: stroke.points[points].to_vec(), closed: false, ..stroke }).collect()
}
