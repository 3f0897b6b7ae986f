//! Flat water in a DEM of steps: lakes and the sea lie level, while other regions of equal heights are slopes that were
//! rounded.
//!
//! Method: equal heights that share an edge are one region, found in one look over the rows (runs, and a union-find over the
//! two rows at hand; He, Chao, Suzuki 2008, "A Run-Based Two-Scan Labeling Algorithm"). A region is water if it is large
//! ([`LEAST`]), if hardly any of its shore leads down ([`OUTLETS`]: a lake has one), and if it is much wider than the
//! terraces at its shores ([`WIDER`]). The floor of a rounded hollow is not, whatever step and slope: next to one with the
//! section of a parabola lies a terrace of a fifth of its width at least. Widths are measured along rows alone, where the
//! next terrace is the next run. Beyond the DEM and in voids nothing is known, that is no evidence of either kind. The sea, at
//! exactly 0, may have more of its shore below; where none of its rows ends at a shore it is believed.
//!
//! Cost: some nanoseconds a sample, more where runs are short. Memory: 16 bytes a run of the regions that are open at a row,
//! and 8 a run of water. Not handled: lakes as wide as the DEM, water that no one made level, rivers: they fall, and the
//! smoothest surface within their steps is right for them.

use crate::dem::Window;

/// Fewest samples of a body of water: smaller ones are gone on a page, and as likely a hollow.
const LEAST: u64 = 64;
/// One in so many edges of its shore may lead down.
const OUTLETS: u64 = 16;
/// The same of the sea: mud and noise lie below 0 along its shores. On a slope it is every other one.
const MUD: u64 = 4;
/// How many times as wide as the next terrace a row of water is.
const WIDER: u32 = 8;
/// No region, no run.
const NONE: u32 = u32::MAX;

/// Which samples of a window are flat water: runs of columns, row by row.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Water {
    /// First column and that beyond the last.
    runs: Vec<[u32; 2]>,
    /// Where the runs of each row begin, and where they end.
    rows: Vec<u32>,
}

/// It in the making, from the rows of a window.
pub(super) struct WaterBuilder {
    width: usize,
    row: u32,
    above: Vec<Run>,
    regions: Regions,
    /// Row and columns of water that was found.
    water: Vec<[u32; 3]>,
}

/// Equal heights side by side; NaN: voids.
#[derive(Debug, Clone, Copy)]
struct Run {
    first: u32,
    end: u32,
    height: f32,
    region: u32,
}

/// Equal heights that hang together, as far as rows were seen.
#[derive(Debug, Clone, Copy)]
struct Region {
    /// The region that it became part of; itself otherwise.
    parent: u32,
    /// The last row that has a run of it.
    row: u32,
    height: f32,
    /// First and last of its runs.
    runs: [u32; 2],
    samples: u64,
    /// Edges to other heights, and those of them to lower ones.
    shore: u64,
    down: u64,
    /// Samples of runs that end at higher ground, once for each end, and those much wider than the run there.
    ends: u64,
    steep: u64,
}

/// Regions that are open, with their runs; what is closed makes room for others.
#[derive(Default)]
struct Regions {
    all: Vec<Region>,
    free: Vec<u32>,
    /// Those that became part of others since the last row.
    joined: Vec<u32>,
    /// Row, columns, and the next run of the region.
    runs: Vec<[u32; 4]>,
    free_runs: Vec<u32>,
}

impl Water {
    /// Sets `half` to 0 at the water of `window`, row-major.
    pub fn level(&self, window: Window, half: &mut [f32]) {
        let [from, to] = [window.first[0], window.first[0] + window.size[0]];
        for (r, half) in half.chunks_exact_mut(window.size[0].max(1)).enumerate() {
            let runs = self.rows.get(window.first[1] + r..window.first[1] + r + 2);
            let runs = runs.map_or(&[][..], |rows| &self.runs[rows[0] as usize..rows[1] as usize]);
            for [first, end] in runs.iter().map(|run| run.map(|c| (c as usize).clamp(from, to) - from)) {
                half[first..end].fill(0.0);
            }
        }
    }

    /// Where the runs of each row begin, and the runs.
    pub fn parts(&self) -> (&[u32], &[[u32; 2]]) {
        (&self.rows, &self.runs)
    }

