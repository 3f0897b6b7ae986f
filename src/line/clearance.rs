//! Clearance: of two lines that run side by side too near each other the weaker yields.
//!
//! Method: samples of lines are taken from the strongest to the weakest; each yields to the one that presses hardest of
//! those before it: `its weight * how near * how parallel * how much stronger`, every factor continuous and 0 where the
//! rule begins, so that neither the order of samples nor the cut of lines into samples shows. A line that has faded presses
//! no one. Lines that cross or end on each other, and what follows along one line, do not run side by side.
//!
//! Source: the rule of halftoning by strokes (Salisbury et al. 1994: a stroke is drawn where the page has room), here
//! without its order of arrival. Cost: a look at the samples within the gap; 40 000 in some 10 ms on one core. Does not
//! handle: many weak lines beside a strong one that press no harder than one of them.

use glam::Vec2;

/// Samples differ in rank by this where the weaker yields wholly: a factor of 1.6 in jump.
const RANK: f32 = 0.35;
/// Cosines of the angle between two lines up to which they cross, and from which they run side by side: 60 and 30 degrees.
const SIDE_BY_SIDE: [f32; 2] = [0.5, 0.866];
/// Differences in ln depth up to which a skyline is the same, and from which the farther one says that the nearer has land
/// behind it, not sky.
const COVERED: [f32; 2] = [0.0005, 0.002];
/// What lies ahead on the line's own way counts as this many times as far: it is not beside.
const AHEAD: f32 = 6.0;
/// Along one line, gaps between samples up to which they are neighbours, and from which they are strangers.
const STRANGERS: [f32; 2] = [3.0, 6.0];
/// Least side of a cell of the page in which samples are looked up, px.
const LEAST_CELL: f32 = 2.0;

/// A piece of a line, about straight.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// Its middle on the page, px.
    pub place: Vec2,
    /// Unit vector along the line.
    pub along: Vec2,
    /// Half its length, px.
    pub half: f32,
    /// Which chain it is of.
    pub chain: u32,
    /// Where on the chain it is, px from its start.
    pub arc: f32,
    /// Length of the chain where it is closed, else infinite, px.
    pub round: f32,
    /// How strong it is: the higher yields not to the lower.
    pub rank: f32,
    /// Its weight where it is alone, 0 to 1.
    pub alone: f32,
    /// How far it is skyline, 0 to 1: that share yields to no one.
    pub skyline: f32,
    /// ln depth: larger is nearer.
    pub log_depth: f32,
}

/// Weights of samples whose lines keep `gap` px apart, 0 to 1, in the order of the samples.
pub fn weights(samples: &[Sample], gap: f32) -> Vec<f32> {
    let mut order: Vec<u32> = (0..samples.len() as u32).filter(|&i| samples[i as usize].alone > 0.0).collect();
    order.sort_unstable_by(|&a, &b| samples[b as usize].rank.total_cmp(&samples[a as usize].rank).then(a.cmp(&b)));
    let mut weights = vec![0.0; samples.len()];
    let cells = Cells::new(samples, &order, gap);
    for &i in &order {
        let sample = &samples[i as usize];
        // Those to come have no weight yet.
        let harder = |pressure: f32, j: usize| match weights[j] > pressure {
            true => pressure.max(weights[j] * sample.pressed_by(&samples[j], gap)),
            false => pressure,
        };
        let pressure = if gap > 0.0 { cells.near(sample.place).fold(0.0, harder) } else { 0.0 };
        weights[i as usize] = sample.alone * (1.0 - pressure);
    }
    weights
}

impl Sample {
    /// How hard a stronger sample of full weight presses, 0 to 1.
    fn pressed_by(&self, other: &Self, gap: f32) -> f32 {
        // Most of what is near goes on along the same line.
        let strange = self.strangeness(other, gap);
        if strange <= 0.0 {
            return 0.0;
        }
        let to = self.way_to(other);
        let nearer = 1.0 - smoothstep([gap / 2.0, gap], to.length());
        let cos = self.along.dot(other.along);
        let stronger = smoothstep([0.0, RANK], other.rank - self.rank) * smoothstep(SIDE_BY_SIDE, cos.abs());
        // The surface lies on the left, what is behind on the right.
        let outside = smoothstep([gap / 8.0, gap / 4.0], to.y) * smoothstep(SIDE_BY_SIDE, cos);
        let covered = other.skyline * outside * smoothstep(COVERED, self.log_depth - other.log_depth);
        strange * nearer * (stronger + (covered - stronger) * self.skyline)
    }

