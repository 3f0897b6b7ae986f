//! Smooths and simplifies chains within a tolerance.
//!
//! Method: the stiffest curve that stays within the tolerance of every point. Places are smoothed by Whittaker's
//! graduation (1923: least squares against squared second differences, which does not shrink arcs as averaging does);
//! where the result strays too far, the weight of those points is raised and it is solved again. Then points are left out
//! (Douglas and Peucker 1973), in place and ln depth at once. Pixel stairs come out straight, corners are rounded by the
//! tolerance at most. Ends on another chain follow that chain; free ends move within the tolerance.
//!
//! Cost: at most 16 pentadiagonal solves, 40 000 points in some 20 ms. Does not handle: closed chains that cross
//! themselves after smoothing.

use std::collections::{HashMap, HashSet};

use glam::{DVec2, DVec3};

use super::simplify::needed;
use super::{Chain, ChainPoint};
use crate::view::Perspective;

/// Weight of second differences: waves shorter than 2 pi (STIFFNESS)^(1/4) points, about 60, are flattened.
const STIFFNESS: f64 = 8.0e3;
/// Solves before what still strays is put back onto the tolerance's circle.
const ROUNDS: usize = 16;
/// Share of the tolerance spent on leaving points out: with the default of 0.6 px a sag of 0.03 px, which no pen shows.
const SIMPLIFY_SHARE: f64 = 0.05;
/// Below this the weights that hold a point in place lose their digits, px.
const LEAST_TOLERANCE: f64 = 1.0e-3;
/// Weight of a point that must not move.
const PINNED: f64 = 1.0e9;
/// Points over which an end that follows another chain takes its own chain along.
const FOLLOW: usize = 8;
/// Points by which a closed chain is unrolled at both ends: beyond the reach of the stiffness.
const UNROLL: usize = 96;

/// The chains smoothed, in the same order: every point given stays within `tolerance` px (at least 0.001) of its chain.
/// Places in the world follow those on the page.
pub fn smooth(chains: &[Chain], perspective: &Perspective, tolerance: f64) -> Vec<Chain> {
    let tolerance = tolerance.max(LEAST_TOLERANCE);
    let radius = tolerance * (1.0 - SIMPLIFY_SHARE);
    let shared = shared_places(chains);
    let mut places: Vec<Vec<DVec2>> = chains.iter().map(|c| smooth_places(c, radius, &shared)).collect();
    let mut moved = HashMap::new();
    for (chain, places) in chains.iter().zip(&places) {
        for (i, (point, &place)) in chain.points.iter().zip(places).enumerate() {
            if (chain.closed || !is_end(i, places.len())) && shared.contains(&key(point.place)) {
                moved.entry(key(point.place)).or_insert(place);
            }
        }
    }
    for (chain, places) in chains.iter().zip(&mut places).filter(|(chain, _)| !chain.closed) {
        follow(chain, places, radius, &moved);
    }
    let seen = |point: DVec3, line| ChainPoint::seen(point.truncate(), line, point.z.exp() as f32, perspective);
    let simplify = |(chain, places): (&Chain, &Vec<DVec2>)| {
        let line = chain.line();
        let simplified = simplified(chain, places, tolerance * SIMPLIFY_SHARE).into_iter();
        let points = simplified.map(|point| seen(point, line)).collect();
        Chain { points, ..*chain }
    };
    chains.iter().zip(&places).map(simplify).collect()
}

/// A place as something to look up: points of a junction are equal to the last bit.
fn key(place: DVec2) -> (u64, u64) {
    (place.x.to_bits(), place.y.to_bits())
}

/// Whether this is the first or last of `n` points.
fn is_end(i: usize, n: usize) -> bool {
    i == 0 || i + 1 == n
}

/// Places of chain ends at which another chain's point lies.
fn shared_places(chains: &[Chain]) -> HashSet<(u64, u64)> {
    let open = chains.iter().filter(|c| !c.closed && c.points.len() > 1);
    let ends: HashSet<_> =
        open.flat_map(|c| [key(c.points[0].place), key(c.points[c.points.len() - 1].place)]).collect();
    let mut seen = HashSet::new();
    chains
        .iter()
        .flat_map(|c| &c.points)
        .map(|p| key(p.place))
        .filter(|k| ends.contains(k) && !seen.insert(*k))
        .collect()
}

/// The places of one chain, as many as it has points, each within `radius` of its own.
fn smooth_places(chain: &Chain, radius: f64, shared: &HashSet<(u64, u64)>) -> Vec<DVec2> {
    let given: Vec<DVec2> = chain.points.iter().map(|p| p.place).collect();
    let n = given.len();
    let pinned = |i: usize| !chain.closed && is_end(i, n) && shared.contains(&key(given[i]));
    let mut weights: Vec<f64> = (0..n).map(|i| if pinned(i) { PINNED } else { 1.0 }).collect();
    let mut places = given.clone();
    for _ in 0..ROUNDS {
        let unroll = |values: &dyn Fn(usize) -> f64| solve_chain(chain.closed, n, &weights, values);
        let (x, y) = (unroll(&|i| given[i].x), unroll(&|i| given[i].y));
        let mut strays = false;
        for i in 0..n {
            places[i] = DVec2::new(x[i], y[i]);
            let off = places[i].distance(given[i]) / radius;
            if off > 1.0 {
                strays = true;
                weights[i] = (weights[i] * 2.0 * off * off).min(PINNED);
            }
        }
        if !strays {
            break;
        }
    }
    places.iter().zip(&given).map(|(&p, &o)| o + (p - o).clamp_length_max(radius)).collect()
}

