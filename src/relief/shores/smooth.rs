//! Smooth lines that cross the sides of cells where they did before.
//!
//! Method: each crossing moves along its side toward a line through its neighbours, and away from one through those beyond
//! them, so that circles keep their radii (Taubin 1995 does so in two steps). Cells are convex and a side belongs to two of
//! them, so a line that crosses the same sides in the same order has the same crossings with others: none. Cost: so many
//! passes over the crossings. Not handled: corners, which become round within about three cells.

use glam::DVec2;

use super::Crossing;

/// Passes, and the share of the way to its aim that a crossing goes in one.
const PASSES: usize = 60;
const PACE: f64 = 0.3;
/// How many times as far outside the farther chord must lie: less, and what is found between them grows.
const LEAST_RATIO: f64 = 2.0;
/// How near to a sample a crossing may come, so that none falls together with another.
const NEAREST: f64 = 0.02;

/// Makes a line smooth; ends stay where they are.
pub(super) fn smooth(crossings: &mut [Crossing], closed: bool) {
    let count = crossings.len();
    let mut moved: Vec<f64> = crossings.iter().map(|crossing| crossing.at).collect();
    for _ in 0..PASSES {
        let neighbour = |i: usize, by: isize| {
            let at = i as isize + by;
            let within = (0..count as isize).contains(&at);
            (closed || within).then(|| crossings[at.rem_euclid(count as isize) as usize].place())
        };
        for (i, moved) in moved.iter_mut().enumerate() {
            let between = |by: isize| {
                let (before, after) = (neighbour(i, -by)?, neighbour(i, by)?);
                let here = crossings[i].place();
                Some((met(crossings[i], before, after)?, here.distance(before) * here.distance(after)))
            };
            let aim = match (between(1), between(2)) {
                // A circle lies outside of its chords by the product of their parts.
                (Some((near, inside)), Some((far, farther))) if farther > LEAST_RATIO * inside => {
                    (farther * near - inside * far) / (farther - inside)
                }
                (Some((near, _)), _) => near,
                (None, _) => continue,
            };
            let at = crossings[i].at;
            *moved = (at + PACE * (aim - at)).clamp(NEAREST, 1.0 - NEAREST);
        }
        crossings.iter_mut().zip(&moved).for_each(|(crossing, moved)| crossing.at = *moved);
    }
}

/// Where a line from one place to another meets the side of a crossing, or would meet what goes on from it at either end;
/// `None` where both places lie on one side of it.
fn met(crossing: Crossing, before: DVec2, after: DVec2) -> Option<f64> {
    let off = |place: DVec2| crossing.step.perp_dot(place - crossing.from);
    let (from, to) = (off(before), off(after));
    if from * to > 0.0 || from == to {
        return None;
    }
    Some((before.lerp(after, from / (from - to)) - crossing.from).dot(crossing.step))
}
