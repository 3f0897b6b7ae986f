//! The rim: patch edges with one patch only, the border of the DEM and of its voids.

use rayon::prelude::*;

use crate::dem::{BLOCK_SIDE, Dem, Validity};
use crate::error::Result;

/// A patch edge of the rim, laid out as the shaders read it.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct RimEdge {
    /// Column and row of the sample it starts at.
    pub sample: [u32; 2],
    /// 0 leads one sample east, 1 south, 2 south-east.
    pub direction: u32,
    /// Which patch has it: 0 (NW, SW, SE) or 1 (NW, SE, NE).
    pub half: u32,
}

/// Every rim edge, row by row: from what is known of blocks of samples, none of which is looked at. Cost: some forty
/// operations for 64 samples of a row, where a block holds voids or lies beside one that does.
///
/// # Errors
/// As [`Dem::survey`].
pub fn rim(dem: &Dem) -> Result<Vec<RimEdge>> {
    let validity = dem.validity()?;
    let of_rows = |y| {
        let mut edges = Vec::new();
        each_row(validity, y, |sample, sides| push(&mut edges, sample, sides));
        edges
    };
    Ok(rows_of_blocks(validity).flat_map_iter(of_rows).collect())
}

/// How many edges [`rim`] has, without making them.
///
/// # Errors
/// As [`Dem::survey`].
pub fn rim_length(dem: &Dem) -> Result<u64> {
    let validity = dem.validity()?;
    let of_rows = |y| {
        let mut length = 0;
        each_row(validity, y, |_, sides| {
            length += sides.map(|[a, b]| u64::from((a ^ b).count_ones())).iter().sum::<u64>()
        });
        length
    };
    Ok(rows_of_blocks(validity).map(of_rows).sum())
}

/// Of 64 samples of a row, for each direction, which of the edges that start there a patch of half 0 has, and one of half 1.
type Sides = [[u64; 2]; 3];

fn rows_of_blocks(validity: &Validity) -> impl IndexedParallelIterator<Item = usize> {
    (0..validity.samples()[1].div_ceil(BLOCK_SIDE)).into_par_iter()
}

/// Tells `take` the sides that start in each row of the `y`-th row of blocks, and the first sample of each; but not those of
/// blocks inside the land.
fn each_row(validity: &Validity, y: usize, mut take: impl FnMut([u32; 2], Sides)) {
    let [columns, rows] = validity.samples();
    let blocks: Vec<usize> = (0..columns.div_ceil(BLOCK_SIDE)).filter(|x| !validity.is_inside(*x, y)).collect();
    for r in y * BLOCK_SIDE..((y + 1) * BLOCK_SIDE).min(rows) {
        blocks.iter().for_each(|x| take([x * BLOCK_SIDE, r].map(|at| at as u32), sides(validity, *x, r)));
    }
}

fn sides(validity: &Validity, x: usize, r: usize) -> Sides {
    let [[above, _], [here_0, here_1]] = [r.wrapping_sub(1), r].map(|r| patches(validity, x, r));
    let [_, beyond] = patches(validity, x.wrapping_sub(1), r);
    let west = here_1 << 1 | beyond >> (BLOCK_SIDE - 1);
    [[above, here_1], [here_0, west], [here_0, here_1]]
}

/// Which of their patches 0 and 1 the 64 cells at the samples of row `r` in the `x`-th column of blocks have.
fn patches(validity: &Validity, x: usize, r: usize) -> [u64; 2] {
    let row = |r| {
        let here = validity.row(x, r);
        [here, here >> 1 | validity.row(x.wrapping_add(1), r) << (BLOCK_SIDE - 1)]
    };
    let ([nw, ne], [sw, se]) = (row(r), row(r.wrapping_add(1)));
    [nw & sw & se, nw & se & ne]
}

fn push(edges: &mut Vec<RimEdge>, [c, r]: [u32; 2], sides: Sides) {
    let [east, south, across] = sides.map(|[first, second]| first ^ second);
    let mut left = east | south | across;
    while left != 0 {
        let bit = left.trailing_zeros();
        left &= left - 1;
        for (direction, [first, second]) in (0..).zip(sides.map(|of| of.map(|bits| bits >> bit & 1))) {
            if first != second {
                edges.push(RimEdge { sample: [c + bit, r], direction, half: second as u32 });
            }
        }
    }
}
