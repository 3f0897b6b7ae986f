//! Flat water in a DEM of steps: lakes and the sea lie level, while other regions of equal heights are slopes that were
//! rounded.
//!
//! Method: equal heights that share an edge are one region, found in one look over the rows (runs, and a union-find over the
//! two rows at hand; He, Chao, Suzuki 2008, "A Run-Based Two-Scan Labeling Algorithm"). Which of them are water is said in
//! `regions`, by their shores and by the widths of the terraces there, along rows and along columns alike: the water of a DEM
//! on its side is that of the DEM. Beyond the DEM and in voids nothing is known, that is no evidence of either kind.
//!
//! Cost: some nanoseconds a sample, more where runs are short. Memory: 16 bytes a column and a run of the regions that are
//! open at a row, and 8 a run of water. Not handled: lakes as wide as the DEM, water that no one made level, rivers: they
//! fall, and the smoothest surface within their steps is right for them; reaches of those aslant to the grid are taken for
//! lakes.

mod regions;

use regions::{Ending, NONE, Regions};

use super::Window;

/// Which samples of a window are flat water: runs of columns, row by row.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Water {
    /// First column and that beyond the last.
    runs: Vec<[u32; 2]>,
    /// Where the runs of each row begin, and where they end.
    rows: Vec<u32>,
}

/// It in the making, from the rows of a window.
pub(crate) struct WaterBuilder {
    width: usize,
    row: u32,
    above: Vec<EqualHeights>,
    columns: Vec<Column>,
    regions: Regions,
}

/// Equal heights side by side; NaN: voids.
#[derive(Debug, Clone, Copy)]
struct EqualHeights {
    first: u32,
    end: u32,
    height: f32,
    region: u32,
}

/// What a column has shown by a row.
#[derive(Debug, Clone, Copy)]
struct Column {
    /// The row where its run begins.
    first: u32,
    before: Before,
}

/// What lies before a run of a column.
#[derive(Debug, Clone, Copy)]
enum Before {
    /// Voids or the DEM's edge.
    Nothing,
    /// Lower ground that is too narrow to tell anything.
    Lower,
    /// Lower ground to which the run is a terrace, and how long it is.
    Region(u32, u32),
    /// A terrace: how wide it is, and whether all of it was seen.
    Terrace(u32, bool),
}

impl Water {
    /// Sets `half` to 0 at the water of `window`, row-major.
    pub(crate) fn level(&self, window: Window, half: &mut [f32]) {
        let [from, to] = [window.first[0], window.first[0] + window.size[0]];
        for (r, half) in half.chunks_exact_mut(window.size[0].max(1)).enumerate() {
            for [first, end] in
                self.row(window.first[1] + r).iter().map(|run| run.map(|c| (c as usize).clamp(from, to) - from))
            {
                half[first..end].fill(0.0);
            }
        }
    }

    /// First columns of the water of a row, and those beyond its last ones.
    pub(crate) fn row(&self, r: usize) -> &[[u32; 2]] {
        self.rows.get(r..r + 2).map_or(&[], |rows| &self.runs[rows[0] as usize..rows[1] as usize])
    }

    /// Where the runs of each row begin, and the runs.
    pub(crate) fn parts(&self) -> (&[u32], &[[u32; 2]]) {
        (&self.rows, &self.runs)
    }

    /// From [`Self::parts`]; `None` where they are none.
    pub(crate) fn from_parts(rows: Vec<u32>, runs: Vec<[u32; 2]>) -> Option<Self> {
        let sound = rows.is_sorted() && rows.last().copied().unwrap_or(0) as usize == runs.len();
        sound.then_some(Self { runs, rows })
    }
}

impl WaterBuilder {
    /// Of a window so many columns wide, no row seen yet.
    pub(crate) fn new(width: usize) -> Self {
        let columns = vec![Column { first: 0, before: Before::Nothing }; width];
        Self { width, row: 0, above: Vec::new(), columns, regions: Regions::default() }
    }

