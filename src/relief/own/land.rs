//! Lines cut where a DEM has no patch under them.

use glam::DVec2;

use crate::dem::{Dem, Validity};
use crate::error::Result;

/// The parts of a line over patches, its steps being at most one cell; columns and rows.
///
/// # Errors
/// As [`Dem::survey`].
pub(super) fn on_land(line: &[DVec2], dem: &Dem) -> Result<Vec<Vec<DVec2>>> {
    let survey = dem.survey(&|_| ())?;
    if survey.voids == 0 {
        return Ok(vec![line.to_vec()]);
    }
    let mut parts: Vec<Vec<DVec2>> = Vec::new();
    let mut goes_on = false;
    for pair in line.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let ends = crossings(a, b);
        let pieces: Vec<bool> =
            ends.windows(2).map(|ends| has_patch(&survey.validity, a.lerp(b, (ends[0] + ends[1]) / 2.0))).collect();
        // Pieces side by side on land are one.
        for (i, on_land) in pieces.iter().enumerate() {
            if *on_land && !goes_on {
                parts.push(vec![if i == 0 { a } else { a.lerp(b, ends[i]) }]);
            }
            let is_last = !pieces.get(i + 1).copied().unwrap_or(false);
            if let Some(part) = parts.last_mut().filter(|_| *on_land && is_last) {
                part.push(if i + 1 == pieces.len() { b } else { a.lerp(b, ends[i + 1]) });
            }
            goes_on = *on_land;
        }
    }
    Ok(parts)
}

/// 0, the shares of a step at which it crosses sides or diagonals of cells, and 1.
fn crossings(a: DVec2, b: DVec2) -> Vec<f64> {
    let mut at = vec![0.0, 1.0];
    for [from, to] in [[a.x, b.x], [a.y, b.y], [a.x - a.y, b.x - b.y]] {
        let (low, high) = (from.min(to), from.max(to));
        let mut line = low.floor() + 1.0;
        while line < high {
            at.push((line - from) / (to - from));
            line += 1.0;
        }
    }
    at.sort_by(f64::total_cmp);
    at.dedup();
    at
}

/// Whether a patch lies under a place, or on one side of it.
fn has_patch(validity: &Validity, place: DVec2) -> bool {
    let [columns, rows] = [place.x, place.y].map(sides);
    rows.into_iter().any(|r| {
        columns.into_iter().any(|c| {
            let within = place - DVec2::new(c as f64, r as f64);
            (within.x <= within.y && validity.has_patch(c, r, 0))
                || (within.x >= within.y && validity.has_patch(c, r, 1))
        })
    })
}

/// The cell of a coordinate; on a side that before it, too.
fn sides(at: f64) -> [usize; 2] {
    let cell = at.max(0.0).floor();
    [cell, if cell == at { (cell - 1.0).max(0.0) } else { cell }].map(|cell| cell as usize)
}
