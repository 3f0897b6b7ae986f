//! Traces ink to chains: ordered polylines of inked pixels.
//!
//! Method: the ink is thinned to lines one pixel wide, whose branches are joined through junctions and over gaps of one
//! pixel; a chain is cut again where its depth jumps (a far line running into a near one) and where silhouette turns
//! into border. Chains that meet share the point of the junction. Every ink pixel lies within 1.5 px of a pixel of a
//! chain. The order is that of the pixels, top to bottom: the same ink gives the same chains.
//!
//! Cost: 40 000 ink pixels take some 20 ms on one core. Does not handle: two lines less than 2 px apart (one chain).

use std::collections::HashSet;

use glam::DVec2;

use super::graph::Graph;
use super::join::partners;
use super::thin::thin;
use super::{Chain, ChainPoint, Kind, Line, Mark, Marks, Pixel};
use crate::view::Perspective;

/// A chain is cut where ln depth jumps by more than this between the points before and after: 1.5 times the distance.
const DEPTH_JUMP: f64 = 0.405;
/// Points before and after a cut that must all lie on their side of the jump: an odd pixel cuts nothing.
const WINDOW: usize = 4;

/// The chains of a page's ink, seen in perspective. Those of silhouettes are [`Line::Skyline`] where most of their pixels
/// lie beside the sky, else [`Line::Occluding`]; they are not cut where one turns into the other.
pub fn trace(marks: &Marks, perspective: &Perspective) -> Vec<Chain> {
    let (lines, cells) = thin(marks);
    let graph = Graph::new(&lines, &cells);
    let mark = |cell: usize| {
        let [column, row] = lines.pixel(cell);
        marks.at(column, row)
    };
    let point = |&cell: &usize| {
        let centre = DVec2::from(lines.pixel(cell).map(|v| v as f64 + 0.5));
        let pixel = mark(cell).map(|mark| mark.pixel);
        // A filled hole has no line of its own.
        let offset = pixel.filter(|pixel| pixel.is_ink()).map_or(DVec2::ZERO, Pixel::place);
        ChainPoint::seen(centre + offset, Line::Occluding, pixel.map_or(0.0, Pixel::depth), perspective)
    };
    let points: Vec<Vec<ChainPoint>> = graph.branches.iter().map(|branch| branch.iter().map(point).collect()).collect();
    let partners = partners(&graph.branches, &points);
    let mut chains = Vec::new();
    let mut add = |cells: &[usize], closed: bool| {
        let points: Vec<ChainPoint> = cells.iter().map(point).collect();
        let drawn: Vec<Line> = cells.iter().map(|&cell| mark(cell).map_or(Line::Occluding, line_of)).collect();
        cut(points, &drawn, closed, &mut chains);
    };
    for (cells, closed) in walks(&graph.branches, &partners) {
        add(&cells, closed);
    }
    graph.rings.iter().for_each(|ring| add(ring, true));
    chains
}

/// What a pixel draws by itself.
fn line_of(mark: &Mark) -> Line {
    match mark.pixel.kind() {
        Kind::Border => Line::Border,
        _ if mark.beside_sky => Line::Skyline,
        _ => Line::Occluding,
    }
}

/// Branches joined to walks as their ends go on into each other, each with whether it is closed.
fn walks(branches: &[Vec<usize>], partners: &[Option<usize>]) -> Vec<(Vec<usize>, bool)> {
    let ends = branches.iter().flat_map(|b| [b[0], b[b.len() - 1]]);
    let run_through: HashSet<usize> = ends.zip(partners).filter(|(_, p)| p.is_some()).map(|(cell, _)| cell).collect();
    // Lines side by side may touch by a corner: such a rung between two that run through is no line.
    let is_rung = |b: usize| {
        let alone = partners[2 * b].is_none() && partners[2 * b + 1].is_none();
        alone && branches[b].len() == 2 && branches[b].iter().all(|cell| run_through.contains(cell))
    };
    let mut done: Vec<bool> = (0..branches.len()).map(is_rung).collect();
    let mut walks = Vec::new();
    // Open walks begin at ends without a partner; what is left then is closed.
    for closed in [false, true] {
        for start in 0..partners.len() {
            if done[start / 2] || (!closed && partners[start].is_some()) {
                continue;
            }
            let mut cells: Vec<usize> = Vec::new();
            let mut next = Some(start);
            while let Some(end) = next.filter(|end| !done[end / 2]) {
                done[end / 2] = true;
                match end % 2 {
                    0 => cells.extend(&branches[end / 2]),
                    _ => cells.extend(branches[end / 2].iter().rev()),
                }
                next = partners[end ^ 1];
            }
            cells.dedup();
            if closed && cells.len() > 1 && cells.first() == cells.last() {
                cells.pop();
            }
            walks.push((cells, closed));
        }
    }
    walks
}

/// Cuts a run of points where its depth jumps or its kind changes; the pieces share the points of the cuts.
fn cut(mut points: Vec<ChainPoint>, drawn: &[Line], closed: bool, chains: &mut Vec<Chain>) {
    let n = points.len();
    let window = |i: usize| &drawn[i.saturating_sub(WINDOW)..(i + WINDOW + 1).min(n)];
    let is_border: Vec<bool> = (0..n).map(|i| is_mostly(window(i), Line::Border)).collect();
    let logs: Vec<f64> = points.iter().map(ChainPoint::log_depth).collect();
    let range = |part: &[f64]| part.iter().fold((f64::MAX, f64::MIN), |(low, high), &v| (v.min(low), v.max(high)));
    // The gap between all points before and all after.
    let jump = |i: usize| {
        if i < WINDOW || i + WINDOW >= n {
            return 0.0;
        }
        let (before, after) = (range(&logs[i - WINDOW..i]), range(&logs[i + 1..=i + WINDOW]));
        (before.0 - after.1).max(after.0 - before.1)
    };
    let jumps: Vec<f64> = (0..n).map(jump).collect();
    let is_cut = |i: usize| {
        let around = &jumps[i.saturating_sub(WINDOW)..(i + WINDOW + 1).min(n)];
        let first_peak = || around.iter().all(|&j| j <= jumps[i]) && !around[..WINDOW].contains(&jumps[i]);
        is_border[i] != is_border[i - 1] || (jumps[i] > DEPTH_JUMP && first_peak())
    };
    let mut cuts: Vec<usize> = (1..n.saturating_sub(1)).filter(|&i| is_cut(i)).collect();
    let line = |start: usize, end: usize| match &drawn[start..end.min(n)] {
        _ if is_border[start] => Line::Border,
        drawn if is_mostly(drawn, Line::Skyline) => Line::Skyline,
        _ => Line::Occluding,
    };
    if cuts.is_empty() {
        chains.push(chain(&points, line(0, n), closed && n > 2));
        return;
    }
    if closed {
        points.push(points[0]);
    }
    cuts.push(points.len() - 1);
    let mut start = 0;
    for end in cuts {
        chains.push(chain(&points[start..=end], line(start, end + 1), false));
        start = end;
    }
}

/// The chain of these points that draws a line.
fn chain(points: &[ChainPoint], line: Line, closed: bool) -> Chain {
    Chain { id: None, points: points.iter().map(|point| ChainPoint { line, ..*point }).collect(), closed }
}

/// Whether more than half of the pixels draw this line.
fn is_mostly(drawn: &[Line], line: Line) -> bool {
    2 * drawn.iter().filter(|&&pixel| pixel == line).count() > drawn.len()
}
