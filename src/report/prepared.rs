//! What takes a look at every sample of a DEM that stays in its file, kept on disk beside truths: its survey and its
//! pyramid. A second view of the same file starts from them.
//!
//! A file is named by the stamp of the DEM (its files, their times and sizes, the crop, the exaggeration) and the code that
//! makes it, and ends with a hash of its bytes.

use std::fs;
use std::path::Path;

use bytemuck::{Pod, Zeroable};
use xxhash_rust::xxh3::{xxh3_64, xxh3_128};

use super::cache::{Cache, write_file};
use crate::dem::{Dem, Survey};
use crate::error::Result;
use crate::surface::{Pyramid, Surface};

/// The code that the content depends on: when it changes, older files are no longer found.
const CODE: &str = concat!(
    include_str!("prepared.rs"),
    include_str!("../dem/survey.rs"),
    include_str!("../surface/normals.rs"),
    include_str!("../surface/patch.rs"),
    include_str!("../surface/pyramid.rs"),
);

/// What stands before the thinned samples and the pyramid.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct Header {
    range: [f32; 2],
    /// 0 where all samples are void and there is no range.
    has_range: u32,
    pad: u32,
    voids: u64,
    marks: u64,
    patches: u64,
    thinned: u64,
}

impl Cache {
    /// Gives a surface over a DEM in its file what is kept of it, or makes and keeps it: of 400 million samples minutes
    /// against seconds. Other DEMs need nothing. `warn` hears of a damaged file and of a folder that cannot be written,
    /// `progress` the share done.
    ///
    /// # Errors
    /// As [`Dem::survey`] and [`Pyramid::new`].
    pub fn prepare(&self, surface: &Surface, warn: &dyn Fn(&str), progress: &dyn Fn(f64)) -> Result<()> {
        let dem = surface.dem();
        let Some(path) = dem.stamp().and_then(|stamp| self.path(&name(stamp))) else { return Ok(()) };
        if let Ok(bytes) = fs::read(&path) {
            match from_bytes(dem, &bytes) {
                Some((survey, pyramid)) => {
                    dem.remember(survey);
                    surface.remember(pyramid);
                    return Ok(());
                }
                None => warn("what was kept of the DEM is damaged: it is made anew"),
            }
        }
        let survey = dem.survey(&|done| progress(done / 4.0))?.clone();
        keep(&path, &survey, surface.pyramid()?, warn);
        Ok(())
    }
}

fn name(stamp: u128) -> String {
    let code = xxh3_128([env!("CARGO_PKG_VERSION"), CODE].concat().as_bytes());
    format!("pyramid-{:032x}", stamp ^ code)
}

fn keep(path: &Path, survey: &Survey, pyramid: &Pyramid, warn: &dyn Fn(&str)) {
    let Survey { range, voids, marks, patches, thinned } = survey;
    let header = Header {
        range: range.unwrap_or_default(),
        has_range: range.is_some().into(),
        pad: 0,
        voids: *voids as u64,
        marks: *marks as u64,
        patches: *patches,
        thinned: thinned.len() as u64,
    };
    let mut bytes = [bytemuck::bytes_of(&header), bytemuck::cast_slice(thinned)].concat();
    bytes.extend(pyramid.to_bytes());
    bytes.extend(xxh3_64(&bytes).to_le_bytes());
    if let Err(error) = write_file(path, &bytes) {
        warn(&format!("the pyramid is not cached: {error}"));
    }
}

/// `None` where the bytes are not those that were written.
fn from_bytes(dem: &Dem, bytes: &[u8]) -> Option<(Survey, Pyramid)> {
    let (content, sum) = bytes.split_last_chunk::<8>()?;
    if xxh3_64(content) != u64::from_le_bytes(*sum) {
        return None;
    }
    let (header, rest) = content.split_at_checked(size_of::<Header>())?;
    let Header { range, has_range, voids, marks, patches, thinned, .. } = bytemuck::pod_read_unaligned(header);
    let (thinned, pyramid) = rest.split_at_checked(thinned as usize * size_of::<f32>())?;
    let survey = Survey {
        range: (has_range != 0).then_some(range),
        voids: voids as usize,
        marks: marks as usize,
        patches,
        thinned: bytemuck::pod_collect_to_vec(thinned),
    };
    Some((survey, Pyramid::from_bytes(dem, pyramid)?))
}
