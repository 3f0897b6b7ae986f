//! What the samples of a DEM say, kept without exaggeration: survey and overviews. A file is named by the stamp of the DEM (all
//! its files, the way of reading them, the crop):
//!
//! ```text
//! blocks of overviews | header | thinned samples | validity | index of the blocks | assumed | where the header begins,
//! hash from there
//! ```
//!
//! What is damaged is noticed: blocks when they are read, the rest at once.

use std::io::{self, BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use xxhash_rust::xxh3::Xxh3;

use super::WORDS;
use crate::cache::{CacheKey, CacheKind, KeptEntry, NewEntry, not_kept};
use crate::dem::{Band, Dem, OverviewBuilder, OverviewEntry, Overviews, Samples, Survey, SurveyBuilder, Validity};
use crate::error::{Message, Result};

/// Raise it when the survey or the overviews of the same samples come out otherwise, or when the bytes below mean something
/// else: settings stand in them by the names that they have in the code.
const FORMAT: u32 = 3;
const KIND: CacheKind = CacheKind { name: "heights", format: FORMAT, words: WORDS };

/// What stands before the thinned samples.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct Header {
    range: [f32; 2],
    voids: u64,
    marks: u64,
    patches: u64,
    thinned: u64,
    validity: u64,
    /// Bytes of what was assumed, JSON of messages, behind the index.
    assumed: u64,
}

/// The last bytes of a file.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct Footer {
    /// Where the header begins.
    header: u64,
    /// Of all bytes from there to here.
    hash: u64,
}

/// What the samples of a DEM say, not exaggerated.
pub(super) struct Heights {
    survey: Survey,
    /// None where they could not be kept.
    overviews: Option<Overviews>,
}

/// They in the making, from bands of the DEM without exaggeration.
pub(super) struct HeightsBuilder<'a> {
    dem: &'a Dem,
    survey: SurveyBuilder<'a>,
    overviews: OverviewBuilder,
    sheet: Option<NewEntry>,
}

/// What the heights of a DEM with this stamp depend on.
pub(super) fn key(dem: &Dem, stamp: u128) -> CacheKey {
    CacheKey { kind: KIND, hash: stamp, of: dem.label() }
}

/// Makes them in a look of their own.
pub(super) fn make(
    dem: &Dem,
    sheet: Option<NewEntry>,
    warn: &dyn Fn(&Message),
    progress: &dyn Fn(f64),
) -> Result<Heights> {
    let mut heights = HeightsBuilder::new(dem, sheet);
    for band in dem.bands(1) {
        let Band { rows, samples } = band?;
        let done = rows.end as f64 / dem.rows() as f64;
        heights.take(&samples, rows);
        progress(done);
    }
    // What was read of files that changed meanwhile is of neither state.
    dem.check()?;
    heights.finish(warn)
}

impl<'a> HeightsBuilder<'a> {
    /// Of a DEM without exaggeration, no row seen yet. Without a sheet there are no overviews.
    pub(super) fn new(dem: &'a Dem, sheet: Option<NewEntry>) -> Self {
        Self { dem, survey: SurveyBuilder::new(dem), overviews: OverviewBuilder::new(dem), sheet }
    }

    /// Takes the next rows, which `samples` holds with the one below them.
    pub(super) fn take(&mut self, samples: &Samples, rows: Range<usize>) {
        if let Some(sheet) = &mut self.sheet {
            self.overviews.take(samples, rows.clone(), &mut |block| sheet.write(block));
        }
        self.survey.take(samples, rows);
    }

    /// They, kept where they can be, when all rows have been taken.
    pub(super) fn finish(self, warn: &dyn Fn(&Message)) -> Result<Heights> {
        let (survey, index) = (self.survey.finish()?, self.overviews.into_index());
        let Some(mut sheet) = self.sheet else { return Ok(Heights { survey, overviews: None }) };
        let key = sheet.key().clone();
        finish(&mut sheet, &survey, &index);
        let overviews = match sheet.publish() {
            Ok(KeptEntry { file, path, .. }) => Overviews::new(self.dem, &path, file, index),
            Err(error) => {
                warn(&not_kept(&key, &error));
                None
            }
        };
        Ok(Heights { survey, overviews })
    }
}

