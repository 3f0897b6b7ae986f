//! Which slope lines a page shows as hachures, and how strongly.
//!
//! A slope line is there where its room, the distance on the map to what lies beside it, fills on the page the spacing that the
//! tone wants: measured across the stroke, for land that is seen askance. Rooms belong to the land, so the lines of a light tone
//! are among those of a dark one, and none is chosen by what else the page holds; lines come and go by width. Short pieces are
//! left out. Long lines are cut where the page makes them longer than a hand would draw, always at the same places of the land.
//!
//! Where strokes stand far apart on the land, for it is far from the eye, lines are those of the land at a smaller scale. Between two
//! scales lines of both are there, each coming or going at a distance of its own. A map is of the land as it is.
//!
//! Cost: a look at each point of the lines that may fill the spacing. What a page surely hides is left out; whether the eye sees
//! the rest is looked at later. Does not handle: land so near that strokes would stand closer than lines do, which stays bare; how
//! far it goes is told.

mod viewer;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

pub use viewer::Viewer;

use super::Line;
use super::along::fade;
use super::way::{LandWay, WayPoint};
use crate::error::Result;
use crate::plan::{Hachures, Shade};
use crate::relief::{Need, Needed, SlopeLine, SlopePoint, Slopes};

/// Shares of the wanted spacing up to which a line is left out, and from which it is whole.
const ROOM: [f64; 2] = [0.75, 0.95];
/// Spacings that are wanted, in parts of the least that lines have, up to which there are none, and from which they are whole.
pub(crate) const NEAR: [f64; 2] = [0.4, 0.7];
/// How far along a line, in spacings, is looked for how much of it is there.
const AROUND: f64 = 0.7;
/// The share of that up to which it is left out, and from which it is whole.
const LASTS: [f64; 2] = [0.4, 0.9];
/// So far beside the page lines are looked for, px: they tell those on it how broad they are, and how close.
pub(crate) const BESIDE: f64 = 64.0;
/// A cut between two pieces of a line, spacings.
const CUT: f64 = 0.8;
/// By how much of the share that is to be black it is shorter.
const DARK: f64 = 0.95;
/// The share of it that is blank; to both sides strokes run out.
const BLANK: f64 = 0.3;
/// Lengths of a piece on the page, in lengths of a stroke, between which it is cut in two.
const LONG: [f64; 2] = [1.0, 1.6];
/// Most times that a piece is cut in two.
const MOST_CUTS: u32 = 12;
/// Least distance between strokes from which on lines of land at half the scale begin to be drawn, in the closest that these are: a
/// quarter of its cells.
const WIDER: f64 = 2.0;
/// How many times that distance is where those alone are.
const BLEND: f64 = 1.3;
/// On the way there, how much of it a line takes to come or go.
const COMES: f64 = 0.25;

/// The hachures of a page.
#[derive(Debug, Clone, Default)]
pub struct Hatched {
    /// Each point as strongly as it is shown.
    pub ways: Vec<LandWay>,
    /// How far from the eye, metres, land goes that is so near that it stays bare; none where there is none.
    pub bare: Option<f64>,
}

/// The hachures that are shown.
///
/// # Errors
/// As [`Slopes::blocks`].
pub fn hatched(slopes: &Slopes, look: &Hachures, seen: Viewer) -> Result<Hatched> {
    let azimuth = if let Viewer::By(_, azimuth, _) = seen { azimuth } else { 0.0 };
    let shade = look.shade(azimuth, slopes.exaggeration());
    let mut all = Hatched::default();
    let (mut scale, mut from) = (Some(slopes), 0.0);
    while let Some(slopes) = scale {
        // The next has lines that are close enough for what is black, at the corners of the page too.
        let closest = NEAR[1] * seen.stretch() * look.spacing / look.least_apart();
        let to = 2.0 * slopes.least_spacing() * closest.max(WIDER);
        let is_beyond =
            |corners| seen.most_px_per_metre(corners) > 0.0 && seen.metres_per_px(corners)[1] * look.spacing > to;
        scale = if slopes.has_land(is_beyond)? { slopes.wider()? } else { None };
        let to = if scale.is_some() { to } else { f64::INFINITY };
        let page = HachuredPage { seen, look, shade, slopes, scale: [from, to] };
        let blocks = slopes.blocks(&page)?;
        let of_block = |needed: &Needed| {
            let of_line = |line| page.hatched(line, needed.share);
            needed.block.lines.iter().map(of_line).fold(Hatched::default(), Hatched::and)
        };
        let of_blocks: Vec<Hatched> = blocks.par_iter().map(of_block).collect();
        all = of_blocks.into_iter().fold(all, Hatched::and);
        from = to;
    }
    Ok(all)
}

