//! Bounds of patches, row by row and several at a time.
//!
//! Method: all that is asked of a patch is how its control points differ from its flat triangle. With d from corner i to
//! corner j and n the normal at i, the control point a third of the way there lies at `p + d / 3 - m`, m = n (d . n) / 3: how
//! far d leaves the tangent plane, a third of it. Second differences along a side are sums of the m's of its ends, those at
//! the third corner sums of all six: no difference of near numbers is taken. See [`Patch::bulge`](super::patch::Patch::bulge),
//! which finds the same numbers from the control points of one patch. Cost: some 600 operations a cell, without a branch, so
//! that compilers do them on as many cells at once as the machine has lanes.

use std::array::from_fn;

use glam::DVec2;

use super::Surface;
use crate::dem::Samples;

/// Stands for slopes of any steepness.
const STEEPEST: f64 = 1e9;
/// Cells worked on together.
const LANES: usize = 4;

/// A number of each cell, and a vector.
type Lanes = [f64; LANES];
type Vectors = [Lanes; 3];

/// Heights and unit normals of a row of samples, metres.
pub(super) struct Corners {
    heights: Vec<f64>,
    normals: [Vec<f64>; 3],
}

/// What is known of the patches of a column of cells, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    /// Height below all of them; above `high` where there is none.
    pub low: f64,
    pub high: f64,
    /// See [`Bulge`](super::patch::Bulge).
    pub limit: f64,
    pub flat: f64,
    /// Least dz/d east and dz/d north of the sides of facets.
    pub least_slopes: [f64; 2],
    pub most_slopes: [f64; 2],
}

impl Bounds {
    /// Of no patch.
    pub(super) const NONE: Self = Self {
        low: f64::INFINITY,
        high: f64::NEG_INFINITY,
        limit: 0.0,
        flat: 0.0,
        least_slopes: [STEEPEST; 2],
        most_slopes: [-STEEPEST; 2],
    };

    /// Of these and others.
    pub(super) fn with(self, other: Self) -> Self {
        Self {
            low: least(self.low, other.low),
            high: most(self.high, other.high),
            limit: most(self.limit, other.limit),
            flat: most(self.flat, other.flat),
            least_slopes: from_fn(|axis| least(self.least_slopes[axis], other.least_slopes[axis])),
            most_slopes: from_fn(|axis| most(self.most_slopes[axis], other.most_slopes[axis])),
        }
    }
}

impl Corners {
    /// Of row `r` of `surface`, whose samples there are these, with their gradients in memory.
    pub(super) fn of(surface: &Surface, samples: &Samples, r: usize) -> Self {
        let heights: Vec<f64> = samples.row(r).iter().map(|height| f64::from(*height)).collect();
        let [mut x, mut y, mut z] = [(); 3].map(|()| vec![0.0; heights.len()]);
        let [east, north] = surface.gradients_of_row(r);
        for ((((x, y), z), p), q) in x.iter_mut().zip(&mut y).zip(&mut z).zip(east).zip(north) {
            let [p, q] = [p, q].map(|slope| f64::from(*slope));
            let share = 1.0 / (p * p + q * q + 1.0).sqrt();
            (*x, *y, *z) = (-p * share, -q * share, share);
        }
        Self { heights, normals: [x, y, z] }
    }
}

/// Takes the patches of the cells between two rows of samples into the `bounds` of their columns. `exists` tells which of
/// the two patches of each cell there are, `None` that all are.
pub(super) fn take_row(
    bounds: &mut [Bounds],
    [north, south]: [&Corners; 2],
    cell: DVec2,
    exists: Option<&[[bool; 2]]>,
) {
    for first in (0..bounds.len()).step_by(LANES) {
        let bounds = &mut bounds[first..];
        let of = of_cells(north, south, first, cell);
        for (lane, bounds) in bounds.iter_mut().take(LANES).enumerate() {
            let exists = exists.map_or([true; 2], |exists| exists[first + lane]);
            for (of, _) in of.iter().zip(exists).filter(|(_, exists)| *exists) {
                *bounds = bounds.with(of.in_lane(lane));
            }
        }
    }
}

