//! The smoothest surface within the steps of a DEM's files, in the place of the stairs that they hold.
//!
//! What must be known of all samples before the first is given are the steps and the flat water, which stays as it is. A DEM
//! that is held is looked at as it is read; one that stays in its files takes a look of its own, which the cache keeps. Cost
//! of that look: all samples once; nothing where the first numbers of float files show that there is no step.

use std::io::{self, ErrorKind, Read};
use std::sync::Arc;

use xxhash_rust::xxh3::{Xxh3, xxh3_128};

use super::part::Part;
use super::steps::Steps;
use crate::cache::{CacheKey, CacheKind, KeptEntry, NewEntry};
use crate::dem::Window;
use crate::dem::focal::Focal;
use crate::dem::smoothest::{HALO, smoothest};
use crate::dem::water::Water;
use crate::error::Result;

/// Raise it when the same numbers have other steps, other water or another smoothest surface, or when the bytes below mean
/// something else.
const FORMAT: u32 = 1;
/// The look in the cache.
const KIND: CacheKind =
    CacheKind { name: "steps", format: FORMAT, words: ["what was found of steps", "what was kept of steps"] };

/// What is known of the steps of a DEM.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Smoothing {
    pub steps: Steps,
    pub water: Water,
}

/// A part of a DEM whose samples are smoothed as they are read.
#[derive(Debug)]
pub(super) struct Smoothed {
    pub part: Arc<Part>,
    pub smoothing: Smoothing,
}

impl Smoothing {
    /// Makes the heights of a window of `part` the smoothest within their steps; the window's halo is part of it.
    pub(super) fn smooth(&self, part: &Part, heights: &mut [f32], window: Window, parallel: bool) -> Result<()> {
        let mut half = match self.steps.common_half() {
            Some(half) => vec![half; heights.len()],
            None => part.halves(&self.steps, window)?,
        };
        self.water.level(window, &mut half);
        smoothest(heights, &half, window, parallel);
        Ok(())
    }
}

impl Focal for Smoothed {
    fn halo(&self) -> usize {
        HALO
    }

    fn apply(&self, heights: &mut [f32], window: Window) -> Result<()> {
        self.smoothing.smooth(&self.part, heights, window, false)
    }

    /// Water follows from the steps and the samples.
    fn stamp(&self) -> u128 {
        xxh3_128(format!("smoothest {FORMAT} {:?}", self.smoothing.steps).as_bytes())
    }
}

/// What the look at a DEM with this stamp depends on.
pub(super) fn key(stamp: u128, of: String) -> CacheKey {
    CacheKey { kind: KIND, hash: stamp, of }
}

/// Writes what was found, that there are no steps too, and a hash of it.
pub(super) fn keep(found: Option<&Smoothing>, mut sheet: NewEntry) {
    let (steps, (rows, runs)) = found.map_or_else(Default::default, |found| {
        let metres: &[f64] = found.steps.metres();
        (metres, found.water.parts())
    });
    let counts = [steps.len(), rows.len(), runs.len()].map(|count| count as u64);
    let mut hash = Xxh3::new();
    for bytes in [
        bytemuck::cast_slice(&counts),
        bytemuck::cast_slice(steps),
        bytemuck::cast_slice(rows),
        bytemuck::cast_slice(runs),
    ] {
        hash.update(bytes);
        sheet.write(bytes);
    }
    sheet.write(&hash.digest().to_le_bytes());
    // Where nothing can be kept, those who keep more tell so.
    let _ = sheet.publish();
}

/// Reads what was kept. Fails where the bytes are not those that were written.
pub(super) fn recall(KeptEntry { mut file, bytes, .. }: KeptEntry) -> io::Result<Option<Smoothing>> {
    let damaged = || io::Error::from(ErrorKind::InvalidData);
    let mut hash = Xxh3::new();
    let mut fill = |bytes: &mut [u8]| {
        file.read_exact(bytes)?;
        hash.update(bytes);
        Ok::<_, io::Error>(())
    };
    let mut counts = [0_u64; 3];
    fill(bytemuck::cast_slice_mut(&mut counts))?;
    if counts.iter().any(|count| *count > bytes) {
        return Err(damaged());
    }
    let mut steps = vec![0.0; counts[0] as usize];
    fill(bytemuck::cast_slice_mut(&mut steps))?;
    let mut rows = vec![0; counts[1] as usize];
    fill(bytemuck::cast_slice_mut(&mut rows))?;
    let mut runs = vec![[0; 2]; counts[2] as usize];
    fill(bytemuck::cast_slice_mut(&mut runs))?;
    let mut written = [0; size_of::<u64>()];
    file.read_exact(&mut written)?;
    if u64::from_le_bytes(written) != hash.digest() {
        return Err(damaged());
    }
    let water = Water::from_parts(rows, runs).ok_or_else(damaged)?;
    Ok((!steps.is_empty()).then(|| Smoothing { steps: Steps::from_metres(steps), water }))
}
