//! A first look at a raster's numbers, before it is read: a few windows spread over it.

use crate::dem::Window;

/// Sides of a raster up to which the look takes all of it.
const WHOLE: usize = 192;
/// Columns and rows of a window.
const SIDE: usize = 64;
/// Windows across and down.
const WINDOWS: usize = 3;

/// The windows to look at: all of a small raster, nine parts of a larger one.
pub(super) fn windows(size: [usize; 2]) -> Vec<Window> {
    if size.iter().all(|n| *n <= WHOLE) {
        return vec![Window { first: [0, 0], size }];
    }
    let first = |i: usize, k: usize| size[i].saturating_sub(SIDE) * k / (WINDOWS - 1);
    let of = |c, r| Window { first: [first(0, c), first(1, r)], size: size.map(|n| n.min(SIDE)) };
    (0..WINDOWS).flat_map(|r| (0..WINDOWS).map(move |c| of(c, r))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_lie_inside() {
        for size in [[2, 2], [192, 192], [193, 5], [64, 1000], [5000, 300]] {
            let windows = windows(size);
            assert!(windows.iter().all(|w| (0..2).all(|i| w.first[i] + w.size[i] <= size[i])), "{size:?}");
            assert!(windows.iter().any(|w| (0..2).all(|i| w.first[i] + w.size[i] == size[i])), "{size:?}");
        }
    }
}
