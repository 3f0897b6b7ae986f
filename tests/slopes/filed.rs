//! Lines of a DEM that stays in its file are those of the same samples in memory.

use std::sync::Arc;

use hachure::dem::{Dem, Tiles, Tiling, Window};
use hachure::door::relief::slope::Slopes;
use hachure::error::{Error, Message, Result};
use hachure::surface::Surface;

use super::{RULES, Scene, blocks, sample};

/// Samples as a file's.
#[derive(Debug)]
struct File(Dem);

impl Tiles for File {
    fn size(&self) -> [usize; 2] {
        [self.0.columns(), self.0.rows()]
    }

    fn tiling(&self) -> Tiling {
        Tiling::whole([64, 64], self.size())
    }

    fn is_parallel(&self) -> bool {
        true
    }

    fn read(&self, Window { first, size }: Window) -> Result<Vec<f32>> {
        let samples = self.0.window(first, size)?;
        let rows = first[1]..first[1] + size[1];
        Ok(rows
            .flat_map(|r| samples.row_from(first[0], r).map(|height| height.unwrap_or(f32::NAN)).collect::<Vec<_>>())
            .collect())
    }

    fn stamp(&self) -> Option<u128> {
        None
    }

    fn check(&self) -> Result<()> {
        Ok(())
    }

    fn marks(&self) -> usize {
        0
    }

    fn assumed(&self) -> Vec<Message> {
        Vec::new()
    }

    fn all_void(&self) -> Error {
        Error::limit("all void", "give others")
    }
}

#[test]
fn lines_of_a_file_are_those_of_its_samples() {
    let scene: Scene = sample();
    let held = scene.surface.dem();
    let origin = held.position(0, 0).truncate();
    let filed = Dem::from_tiles(Arc::new(File(held.clone())), held.cell(), origin, 1.0, 1 << 20);
    assert!(filed.is_filed());
    let slopes =
        Slopes::new(Arc::new(Surface::new(filed)), 1.0, RULES, &scene.stops, Some(&scene.water)).expect("slopes");
    let need = |_: [glam::DVec3; 2]| 4.0 * scene.unit();
    let (of_file, of_samples) = (blocks(&slopes, &need), blocks(&scene.slopes(), &need));
    assert!(!of_samples.is_empty() && of_file == of_samples);
}
