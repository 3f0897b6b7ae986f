//! The tiles in which samples are read from their files and kept: whole blocks of the file, so that none is unpacked
//! twice.

use rayon::prelude::*;

use super::window::Window;
use crate::error::Result;

/// Shortest side of a tile where the file's blocks are smaller, samples: 1 MiB of heights in all.
const SIDE: usize = 512;
/// Most samples of a tile where the file's blocks are larger.
const MOST: usize = 1 << 20;
/// Tiles that each core reads before they are put together.
const TILES_A_CORE: usize = 4;

/// A grid laid over a window's samples, which cuts it at the borders of the file's blocks.
#[derive(Debug, Clone, Copy)]
pub struct Tiling {
    /// Columns and rows of a whole tile.
    pub size: [usize; 2],
    /// Columns and rows of the first tile that lie beyond the window.
    before: [usize; 2],
    /// Columns and rows of the window.
    whole: [usize; 2],
}

impl Tiling {
    /// For a file stored in blocks of `stored` columns and rows, of which a window of `whole` samples begins at `first`.
    pub fn of(stored: [usize; 2], first: [i64; 2], whole: [usize; 2]) -> Self {
        let times = |length: usize, side: usize| length * (side / length).max(1);
        let width = times(stored[0].max(1), SIDE);
        let height = stored[1].clamp(1, (MOST / width).max(1));
        let size = [width, times(height, (SIDE * SIDE / width).max(1))];
        Self { size, before: [0, 1].map(|i| first[i].rem_euclid(size[i] as i64) as usize), whole }
    }

    /// Tiles of just this size over a window of `whole` samples, from its first one on.
    pub fn whole(size: [usize; 2], whole: [usize; 2]) -> Self {
        Self { size, before: [0; 2], whole }
    }

    /// The tiles that a window meets, row by row.
    pub fn tiles(&self, window: Window) -> Vec<Window> {
        let starts = |i: usize| {
            let end = window.first[i] + window.size[i];
            let next = move |at: &usize| {
                let tile = self.tile([0, 1].map(|k| if k == i { *at } else { 0 }));
                Some(tile.first[i] + tile.size[i]).filter(|at| *at < end)
            };
            std::iter::successors(Some(window.first[i]), next).filter(move |at| *at < end)
        };
        starts(1).flat_map(|r| starts(0).map(move |c| self.tile([c, r]))).collect()
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Tiling {
    /// The tile that holds sample (c, r).
    pub fn tile(&self, at: [usize; 2]) -> Window {
        let borders = [0, 1].map(|i| {
            let first = (at[i] + self.before[i]) / self.size[i] * self.size[i];
            let end = (first + self.size[i] - self.before[i]).min(self.whole[i]);
            [first.saturating_sub(self.before[i]), end]
        });
        Window { first: borders.map(|[first, _]| first), size: borders.map(|[first, end]| end - first) }
    }
}

/// Puts a window together from its `tiles`; `load` reads one, on several threads if `parallel`. `progress` hears the share
/// done.
pub(crate) fn gather<T: AsRef<[f32]> + Send>(
    window: Window,
    tiles: &[Window],
    parallel: bool,
    load: impl Fn(Window) -> Result<T> + Sync,
    progress: &dyn Fn(f64),
) -> Result<Vec<f32>> {
    let mut samples = vec![f32::NAN; window.size[0] * window.size[1]];
    let at_once = if parallel { TILES_A_CORE * rayon::current_num_threads() } else { 1 };
    let mut done = 0;
    for batch in tiles.chunks(at_once) {
        let loaded: Vec<_> = match batch {
            [tile] => vec![load(*tile)?],
            _ => batch.par_iter().map(|tile| load(*tile)).collect::<Result<_>>()?,
        };
        batch.iter().zip(&loaded).for_each(|(tile, loaded)| copy(*tile, loaded.as_ref(), window, &mut samples));
        done += batch.len();
        progress(done as f64 / tiles.len() as f64);
    }
    Ok(samples)
}

/// Copies what two windows share of `from`, the samples of `tile`, to `onto`, those of `window`.
pub(crate) fn copy(tile: Window, from: &[f32], window: Window, onto: &mut [f32]) {
    let first = [0, 1].map(|i| tile.first[i].max(window.first[i]));
    let end = [0, 1].map(|i| (tile.first[i] + tile.size[i]).min(window.first[i] + window.size[i]));
    for r in first[1]..end[1] {
        let place = |of: Window| (r - of.first[1]) * of.size[0] + first[0] - of.first[0];
        let (from_row, onto_row, length) = (place(tile), place(window), end[0] - first[0]);
        onto[onto_row..onto_row + length].copy_from_slice(&from[from_row..from_row + length]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_whole_blocks_of_the_file() {
        let size = |stored| Tiling::of(stored, [0, 0], [1 << 20; 2]).size;
        assert_eq!(size([256, 256]), [512, 512]);
        assert_eq!(size([128, 128]), [512, 512]);
        assert_eq!(size([1024, 1024]), [1024, 1024]);
        assert_eq!(size([20_000, 1]), [20_000, 13]);
        assert_eq!(size([20_000, 20_000]), [20_000, 52], "a part of the one block");
        assert_eq!(size([300, 40]), [300, 840]);
    }

    #[test]
    fn tiles_cut_at_the_borders_of_blocks_and_cover_each_sample_once() {
        let tiling = Tiling::of([512, 512], [700, -100], [1300, 900]);
        let columns: Vec<_> =
            tiling.tiles(Window { first: [0, 0], size: [1300, 1] }).iter().map(|t| t.first[0]).collect();
        assert_eq!(columns, [0, 324, 836]);
        let rows: Vec<_> = tiling.tiles(Window { first: [0, 0], size: [1, 900] }).iter().map(|t| t.first[1]).collect();
        assert_eq!(rows, [0, 100, 612]);
        let window = Window { first: [323, 90], size: [700, 600] };
        let tiles = tiling.tiles(window);
        assert_eq!(tiles.len(), 9);
        let load = |tile: Window| Ok(vec![1.0; tile.samples() as usize]);
        let samples = gather(window, &tiles, true, load, &|_| ()).expect("no error");
        assert!(samples.iter().all(|sample| *sample == 1.0), "a sample that no tile covers");
        assert!(
            gather(window, &tiles[1..], false, load, &|_| ()).expect("no error").iter().any(|sample| sample.is_nan())
        );
        let all = tiling.tiles(Window { first: [0, 0], size: [1300, 900] });
        assert_eq!(all.iter().map(|tile| tile.samples()).sum::<u64>(), 1300 * 900, "a sample that two tiles cover");
        assert!(tiling.tiles(Window { first: [1300, 0], size: [0, 5] }).is_empty());
    }
}