    /// The shortest way on the page to the other piece: along the line, counted as farther than it is, and to its right; px.
    fn way_to(&self, other: &Self) -> Vec2 {
        let own = |v: Vec2| Vec2::new(v.dot(self.along) * AHEAD, self.along.perp_dot(v));
        let (to, half) = (own(other.place - self.place), own(other.along * other.half));
        let t = (-to.dot(half) / half.length_squared().max(f32::MIN_POSITIVE)).clamp(-1.0, 1.0);
        to + half * t
    }

    /// 0 for neighbours along one line, 1 for samples of two.
    fn strangeness(&self, other: &Self, gap: f32) -> f32 {
        if self.chain != other.chain {
            return 1.0;
        }
        let arc = (self.arc - other.arc).abs();
        smoothstep(STRANGERS.map(|gaps| gaps * gap), arc.min(self.round - arc))
    }
}

/// 0 up to the first edge, 1 from the second on, smooth between.
pub fn smoothstep([low, high]: [f32; 2], x: f32) -> f32 {
    let t = ((x - low) / (high - low).max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Samples by cells of the page, each at least as wide as samples press.
struct Cells {
    low: Vec2,
    side: f32,
    /// Between places farther apart than this nothing presses, px.
    reach: f32,
    columns: usize,
    rows: usize,
    /// Where each cell's samples begin in `list`, and where the last ends.
    starts: Vec<u32>,
    list: Vec<(Vec2, u32)>,
}

impl Cells {
    /// Sorts those samples of `order` in that press on others up to `gap` px away.
    fn new(samples: &[Sample], order: &[u32], gap: f32) -> Self {
        let places = || order.iter().map(|&i| samples[i as usize].place);
        let low = places().reduce(Vec2::min).unwrap_or_default();
        let size = places().reduce(Vec2::max).unwrap_or_default() - low;
        let longest = order.iter().map(|&i| samples[i as usize].half).fold(0.0, f32::max);
        // No more cells than twice the samples, however large the page.
        let fewest = (size.x * size.y / (2.0 * order.len() as f32 + 1.0)).sqrt().max(size.max_element() / 10_000.0);
        let reach = gap + longest;
        let side = reach.max(fewest).max(LEAST_CELL);
        let [columns, rows] = [size.x, size.y].map(|size| (size / side) as usize + 1);
        let mut cells = Self {
            low,
            side,
            reach,
            columns,
            rows,
            starts: vec![0; columns * rows + 1],
            list: vec![(low, 0); order.len()],
        };
        let cell = |cells: &Self, i: u32| {
            let [column, row] = cells.at(samples[i as usize].place);
            row * columns + column
        };
        for &i in order {
            let cell = cell(&cells, i);
            cells.starts[cell + 1] += 1;
        }
        (0..columns * rows).for_each(|cell| cells.starts[cell + 1] += cells.starts[cell]);
        let mut ends = cells.starts.clone();
        for &i in order {
            let end = &mut ends[cell(&cells, i)];
            cells.list[*end as usize] = (samples[i as usize].place, i);
            *end += 1;
        }
        cells
    }

    /// Column and row of a place.
    fn at(&self, place: Vec2) -> [usize; 2] {
        let at = ((place - self.low) / self.side).to_array();
        [(at[0] as usize).min(self.columns - 1), (at[1] as usize).min(self.rows - 1)]
    }

    /// The samples that may press on one at a place.
    fn near(&self, place: Vec2) -> impl Iterator<Item = usize> {
        let [column, row] = self.at(place);
        let columns = column.saturating_sub(1)..(column + 2).min(self.columns);
        let rows = row.saturating_sub(1)..(row + 2).min(self.rows);
        let about = rows.flat_map(move |row| {
            let [first, last] = [columns.start, columns.end].map(|column| self.starts[row * self.columns + column]);
            &self.list[first as usize..last as usize]
        });
        let is_near = move |&&(other, _): &&(Vec2, u32)| other.distance_squared(place) < self.reach * self.reach;
        about.filter(is_near).map(|&(_, i)| i as usize)
    }
}
