//! What takes a look at every sample of a DEM that stays in its file, kept on disk beside truths: its survey, its
//! pyramid and its overviews. A second view of the same file starts from them.
//!
//! All three are made in one look at the samples, band by band. A file is named by the stamp of the DEM (its files, their
//! times and sizes, the crop, the exaggeration) and the code that makes it:
//!
//! ```text
//! blocks of overviews | header | thinned samples | validity | index of the blocks | pyramid | assumed | where the header begins,
//! hash from there
//! ```
//!
//! What is damaged is noticed: blocks when they are read, the rest at once.

use std::fs::{self, File};
use std::io::{self, BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use bytemuck::{Pod, Zeroable};
use xxhash_rust::xxh3::{Xxh3, xxh3_128};

use super::cache::{Cache, create};
use crate::dem::{Dem, Entry, OverviewBuilder, Overviews, Survey, SurveyBuilder, Validity};
use crate::error::Result;
use crate::ink::Output;
use crate::surface::{Pyramid, PyramidBuilder, Surface, SurfaceBand};

/// The code that the content depends on: when it changes, older files are no longer found.
const CODE: &str = concat!(
    include_str!("prepared.rs"),
    include_str!("../dem/filed.rs"),
    include_str!("../dem/overviews.rs"),
    include_str!("../dem/samples.rs"),
    include_str!("../dem/survey.rs"),
    include_str!("../dem/validity.rs"),
    include_str!("../surface/bounds.rs"),
    include_str!("../surface/lattice.rs"),
    include_str!("../surface/normals.rs"),
    include_str!("../surface/patch.rs"),
    include_str!("../surface/pyramid.rs"),
    include_str!("../surface/slopes.rs"),
);

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

impl Cache {
    /// Gives a surface over a DEM in its file what is kept of it, or makes and keeps it: of 400 million samples a minute
    /// against a tenth of a second. Other DEMs need nothing. `warn` hears of a damaged file and of a folder that cannot be
    /// written, `progress` the share done.
    ///
    /// # Errors
    /// As [`Dem::survey`] and [`Pyramid::new`].
    pub fn prepare(&self, surface: &Surface, warn: &dyn Fn(&str), progress: &dyn Fn(f64)) -> Result<()> {
        let Some(path) = self.path_of(surface.dem()) else { return Ok(()) };
        if let Ok(file) = File::open(&path) {
            match recall(surface, &path, file) {
                Ok(()) => return Ok(()),
                Err(_) => warn("what was kept of the DEM is damaged: it is made anew"),
            }
        }
        if let Err(error) = make(surface, &path, progress)? {
            warn(&format!("what was made of the DEM is not cached: {error}"));
        }
        Ok(())
    }

    /// Removes what is kept of a DEM whose overviews turned out damaged, so that it is made anew next time. Nothing is wrong
    /// with what was drawn: it took the samples themselves. `warn` hears of it.
    pub fn discard_damaged(&self, dem: &Dem, warn: &dyn Fn(&str)) {
        if let Some(path) = self.path_of(dem).filter(|_| dem.has_damaged_overviews()) {
            warn("what was kept of the DEM is damaged: it is made anew next time");
            // One that cannot be removed is found damaged again.
            let _ = fs::remove_file(path);
        }
    }

    fn path_of(&self, dem: &Dem) -> Option<PathBuf> {
        let code = xxh3_128([env!("CARGO_PKG_VERSION"), CODE].concat().as_bytes());
        dem.stamp().and_then(|stamp| self.path(&format!("prepared-{:032x}", stamp ^ code)))
    }
}

/// A file as it is written; the first error ends it.
struct Sheet {
    output: Result<Output>,
    hash: Xxh3,
    bytes: u64,
}

impl Sheet {
    fn write(&mut self, bytes: &[u8]) {
        self.hash.update(bytes);
        self.bytes += bytes.len() as u64;
        if let Ok(output) = &mut self.output
            && let Err(error) = output.write(|file| file.write_all(bytes))
        {
            self.output = Err(error);
        }
    }
}

/// Makes survey, pyramid and overviews of a surface and keeps them in a file. Fails where the samples cannot be read; the
/// inner error is that of the file, without which the surface has no overviews.
fn make(surface: &Surface, path: &Path, progress: &dyn Fn(f64)) -> Result<Result<()>> {
    let dem = surface.dem();
    let mut sheet = Sheet { output: create(path), hash: Xxh3::new(), bytes: 0 };
    let (mut survey, mut pyramid) = (SurveyBuilder::new(dem), PyramidBuilder::new(dem));
    let mut overviews = OverviewBuilder::new(dem);
    for band in surface.bands(PyramidBuilder::HALO) {
        let band = band?;
        pyramid.take(&band)?;
        let SurfaceBand { rows, surface: part } = band;
        let samples = part.dem().held()?;
        overviews.take(samples, rows.clone(), &mut |block| sheet.write(block));
        survey.take(samples, rows.clone());
        progress(rows.end as f64 / dem.rows() as f64);
    }
    let (survey, pyramid, index) = (survey.finish()?, pyramid.finish(), overviews.into_index());
    sheet.finish(&survey, &index, &pyramid);
    dem.remember(survey);
    surface.remember(pyramid);
    let published = sheet.output.and_then(Output::publish);
    if let (Ok(()), Ok(file)) = (&published, File::open(path)) {
        Overviews::new(dem, path, file, index).into_iter().for_each(|overviews| dem.remember_overviews(overviews));
    }
    Ok(published)
}

impl Sheet {
    /// Writes what follows the blocks.
    fn finish(&mut self, survey: &Survey, index: &[Entry], pyramid: &Pyramid) {
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
        let begin = self.bytes;
        self.hash.reset();
        self.write(bytemuck::bytes_of(&header));
        self.write(bytemuck::cast_slice(thinned));
        self.write(bytemuck::cast_slice(validity.words()));
        self.write(bytemuck::cast_slice(index));
        pyramid.bytes().for_each(|bytes| self.write(bytes));
        self.write(assumed.as_bytes());
        let footer = Footer { header: begin, hash: self.hash.digest() };
        self.write(bytemuck::bytes_of(&footer));
    }
}

/// Reads what was kept. Fails where the bytes are not those that were written.
fn recall(surface: &Surface, path: &Path, file: File) -> io::Result<()> {
    let (dem, damaged) = (surface.dem(), || io::Error::from(ErrorKind::InvalidData));
    let size = file.metadata()?.len();
    let mut file = BufReader::new(file);
    file.seek(SeekFrom::End(-(size_of::<Footer>() as i64)))?;
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
    if thinned.max(validity).max(assumed) > size {
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
    let overviews = Overviews::new(dem, path, file.into_inner(), index).ok_or_else(damaged)?;
    let validity = Validity::from_words(dem, valid).ok_or_else(damaged)?;
    let assumed = String::from_utf8(words).map_err(|_| damaged())?.lines().map(str::to_owned).collect();
    dem.remember(Survey { range, voids: voids as usize, marks: marks as usize, assumed, patches, thinned, validity });
    dem.remember_overviews(overviews);
    surface.remember(pyramid);
    Ok(())
}