    /// Takes the next rows, whole ones: metres, NaN at voids.
    pub(crate) fn take(&mut self, heights: &[f32]) {
        heights.chunks_exact(self.width).for_each(|row| self.take_row(row));
    }

    /// The water, when all rows have been taken.
    pub(crate) fn finish(mut self) -> Water {
        for over in std::mem::take(&mut self.above) {
            let beyond = EqualHeights { height: f32::NAN, region: NONE, ..over };
            self.regions.shore([&over, &beyond], over.end - over.first);
            self.below(&over, &beyond);
            self.regions.close_before(over.region, self.row);
        }
        let mut water = self.regions.into_water();
        water.sort_unstable();
        let begins = |row| water.partition_point(|[of, ..]| *of < row) as u32;
        let rows = (0..=self.row).map(begins).collect();
        Water { runs: water.iter().map(|[_, first, end]| [*first, *end]).collect(), rows }
    }

    fn take_row(&mut self, heights: &[f32]) {
        let mut here = runs(heights);
        for run in here.iter_mut().filter(|run| !run.height.is_nan()) {
            run.region = self.regions.add(self.row, *run);
        }
        if self.row == 0 {
            let edges = here.iter().map(|run| (run, EqualHeights { height: f32::NAN, region: NONE, ..*run }));
            edges.for_each(|(run, beyond)| self.regions.shore([run, &beyond], run.end - run.first));
        }
        self.meet(&here);
        self.beside(&here);
        here.iter_mut().filter(|run| run.region != NONE).for_each(|run| run.region = self.regions.root(run.region));
        self.above.iter().for_each(|run| self.regions.close_before(run.region, self.row));
        // Nobody names those that became part of others any more.
        self.regions.release();
        self.above = here;
        self.row += 1;
    }

    /// Runs of this row and of the one above: equal heights become one region, others are each other's shore.
    fn meet(&mut self, here: &[EqualHeights]) {
        let (mut above, mut below) = (0, 0);
        while let (Some(&over), Some(&run)) = (self.above.get(above), here.get(below)) {
            let edges = over.end.min(run.end) - over.first.max(run.first);
            if over.height == run.height {
                self.regions.join(over.region, run.region);
            } else {
                self.regions.shore([&over, &run], edges);
                if !(over.height.is_nan() && run.height.is_nan()) {
                    self.below(&over, &run);
                }
            }
            above += usize::from(over.end <= run.end);
            below += usize::from(run.end <= over.end);
        }
    }

    /// In the columns of both `run` lies below `over`, which is another height: the higher one is a terrace.
    fn below(&mut self, over: &EqualHeights, run: &EqualHeights) {
        for c in over.first.max(run.first)..over.end.min(run.end) {
            let Column { first, before } = self.columns[c as usize];
            let length = self.row - first;
            match before {
                Before::Region(region, of) => {
                    let terrace = Ending { length: of, width: length, is_seen: !run.height.is_nan() };
                    self.regions.end(region, 1, terrace);
                    self.regions.let_go(region);
                }
                Before::Terrace(width, is_seen) => {
                    self.regions.end(over.region, 1, Ending { length, width, is_seen });
                }
                Before::Nothing | Before::Lower => {}
            }
            let before = if over.height < run.height {
                match self.regions.hold(over.region, length) {
                    Some(region) => Before::Region(region, length),
                    None => Before::Lower,
                }
            } else if over.height > run.height {
                Before::Terrace(length, !matches!(before, Before::Nothing))
            } else {
                Before::Nothing
            };
            self.columns[c as usize] = Column { first: self.row, before };
        }
    }