/// [`Bounds`] of patches of as many cells.
struct BoundsOfCells {
    low: Lanes,
    high: Lanes,
    limit: Lanes,
    flat: Lanes,
    /// Least and largest, along east and along north.
    slopes: [[Lanes; 2]; 2],
}

impl BoundsOfCells {
    fn in_lane(&self, i: usize) -> Bounds {
        let [least_slopes, most_slopes] = from_fn(|k| from_fn(|axis| self.slopes[axis][k][i]));
        let (low, high, limit, flat) = (self.low[i], self.high[i], self.limit[i], self.flat[i]);
        Bounds { low, high, limit, flat, least_slopes, most_slopes }
    }
}

/// Of the two patches of the cells from column `first` on; beyond the last, numbers without meaning.
fn of_cells(north: &Corners, south: &Corners, first: usize, cell: DVec2) -> [BoundsOfCells; 2] {
    let of = |from: &[f64], c: usize| match from.get(c..c + LANES) {
        Some(lanes) => from_fn(|lane| lanes[lane]),
        None => from_fn(|lane| from.get(c + lane).copied().unwrap_or(0.0)),
    };
    let corner = |row: &Corners, c| (of(&row.heights, c), row.normals.each_ref().map(|n| of(n, c)));
    let [nw, ne, sw, se] =
        [corner(north, first), corner(north, first + 1), corner(south, first), corner(south, first + 1)];
    let east = |a: &(Lanes, Vectors), b: &(Lanes, Vectors)| side(a, b, [cell.x, 0.0]);
    let down = |a: &(Lanes, Vectors), b: &(Lanes, Vectors)| side(a, b, [0.0, -cell.y]);
    let diagonal = side(&nw, &se, [cell.x, -cell.y]);
    let back = |[from, to]: [Vectors; 2]| [to, from];
    // Sides in turn: from corner 0 to 1, from 1 to 2, from 2 to 0.
    [
        of_patch([nw.0, sw.0, se.0], [down(&nw, &sw), east(&sw, &se), back(diagonal)], [[1, 2], [1, 0]], cell),
        of_patch([nw.0, se.0, ne.0], [diagonal, back(down(&ne, &se)), back(east(&nw, &ne))], [[0, 2], [1, 2]], cell),
    ]
}

/// A third of how far the side between two corners, `x` and `y` metres long on the map, leaves the tangent plane of each.
fn side((a, n): &(Lanes, Vectors), (b, m): &(Lanes, Vectors), [x, y]: [f64; 2]) -> [Vectors; 2] {
    let leaves = |n: &Vectors, sign: f64| {
        let third: Lanes = from_fn(|i| (x * n[0][i] + y * n[1][i] + (b[i] - a[i]) * n[2][i]) * (sign / 3.0));
        vectors(|axis, i| n[axis][i] * third[i])
    };
    [leaves(n, 1.0), leaves(m, -1.0)]
}

/// Bounds of patches with corners of these heights. `sides`: see [`side`], from each corner to the next; `legs`: from which
/// corner to which it goes east, and north.
fn of_patch(heights: [Lanes; 3], sides: [[Vectors; 2]; 3], legs: [[usize; 2]; 2], cell: DVec2) -> BoundsOfCells {
    let [[m01, m10], [m12, m21], [m20, m02]] = sides;
    let sum = vectors(|k, i| m01[k][i] + m10[k][i] + m12[k][i] + m21[k][i] + m20[k][i] + m02[k][i]);
    let [limit, flat] = bulge(&sides, &sum);
    let [low, high] = range(&heights, &sides, &sum);
    let none = [[0.0; LANES]; 3];
    let leaves = [[none, m01, m02], [m10, none, m12], [m20, m21, none]];
    let centre = vectors(|k, i| 0.25 * sum[k][i]);
    let slopes = from_fn(|axis| slopes(&heights, &leaves, &centre, legs[axis], axis, cell));
    BoundsOfCells { low, high, limit, flat, slopes }
}

