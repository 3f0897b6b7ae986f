//! Lines on the land on their way over a page: points about a pixel apart, which the device lays on the facets that are drawn, and
//! the curves that come back.
//!
//! Between the points of a line it runs as a Catmull-Rom spline on the map, so that near land shows no corners. Lattice places are
//! rounded to odd numbers of their units: no facet's edge passes there. Cost: a look-up for each pixel of line. Does not handle:
//! lines over voids, which end there.

use glam::{DVec2, DVec3, FloatExt, Vec3};
use rayon::prelude::*;

use super::Line;
use super::curve::{Bound, Curve, CurvePoint, LatticePlace, Sight, Stretch};
use super::identity::CELL;
use super::way::LandWay;
use crate::error::{Error, Message, Result, Setting};
use crate::gpu::uniforms::{Segment, code, seen};
use crate::message;
use crate::relief::LineKind;
use crate::view::Perspective;
use crate::view::cut::share_within;

/// Longest way between two points on the page, px; of a hachure, many of which say one thing.
const STEP: f64 = 1.0;
const HACHURE_STEP: f64 = 2.5;
/// Beyond the page lines are followed for so many px.
const BEYOND: f64 = 4.0;
/// Most points that the device numbers.
const MOST: usize = 1 << 24;

/// Lines on the land as a page shows them, in points.
#[derive(Debug, Clone, Default)]
pub(crate) struct Laid {
    /// Where the points lie on the lattice.
    pub places: Vec<LatticePlace>,
    /// As [`Hatched::bare`](super::hachures::Hatched::bare).
    pub bare: Option<f64>,
    runs: Vec<PointRun>,
}

/// Points one after the other.
#[derive(Debug, Clone)]
struct PointRun {
    line: Line,
    places: Vec<LatticePlace>,
    /// Of each its weight, and the share of black about it.
    inks: Vec<[f32; 2]>,
    closed: bool,
}

impl Laid {
    /// What a page shows of lines.
    ///
    /// # Errors
    /// [`Error::Limit`] where they are longer than a device numbers their points.
    pub(crate) fn new(ways: &[LandWay], perspective: &Perspective) -> Result<Self> {
        let runs: Vec<PointRun> = ways.par_iter().flat_map_iter(|way| runs(way, perspective)).collect();
        let places: Vec<LatticePlace> = runs.iter().flat_map(|run| run.places.iter().copied()).collect();
        check_length(places.len(), message!["use a smaller ", Setting::Size])?;
        Ok(Self { places, bare: None, runs })
    }

    /// The curves of these lines, by the points that the device found on the page; the others of `segments` play no part.
    pub(crate) fn curves(&self, segments: &[Segment], perspective: &Perspective) -> Vec<Curve> {
        let mut found: Vec<Option<&Segment>> = vec![None; self.places.len()];
        for segment in segments.iter().filter(|segment| is_laid(segment)) {
            found[(segment.code >> code::PART_SHIFT) as usize] = Some(segment);
        }
        let mut first = 0;
        let of_runs = self.runs.iter().map(|run| {
            first += run.places.len();
            (run, &found[first - run.places.len()..first])
        });
        let of_runs: Vec<_> = of_runs.collect();
        of_runs.into_par_iter().flat_map_iter(|(run, found)| curves(run, found, perspective)).collect()
    }
}

/// Fails where lines of the land are longer on a page than can be drawn, px; `less`: what makes them shorter.
pub(super) fn check_length(px: usize, less: Message) -> Result<()> {
    if px <= MOST {
        return Ok(());
    }
    let what = format!("lines of the land are {px} px long on the page, {MOST} can be laid");
    Err(Error::limit(
        what,
        message![less, ", or fewer ", Setting::Creases, ", ", Setting::Hachures, " or ", Setting::Lines],
    ))
}

/// Whether a segment is a point of a line on the land.
pub(crate) fn is_laid(segment: &Segment) -> bool {
    segment.code & code::CORNER == code::LAID
}

/// What a line of the land draws.
pub(super) fn line_of(kind: LineKind) -> Line {
    match kind {
        LineKind::Shore => Line::Shore,
        LineKind::Drainage => Line::Drainage,
        LineKind::Ridge => Line::Ridge,
        LineKind::Own(layer) => Line::Own(layer),
    }
}

/// The parts of a line that a page shows.
fn runs(way: &LandWay, perspective: &Perspective) -> Vec<PointRun> {
    let new = || PointRun { line: way.line, places: Vec::new(), inks: Vec::new(), closed: false };
    let (mut runs, mut run) = (Vec::new(), new());
    let mut finish = |run: &mut PointRun| {
        let whole = std::mem::replace(run, new());
        runs.extend((whole.places.len() > 1).then_some(whole));
    };
    let longest = if way.line == Line::Hachure { HACHURE_STEP } else { STEP };
    let n = way.points.len();
    let stretches = if way.closed { n } else { n.saturating_sub(1) };
    let bounds = [DVec2::splat(-BEYOND), perspective.size() + BEYOND];
    for i in 0..stretches {
        let [start, end] = [i, (i + 1) % n].map(|end| way.points[end]);
        let is_shown = start.weight > 0.0 || end.weight > 0.0;
        let ahead = ahead([start.world, end.world], perspective).filter(|_| is_shown);
        let on_page = ahead.and_then(|ahead| {
            let [a, b] = ahead.map(|share| perspective.project(start.world.lerp(end.world, share)));
            Some((ahead, a, b, share_within(bounds, a.0, b.0)?))
        });
        let Some(([from, to], a, b, [enter, leave])) = on_page else {
            finish(&mut run);
            continue;
        };
        if enter > 0.0 || from > 0.0 {
            finish(&mut run);
        }
        let steps = (a.0.distance(b.0) * (leave - enter) / longest).ceil().max(1.0);
        for k in 0..=steps as usize {
            let share = enter + (leave - enter) * k as f64 / steps;
            // Depth is linear on the page; the way on the map is not.
            let share = from + (to - from) * share * b.1 / (a.1 + (b.1 - a.1) * share);
            let place = on_lattice(between(way, i, share));
            if run.places.last() != Some(&place) {
                run.places.push(place);
                let share = share as f32;
                run.inks.push([start.weight.lerp(end.weight, share), start.black.lerp(end.black, share)]);
            }
        }
        if leave < 1.0 || to < 1.0 {
            finish(&mut run);
        }
    }
    if way.closed && runs_whole(&run, way) {
        run.closed = true;
        run.places.pop();
        run.inks.pop();
    }
    finish(&mut run);
    runs
}