impl Hatched {
    fn and(mut self, other: Self) -> Self {
        self.ways.extend(other.ways);
        Self { ways: self.ways, bare: self.bare.into_iter().chain(other.bare).reduce(f64::max) }
    }
}

/// What hachures are drawn on.
struct HachuredPage<'a> {
    seen: Viewer<'a>,
    look: &'a Hachures,
    shade: Shade,
    slopes: &'a Slopes,
    /// Metres between strokes of the widest spacing from which on the lines come, and from which on they go.
    scale: [f64; 2],
}

/// A point on its way to the page.
#[derive(Debug, Clone, Copy)]
struct Point {
    of_way: WayPoint,
    /// On the page, px.
    place: DVec2,
    /// Px along the line on the page from its start.
    arc: f64,
    /// Metres on the map from its start.
    metres: f64,
    /// How far apart strokes should stand here, px.
    apart: f64,
    /// How much of it is there for the land not being too near.
    far_enough: f64,
}

/// A place where a line is cut.
#[derive(Debug, Clone, Copy)]
struct Cut {
    /// Of its middle, px.
    arc: f64,
    /// Half its length, px.
    half: f64,
    /// How far it is open, 0 to 1.
    open: f64,
}

impl HachuredPage<'_> {
    /// The pieces of a line that are shown, at most as strongly as `most`.
    fn hatched(&self, line: &SlopeLine, most: f64) -> Hatched {
        let worlds: Vec<DVec3> = line.points.iter().map(|point| self.slopes.world(point)).collect();
        let mut metres = 0.0;
        let steps = worlds.windows(2).map(|pair| {
            metres += (pair[1] - pair[0]).truncate().length();
            metres
        });
        let metres: Vec<f64> = [0.0].into_iter().chain(steps).collect();
        let at = share_of(line.id, 0);
        let on_page = |((point, world), metres): ((&SlopePoint, &DVec3), &f64)| {
            let place = self.seen.place(*world)?;
            let point = self.point(point, *world, place, *metres);
            let weight = point.of_way.weight * (most * self.of_scale(*world, at)) as f32;
            Some(Point { of_way: WayPoint { weight, ..point.of_way }, ..point })
        };
        let points: Vec<Option<Point>> = line.points.iter().zip(&worlds).zip(&metres).map(on_page).collect();
        // Lines of a smaller scale go before they are too close.
        let is_finest = self.scale[0] <= 0.0;
        let is_bare =
            |point: &&Point| is_finest && point.far_enough < 0.5 && self.seen.may_show(point.place, point.of_way.world);
        let bare = points.iter().flatten().filter(is_bare).map(|point| self.seen.distance(point.of_way.world));
        let bare = bare.reduce(f64::max);
        // Behind the eye there is no page.
        let parts = points.chunk_by(|a, b| a.is_some() == b.is_some());
        let shown =
            parts.flat_map(|part| self.shown(line.id, metres[metres.len() - 1], part.iter().flatten().copied()));
        Hatched { ways: shown.collect(), bare }
    }

    /// The pieces of a part of a line so many metres long that are shown.
    fn shown(&self, id: u64, metres: f64, part: impl Iterator<Item = Point>) -> Vec<LandWay> {
        let mut points: Vec<Point> = part.collect();
        if points.len() < 2 || points.iter().all(|point| point.of_way.weight == 0.0) {
            return Vec::new();
        }
        for i in 1..points.len() {
            points[i].arc = points[i - 1].arc + points[i].place.distance(points[i - 1].place);
        }
        lasting(&mut points, AROUND * self.look.spacing);
        let mut cuts = Vec::new();
        self.halve(id, 1, [0.0, metres], &points, &mut cuts);
        cut(&mut points, &cuts);
        let is_shown = |point: &Point| point.of_way.weight > 0.0 && !self.seen.hides(point.of_way.world);
        let points: Vec<(WayPoint, bool)> = points.iter().map(|point| (point.of_way, is_shown(point))).collect();
        let pieces = points.chunk_by(|(_, a), (_, b)| *a || *b);
        let pieces = pieces.filter(|piece| piece.len() > 1 && piece.iter().any(|(_, is_shown)| *is_shown));
        let way = |piece: &[(WayPoint, bool)]| LandWay {
            line: Line::Hachure,
            points: piece.iter().map(|(point, _)| *point).collect(),
            closed: false,
        };
        pieces.map(way).collect()
    }

    /// A point by its room alone.
    fn point(&self, point: &SlopePoint, world: DVec3, place: DVec2, metres: f64) -> Point {
        let gradient = point.gradient.as_dvec2();
        let black = self.shade.black(gradient);
        let apart = self.look.apart(black);
        let wanted = self.metres_apart(world, gradient, black);
        let far_enough = fade(NEAR, wanted / self.slopes.least_spacing());
        let weight = if wanted.is_finite() { fade(ROOM, f64::from(point.room) / wanted) * far_enough } else { 0.0 };
        let of_way = WayPoint { at: point.at, world, weight: weight as f32, black: black as f32 };
        Point { of_way, place, arc: 0.0, metres, apart, far_enough }
    }

    /// How far lines have come at a distance between strokes, and how far they have gone, 0 to 1.
    fn ways(&self, metres: f64) -> [f64; 2] {
        self.scale.map(|scale| if scale <= 0.0 { 1.0 } else { (metres / scale).ln() / BLEND.ln() }.clamp(0.0, 1.0))
    }

    /// How much of a line is there at a place for the scale of its land; `at` says when it comes and goes, 0 to 1.
    fn of_scale(&self, world: DVec3, at: f64) -> f64 {
        let [metres, _] = self.seen.metres_per_px([world; 2]);
        let comes = (1.0 - COMES) * at;
        let [come, gone] = self.ways(metres * self.look.spacing).map(|way| fade([comes, comes + COMES], way));
        come * (1.0 - gone)
    }

    /// How far apart on the map strokes are to stand on land of a gradient and a tone, metres; infinite where none are.
    fn metres_apart(&self, world: DVec3, gradient: DVec2, black: f64) -> f64 {
        if black <= 0.0 || self.seen.is_away(world, gradient) {
            return f64::INFINITY;
        }
        self.look.apart(black) / self.px_across(world, gradient).max(f64::MIN_POSITIVE)
    }

    /// Pixels between two lines down the slope that are a metre apart on the map.
    fn px_across(&self, world: DVec3, gradient: DVec2) -> f64 {
        let Some(up) = gradient.try_normalize() else { return 0.0 };
        let down = self.seen.moves(world, -up.extend(gradient.length()));
        let across = self.seen.moves(world, up.perp().extend(0.0));
        across.perp_dot(down).abs() / down.length().max(f64::MIN_POSITIVE)
    }

    /// Where a piece of a line between two places, metres, is cut, and how far each cut is open, 0 to 1: in two where the page makes
    /// it too long for a stroke, and each half again. Where is a matter of the line.
    fn halve(&self, id: u64, number: u64, [from, to]: [f64; 2], points: &[Point], cuts: &mut Vec<Cut>) {
        let [begin, end] = [from, to].map(|metres| between(points, |point| point.metres, metres));
        let open = fade(LONG, (end.arc - begin.arc) / self.look.length);
        if open <= 0.0 || number.ilog2() >= MOST_CUTS {
            return;
        }
        let middle = from + (to - from) * (0.35 + 0.3 * share_of(id, number));
        let at = between(points, |point| point.metres, middle);
        cuts.push(Cut { arc: at.arc, half: CUT * at.apart * (1.0 - DARK * f64::from(at.of_way.black)) / 2.0, open });
        self.halve(id, 2 * number, [from, middle], points, cuts);
        self.halve(id, 2 * number + 1, [middle, to], points, cuts);
    }
}