/// Both numbers of a [`Bulge`](super::patch::Bulge), from the second differences of the control points: those along a side
/// at either end, and those at the third corner. `sum` is that of all `sides`.
fn bulge([[m01, m10], [m12, m21], [m20, m02]]: &[[Vectors; 2]; 3], sum: &Vectors) -> [Lanes; 2] {
    let [mut limit, mut bend, mut change] = [[0.0; LANES]; 3];
    for [from, to, beside, beyond] in [[m01, m10, m02, m12], [m12, m21, m10, m20], [m20, m02, m21, m01]] {
        let a = vectors(|k, i| 2.0 * from[k][i] - to[k][i]);
        let b = vectors(|k, i| 2.0 * to[k][i] - from[k][i]);
        let c = vectors(|k, i| 0.5 * sum[k][i] - beside[k][i] - beyond[k][i]);
        let mean = vectors(|k, i| (a[k][i] + b[k][i] + c[k][i]) * (1.0 / 3.0));
        let widest =
            vectors(|k, i| most(most((a[k][i] - b[k][i]).abs(), (b[k][i] - c[k][i]).abs()), (c[k][i] - a[k][i]).abs()));
        limit = longer(longer(longer(limit, &a), &b), &c);
        (bend, change) = (longer(bend, &mean), longer(change, &widest));
    }
    let limit = limit.map(|squared| 0.75 * squared.sqrt());
    [limit, from_fn(|i| 0.75 * bend[i].sqrt() + 0.05 * change[i].sqrt())]
}

/// Heights below and above all ten control points: corners, a third along each side from either end, the middle.
fn range(
    [p, q, r]: &[Lanes; 3],
    [[m01, m10], [m12, m21], [m20, m02]]: &[[Vectors; 2]; 3],
    sum: &Vectors,
) -> [Lanes; 2] {
    let with = |[low, high]: [Lanes; 2], z: Lanes| -> [Lanes; 2] {
        [from_fn(|i| least(low[i], z[i])), from_fn(|i| most(high[i], z[i]))]
    };
    let mut range = with(with([*p, *p], *q), *r);
    for (from, to, m, n) in [(p, q, m01, m10), (q, r, m12, m21), (r, p, m20, m02)] {
        let third: Lanes = from_fn(|i| (to[i] - from[i]) * (1.0 / 3.0));
        range = with(range, from_fn(|i| from[i] + third[i] - m[2][i]));
        range = with(range, from_fn(|i| to[i] - third[i] - n[2][i]));
    }
    with(range, from_fn(|i| (p[i] + q[i] + r[i]) * (1.0 / 3.0) - 0.25 * sum[2][i]))
}

/// A vector of each cell from its components.
fn vectors(component: impl Fn(usize, usize) -> f64) -> Vectors {
    from_fn(|k| from_fn(|i| component(k, i)))
}

/// Least and largest slope along a leg, from corner a to corner b, of patches. Facets have sides along
/// east and north, chords of the patch or of several: their slopes lie between those of the control points' first
/// differences. `leaves`: by which vector the control point beside one corner on the way to another leaves the flat
/// triangle, `centre`: the one in the middle.
fn slopes(
    heights: &[Lanes; 3],
    leaves: &[[Vectors; 3]; 3],
    centre: &Vectors,
    [a, b]: [usize; 2],
    axis: usize,
    cell: DVec2,
) -> [Lanes; 2] {
    let c = 3 - a - b;
    let nothing = &leaves[a][a];
    let (ab, ba, ac, bc) = (&leaves[a][b], &leaves[b][a], &leaves[a][c], &leaves[b][c]);
    let steps = [(nothing, ab), (ab, ba), (ba, nothing), (ac, centre), (centre, bc), (&leaves[c][a], &leaves[c][b])];
    let (mut low, mut high) = ([STEEPEST; LANES], [-STEEPEST; LANES]);
    for (from, to) in steps {
        for i in 0..LANES {
            let run = cell[axis] / 3.0 - (to[axis][i] - from[axis][i]);
            let rise = (heights[b][i] - heights[a][i]) * (1.0 / 3.0) - (to[2][i] - from[2][i]);
            let slope = rise / run;
            // What folds over may lean any way.
            low[i] = least(low[i], if run > 0.0 { slope } else { -STEEPEST });
            high[i] = most(high[i], if run > 0.0 { slope } else { STEEPEST });
        }
    }
    [low, high]
}

