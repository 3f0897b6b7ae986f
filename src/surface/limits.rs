//! Tangents limited, so that no patch folds.
//!
//! Method: where a patch [folds](super::folds), or a facet of it at any level, the gradients of its three samples are made less by a
//! quarter, and so again, with the patches about samples that were changed, until none does. It ends, for a patch whose corners are
//! level stands over its flat triangle; a share under 1/64 is none. What has no such sample stays as it is, bit for bit.
//!
//! Since it is normals that change, and a sample has one, the surface stays without cracks, and everything that looks at it sees
//! the same one: the device, truth, bounds, lines on the land.
//!
//! Limits depend on the whole DEM, for one patch may lead to the next. They are found once, of a DEM in its files too, of which
//! only blocks with patches that bend are read. Cost: some rounds over the patches about changed samples, 0.3 us each; memory: 20
//! bytes a changed sample.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::{DVec2, DVec3};
use xxhash_rust::xxh3::Xxh3;

use super::folds::{Cells, Ground, PatchAt};
use super::patch::Surface;
use crate::error::{Error, Result, Setting};
use crate::message;

/// What a round leaves of a gradient.
const PER_ROUND: f32 = 0.75;
/// A share that is less is none.
const LEAST: f32 = 1.0 / 64.0;
/// Samples that may be changed: 320 MiB.
const MOST: usize = 1 << 24;
/// Subdivisions of the patches at whose vertices it is measured how far the surface moves.
const LOOKED: u32 = 4;

/// What share of its gradient is left to a sample, by its row and column; the others keep theirs.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Limits(BTreeMap<[u32; 2], f32>);

/// How far limits move vertices of the surface, those of level 4, metres of the exaggerated world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moved {
    /// Samples whose tangents are limited.
    pub samples: usize,
    /// Patches that have one of them.
    pub patches: usize,
    /// Up or down, the most.
    pub most: f64,
    /// Up or down, the mean over those patches.
    pub mean: f64,
    /// On the map, the most.
    pub aside: f64,
}

impl Limits {
    /// Of a surface, as few and as little as the method finds.
    ///
    /// # Errors
    /// As [`Surface::folds`]; [`Error::Limit`] where too many samples would change.
    pub(super) fn of(surface: &Surface) -> Result<Self> {
        let (mut limits, cell) = (Self::default(), surface.dem.cell());
        let folding = |part: &Surface, at: PatchAt, limits: &Self| {
            let ground = Ground::of(&part.patch(at, |sample| limits.gradient(part, sample)), cell);
            (!ground.is_upright()).then(|| at.corners())
        };
        let mut found = surface.look(surface.bent()?, |part, at| folding(part, at, &limits))?;
        while !found.is_empty() {
            let mut samples = found.concat();
            samples.sort_unstable();
            samples.dedup();
            samples.iter().for_each(|sample| limits.lower(*sample));
            if limits.0.len() > MOST {
                let what = format!("patches fold about more than {MOST} samples");
                return Err(Error::limit(what, message!["use a ", Setting::Crop, " or less ", Setting::Exaggeration]));
            }
            found = surface.look(about(&samples), |part, at| folding(part, at, &limits))?;
        }
        Ok(limits)
    }

    /// Whether nothing is limited.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Columns of a row among these, with what is left of their gradients.
    pub(super) fn of_row(&self, r: usize, columns: Range<usize>) -> impl Iterator<Item = (usize, f32)> {
        let [first, end] = [columns.start, columns.end].map(|c| [r as u32, c as u32]);
        self.0.range(first..end).map(|([_, c], share)| (*c as usize, *share))
    }

    /// Adds them to the hash of what depends on the surface; nothing where there are none.
    pub(crate) fn identify(&self, hash: &mut Xxh3) {
        for ([r, c], share) in &self.0 {
            hash.update(bytemuck::cast_slice(&[*r, *c, share.to_bits()]));
        }
    }

    fn lower(&mut self, sample: [u32; 2]) {
        let share = self.0.entry(sample).or_insert(1.0);
        *share = if *share * PER_ROUND < LEAST { 0.0 } else { *share * PER_ROUND };
    }

    /// The gradient of a sample of a surface without limits, limited as gradients in memory are.
    fn gradient(&self, surface: &Surface, sample: [u32; 2]) -> DVec2 {
        let gradient = surface.gradient_at(sample);
        self.0.get(&sample).map_or(gradient, |share| (gradient.as_vec2() * *share).as_dvec2())
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Surface {
    /// How far its limits move it; `None` where it has none.
    ///
    /// # Errors
    /// As [`Surface::part`].
    pub fn moved(&self) -> Result<Option<Moved>> {
        let limits = self.limits();
        if limits.is_empty() {
            return Ok(None);
        }
        let samples: Vec<[u32; 2]> = limits.0.keys().copied().collect();
        let moved = self.look(about(&samples), |part, at| {
            let is_limited = at.corners().iter().any(|sample| limits.0.contains_key(sample));
            is_limited.then(|| moved(part, at))
        })?;
        let moved = moved.into_iter().collect::<Result<Vec<_>>>()?;
        let most = |of: fn(&[f64; 3]) -> f64| moved.iter().map(of).fold(0.0, f64::max);
        Ok(Some(Moved {
            samples: samples.len(),
            patches: moved.len(),
            most: most(|[most, ..]| *most),
            mean: moved.iter().map(|[_, mean, _]| *mean).sum::<f64>() / moved.len().max(1) as f64,
            aside: most(|[.., aside]| *aside),
        }))
    }
}

/// How far limits move the vertices of a patch: up or down at most and on average, and aside at most, metres.
fn moved(surface: &Surface, at: PatchAt) -> Result<[f64; 3]> {
    let [r, c] = at.cell.map(|at| at as usize);
    let before = surface.part_without_limits([c, r], [2, 2])?;
    let [now, before] = [surface, &before].map(|of| of.patch(at, |sample| of.gradient_at(sample)));
    let vertices = (0..=LOOKED).flat_map(|j| (0..=LOOKED - j).map(move |k| [LOOKED - j - k, j, k]));
    let ways = vertices.map(|weights| {
        let weights = weights.map(|weight| f64::from(weight) / f64::from(LOOKED));
        now.point(weights) - before.point(weights)
    });
    let ways: Vec<DVec3> = ways.collect();
    let most = |of: fn(&DVec3) -> f64| ways.iter().map(of).fold(0.0, f64::max);
    let mean = ways.iter().map(|way| way.z.abs()).sum::<f64>() / ways.len() as f64;
    Ok([most(|way| way.z.abs()), mean, most(|way| way.truncate().length())])
}

/// The cells about samples, each once.
fn about(samples: &[[u32; 2]]) -> Vec<Cells> {
    let around = |[r, c]: &[u32; 2]| {
        [[1, 1], [1, 0], [0, 1], [0, 0]].map(|[up, left]| Some([r.checked_sub(up)?, c.checked_sub(left)?]))
    };
    let mut cells: Vec<[u32; 2]> = samples.iter().flat_map(around).flatten().collect();
    cells.sort_unstable();
    cells.dedup();
    cells.into_iter().map(Cells::one).collect()
}
