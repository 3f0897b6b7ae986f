//! What a frame did without, why, and what that saved, in words.
//!
//! What is left out is noted where a [`Frame`] decides it. How much that saves is counted when asked: it takes a look at
//! every chunk.

use std::collections::{BTreeMap, HashSet};

use super::frame::Frame;
use crate::error::{Message, Result, Setting};
use crate::surface::lattice::{CELL_STEPS, CHUNK_QUADS};
use crate::surface::{Surface, Tile};

/// Something a frame does without, in the order of telling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Omission {
    /// Facets finer than the page shows.
    FineFacets,
    /// The pixels of chunks that cannot appear.
    Rasterizing,
    /// Samples that no chunk needs.
    Samples,
    /// Chunks of a uniform lattice beside the page.
    Chunks,
    /// The pass `seam`.
    SeamPass,
    /// The pass `border`.
    BorderPass,
    /// Tests for voids.
    VoidTests,
}

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

impl Omission {
    /// What and why.
    fn words(self) -> (&'static str, Message) {
        match self {
            Self::FineFacets => ("fine facets", "where the page does not show them".into()),
            Self::Rasterizing => ("rasterizing", "hidden by nearer land or beside the page".into()),
            Self::Samples => ("samples", "no chunk of the frame needs them".into()),
            Self::Chunks => ("chunks", "beside the page".into()),
            Self::SeamPass => ("seam pass", "all chunks have one level".into()),
            Self::BorderPass => ("border pass", Setting::Border.at("off").into()),
            Self::VoidTests => ("void tests", "the DEM has no voids".into()),
        }
    }
}

impl Frame {
    /// What it does without.
    ///
    /// # Errors
    /// As [`Surface::pyramid`].
    pub fn left_out(&self, surface: &Surface) -> Result<Vec<LeftOut>> {
        let mut left_out = Vec::new();
        for omission in &self.omissions {
            let (what, why) = omission.words();
            let saved = self.saved(*omission, surface)?;
            // Where nothing was saved, nothing was left out.
            if saved.as_ref().is_none_or(|saved| !saved.is_empty()) {
                left_out.push(LeftOut { what, why, saved });
            }
        }
        Ok(left_out)
    }

    /// Of how much something was left out: empty where of nothing, `None` where of all.
    fn saved(&self, omission: Omission, surface: &Surface) -> Result<Option<String>> {
        let (lattice, chunks) = (&self.lattice, self.lattice.chunks());
        let of = |left: usize, all: usize, what: &str| {
            Some(if left > 0 { format!("{left} of {all} {what}") } else { String::new() })
        };
        Ok(match omission {
            Omission::FineFacets => {
                let finest = chunks.iter().map(|chunk| chunk.step).min().unwrap_or(CELL_STEPS).min(CELL_STEPS);
                let uniform = surface.patches() * u64::from(CELL_STEPS / finest).pow(2);
                let saved = uniform.saturating_sub(lattice.facets(surface.dem()));
                Some(format!("{saved} of {uniform} facets of level {}", CELL_STEPS / finest))
            }
            Omission::Rasterizing => of(chunks.len() - self.seen as usize, chunks.len(), "chunks"),
            Omission::Samples => {
                let tiles: HashSet<Tile> = chunks.iter().map(Tile::of).collect();
                let of_level_1 = |samples: usize| (samples - 1).div_ceil(CHUNK_QUADS as usize);
                let all = of_level_1(surface.dem().columns()) * of_level_1(surface.dem().rows());
                of(all.saturating_sub(tiles.len()), all, "tiles of samples")
            }
            Omission::Chunks => of(self.across(surface)?.filter(|across| !across).count(), chunks.len(), "chunks"),
            Omission::SeamPass | Omission::BorderPass | Omission::VoidTests => None,
        })
    }

    /// How many chunks there are at each level, finest first: "level 4: 12, level 1/2: 30".
    pub fn levels(&self) -> String {
        let mut counts = BTreeMap::new();
        self.lattice.chunks().iter().for_each(|chunk| *counts.entry(chunk.step).or_insert(0_usize) += 1);
        let level = |step: u32| match step {
            _ if step > CELL_STEPS => format!("1/{}", step / CELL_STEPS),
            _ => (CELL_STEPS / step).to_string(),
        };
        let counts: Vec<String> = counts.into_iter().map(|(step, n)| format!("level {}: {n}", level(step))).collect();
        counts.join(", ")
    }
}
