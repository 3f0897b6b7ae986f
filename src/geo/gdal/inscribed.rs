//! The largest upright rectangle of samples inside a region, so that a warped DEM has straight borders.
//!
//! Method: the largest rectangle of a coarse sub-grid of nodes that are all inside (by the stack of rising bars, row by
//! row), then each side moved out, or in, sample by sample. Cost: about 256 x 256 places and a few dozen sides. The
//! region must be without holes, as the image of a rectangle is. The result is largest up to one node's spacing.

use crate::dem::Window;

/// Nodes along the longer side.
const NODES: usize = 256;

/// The largest window of `columns` x `rows` samples whose every sample is inside, at least 2 x 2; `inside` judges a
/// list of (column, row).
pub(super) fn largest(
    columns: usize,
    rows: usize,
    mut inside: impl FnMut(&[[usize; 2]]) -> Vec<bool>,
) -> Option<Window> {
    let step = columns.max(rows).div_ceil(NODES).max(1);
    let [across, down] = [columns, rows].map(|n| (n - 1) / step + 1);
    let nodes: Vec<_> = (0..down).flat_map(|r| (0..across).map(move |c| [c * step, r * step])).collect();
    let [c0, r0, c1, r1] = largest_of_nodes(&inside(&nodes), across)?.map(|node| node * step);
    let mut sides = [c0, r0, c1, r1];
    let mut whole = |sides: [usize; 4], side| inside(&line(sides, side)).into_iter().all(|i| i);
    let ends = [0, 0, columns - 1, rows - 1];
    // In, until all four sides are inside: between nodes the region may bend inwards.
    while let Some(side) = (0..4).find(|&side| !whole(sides, side)) {
        sides[side] = if side < 2 { sides[side] + 1 } else { sides[side].checked_sub(1)? };
        if sides[0] >= sides[2] || sides[1] >= sides[3] {
            return None;
        }
    }
    // Out, each side as far as it goes.
    let mut open = [true; 4];
    while let Some(side) = (0..4).find(|&side| open[side]) {
        let mut moved = sides;
        open[side] = sides[side] != ends[side];
        if open[side] {
            moved[side] = if side < 2 { sides[side] - 1 } else { sides[side] + 1 };
            open[side] = whole(moved, side);
        }
        if open[side] {
            sides = moved;
        }
    }
    let [c0, r0, c1, r1] = sides;
    Some(Window { first: [c0, r0], size: [c1 - c0 + 1, r1 - r0 + 1] })
}

/// The samples of one side (west, north, east, south) of the rectangle.
fn line([c0, r0, c1, r1]: [usize; 4], side: usize) -> Vec<[usize; 2]> {
    match side {
        0 => (r0..=r1).map(|r| [c0, r]).collect(),
        1 => (c0..=c1).map(|c| [c, r0]).collect(),
        2 => (r0..=r1).map(|r| [c1, r]).collect(),
        _ => (c0..=c1).map(|c| [c, r1]).collect(),
    }
}

/// First and last column and row (c0, r0, c1, r1) of the largest all-true rectangle of at least 2 x 2 in rows of
/// `across` nodes, measured between outermost nodes.
fn largest_of_nodes(inside: &[bool], across: usize) -> Option<[usize; 4]> {
    let mut best: Option<(usize, [usize; 4])> = None;
    let mut heights = vec![0; across + 1];
    for (r, row) in inside.chunks(across).enumerate() {
        for (height, inside) in heights.iter_mut().zip(row) {
            *height = if *inside { *height + 1 } else { 0 };
        }
        // Bars of rising height, each with the column from which it is as high; the last, empty one closes all.
        let mut bars: Vec<(usize, usize)> = Vec::new();
        for (c, &height) in heights.iter().enumerate() {
            let mut from = c;
            while let Some(&(first, high)) = bars.last().filter(|(_, high)| *high > height) {
                bars.pop();
                from = first;
                let area = (c - 1 - first) * (high - 1);
                if area > best.map_or(0, |(area, _)| area) {
                    best = Some((area, [first, r + 1 - high, c - 1, r]));
                }
            }
            bars.push((from, height));
        }
    }
    best.map(|(_, rectangle)| rectangle)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Area of the largest window by trying all of them.
    fn by_trial(columns: usize, rows: usize, inside: impl Fn(usize, usize) -> bool) -> usize {
        let mut best = 0;
        for (c0, r0) in (0..rows).flat_map(|r| (0..columns).map(move |c| (c, r))) {
            let mut end = columns;
            for r in r0..rows {
                end = (c0..end).find(|&c| !inside(c, r)).unwrap_or(end);
                if end > c0 + 1 && r > r0 {
                    best = best.max((end - c0) * (r + 1 - r0));
                }
            }
        }
        best
    }

    fn found(columns: usize, rows: usize, inside: impl Fn(usize, usize) -> bool) -> Window {
        let window = largest(columns, rows, |at| at.iter().map(|&[c, r]| inside(c, r)).collect()).expect("a window");
        let [c, r] = window.first;
        let all = (r..r + window.size[1]).all(|r| (c..c + window.size[0]).all(|c| inside(c, r)));
        assert!(all, "{window:?} holds a sample outside");
        window
    }

    #[test]
    fn small_regions_give_the_largest_rectangle() {
        let tilted = |c: usize, r: usize| {
            let (x, y) = (c as f64 - 50.0, r as f64 - 40.0);
            (x * 0.9 + y * 0.2).abs() <= 35.0 && (y * 0.9 - x * 0.2).abs() <= 28.0
        };
        let window = found(100, 80, tilted);
        assert_eq!(window.samples() as usize, by_trial(100, 80, tilted));
        assert_eq!(found(9, 7, |_, _| true), Window { first: [0, 0], size: [9, 7] });
    }

    #[test]
    fn large_curved_regions_lose_less_than_two_nodes() {
        // A bowl above and below, as a degree block is in UTM.
        let bowl = |c: usize, r: usize| {
            let bend = ((c as f64 - 500.0) / 500.0).powi(2) * 30.0;
            (r as f64) >= 40.0 - bend && (r as f64) <= 760.0 - bend
        };
        // Narrower ones gain fewer rows than they lose columns: the largest is 1000 wide, from row 40 to row 730.
        let window = found(1000, 800, bowl);
        assert!(window.samples() as f64 > 0.99 * 691_000.0, "{window:?}");
    }

    #[test]
    fn nothing_inside_gives_nothing() {
        assert_eq!(largest(50, 50, |at| vec![false; at.len()]), None);
        assert_eq!(largest(50, 50, |at| at.iter().map(|at| at[0] == 3).collect()), None);
    }
}
