//! Links segments to curves: by integers alone, across chunks and levels.
//!
//! Where a segment starts or ends on a lattice edge, that edge is its key, two lattice vertices; at a vertex of the rim it is the
//! vertex, between two parts of one facet's line facet and part. The toward surface lies on the left of every segment, so
//! that at most one starts and one ends at a key, but where two parts of a rim touch in a vertex: there curves end. Cost: a
//! hash for each segment, and a sort.

use glam::{DVec2, Vec3};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::curve::{Bound, Curve, CurvePoint, Sight, Stretch};
use super::laid::is_laid;
use crate::gpu::uniforms::{Segment, code, seen};
use crate::surface::Lattice;
use crate::surface::lattice::LatticePoint;
use crate::view::Perspective;

/// Where a segment starts or ends.
type Key = u128;
/// Bit of keys between two parts of a line.
const BETWEEN_PARTS: u32 = 127;
/// Bits of one number of a lattice vertex: 131 000 samples of 64 steps.
const BITS: u32 = 23;

/// The curves that segments on the facets of a lattice make up. In the order of their first segments' facets, whatever the
/// order of the segments; one given twice counts once, points of lines on the land play no part.
pub fn link(mut segments: Vec<Segment>, lattice: &Lattice, perspective: &Perspective) -> Vec<Curve> {
    segments.retain(|segment| !is_laid(segment));
    let name = |segment: &Segment| (segment.facet, segment.code);
    segments.par_sort_unstable_by_key(name);
    segments.dedup_by_key(|segment| name(segment));
    let ends: Vec<[Key; 2]> = segments.par_iter().map(|segment| keys(segment, lattice)).collect();
    let mut starting: FxHashMap<Key, usize> = FxHashMap::default();
    starting.reserve(segments.len());
    for (i, [start, _]) in ends.iter().enumerate() {
        starting.entry(*start).or_insert(i);
    }
    let next: Vec<Option<usize>> = ends.iter().map(|[_, end]| starting.get(end).copied()).collect();
    let mut follows = vec![false; segments.len()];
    next.iter().flatten().for_each(|&i| follows[i] = true);
    let mut done = vec![false; segments.len()];
    let mut curves = Vec::new();
    // Open curves begin at segments that follow none; what is left then is closed.
    for closed in [false, true] {
        for first in 0..segments.len() {
            if done[first] || follows[first] != closed {
                continue;
            }
            let mut run = Vec::new();
            let mut last = Some(first);
            while let Some(i) = last.filter(|&i| !std::mem::replace(&mut done[i], true)) {
                run.push(i);
                last = next[i];
            }
            curves.push((run, closed));
        }
    }
    let curve = |(run, closed): &(Vec<usize>, bool)| {
        let of_run: Vec<&Segment> = run.iter().map(|&i| &segments[i]).collect();
        curve(&of_run, *closed, perspective)
    };
    curves.par_iter().filter_map(curve).collect()
}

/// The keys of a segment's start and end.
fn keys(segment: &Segment, lattice: &Lattice) -> [Key; 2] {
    let code = segment.code;
    let facet = lattice.facet(segment.facet);
    let corner = |k: u32| facet[((code & code::CORNER) + k) as usize % 3];
    let part = code >> code::PART_SHIFT;
    let line = code & (code::CORNER | code::AWAY_CORNER | code::OF_RIM);
    let between =
        |part: u32| 1 << BETWEEN_PARTS | Key::from(segment.facet) << 64 | Key::from(line) << 32 | Key::from(part);
    let own = if code & code::OF_RIM != 0 {
        let at = |turns: u32, k: u32| {
            if code & turns != 0 { edge(corner(0), corner(1)) } else { edge(corner(k), corner(k)) }
        };
        [at(code::STARTS_TURNING, 0), at(code::ENDS_TURNING, 1)]
    } else {
        let edges = [edge(corner(0), corner(1)), edge(corner(0), corner(2))];
        if code & code::AWAY_CORNER != 0 { [edges[1], edges[0]] } else { edges }
    };
    [
        if code & code::STARTS != 0 { own[0] } else { between(part) },
        if code & code::ENDS != 0 { own[1] } else { between(part + 1) },
    ]
}

/// The key of a lattice edge, or of a vertex given twice.
fn edge(a: LatticePoint, b: LatticePoint) -> Key {
    let vertex = |v: LatticePoint| Key::from(v.y) << BITS | Key::from(v.x);
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    vertex(low) << (2 * BITS) | vertex(high)
}

/// The curve of segments one after the other; stretches begin where somebody looked, and where contour turns into rim.
/// `None` where nobody looked: shorter than two pixels.
fn curve(run: &[&Segment], closed: bool, perspective: &Perspective) -> Option<Curve> {
    let is_rim = |segment: &Segment| segment.code & code::OF_RIM != 0;
    let asked = |segment: &Segment| segment.sight != seen::NOT_ASKED;
    run.iter().find(|segment| asked(segment))?;
    let mut starts = vec![0];
    let mut has_asked = asked(run[0]);
    for (i, pair) in (1..).zip(run.windows(2)) {
        let turns = is_rim(pair[0]) != is_rim(pair[1]);
        if turns || (asked(pair[1]) && has_asked) {
            starts.push(i);
            has_asked = false;
        }
        has_asked |= asked(pair[1]);
    }
    let parts: Vec<&[&Segment]> =
        starts.iter().zip(starts.iter().skip(1).chain([&run.len()])).map(|(&from, &to)| &run[from..to]).collect();
    let point = |from_eye: [f32; 3], at: [i32; 2]| {
        let world = perspective.eye() + Vec3::from(from_eye).as_dvec3();
        let (place, depth) = perspective.project(world);
        CurvePoint { place, depth, world, at, weight: 1.0, black: 1.0 }
    };
    let mut points: Vec<CurvePoint> = parts.iter().map(|part| point(part[0].start, part[0].at)).collect();
    if let Some(last) = run.last().filter(|_| !closed) {
        points.push(point(last.end, last.at));
    }
    let looked: Vec<Option<&Segment>> =
        parts.iter().map(|part| part.iter().copied().find(|segment| asked(segment))).collect();
    let nearest = |i: usize| looked[..=i].iter().rev().chain(&looked[i..]).find_map(|segment| *segment);
    let stretches = parts.iter().enumerate().filter_map(|(i, part)| Some(stretch(part, nearest(i)?)));
    Some(Curve { stretches: stretches.collect(), points, closed })
}

/// The stretch of segments one after the other, of which this one was looked at.
fn stretch(part: &[&Segment], looked: &Segment) -> Stretch {
    let length = |segment: &Segment| Vec3::from(segment.start).distance(Vec3::from(segment.end)).max(f32::MIN_POSITIVE);
    let whole: f32 = part.iter().map(|segment| length(segment)).sum();
    Stretch {
        bound: if part[0].code & code::OF_RIM != 0 { Bound::Rim } else { Bound::Contour },
        sight: match looked.sight {
            seen::FREE => Sight::Free,
            seen::HIDDEN => Sight::Hidden,
            nearest => Sight::Doubt { free: nearest == seen::NEAREST_FREE },
        },
        behind: looked.behind,
        fall: part.iter().map(|segment| segment.fall * length(segment)).sum::<f32>() / whole,
        outward: DVec2::from(looked.outward.map(f64::from)),
    }
}