/// The part of the way between two places of the world that lies beyond the near plane, as shares of it.
fn ahead([a, b]: [DVec3; 2], perspective: &Perspective) -> Option<[f64; 2]> {
    let near = perspective.near();
    let [from, to] = [a, b].map(|end| perspective.distance(end));
    let crossing = (near - from) / (to - from);
    match (from >= near, to >= near) {
        (true, true) => Some([0.0, 1.0]),
        (true, false) => Some([0.0, crossing]),
        (false, true) => Some([crossing, 1.0]),
        (false, false) => None,
    }
}

/// Whether a run goes all round a closed line.
fn runs_whole(run: &PointRun, way: &LandWay) -> bool {
    let ends = [run.places.first(), run.places.last()];
    way.points.len() > 2 && run.places.len() > 3 && ends.iter().all(|end| *end == Some(&on_lattice(way.points[0].at)))
}

/// The place at a share of the way from point `i` of a line to the next (Catmull, Rom 1974).
fn between(way: &LandWay, i: usize, t: f64) -> DVec2 {
    let n = way.points.len();
    let at = |k: usize| way.points[k % n].at;
    let (b, c) = (at(i), at(i + 1));
    let a = match (i, way.closed) {
        (0, false) => b * 2.0 - c,
        _ => at(i + n - 1),
    };
    let d = if i + 2 < n || way.closed { at(i + 2) } else { c * 2.0 - b };
    let (t2, t3) = (t * t, t * t * t);
    (b * 2.0 + (c - a) * t + (a * 2.0 - b * 5.0 + c * 4.0 - d) * t2 + (b * 3.0 - a - c * 3.0 + d) * t3) / 2.0
}

/// Of column and row, the nearest place on the lattice that lies on no edge of a facet.
pub(super) fn on_lattice(at: DVec2) -> LatticePlace {
    let [x, y] = (at * f64::from(CELL)).to_array().map(|v| v.round() as i32);
    [x | 1, y & !3 | 2]
}

/// The curves of a run: as many as the gaps between the points that were found leave.
fn curves(run: &PointRun, found: &[Option<&Segment>], perspective: &Perspective) -> Vec<Curve> {
    let numbers: Vec<usize> = (0..found.len()).collect();
    let parts = numbers.chunk_by(|a, b| found[*a].is_some() == found[*b].is_some());
    let parts: Vec<&[usize]> = parts.filter(|part| found[part[0]].is_some() && part.len() > 1).collect();
    let whole = |part: &[usize]| run.closed && part.len() == found.len();
    let curve = |part: &[usize]| {
        let there: Vec<(&Segment, [f32; 2])> = part.iter().filter_map(|i| Some((found[*i]?, run.inks[*i]))).collect();
        curve(&there, run.line, whole(part), perspective)
    };
    parts.into_iter().map(curve).collect()
}

/// The curve through points one after the other.
fn curve(there: &[(&Segment, [f32; 2])], line: Line, closed: bool, perspective: &Perspective) -> Curve {
    let point = |&(segment, [weight, black]): &(&Segment, [f32; 2])| {
        let world = perspective.eye() + Vec3::from(segment.start).as_dvec3();
        let (place, depth) = perspective.project(world);
        CurvePoint { place, depth, world, at: segment.at, weight, black }
    };
    let points: Vec<CurvePoint> = there.iter().map(point).collect();
    let count = if closed { points.len() } else { points.len() - 1 };
    let stretch = |i: usize| {
        let next = (i + 1) % points.len();
        let way = points[next].place - points[i].place;
        Stretch {
            bound: Bound::Nothing(line),
            sight: sight(there[i].0.sight, there[next].0.sight),
            // Nothing but the slope that it lies on.
            behind: points[i].depth as f32,
            fall: 1.0,
            outward: DVec2::new(-way.y, way.x).normalize_or_zero(),
        }
    };
    Curve { stretches: (0..count).map(stretch).collect(), points, closed }
}

/// What is known of a stretch by its ends.
fn sight(start: u32, end: u32) -> Sight {
    match (start, end) {
        (seen::FREE, seen::FREE) => Sight::Free,
        (seen::HIDDEN, seen::HIDDEN) => Sight::Hidden,
        _ => Sight::Doubt { free: matches!(start, seen::FREE | seen::NEAREST_FREE) },
    }
}