impl Heights {
    /// Gives them to their DEM, which may be exaggerated.
    pub(super) fn give(self, dem: &Dem) {
        dem.remember(self.survey);
        self.overviews.into_iter().for_each(|overviews| dem.remember_overviews(overviews));
    }
}

/// Writes what follows the blocks.
fn finish(sheet: &mut NewEntry, survey: &Survey, index: &[OverviewEntry]) {
    let Survey { range, voids, marks, assumed, patches, thinned, validity } = survey;
    // Words are always JSON; a file without them is damaged, and made anew.
    let assumed = serde_json::to_vec(assumed).unwrap_or_default();
    let header = Header {
        range: range.unwrap_or([1.0, 0.0]),
        voids: *voids as u64,
        marks: *marks as u64,
        patches: *patches,
        thinned: thinned.len() as u64,
        validity: validity.words().len() as u64,
        assumed: assumed.len() as u64,
    };
    let begin = sheet.bytes();
    let mut hash = Xxh3::new();
    let mut write = |bytes: &[u8]| {
        hash.update(bytes);
        sheet.write(bytes);
    };
    write(bytemuck::bytes_of(&header));
    write(bytemuck::cast_slice(thinned));
    write(bytemuck::cast_slice(validity.words()));
    write(bytemuck::cast_slice(index));
    write(&assumed);
    let footer = Footer { header: begin, hash: hash.digest() };
    sheet.write(bytemuck::bytes_of(&footer));
}

/// Reads what was kept. Fails where the bytes are not those that were written.
pub(super) fn recall(dem: &Dem, KeptEntry { file, bytes: size, path }: KeptEntry) -> io::Result<Heights> {
    let damaged = || io::Error::from(ErrorKind::InvalidData);
    let mut file = BufReader::new(file);
    file.seek(SeekFrom::Start(size.checked_sub(size_of::<Footer>() as u64).ok_or_else(damaged)?))?;
    let mut footer = Footer::zeroed();
    file.read_exact(bytemuck::bytes_of_mut(&mut footer))?;
    file.seek(SeekFrom::Start(footer.header))?;
    let mut hash = Xxh3::new();
    let mut fill = |bytes: &mut [u8]| {
        file.read_exact(bytes)?;
        hash.update(bytes);
        Ok::<_, io::Error>(())
    };
    let mut header = Header::zeroed();
    fill(bytemuck::bytes_of_mut(&mut header))?;
    let Header { range, voids, marks, patches, thinned, validity, assumed } = header;
    if thinned.max(validity) > size / size_of::<f32>() as u64 || assumed > size {
        return Err(damaged());
    }
    let mut thinned = vec![0.0; thinned as usize];
    fill(bytemuck::cast_slice_mut(&mut thinned))?;
    let mut valid = vec![0; validity as usize];
    fill(bytemuck::cast_slice_mut(&mut valid))?;
    let mut index = vec![OverviewEntry::zeroed(); Overviews::blocks(dem)];
    fill(bytemuck::cast_slice_mut(&mut index))?;
    let mut words = vec![0; assumed as usize];
    fill(&mut words)?;
    if hash.digest() != footer.hash {
        return Err(damaged());
    }
    let range = Some(range).filter(|[low, high]| low <= high);
    let overviews = Overviews::new(dem, &path, file.into_inner(), index).ok_or_else(damaged)?;
    let validity = Validity::from_words(dem, valid).ok_or_else(damaged)?;
    let assumed = serde_json::from_slice(&words).map_err(|_| damaged())?;
    let survey = Survey { range, voids: voids as usize, marks: marks as usize, assumed, patches, thinned, validity };
    Ok(Heights { survey, overviews: Some(overviews) })
}