/// What a page needs of the lines of the land.
impl Need for HachuredPage<'_> {
    fn in_box(&self, corners: [DVec3; 2]) -> f64 {
        let [least, most] = self.seen.metres_per_px(corners).map(|metres| metres * self.look.spacing);
        let [[come, _], [_, gone]] = [self.ways(most), self.ways(least)];
        let is_there = come > 0.0 && gone < 1.0;
        let need = || ROOM[0] * self.look.least_apart() / self.seen.most_px_per_metre(corners);
        if is_there { need() } else { f64::INFINITY }
    }

    fn at(&self, place: DVec3, gradient: DVec2) -> f64 {
        let [metres, _] = self.seen.metres_per_px([place; 2]);
        let [come, gone] = self.ways(metres * self.look.spacing);
        let is_there = come > 0.0 && gone < 1.0 && self.seen.place(place).is_some();
        let need = || ROOM[0] * self.metres_apart(place, gradient, self.shade.black(gradient));
        if is_there { need() } else { f64::INFINITY }
    }

    fn sees(&self, place: DVec3) -> bool {
        self.seen.place(place).is_some() && !self.seen.hides(place)
    }
}

/// A share made of two numbers alone.
fn share_of(id: u64, number: u64) -> f64 {
    let mut bytes = [0; 16];
    bytes[..8].copy_from_slice(&id.to_le_bytes());
    bytes[8..].copy_from_slice(&number.to_le_bytes());
    (xxhash_rust::xxh3::xxh3_64(&bytes) >> 11) as f64 / (1_u64 << 53) as f64
}

