//! Lines from the system of their file to the grid of a DEM.
//!
//! They are cut to a box about the DEM there (Liang, Barsky 1984), carried over at steps of eight cells, cut to the grid and
//! split to steps of one cell. Not handled: bends of less than eight cells between two systems.

use glam::DVec2;

use crate::dem::{Crs, Dem};
use crate::geo::OwnLine;

/// Places along each side of the DEM whose box is looked for in the file's system.
const PLACES: usize = 21;
/// How much wider than theirs the box is, for what lies between them: a shape bulges there by less, a pole lies at most so
/// far from one of them.
const WIDER: f64 = 1.5 / (PLACES - 1) as f64;
/// Cells between places that are carried from one system to the other.
const STEP: f64 = 8.0;

/// A part of a line in the file's coordinates.
struct OwnRun {
    line: usize,
    places: Vec<DVec2>,
}

/// The parts of each line that are over the DEM: columns and rows, fractional, at steps of at most one cell. The last place of
/// a closed line is its first.
pub(super) fn to_grid(lines: &[OwnLine], crs: &Crs, dem: &Dem) -> Vec<Vec<Vec<DVec2>>> {
    let around = around(crs, dem);
    let runs = lines.iter().enumerate().flat_map(|(i, line)| {
        let places: Vec<_> = line.places.iter().chain(line.places.first().filter(|_| line.closed)).copied().collect();
        let within = match around {
            Some(around) => within(&places, around),
            None => vec![places],
        };
        within.into_iter().map(move |places| OwnRun { line: i, places })
    });
    let runs: Vec<OwnRun> = runs.collect();
    let coarse = carried(&runs, crs, dem);
    let is_world = crs == dem.georeference().world();
    let (runs, carried_over) = if is_world {
        (runs, coarse)
    } else {
        let fine =
            |(run, on_grid): (OwnRun, Vec<DVec2>)| OwnRun { line: run.line, places: refined(&run.places, &on_grid) };
        let runs: Vec<OwnRun> = runs.into_iter().zip(coarse).map(fine).collect();
        let on_grid = carried(&runs, crs, dem);
        (runs, on_grid)
    };
    let far = DVec2::new((dem.columns() - 1) as f64, (dem.rows() - 1) as f64);
    let mut parts = vec![Vec::new(); lines.len()];
    for (run, on_grid) in runs.iter().zip(carried_over) {
        let cut = within(&on_grid, [DVec2::ZERO, far]);
        parts[run.line].extend(cut.iter().map(|part| split(part, |a, b| a.distance(b))));
    }
    parts
}

/// A box that holds the DEM, in another system; `None` where it has no place there, or nobody knows.
fn around(crs: &Crs, dem: &Dem) -> Option<[DVec2; 2]> {
    let [west, south, east, north] = dem.extent();
    let (low, high) = (DVec2::new(west, south), DVec2::new(east, north));
    let share = |i: usize| i as f64 / (PLACES - 1) as f64;
    let world = |i: usize| low + (high - low) * DVec2::new(share(i % PLACES), share(i / PLACES));
    let worlds: Vec<DVec2> = (0..PLACES * PLACES).map(world).collect();
    let places = dem.georeference().places_in(crs, &worlds);
    let places = || places.iter().flatten().copied();
    let (low, high) = (places().reduce(DVec2::min)?, places().reduce(DVec2::max)?);
    let wider = (high - low) * WIDER;
    Some([low - wider, high + wider])
}

/// Columns and rows of the places of each run; NaN where there is no such place.
fn carried(runs: &[OwnRun], crs: &Crs, dem: &Dem) -> Vec<Vec<DVec2>> {
    // All at once: the way from one system to another is dear to find.
    let places: Vec<DVec2> = runs.iter().flat_map(|run| &run.places).copied().collect();
    let worlds = dem.georeference().world_places(crs, &places);
    let mut on_grid = worlds.into_iter().map(|world| world.map_or(DVec2::NAN, |world| dem.grid_place(world)));
    runs.iter().map(|run| on_grid.by_ref().take(run.places.len()).collect()).collect()
}