    /// From [`Self::parts`]; `None` where they are none.
    pub fn from_parts(rows: Vec<u32>, runs: Vec<[u32; 2]>) -> Option<Self> {
        let sound = rows.is_sorted() && rows.last().copied().unwrap_or(0) as usize == runs.len();
        sound.then_some(Self { runs, rows })
    }
}

impl WaterBuilder {
    /// Of a window so many columns wide, no row seen yet.
    pub fn new(width: usize) -> Self {
        Self { width, row: 0, above: Vec::new(), regions: Regions::default(), water: Vec::new() }
    }

    /// Takes the next rows, whole ones: metres, NaN at voids.
    pub fn take(&mut self, heights: &[f32]) {
        heights.chunks_exact(self.width).for_each(|row| self.take_row(row));
    }

    /// The water, when all rows have been taken.
    pub fn finish(mut self) -> Water {
        self.close(self.row);
        self.water.sort_unstable();
        let begins = |row| self.water.partition_point(|[of, ..]| *of < row) as u32;
        let rows = (0..=self.row).map(begins).collect();
        Water { runs: self.water.iter().map(|[_, first, end]| [*first, *end]).collect(), rows }
    }

    fn take_row(&mut self, heights: &[f32]) {
        let mut here = runs(heights);
        for run in here.iter_mut().filter(|run| !run.height.is_nan()) {
            run.region = self.regions.add(self.row, *run);
        }
        self.meet(&here);
        self.beside(&here);
        here.iter_mut().filter(|run| run.region != NONE).for_each(|run| run.region = self.regions.root(run.region));
        self.close(self.row);
        // Nobody names those that became part of others any more.
        self.regions.release();
        self.above = here;
        self.row += 1;
    }

    /// Runs of this row and of the one above: equal heights become one region, others are each other's shore.
    fn meet(&mut self, here: &[Run]) {
        let (mut above, mut below) = (0, 0);
        while let (Some(over), Some(run)) = (self.above.get(above), here.get(below)) {
            let edges = over.end.min(run.end) - over.first.max(run.first);
            if over.height == run.height {
                self.regions.join(over.region, run.region);
            } else {
                self.regions.shore([over, run], edges);
            }
            above += usize::from(over.end <= run.end);
            below += usize::from(run.end <= over.end);
        }
    }

    /// Runs beside each other in a row: each is the other's shore, and the higher one a terrace whose width is seen if it ends
    /// at another.
    fn beside(&mut self, here: &[Run]) {
        for (i, pair) in here.windows(2).enumerate() {
            let [west, east] = [&pair[0], &pair[1]];
            self.regions.shore([west, east], 1);
            let seen = |beyond: Option<&Run>| beyond.is_some_and(|run| !run.height.is_nan());
            if east.height > west.height && seen(here.get(i + 2)) {
                self.regions.end(west, east);
            } else if west.height > east.height && seen(i.checked_sub(1).and_then(|before| here.get(before))) {
                self.regions.end(east, west);
            }
        }
    }

    /// Closes the regions of the row above that have no run in row `row`.
    fn close(&mut self, row: u32) {
        for i in 0..self.above.len() {
            let region = self.above[i].region;
            if region != NONE && self.regions.is_open_before(region, row) {
                self.regions.close(region, &mut self.water);
            }
        }
    }
}

impl Region {
    fn is_water(&self) -> bool {
        let is_sea = self.height == 0.0;
        let level = self.samples >= LEAST && self.down * if is_sea { MUD } else { OUTLETS } <= self.shore;
        let wide = if self.ends == 0 { is_sea } else { 2 * self.steep >= self.ends };
        level && wide
    }
}

impl Regions {
    /// A region of this run alone.
    fn add(&mut self, row: u32, run: Run) -> u32 {
        let node = [row, run.first, run.end, NONE];
        let node = put(&mut self.runs, &mut self.free_runs, node);
        let (runs, samples) = ([node; 2], u64::from(run.end - run.first));
        let region =
            Region { parent: NONE, row, height: run.height, runs, samples, shore: 0, down: 0, ends: 0, steep: 0 };
        put(&mut self.all, &mut self.free, region)
    }

