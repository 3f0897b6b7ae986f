//! Heights that depend on those around them, of a grid that is held: changed band by band, so that what the work takes
//! beside them is bounded.
//!
//! Cost: rows of the halo are worked on twice. Memory beside the heights: a band with its halo.

use super::window::Window;
use crate::error::Result;

/// Most samples of a band, unless its rows are fewer than those of the halo: 32 MiB.
const BAND: usize = 1 << 23;

/// Changes all `heights` of a grid of so many columns and rows, row-major, by `work`, which changes those of a window and
/// looks at `halo` samples around: a height must come out the same whatever window is worked on, see
/// [`Focal`](super::focal::Focal).
///
/// # Errors
/// Those of `work`.
pub(crate) fn in_bands(
    heights: &mut [f32],
    size: [usize; 2],
    halo: usize,
    work: impl FnMut(&mut [f32], Window) -> Result<()>,
) -> Result<()> {
    let together = (BAND / size[0]).max(halo).max(1);
    banded(heights, size, [together, halo], work)
}

/// The same, so many rows together.
fn banded(
    heights: &mut [f32],
    [columns, rows]: [usize; 2],
    [together, halo]: [usize; 2],
    mut work: impl FnMut(&mut [f32], Window) -> Result<()>,
) -> Result<()> {
    if rows <= together + halo {
        return work(heights, Window { first: [0, 0], size: [columns, rows] });
    }
    // The last rows of the band before, as they were.
    let mut above = Vec::new();
    for first in (0..rows).step_by(together) {
        let (end, below) = ((first + together).min(rows), (first + together + halo).min(rows));
        let mut band = [above.as_slice(), &heights[first * columns..below * columns]].concat();
        let kept = above.len();
        above = heights[end.saturating_sub(halo).max(first) * columns..end * columns].to_vec();
        let from = first - kept / columns;
        work(&mut band, Window { first: [0, from], size: [columns, below - from] })?;
        let inside = (end - first) * columns;
        heights[first * columns..][..inside].copy_from_slice(&band[kept..][..inside]);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sum over so many rows above and below.
    fn summed(heights: &mut [f32], window: Window, reach: usize) {
        let [columns, rows] = window.size;
        let before = heights.to_vec();
        for (i, height) in heights.iter_mut().enumerate() {
            let around = (i / columns).saturating_sub(reach)..(i / columns + reach + 1).min(rows);
            *height = around.map(|r| before[r * columns + i % columns]).sum();
        }
    }

    #[test]
    fn bands_are_as_the_whole() {
        let size = [3, 40];
        let heights: Vec<f32> = (0..120).map(|i| (i * 37 % 101) as f32).collect();
        let mut whole = heights.clone();
        summed(&mut whole, Window { first: [0, 0], size }, 4);
        let by = |together: usize, halo: usize| {
            let mut banded_heights = heights.clone();
            let work = |part: &mut [f32], window: Window| {
                summed(part, window, 4);
                Ok(())
            };
            banded(&mut banded_heights, size, [together, halo], work).map(|()| banded_heights)
        };
        for together in [4, 5, 7, 13, 36, 39, 40, 99] {
            assert_eq!(by(together, 4).ok(), Some(whole.clone()), "{together} rows");
        }
        assert_ne!(by(7, 3).ok(), Some(whole), "a halo too narrow");
    }
}