/// The larger of squared lengths.
fn longer(squared: Lanes, v: &Vectors) -> Lanes {
    from_fn(|i| most(squared[i], v[0][i] * v[0][i] + v[1][i] * v[1][i] + v[2][i] * v[2][i]))
}

/// The lesser of two numbers: unlike `f64::min` one instruction, for no NaN comes here.
fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

fn most(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::dem::{Dem, fractal};
    use crate::surface::Patch;

    /// A surface of 23 x 9 samples, some of them void, steep and rough.
    fn surface() -> Surface {
        let heights = (0..9).flat_map(|r| fractal::row(4000, 700 * r).into_iter().step_by(171).take(23));
        let heights = heights.enumerate().map(|(i, height)| if i % 31 == 5 { f32::NAN } else { height / 20.0 });
        Surface::new(Dem::from_heights(23, DVec2::new(30.0, 20.0), DVec2::new(3e5, 4e6), heights.collect()))
    }

    /// Least and largest dz/d east and dz/d north between neighbouring control points.
    fn slopes_of(patch: &Patch, half: usize) -> [[f64; 2]; 2] {
        let control = patch.control();
        let mut range = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for (j, k) in [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (0, 2)] {
            let [a, b, c] = [(j, k), (j + 1, k), (j, k + 1)].map(|(j, k)| control[Patch::index(j, k)]);
            let (east, north) = if half == 0 { (c - b, a - b) } else { (c - a, c - b) };
            for (axis, (rise, run)) in [(east.z, east.x), (north.z, north.y)].into_iter().enumerate() {
                let [low, high] = if run > 0.0 { [rise / run; 2] } else { [-STEEPEST, STEEPEST] };
                range[0][axis] = range[0][axis].min(low);
                range[1][axis] = range[1][axis].max(high);
            }
        }
        range
    }

    #[test]
    fn bounds_are_those_of_the_control_points() {
        let surface = surface();
        let mut patches = [0, 0];
        for r in 0..8 {
            let corners = [r, r + 1].map(|r| Corners::of(&surface, surface.dem().held().expect("held"), r));
            let [north, south] = [r, r + 1].map(|r| surface.corners(r));
            let exists: Vec<_> = surface.dem().held().expect("held").patches(r).collect();
            for c in 0..22 {
                let of = of_cells(&corners[0], &corners[1], c, surface.dem().cell());
                for half in (0..2).filter(|half| exists[c][*half]) {
                    let patch = Patch::of_cell([north[c], south[c], south[c + 1], north[c + 1]], half);
                    let heights = patch.control().map(|p| p.z);
                    let [low, high] = [heights.iter().copied().reduce(least), heights.iter().copied().reduce(most)];
                    let bulge = patch.bulge();
                    let found = of[half].in_lane(0);
                    let (low, high) = (low.expect("ten"), high.expect("ten"));
                    let [least_slopes, most_slopes] = slopes_of(&patch, half);
                    let [[a, b], [c, d]] = [found.least_slopes, found.most_slopes];
                    let [[e, f], [g, h]] = [least_slopes, most_slopes];
                    let expected = [low, high, bulge.limit, bulge.flat, e, f, g, h];
                    let found = [found.low, found.high, found.limit, found.flat, a, b, c, d];
                    for (found, expected) in found.into_iter().zip(expected) {
                        // Control points are rounded at millions of metres, 1e-9 m.
                        assert!(
                            (found - expected).abs() < 1e-8 * expected.abs().max(1.0),
                            "{c}, {r}, {half}: {found}, not {expected}"
                        );
                    }
                    patches[half] += 1;
                }
            }
            let mut all = vec![Bounds::NONE; 22];
            take_row(&mut all, corners.each_ref(), surface.dem().cell(), Some(&exists));
            for (c, bounds) in all.iter().enumerate() {
                let of = of_cells(&corners[0], &corners[1], c, surface.dem().cell());
                let of = (0..2).filter(|half| exists[c][*half]).map(|half| of[half].in_lane(0));
                assert_eq!(*bounds, of.fold(Bounds::NONE, Bounds::with), "{c}, {r}");
            }
        }
        assert!(patches.iter().all(|n| *n > 100), "{patches:?}");
    }
}
