//! The pyramid of a surface, kept as it is drawn: a file is named by the stamp of the DEM, its exaggeration, and which tangents are
//! limited.
//!
//! ```text
//! squares, layer by layer | hash of them
//! ```

use std::io::{self, BufReader, ErrorKind, Read};
use std::ops::Range;

use xxhash_rust::xxh3::Xxh3;

use super::super::limits::Limits;
use super::super::{PyramidBuilder, SurfaceBand};
use super::{Pyramid, Surface, WORDS};
use crate::cache::{CacheKey, CacheKind, KeptEntry, NewEntry, not_kept};
use crate::dem::{Dem, Samples};
use crate::error::{Message, Result};

/// Raise it when the pyramid of the same samples comes out otherwise, or when the bytes mean something else.
const FORMAT: u32 = 1;
const KIND: CacheKind = CacheKind { name: "bounds", format: FORMAT, words: WORDS };

/// What the pyramid of a DEM with this stamp and such limits depends on.
pub(super) fn key(dem: &Dem, stamp: u128, exaggeration: f64, limits: &Limits) -> CacheKey {
    let of = dem.label();
    let of = if exaggeration == 1.0 { of } else { format!("{of}, exaggerated {exaggeration} times") };
    let mut hash = Xxh3::new();
    hash.update(&stamp.to_le_bytes());
    hash.update(&exaggeration.to_bits().to_le_bytes());
    limits.identify(&mut hash);
    CacheKey { kind: KIND, hash: hash.digest128(), of }
}

/// Makes the pyramid in a look at every sample; `beside` takes them too, as they are drawn, band by band.
pub(super) fn make(
    surface: &Surface,
    progress: &dyn Fn(f64),
    mut beside: impl FnMut(&Samples, Range<usize>) -> Result<()>,
) -> Result<Pyramid> {
    let dem = surface.dem();
    let mut pyramid = PyramidBuilder::new(dem);
    for band in surface.bands(PyramidBuilder::HALO) {
        let band = band?;
        pyramid.take(&band)?;
        let SurfaceBand { rows, surface: part } = band;
        let done = rows.end as f64 / dem.rows() as f64;
        beside(part.dem().held()?, rows)?;
        progress(done);
    }
    // What was read of files that changed meanwhile is of neither state.
    dem.check()?;
    Ok(pyramid.finish())
}

/// Writes a pyramid where it is kept.
pub(super) fn keep(pyramid: &Pyramid, sheet: Option<NewEntry>, warn: &dyn Fn(&Message)) {
    let Some(mut sheet) = sheet else { return };
    let (key, mut hash) = (sheet.key().clone(), Xxh3::new());
    for bytes in pyramid.bytes() {
        hash.update(bytes);
        sheet.write(bytes);
    }
    sheet.write(&hash.digest().to_le_bytes());
    if let Err(error) = sheet.publish() {
        warn(&not_kept(&key, &error));
    }
}

/// Reads what was kept. Fails where the bytes are not those that were written.
pub(super) fn recall(dem: &Dem, KeptEntry { file, bytes, .. }: KeptEntry) -> io::Result<Pyramid> {
    let mut file = BufReader::new(file).take(bytes);
    let mut hash = Xxh3::new();
    let pyramid = Pyramid::from_bytes(dem, |bytes| {
        file.read_exact(bytes)?;
        hash.update(bytes);
        Ok::<_, io::Error>(())
    })?;
    let mut written = [0; size_of::<u64>()];
    file.read_exact(&mut written)?;
    let whole = file.limit() == 0 && u64::from_le_bytes(written) == hash.digest();
    whole.then_some(pyramid).ok_or(ErrorKind::InvalidData.into())
}