/// Fades what is but a short piece, by how much of the line there is within a reach, px: the more is shown the more stays.
fn lasting(points: &mut [Point], reach: f64) {
    let n = points.len();
    let step = |i: usize| points[i + 1].arc - points[i].arc;
    let weight = |i: usize| f64::from(points[i].of_way.weight);
    // What there is of the line to both sides, the less the farther it is, px.
    let mut around = vec![0.0; n];
    for backward in [false, true] {
        let mut sum = 0.0;
        for k in 1..n {
            let (i, between) = if backward { (n - 1 - k, n - 1 - k) } else { (k, k - 1) };
            let there = f64::midpoint(weight(between), weight(between + 1)) * step(between).min(reach);
            sum = (sum * (-step(between) / reach).exp() + there).min(reach);
            around[i] += sum;
        }
    }
    for (point, around) in points.iter_mut().zip(around) {
        point.of_way.weight *= fade(LASTS, around / reach) as f32;
    }
}

/// The point of a line where a measure that grows along it has a value.
fn between(points: &[Point], measure: impl Fn(&Point) -> f64, value: f64) -> Point {
    let after = points.partition_point(|point| measure(point) < value).clamp(1, points.len() - 1);
    let [a, b] = [points[after - 1], points[after]];
    let [from, to] = [measure(&a), measure(&b)];
    a.lerp(&b, ((value - from) / (to - from).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0))
}

/// Thins a line about its cuts, to nothing where one is open.
fn cut(points: &mut Vec<Point>, cuts: &[Cut]) {
    let ends = |cut: &Cut| [-1.0, -BLANK, BLANK, 1.0].map(|share| cut.arc + share * cut.half);
    let [first, last] = [points[0].arc, points[points.len() - 1].arc];
    let edges = cuts.iter().flat_map(ends).filter(|arc| (first..last).contains(arc));
    let edges: Vec<Point> = edges.map(|arc| between(points, |point| point.arc, arc)).collect();
    if edges.is_empty() {
        return;
    }
    points.extend(edges);
    points.sort_by(|a, b| a.arc.total_cmp(&b.arc));
    points.dedup_by(|a, b| a.arc == b.arc);
    for cut in cuts {
        let near = points.partition_point(|point| point.arc < cut.arc - cut.half);
        let within = points[near..].iter_mut().take_while(|point| point.arc <= cut.arc + cut.half);
        within.for_each(|point| {
            let off = (point.arc - cut.arc).abs() / cut.half;
            let left = ((off - BLANK) / (1.0 - BLANK)).clamp(0.0, 1.0);
            point.of_way.weight *= (1.0 - cut.open * (1.0 - left)) as f32;
        });
    }
}

impl Point {
    fn lerp(&self, other: &Self, t: f64) -> Self {
        let of = |a: f64, b: f64| a + (b - a) * t;
        let (a, b) = (&self.of_way, &other.of_way);
        let single = |a: f32, b: f32| of(a.into(), b.into()) as f32;
        let of_way = WayPoint {
            at: a.at.lerp(b.at, t),
            world: a.world.lerp(b.world, t),
            weight: single(a.weight, b.weight),
            black: single(a.black, b.black),
        };
        Self {
            of_way,
            place: self.place.lerp(other.place, t),
            arc: of(self.arc, other.arc),
            metres: of(self.metres, other.metres),
            apart: of(self.apart, other.apart),
            far_enough: of(self.far_enough, other.far_enough),
        }
    }
}