    /// The region that this one is part of by now.
    fn root(&mut self, mut region: u32) -> u32 {
        while self.all[region as usize].parent != NONE {
            let parent = self.all[region as usize].parent;
            let beyond = self.all[parent as usize].parent;
            if beyond != NONE {
                self.all[region as usize].parent = beyond;
            }
            region = parent;
        }
        region
    }

    /// Makes two regions one.
    fn join(&mut self, one: u32, other: u32) {
        let [one, other] = [one, other].map(|region| self.root(region));
        if one == other {
            return;
        }
        let from = self.all[other as usize];
        let onto = &mut self.all[one as usize];
        self.runs[onto.runs[1] as usize][3] = from.runs[0];
        onto.runs[1] = from.runs[1];
        onto.row = onto.row.max(from.row);
        onto.samples += from.samples;
        onto.shore += from.shore;
        onto.down += from.down;
        onto.ends += from.ends;
        onto.steep += from.steep;
        self.all[other as usize].parent = one;
        self.joined.push(other);
    }

    /// Counts so many edges between two runs of different heights, unless one is void.
    fn shore(&mut self, runs: [&Run; 2], edges: u32) {
        if runs.iter().any(|run| run.region == NONE) {
            return;
        }
        for (run, other) in [(runs[0], runs[1]), (runs[1], runs[0])] {
            let root = self.root(run.region);
            let region = &mut self.all[root as usize];
            region.shore += u64::from(edges);
            region.down += if other.height < run.height { u64::from(edges) } else { 0 };
        }
    }

    /// Counts an end of a run at a higher terrace.
    fn end(&mut self, run: &Run, terrace: &Run) {
        let [length, width] = [run, terrace].map(|run| run.end - run.first);
        let root = self.root(run.region);
        let region = &mut self.all[root as usize];
        region.ends += u64::from(length);
        region.steep += if length / WIDER >= width { u64::from(length) } else { 0 };
    }

    /// Whether it is no part of another, and ended before row `row`.
    fn is_open_before(&self, region: u32, row: u32) -> bool {
        let region = &self.all[region as usize];
        region.parent == NONE && region.row < row
    }

    /// Closes a region: its runs go to `water` if it is some.
    fn close(&mut self, region: u32, water: &mut Vec<[u32; 3]>) {
        let closed = &mut self.all[region as usize];
        let is_water = closed.is_water();
        // It may be named by several runs.
        closed.row = NONE;
        let mut run = closed.runs[0];
        while run != NONE {
            let [row, first, end, next] = self.runs[run as usize];
            if is_water {
                water.push([row, first, end]);
            }
            self.free_runs.push(run);
            run = next;
        }
        self.free.push(region);
    }

    fn release(&mut self) {
        self.free.append(&mut self.joined);
    }
}

/// Puts an item in a free place, or in a new one, and says where.
fn put<T>(list: &mut Vec<T>, free: &mut Vec<u32>, item: T) -> u32 {
    match free.pop() {
        Some(place) => {
            list[place as usize] = item;
            place
        }
        None => {
            list.push(item);
            list.len() as u32 - 1
        }
    }
}

