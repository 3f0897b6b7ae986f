//! What takes a look at every sample of a DEM that stays in its file, kept on disk beside truths: its survey, its
//! pyramid and its overviews. A second view of the same file starts from them.
//!
//! All three are made in one look at the samples, band by band, of the DEM without exaggeration, which is multiplied in when
//! they are used: the same heights as everywhere, and bounds as loose as without a cache. A file is named by the stamp of the
//! DEM (all its files, the way of reading them, the crop) and a number for what its bytes mean:
//!
//! ```text
//! blocks of overviews | header | thinned samples | validity | index of the blocks | pyramid | assumed | where the header begins,
//! hash from there
//! ```
//!
//! What is damaged is noticed: blocks when they are read, the rest at once.

use std::io::{self, BufReader, ErrorKind, Read, Seek, SeekFrom};

use bytemuck::{Pod, Zeroable};
use xxhash_rust::xxh3::Xxh3;

use crate::cache::{Cache, Hearing, Kept, Key, Kind, Sheet, not_kept};
use crate::dem::{Dem, Entry, OverviewBuilder, Overviews, Survey, SurveyBuilder, Validity};
use crate::error::Result;
use crate::surface::{Pyramid, PyramidBuilder, Surface, SurfaceBand};

/// Raise it when the survey, the pyramid or the overviews of the same samples come out otherwise, or when the bytes below
/// mean something else.
const FORMAT: u32 = 1;
const KIND: Kind =
    Kind { name: "prepared", format: FORMAT, words: ["what was made of the DEM", "what was kept of the DEM"] };

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
    /// Bytes of what was assumed, a line each, behind the pyramid.
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

/// What was made of a DEM, none of it exaggerated.
struct Prepared {
    survey: Survey,
    pyramid: Pyramid,
    overviews: Option<Overviews>,
}

impl Cache {
    /// Gives a surface over a DEM in its file what is kept of it, or makes and keeps it: of 400 million samples a minute
    /// against a tenth of a second. Other DEMs need nothing. `warn` hears of a damaged file and of a folder that cannot be
    /// written, `progress` the share done, by this process or by another that is making the same.
    ///
    /// # Errors
    /// As [`Dem::survey`] and [`Pyramid::new`]; where a file of the DEM changed meanwhile, as [`Dem::check`].
    pub fn prepare(&self, surface: &Surface, warn: &dyn Fn(&str), progress: &dyn Fn(f64)) -> Result<()> {
        let dem = surface.dem();
        let Some(key) = self.folder().and_then(|_| key(dem)) else { return Ok(()) };
        let plain = dem.plain().map(|(plain, exaggeration)| (Surface::new(plain), exaggeration));
        let source = plain.as_ref().map_or(surface, |(plain, _)| plain);
        let made = self.get(
            &key,
            Hearing { warn, progress },
            |kept| recall(dem, kept),
            |sheet, progress| make(source, sheet, warn, progress),
        )?;
        dem.remember(made.survey);
        made.overviews.into_iter().for_each(|overviews| dem.remember_overviews(overviews));
        surface.remember(match plain {
            Some((_, exaggeration)) => made.pyramid.exaggerated(exaggeration),
            None => made.pyramid,
        });
        Ok(())
    }

    /// Removes what is kept of a DEM whose overviews turned out damaged, so that it is made anew next time. Nothing is wrong
    /// with what was drawn: it took the samples themselves. `warn` hears of it.
    pub fn discard_damaged(&self, dem: &Dem, warn: &dyn Fn(&str)) {
        if let Some(key) = key(dem).filter(|_| self.folder().is_some() && dem.has_damaged_overviews()) {
            warn(&format!("{} is damaged: it is made anew next time", KIND.words[1]));
            self.remove(&key);
        }
    }
}

fn key(dem: &Dem) -> Option<Key> {
    dem.stamp().map(|hash| Key { kind: KIND, hash, of: dem.label() })
}

/// Makes survey, pyramid and overviews of a surface and writes them where they are kept; without that there are no
/// overviews.
fn make(surface: &Surface, mut sheet: Option<Sheet>, warn: &dyn Fn(&str), progress: &dyn Fn(f64)) -> Result<Prepared> {
    let dem = surface.dem();
    let (mut survey, mut pyramid) = (SurveyBuilder::new(dem), PyramidBuilder::new(dem));
    let mut overviews = OverviewBuilder::new(dem);
    for band in surface.bands(PyramidBuilder::HALO) {
        let band = band?;
        pyramid.take(&band)?;
        let SurfaceBand { rows, surface: part } = band;
        let samples = part.dem().held()?;
        if let Some(sheet) = &mut sheet {
            overviews.take(samples, rows.clone(), &mut |block| sheet.write(block));
        }
        survey.take(samples, rows.clone());
        progress(rows.end as f64 / dem.rows() as f64);
    }
    // What was read of files that changed meanwhile is of neither state.
    dem.check()?;
    let (survey, pyramid, index) = (survey.finish()?, pyramid.finish(), overviews.into_index());
    let Some(mut sheet) = sheet else { return Ok(Prepared { survey, pyramid, overviews: None }) };
    let key = sheet.key().clone();
    finish(&mut sheet, &survey, &index, &pyramid);
    let overviews = match sheet.publish() {
        Ok(Kept { file, path, .. }) => Overviews::new(dem, &path, file, index),
        Err(error) => {
            warn(&not_kept(&key, &error));
            None
        }
    };
    Ok(Prepared { survey, pyramid, overviews })
}

/// Writes what follows the blocks.
fn finish(sheet: &mut Sheet, survey: &Survey, index: &[Entry], pyramid: &Pyramid) {
    let Survey { range, voids, marks, assumed, patches, thinned, validity } = survey;
    let assumed = assumed.join("\n");
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
    pyramid.bytes().for_each(&mut write);
    write(assumed.as_bytes());
    let footer = Footer { header: begin, hash: hash.digest() };
    sheet.write(bytemuck::bytes_of(&footer));
}

/// Reads what was kept. Fails where the bytes are not those that were written.
fn recall(dem: &Dem, Kept { file, bytes: size, path }: Kept) -> io::Result<Prepared> {
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
    let mut index = vec![Entry::zeroed(); Overviews::blocks(dem)];
    fill(bytemuck::cast_slice_mut(&mut index))?;
    let pyramid = Pyramid::from_bytes(dem, &mut fill)?;
    let mut words = vec![0; assumed as usize];
    fill(&mut words)?;
    if hash.digest() != footer.hash {
        return Err(damaged());
    }
    let range = Some(range).filter(|[low, high]| low <= high);
    let overviews = Overviews::new(dem, &path, file.into_inner(), index).ok_or_else(damaged)?;
    let validity = Validity::from_words(dem, valid).ok_or_else(damaged)?;
    let assumed = String::from_utf8(words).map_err(|_| damaged())?.lines().map(str::to_owned).collect();
    let survey = Survey { range, voids: voids as usize, marks: marks as usize, assumed, patches, thinned, validity };
    Ok(Prepared { survey, pyramid, overviews: Some(overviews) })
}
