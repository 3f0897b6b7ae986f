//! Which branch goes on into which: through junctions, and across gaps of a pixel or two.
//!
//! A branch has two ends, 2 b and 2 b + 1. At a junction the two ends that fit best in direction and depth go on into
//! each other, then the next two: where a far line stops at a near one, the near line runs through. Free ends that point
//! at each other over at most [`GAP`] px at one depth are bridged: a mask drops such pixels where a slope is thinner than
//! a pixel. Lines side by side point past each other and stay apart.

use std::collections::{BTreeMap, HashMap};

use glam::DVec2;

use super::chain::ChainPoint;

/// Longest bridge between the places of two free ends, px: one missing pixel on a diagonal.
const GAP: f64 = 3.0;
/// Largest angle between a line's own direction and the bridge, degrees.
const BRIDGE_BEND: f64 = 40.0;
/// Largest difference of ln depth over a bridge: 1.2 times the distance.
const BRIDGE_DEPTH: f64 = 0.18;
/// What a factor e in depth weighs at a junction, in radians of turning: a far line twice as far costs 80 degrees.
const DEPTH_WEIGHT: f64 = 2.0;
/// Worst fit that still goes on through a junction of three or more, radians.
const WORST_FIT: f64 = 1.4;
/// An end's direction and depth are those of its last points, this many.
const REACH: usize = 6;

/// The end of a branch: where it is, where it points, how deep it is.
struct End {
    place: DVec2,
    /// Outwards; `None` for a branch of one point.
    direction: Option<DVec2>,
    /// Mean ln depth.
    depth: f64,
}

/// For each branch end the end it goes on into. `branches` as walks over cells, `points` the same as points.
pub(super) fn partners(branches: &[Vec<usize>], points: &[Vec<ChainPoint>]) -> Vec<Option<usize>> {
    let ends: Vec<End> = (0..2 * branches.len()).map(|e| end(&points[e / 2], e % 2 == 1)).collect();
    let mut partners = vec![None; ends.len()];
    let mut nodes: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let mut free = Vec::new();
    for (b, branch) in branches.iter().enumerate() {
        match branch[..] {
            [_] => free.extend([2 * b, 2 * b + 1]),
            [first, .., last] => {
                nodes.entry(first).or_default().push(2 * b);
                nodes.entry(last).or_default().push(2 * b + 1);
            }
            [] => {}
        }
    }
    for node in nodes.values() {
        match node[..] {
            [alone] => free.push(alone),
            [a, b] => (partners[a], partners[b]) = (Some(b), Some(a)),
            _ => pair_junction(node, &ends, &mut partners),
        }
    }
    bridge_gaps(&free, &ends, &mut partners);
    partners
}

/// The end of a branch at its first or last point.
fn end(points: &[ChainPoint], last: bool) -> End {
    let from_end = |i: usize| &points[if last { points.len() - 1 - i } else { i }];
    let reach = REACH.min(points.len() - 1);
    let place = from_end(0).place;
    // The node's own depth is the nearest line's, whatever this branch's.
    let near_node = reach.min(1);
    let depth = (near_node..=reach).map(|i| from_end(i).log_depth()).sum::<f64>() / (reach - near_node + 1) as f64;
    End { place, direction: (place - from_end(reach).place).try_normalize(), depth }
}

/// Pairs the ends at one junction, best fit first.
fn pair_junction(node: &[usize], ends: &[End], partners: &mut [Option<usize>]) {
    let mut fits = Vec::new();
    for (i, &a) in node.iter().enumerate() {
        for &b in &node[i + 1..] {
            let turn = match (ends[a].direction, ends[b].direction) {
                (Some(u), Some(v)) => u.angle_to(-v).abs(),
                _ => 0.0,
            };
            fits.push((turn + DEPTH_WEIGHT * (ends[a].depth - ends[b].depth).abs(), a, b));
        }
    }
    fits.sort_by(|l, r| l.0.total_cmp(&r.0));
    for (fit, a, b) in fits {
        if fit < WORST_FIT && partners[a].is_none() && partners[b].is_none() {
            (partners[a], partners[b]) = (Some(b), Some(a));
        }
    }
}

/// Pairs free ends that point at each other, shortest gap first.
fn bridge_gaps(free: &[usize], ends: &[End], partners: &mut [Option<usize>]) {
    let tile = |place: DVec2| ((place.x / GAP).floor() as i64, (place.y / GAP).floor() as i64);
    let mut tiles: HashMap<(i64, i64), Vec<usize>> = HashMap::new();
    for &e in free {
        tiles.entry(tile(ends[e].place)).or_default().push(e);
    }
    let mut gaps = Vec::new();
    for &a in free {
        let (x, y) = tile(ends[a].place);
        for near in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy))) {
            for &b in tiles.get(&near).into_iter().flatten().filter(|&&b| a < b && a / 2 != b / 2) {
                let gap = ends[a].place.distance(ends[b].place);
                if gap <= GAP && (ends[a].depth - ends[b].depth).abs() <= BRIDGE_DEPTH {
                    gaps.push((gap, a, b));
                }
            }
        }
    }
    gaps.sort_by(|l, r| l.0.total_cmp(&r.0).then((l.1, l.2).cmp(&(r.1, r.2))));
    for (_, a, b) in gaps {
        let over = ends[b].place - ends[a].place;
        let taken = partners[a].is_some() || partners[b].is_some();
        if !taken && points_along(a, over, ends, partners) && points_along(b, -over, ends, partners) {
            (partners[a], partners[b]) = (Some(b), Some(a));
        }
    }
}

/// Whether the line that ends here goes on along `over` without a bend.
fn points_along(e: usize, over: DVec2, ends: &[End], partners: &[Option<usize>]) -> bool {
    // A lone point has the direction of the line that already reached it, and any before that.
    let direction = ends[e].direction.or_else(|| partners[e ^ 1].map(|p| ends[e].place - ends[p].place));
    direction.is_none_or(|d| d.angle_to(over).abs() <= BRIDGE_BEND.to_radians())
}
