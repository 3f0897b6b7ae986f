//! The rim: patch edges with one patch only, the border of the DEM and of its voids.

use rayon::prelude::*;

use super::lattice::patch_exists;
use crate::dem::Dem;

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
pub fn rim(dem: &Dem) -> Vec<RimEdge> {
    let exists = |c: i64, r: i64, half: usize| {
        let inside = c >= 0 && r >= 0 && c + 1 < dem.columns() as i64 && r + 1 < dem.rows() as i64;
        inside && patch_exists(dem, c as usize, r as usize, half)
    };
    let edges_at = |c: usize, r: usize| {
        let (x, y) = (c as i64, r as i64);
        // For each direction, the patches of half 0 and half 1 that may have the edge.
        let sides = [
            [exists(x, y - 1, 0), exists(x, y, 1)],
            [exists(x, y, 0), exists(x - 1, y, 1)],
            [exists(x, y, 0), exists(x, y, 1)],
        ];
        sides.into_iter().zip(0..).filter(|(s, _)| s[0] != s[1]).map(move |(s, direction)| RimEdge {
            sample: [c as u32, r as u32],
            direction,
            half: u32::from(s[1]),
        })
    };
    (0..dem.rows()).into_par_iter().flat_map_iter(|r| (0..dem.columns()).flat_map(move |c| edges_at(c, r))).collect()
}
