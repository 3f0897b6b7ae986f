//! The rim: patch edges with one patch only, the border of the DEM and of its voids.

use rayon::prelude::*;

use crate::dem::{Band, Dem, Samples};
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

/// Every rim edge, row by row. Cost: three edges a sample.
///
/// # Errors
/// As [`Dem::window`].
pub fn rim(dem: &Dem) -> Result<Vec<RimEdge>> {
    if dem.is_filed() && dem.survey(&|_| ())?.voids == 0 {
        return Ok(border(dem));
    }
    let mut edges = Vec::new();
    for band in dem.bands(1) {
        let Band { rows, samples } = band?;
        edges.par_extend(rows.into_par_iter().flat_map_iter(|r| edges_of_row(&samples, r)));
    }
    Ok(edges)
}

/// The rim of a DEM without voids, in the same order.
fn border(dem: &Dem) -> Vec<RimEdge> {
    let [east, south] = [dem.columns() as u32 - 1, dem.rows() as u32 - 1];
    let edge = |c, r, direction, half| RimEdge { sample: [c, r], direction, half };
    let of_sample = |c, r| {
        let along_row = (c < east && (r == 0 || r == south)).then(|| edge(c, r, 0, u32::from(r == 0)));
        let down_column = (r < south && (c == 0 || c == east)).then(|| edge(c, r, 1, u32::from(c == east)));
        along_row.into_iter().chain(down_column)
    };
    let of_row = |r| (0..=east).step_by(if r == 0 || r == south { 1 } else { east as usize }).map(move |c| (c, r));
    (0..=south).flat_map(of_row).flat_map(|(c, r)| of_sample(c, r)).collect()
}

fn edges_of_row(samples: &Samples, r: usize) -> Vec<RimEdge> {
    let (above, here) = (padded_row(samples, r.wrapping_sub(1)), padded_row(samples, r));
    let mut edges = Vec::new();
    for (c, (above, here)) in (0..).zip(above.windows(2).zip(here.windows(2))) {
        // For each direction, whether patches of half 0 and half 1 have the edge.
        let sides = [[above[1][0], here[1][1]], [here[1][0], here[0][1]], here[1]];
        for (direction, [first, second]) in (0..).zip(sides) {
            if first != second {
                edges.push(RimEdge { sample: [c, r as u32], direction, half: u32::from(second) });
            }
        }
    }
    edges
}

/// Patches of the cells of row `r` with one more cell at either end; none where there is no cell.
fn padded_row(samples: &Samples, r: usize) -> Vec<[bool; 2]> {
    let mut row = vec![[false; 2]; samples.size()[0] + 1];
    row[1..].iter_mut().zip(samples.patches(r)).for_each(|(padded, patches)| *padded = patches);
    row
}
