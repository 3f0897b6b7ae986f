//! Which points of a chain a pen shows, and what lies behind it from each to the next.
//!
//! Method: points that lie on a straight way between others are left out (Douglas and Peucker 1973). Which are is a matter of
//! hundredths of a pixel and changes from frame to frame: so what lies behind is told of the whole way to the next point that
//! stays, not of the place where it stands. Cost: that of leaving out, and a look at each point.

use glam::DVec3;

use super::ChainPoint;
use super::simplify::needed;

/// Points that lie within this of the rest are left out, px; a hundredth in ln depth weighs as much as a hundredth of a px.
const SHOWN: f64 = 0.03;
/// Longest piece of a chain without a point, px: what varies along it is still told.
const APART: f64 = 4.0;

/// The points that a pen shows: both ends, those where what is drawn changes, one at least every [`APART`] px. `lengths` are
/// those of the ways from each point to the next, px.
pub(super) fn shown(points: &[ChainPoint], lengths: &[f64]) -> Vec<ChainPoint> {
    let kept = kept(points);
    let ends = kept.iter().skip(1).copied().chain([points.len() - 1]);
    let told = |(&from, to): (&usize, usize)| {
        let behind = if from < to { behind(&points[from..to], &lengths[from..to]) } else { points[from].behind };
        ChainPoint { behind, ..points[from] }
    };
    kept.iter().zip(ends).map(told).collect()
}

/// Depth of what lies behind these points and the ways from them: its mean, or sky where most is.
fn behind(points: &[ChainPoint], lengths: &[f64]) -> f32 {
    let all = || points.iter().map(|point| f64::from(point.behind)).zip(lengths);
    let sky: f64 = all().filter(|(behind, _)| *behind == 0.0).map(|(_, length)| length).sum();
    let land = all().filter(|(behind, _)| *behind > 0.0);
    let (sum, of_land) = land.fold((0.0, 0.0), |(sum, of), (behind, length)| (sum + behind * length, of + length));
    match (sky < of_land, sky > 0.0) {
        (true, _) => (sum / of_land) as f32,
        (false, true) => 0.0,
        // Ways without length say nothing.
        (false, false) => points[0].behind,
    }
}

/// Numbers of the points that stay.
fn kept(points: &[ChainPoint]) -> Vec<usize> {
    let places: Vec<DVec3> = points.iter().map(|point| point.place.extend(point.log_depth())).collect();
    let (mut kept, mut start) = (vec![0], 0);
    for part in points.chunk_by(|a, b| a.line == b.line) {
        let end = (start + part.len()).min(points.len() - 1);
        for span in needed(&places[start..=end], SHOWN).windows(2) {
            let mut length = 0.0;
            for i in start + span[0] + 1..start + span[1] {
                length += points[i].place.distance(points[i - 1].place);
                if length + points[i + 1].place.distance(points[i].place) > APART {
                    kept.push(i);
                    length = 0.0;
                }
            }
            kept.push(start + span[1]);
        }
        start = end;
    }
    kept
}