/// Smooths `n` values, round the seam if the chain is closed.
fn solve_chain(closed: bool, n: usize, weights: &[f64], value: &dyn Fn(usize) -> f64) -> Vec<f64> {
    let margin = if closed { UNROLL } else { 0 };
    // Index 0 of the unrolled chain is `margin` points before the first.
    let index = |i: usize| (i + n * margin - margin) % n;
    let w: Vec<f64> = (0..n + 2 * margin).map(|i| weights[index(i)]).collect();
    let v: Vec<f64> = (0..n + 2 * margin).map(|i| value(index(i))).collect();
    whittaker(&w, &v)[margin..margin + n].to_vec()
}

/// Minimises the weighted squared distances to `values` plus [`STIFFNESS`] times the squared second differences.
fn whittaker(weights: &[f64], values: &[f64]) -> Vec<f64> {
    let n = values.len();
    if n < 3 {
        return values.to_vec();
    }
    // L D L' of the pentadiagonal matrix W + s D2' D2, the sub-diagonals `l1`, `l2` of L as they come.
    let (mut d, mut l1, mut l2, mut z) = (vec![0.0; n], vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    for i in 0..n {
        // Row i of D2' D2: 1 -4 6 -4 1 inside, less at the ends.
        let differences = |k: usize| k + 2 < n;
        let count = |k: Option<usize>, c: f64| if k.is_some_and(differences) { c } else { 0.0 };
        let (a, b) = (i.checked_sub(1), i.checked_sub(2));
        let diagonal = weights[i] + STIFFNESS * (count(Some(i), 1.0) + count(a, 4.0) + count(b, 1.0));
        let first = STIFFNESS * (count(a, -2.0) + count(b, -2.0));
        let second = STIFFNESS * count(b, 1.0);
        let (mut from1, mut from2) = (0.0, 0.0);
        d[i] = diagonal;
        if let Some(b) = b {
            l2[i] = second / d[b];
            from2 = l2[i] * l2[i] * d[b];
        }
        if let Some(a) = a {
            let cross = b.map_or(0.0, |b| l2[i] * d[b] * l1[a]);
            l1[i] = (first - cross) / d[a];
            from1 = l1[i] * l1[i] * d[a];
        }
        d[i] -= from1 + from2;
        z[i] = weights[i] * values[i] - a.map_or(0.0, |a| l1[i] * z[a]) - b.map_or(0.0, |b| l2[i] * z[b]);
    }
    for i in (0..n).rev() {
        z[i] /= d[i];
        if i + 1 < n {
            z[i] -= l1[i + 1] * z[i + 1];
        }
        if i + 2 < n {
            z[i] -= l2[i + 2] * z[i + 2];
        }
    }
    z
}

/// Moves ends to where the chain they lie on went, and some points before them along.
fn follow(chain: &Chain, places: &mut [DVec2], radius: f64, moved: &HashMap<(u64, u64), DVec2>) {
    let n = places.len();
    for last in [false, true] {
        let at = |i: usize| if last { n - 1 - i } else { i };
        let Some(&target) = moved.get(&key(chain.points[at(0)].place)) else { continue };
        let shift = target - places[at(0)];
        let reach = FOLLOW.min(n - 1);
        for i in 0..reach {
            let given = chain.points[at(i)].place;
            let place = places[at(i)] + shift * (1.0 - i as f64 / reach as f64);
            places[at(i)] = given + (place - given).clamp_length_max(radius);
        }
    }
}

/// Places and ln depths of the chain through these places, with the points left out that lie within `tolerance` px of the
/// rest.
fn simplified(chain: &Chain, places: &[DVec2], tolerance: f64) -> Vec<DVec3> {
    let n = places.len();
    let logs: Vec<f64> = chain.points.iter().map(ChainPoint::log_depth).collect();
    let logs = solve_chain(chain.closed, n, &vec![1.0; n], &|i| logs[i]);
    // A hundredth in ln depth weighs as much as a hundredth of a pixel: widths stay as true as places.
    let mut points: Vec<DVec3> = places.iter().zip(logs).map(|(p, log)| p.extend(log)).collect();
    if chain.closed {
        points.push(points[0]);
    }
    let mut kept = needed(&points, tolerance);
    if chain.closed {
        kept.pop();
    }
    kept.into_iter().map(|i| points[i]).collect()
}