/// Places of a run with more of them between, so that they lie a step of places apart on the grid.
fn refined(places: &[DVec2], on_grid: &[DVec2]) -> Vec<DVec2> {
    let mut i = 0;
    split(places, |_, _| {
        i += 1;
        on_grid[i - 1].distance(on_grid[i]) / STEP
    })
}

/// Places with more of them between, each pair split into parts of at most 1 by the length that it is said to have.
fn split(places: &[DVec2], mut length: impl FnMut(DVec2, DVec2) -> f64) -> Vec<DVec2> {
    let mut fine: Vec<DVec2> = places.first().copied().into_iter().collect();
    for pair in places.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        // NaN is no length: one step.
        let parts = length(a, b).ceil().max(1.0);
        let between = (1..parts as usize).map(|i| a.lerp(b, i as f64 / parts));
        fine.extend(between.chain([b]));
    }
    fine
}

/// The parts of a line within a box, its sides included; what is not finite is outside.
fn within(places: &[DVec2], around: [DVec2; 2]) -> Vec<Vec<DVec2>> {
    let mut parts: Vec<Vec<DVec2>> = Vec::new();
    let mut goes_on = false;
    for pair in places.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let Some([from, to]) = cut([a, b], around) else {
            goes_on = false;
            continue;
        };
        let at = |t: f64| if t == 1.0 { b } else { (a + (b - a) * t).clamp(around[0], around[1]) };
        if !goes_on || from > 0.0 {
            parts.push(vec![at(from)]);
        }
        let end = at(to);
        if let Some(part) = parts.last_mut().filter(|part| part.last() != Some(&end)) {
            part.push(end);
        }
        goes_on = to == 1.0;
    }
    parts.retain(|part| part.len() > 1);
    parts
}

/// From where to where, in shares of it, an edge is in a box.
fn cut([a, b]: [DVec2; 2], [low, high]: [DVec2; 2]) -> Option<[f64; 2]> {
    if !(a.is_finite() && b.is_finite()) {
        return None;
    }
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let (start, run) = (a[axis], b[axis] - a[axis]);
        if run == 0.0 {
            if start < low[axis] || start > high[axis] {
                return None;
            }
            continue;
        }
        let [one, other] = [(low[axis] - start) / run, (high[axis] - start) / run];
        from = from.max(one.min(other));
        to = to.min(one.max(other));
    }
    (from <= to).then_some([from, to])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_cut_to_a_box() {
        let around = [DVec2::ZERO, DVec2::new(4.0, 3.0)];
        let cut = |places: &[[f64; 2]]| {
            let places: Vec<DVec2> = places.iter().copied().map(DVec2::from).collect();
            let parts = within(&places, around).into_iter();
            parts.map(|part| part.into_iter().map(|place| place.to_array()).collect()).collect::<Vec<Vec<[f64; 2]>>>()
        };
        assert_eq!(
            cut(&[[-1.0, 1.0], [2.0, 1.0], [2.0, 9.0], [3.0, 9.0], [3.0, 0.0]]),
            [vec![[0.0, 1.0], [2.0, 1.0], [2.0, 3.0]], vec![[3.0, 3.0], [3.0, 0.0]],]
        );
        assert_eq!(cut(&[[-4.0, 3.0], [9.0, 3.0]]), [[[0.0, 3.0], [4.0, 3.0]]], "along a side");
        assert_eq!(cut(&[[-1.0, 2.0], [1.0, 4.0]]), Vec::<Vec<[f64; 2]>>::new(), "at a corner");
        assert_eq!(cut(&[[1.0, 1.0], [f64::NAN, 1.0], [2.0, 1.0], [3.0, 1.0]]), [[[2.0, 1.0], [3.0, 1.0]]]);
    }
}
