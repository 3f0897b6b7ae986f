//! Leaves points out of polylines (Douglas and Peucker 1973). Cost: some ten looks at each point.

use glam::DVec3;

/// Which points of an open polyline, in order, are enough: the others lie within `tolerance` of it. Both ends stay.
pub(super) fn needed(points: &[DVec3], tolerance: f64) -> Vec<usize> {
    let mut kept = vec![0];
    let mut spans = vec![(0, points.len() - 1)];
    while let Some((first, last)) = spans.pop() {
        let off = |i: usize| (distance_to_segment(points[i], points[first], points[last]), i);
        let worst = (first + 1..last).map(off).max_by(|a, b| a.0.total_cmp(&b.0));
        match worst.filter(|worst| worst.0 > tolerance) {
            Some((_, worst)) => spans.extend([(worst, last), (first, worst)]),
            None => kept.push(last),
        }
    }
    kept.dedup();
    kept
}

/// Distance of a point from the segment a-b.
fn distance_to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let ab = b - a;
    let t = (p - a).dot(ab) / ab.length_squared().max(f64::MIN_POSITIVE);
    p.distance(a + ab * t.clamp(0.0, 1.0))
}
