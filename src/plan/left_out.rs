//! What a frame did without, why, and what that saved, in words.

use std::collections::{BTreeMap, HashSet};

use super::detail::{self, Detail};
use super::{Border, Plan};
use crate::error::{Message, Result, Setting};
use crate::surface::lattice::{CELL_STEPS, CHUNK_QUADS};
use crate::surface::{Lattice, Surface, Tile};
use crate::view::Camera;

/// One thing left out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LeftOut {
    /// The thing.
    pub what: &'static str,
    /// The reason.
    pub why: Message,
    /// Of how much it is; `None` where it is all.
    pub saved: Option<String>,
}

/// What the frame of a camera over this lattice does without.
///
/// # Errors
/// As [`Surface::pyramid`].
pub fn left_out(plan: &Plan, surface: &Surface, lattice: &Lattice, camera: &Camera) -> Result<Vec<LeftOut>> {
    let mut left_out = Vec::new();
    let mut leave = |what, why: Message, saved| left_out.push(LeftOut { what, why, saved });
    let chunks = lattice.chunks();
    let of = |left: usize, all: usize, what: &str| (left > 0).then(|| format!("{left} of {all} {what}"));
    if let Detail::Adaptive { .. } = plan.detail {
        let finest = chunks.iter().map(|chunk| chunk.step).min().unwrap_or(CELL_STEPS).min(CELL_STEPS);
        let uniform = surface.patches() * u64::from(CELL_STEPS / finest).pow(2);
        let saved = uniform.saturating_sub(lattice.facets(surface.dem()));
        let saved = format!("{saved} of {uniform} facets of level {}", CELL_STEPS / finest);
        leave("fine facets", "where the page does not show them".into(), Some(saved));
        if let Some(saved) = of(chunks.len() - lattice.seen() as usize, chunks.len(), "chunks") {
            leave("rasterizing", "hidden by nearer land or beside the page".into(), Some(saved));
        }
        let tiles: HashSet<Tile> = chunks.iter().map(Tile::of).collect();
        let of_level_1 = |samples: usize| (samples - 1).div_ceil(CHUNK_QUADS as usize);
        let all = of_level_1(surface.dem().columns()) * of_level_1(surface.dem().rows());
        if let Some(saved) = of(all.saturating_sub(tiles.len()), all, "tiles of samples") {
            leave("samples", "no chunk of the frame needs them".into(), Some(saved));
        }
    } else if let Some(saved) = of(detail::beside(surface, lattice, camera)?, chunks.len(), "chunks") {
        leave("chunks", "beside the page".into(), Some(saved));
    }
    if !lattice.has_seams() {
        leave("seam pass", "all chunks have one level".into(), None);
    }
    if plan.border == Border::Off {
        leave("border pass", Setting::Border.at("off").into(), None);
    }
    if surface.dem().voids() == 0 {
        leave("void tests", "the DEM has no voids".into(), None);
    }
    Ok(left_out)
}

/// How many chunks there are at each level, finest first: "level 4: 12, level 1/2: 30".
pub fn levels(lattice: &Lattice) -> String {
    let mut counts = BTreeMap::new();
    lattice.chunks().iter().for_each(|chunk| *counts.entry(chunk.step).or_insert(0_usize) += 1);
    let level = |step: u32| match step {
        _ if step > CELL_STEPS => format!("1/{}", step / CELL_STEPS),
        _ => (CELL_STEPS / step).to_string(),
    };
    let counts: Vec<String> = counts.into_iter().map(|(step, n)| format!("level {}: {n}", level(step))).collect();
    counts.join(", ")
}