    /// Runs beside each other in a row: each is the other's shore, and the higher one a terrace.
    fn beside(&mut self, here: &[EqualHeights]) {
        let beyond = EqualHeights { first: 0, end: 0, height: f32::NAN, region: NONE };
        for run in here.first().into_iter().chain(here.last()) {
            self.regions.shore([run, &beyond], 1);
        }
        for (i, pair) in here.windows(2).enumerate() {
            let [west, east] = [&pair[0], &pair[1]];
            self.regions.shore([west, east], 1);
            let is_seen = |beyond: Option<&EqualHeights>| beyond.is_some_and(|run| !run.height.is_nan());
            let ending = |run: &EqualHeights, terrace: &EqualHeights, beyond| {
                let [length, width] = [run, terrace].map(|run| run.end - run.first);
                Ending { length, width, is_seen: is_seen(beyond) }
            };
            if east.height > west.height {
                self.regions.end(west.region, 0, ending(west, east, here.get(i + 2)));
            } else if west.height > east.height {
                let beyond = i.checked_sub(1).and_then(|before| here.get(before));
                self.regions.end(east.region, 0, ending(east, west, beyond));
            }
        }
    }
}

/// The runs of a row, from its first column to its last.
fn runs(heights: &[f32]) -> Vec<EqualHeights> {
    let same = |a: &f32, b: &f32| a == b || a.is_nan() && b.is_nan();
    let mut first = 0;
    let run = |part: &[f32]| {
        let run = EqualHeights { first, end: first + part.len() as u32, height: part[0], region: NONE };
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
        assert_eq!(count(&water_of(|x, y| coast(x, y) + 5.0)), 130 * SIDE, "a lake that the edge cuts");
        let plain = |_: f64, y: f64| 5.0 + ((y - 29.0) * 0.05).max(0.0);
        assert_eq!(count(&water_of(plain)), 0, "a plain may be a slope");
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

    /// As many samples of `height` are water as expected, and those of its transpose are the transposed ones.
    fn both_ways(height: impl Fn(f64, f64) -> f64) -> usize {
        let (water, transposed) = (water_of(&height), water_of(|x, y| height(y, x)));
        assert!((0..SIDE * SIDE).all(|i| water[i] == transposed[i % SIDE * SIDE + i / SIDE]), "not symmetric");
        count(&water)
    }

    #[test]
    fn lakes_are_found_whichever_way_they_lie() {
        let lake = |half: [f64; 2], rise: f64| {
            move |x: f64, y: f64| {
                let away = (x.abs() - half[0]).max(0.0).hypot((y.abs() - half[1]).max(0.0));
                300.0 + away * rise + if away > 0.0 { 0.6 } else { 0.0 }
            }
        };
        assert_eq!(both_ways(lake([12.0, 80.0], 0.3)), 25 * 161, "gentle");
        assert_eq!(both_ways(lake([3.0, 80.0], 1.5)), 7 * 161, "narrow");
        assert_eq!(both_ways(lake([40.0, 40.0], 0.15)), 81 * 81, "square");
        // 1 m in 60 samples, steep banks.
        let river = |x: f64, y: f64| 300.0 - y / 60.0 + (x.abs() - 5.0).max(0.0);
        assert_eq!(both_ways(river), 0, "the reaches of a river fall");
    }

    #[test]
    fn water_of_random_land_transposed_is_the_transposed() {
        let mut state = 1_u64;
        let mut random = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 24)
        };
        let mut found = 0;
        for _ in 0..24 {
            let waves: Vec<_> =
                (0..6).map(|k| [0.3 * random(), 0.3 * random(), 6.3 * random(), 24.0 / f64::from(k + 1)]).collect();
            let (level, void) = (20.0 * random() - 24.0, 160.0 * random() - 80.0);
            let land = |x: f64, y: f64| {
                let height: f64 = waves.iter().map(|[a, b, phase, high]| high * (a * x + b * y + phase).sin()).sum();
                let is_void = (x - void).abs() < 2.0 && y < void || x == 60.0 && y * y < 50.0;
                // The floor of whatever lies below the level, and its outlets.
                if is_void { f64::NAN } else { height.max(level) }
            };
            found += usize::from(both_ways(land) > 0);
        }
        assert!(found > 12, "water in {found} of 24 lands");
    }
}
