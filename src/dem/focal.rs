//! Heights that depend on those around them: tiles of a grid, changed by what works on a window with a halo.
//!
//! Cost: a tile is read with its halo, so tiles are larger than those of the grid; the grid's own are kept while they fit,
//! so that none is read anew for each halo it lies in. Memory: a quarter of the budget, a tile with its halo a thread.

use std::fmt::Debug;
use std::sync::Arc;

use xxhash_rust::xxh3::xxh3_128;

use super::filed::Filed;
use super::tiles::Tiles;
use super::tiling::{Tiling, copy};
use super::window::Window;
use crate::error::{Error, Message, Result};

/// Shortest side of a tile in halos: then no more than 2 1/4 samples are worked on for one.
const HALOS: usize = 4;

/// Work on heights that looks at those around.
///
/// A height must come out the same, bit for bit, whatever window is worked on, with the halo around it: fewer samples only
/// at the grid's own edge.
pub trait Focal: Debug + Send + Sync {
    /// Samples around a window on which the heights in it depend.
    fn halo(&self) -> usize;

    /// Changes metres, row-major, NaN at voids, of a window of the grid, its halo included. Not parallel: others wait for it.
    ///
    /// # Errors
    /// [`Error::Input`] when something must be read and cannot.
    fn apply(&self, heights: &mut [f32], window: Window) -> Result<()>;

    /// What tells this work from any other.
    fn stamp(&self) -> u128;
}

/// Tiles with work done on them.
#[derive(Debug)]
pub(crate) struct Worked<F> {
    of: Filed,
    by: F,
}

impl<F: Focal> Worked<F> {
    /// All of `tiles`; half of `budget` bytes is for those who keep what comes of them.
    pub fn new(tiles: Arc<dyn Tiles>, by: F, budget: usize) -> Self {
        Self { of: Filed::new(tiles, 1.0, budget / 2), by }
    }
}

impl<F: Focal> Tiles for Worked<F> {
    fn size(&self) -> [usize; 2] {
        self.of.tiles().size()
    }

    fn tiling(&self) -> Tiling {
        self.of.tiles().tiling().at_least(HALOS * self.by.halo())
    }

    fn is_parallel(&self) -> bool {
        self.of.is_parallel()
    }

    fn read(&self, window: Window) -> Result<Vec<f32>> {
        let around = window.with_halo(self.by.halo(), self.size());
        let mut heights = self.of.read_alone(around)?;
        self.by.apply(&mut heights, around)?;
        let mut inside = vec![f32::NAN; window.samples() as usize];
        copy(around, &heights, window, &mut inside);
        Ok(inside)
    }

    fn stamp(&self) -> Option<u128> {
        let of = self.of.tiles().stamp()?;
        Some(xxh3_128(bytemuck::bytes_of(&[of, self.by.stamp()])))
    }

    fn check(&self) -> Result<()> {
        self.of.check()
    }

    fn marks(&self) -> usize {
        self.of.tiles().marks()
    }

    fn assumed(&self) -> Vec<Message> {
        self.of.tiles().assumed()
    }

    fn all_void(&self) -> Error {
        self.of.tiles().all_void()
    }
}