/// The runs of a row, from its first column to its last.
fn runs(heights: &[f32]) -> Vec<Run> {
    let same = |a: &f32, b: &f32| a == b || a.is_nan() && b.is_nan();
    let mut first = 0;
    let run = |part: &[f32]| {
        let run = Run { first, end: first + part.len() as u32, height: part[0], region: NONE };
        first = run.end;
        run
    };
    heights.chunk_by(same).map(run).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 200;

    fn water_of(height: impl Fn(f64, f64) -> f64) -> Vec<bool> {
        let heights: Vec<f32> = (0..SIDE * SIDE)
            .map(|i| height((i % SIDE) as f64 - 100.0, (i / SIDE) as f64 - 100.0).round() as f32)
            .collect();
        let mut water = WaterBuilder::new(SIDE);
        heights.chunks(SIDE * 7).for_each(|rows| water.take(rows));
        let (water, mut half) = (water.finish(), vec![1.0; SIDE * SIDE]);
        water.level(Window { first: [0, 0], size: [SIDE; 2] }, &mut half);
        // A part of it is the same.
        let [first, size] = [[37, 51], [120, 99]];
        let mut part = vec![1.0; size[0] * size[1]];
        water.level(Window { first, size }, &mut part);
        let same = |i: usize| part[i] == half[(first[1] + i / size[0]) * SIDE + first[0] + i % size[0]];
        assert!((0..part.len()).all(same));
        half.into_iter().map(|half| half == 0.0).collect()
    }

    fn count(water: &[bool]) -> usize {
        water.iter().filter(|water| **water).count()
    }

    /// A hillside that falls southward, in metres, samples being 10 m apart.
    fn slope(x: f64, y: f64) -> f64 {
        500.0 - 0.4 * y + 0.1 * x
    }

    #[test]
    fn lakes_are_water_to_their_last_sample() {
        // A bowl holds a lake with an island and an outlet.
        let bowl = |x: f64, y: f64| 480.0 + ((x * x + y * y).sqrt() - 30.0).max(0.0) * 0.7;
        let island = |x: f64, y: f64| (x - 9.0).abs() < 5.0 && (y + 4.0).abs() < 5.0;
        let outlet = |x: f64, y: f64| x == 1.0 && y > 30.0;
        let lake = |x: f64, y: f64| match bowl(x, y) {
            _ if island(x, y) => 490.0,
            _ if outlet(x, y) => 480.0 - (y - 30.0) / 9.0,
            height => height,
        };
        let water = water_of(lake);
        let expected: Vec<_> = (0..SIDE * SIDE)
            .map(|i| lake((i % SIDE) as f64 - 100.0, (i / SIDE) as f64 - 100.0).round() == 480.0)
            .collect();
        assert!(count(&expected) > 1000);
        assert!(water == expected, "{} of {} samples", count(&water), count(&expected));
    }

    #[test]
    fn rounded_slopes_and_hollows_are_none() {
        assert_eq!(count(&water_of(slope)), 0, "terraces, also the lowest, which the edge cuts");
        assert_eq!(count(&water_of(|x, y| slope(y, x))), 0);
        for depth in [0.1, 0.4, 0.6, 0.9] {
            assert_eq!(count(&water_of(|x, y| depth + (x * x + y * y) / 1500.0)), 0, "a hollow");
            assert_eq!(count(&water_of(|x, y| depth + (0.8 * x + 0.6 * y).powi(2) / 900.0)), 0, "a valley");
            assert_eq!(count(&water_of(|x, y| depth - (x * x + y * y) / 1500.0)), 0, "a hill");
        }
        let rough = |x: f64, y: f64| 300.0 + 4.0 * (x / 31.0).sin() * (y / 23.0).cos() + 0.02 * x;
        assert_eq!(count(&water_of(rough)), 0, "gentle hills");
    }

    #[test]
    fn the_sea_is_water_where_no_shore_is_seen_in_a_row() {
        let coast = |_: f64, y: f64| if y < 30.0 { 0.0 } else { (y - 29.0) * 0.7 };
        assert_eq!(count(&water_of(coast)), 130 * SIDE);
        assert_eq!(count(&water_of(|x, y| coast(x, y) + 5.0)), 0, "a plain may be a slope");
        assert_eq!(count(&water_of(|_, y| y * 0.1)), 0, "a slope through 0");
        // Mud along the coast.
        let mud = |x: f64, y: f64| if y == 30.0 && x % 8.0 == 0.0 { -1.0 } else { coast(x, y) };
        assert_eq!(count(&water_of(mud)), 130 * SIDE);
        let shore = |x: f64, _: f64| if x < 30.0 { 0.0 } else { (x - 29.0) * 0.7 };
        assert_eq!(count(&water_of(shore)), 130 * SIDE);
    }

    #[test]
    fn voids_are_no_shore() {
        let hole = |x: f64, y: f64| if x.abs() + y.abs() < 30.0 { f64::NAN } else { slope(x, y) };
        assert_eq!(count(&water_of(hole)), 0);
        let lake = |x: f64, y: f64| if x.abs() < 40.0 && y.abs() < 20.0 { 450.0 } else { slope(x, y) };
        let half = |x: f64, y: f64| if x > 10.0 { f64::NAN } else { lake(x, y) };
        assert_eq!(count(&water_of(half)), 50 * 39, "seen from the west alone");
    }
}
