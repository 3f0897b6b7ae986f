//! How the members of a zip archive are packed, which GDAL does not say.
//!
//! Reads the directory at the archive's end (PKWARE's APPNOTE, 4.3.12 and 4.3.16) and nothing else. Cost: the last 64 KiB
//! and the directory. Not handled: archives of over 4 GiB or 65 535 members, and names in another code than UTF-8 where
//! GDAL has recoded them; of these nothing is known.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

/// The directory's end, without its comment.
const END: usize = 22;
/// The end and the longest comment.
const TAIL: u64 = END as u64 + 65_535;
/// A directory's entry, without its name.
const ENTRY: usize = 46;

/// How a member is packed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Packing {
    /// Whether a password is needed.
    pub encrypted: bool,
    /// 0 is stored, 8 deflate.
    pub method: u16,
}

impl Packing {
    /// What packs it, in words.
    pub(super) fn words(self) -> String {
        match self.method {
            _ if self.encrypted => "encrypted".into(),
            9 => "compressed with deflate64".into(),
            12 => "compressed with bzip2".into(),
            14 => "compressed with LZMA".into(),
            93 => "compressed with Zstandard".into(),
            95 => "compressed with xz".into(),
            method => format!("compressed by method {method}"),
        }
    }
}

/// How the member `inner` of `archive` is packed; `None` where that is not known.
pub(super) fn packing(archive: &Path, inner: &[u8]) -> Option<Packing> {
    let mut file = File::open(archive).ok()?;
    let length = file.seek(SeekFrom::End(0)).ok()?;
    let tail = read_at(&mut file, length.saturating_sub(TAIL), TAIL.min(length) as usize)?;
    let end = (0..=tail.len().checked_sub(END)?).rev().find(|at| tail[*at..].starts_with(b"PK\x05\x06"))?;
    let (size, start) = (number(&tail, end + 12, 4)?, number(&tail, end + 16, 4)?);
    let directory = read_at(&mut file, start, usize::try_from(size.min(length)).ok()?)?;
    let mut at = 0;
    while directory.get(at..)?.starts_with(b"PK\x01\x02") {
        let [flags, method, name, extra, comment] = [8, 10, 28, 30, 32].map(|field| number(&directory, at + field, 2));
        let name_length = name? as usize;
        if directory.get(at + ENTRY..at + ENTRY + name_length)? == inner {
            return Some(Packing { encrypted: flags? & 1 == 1, method: method? as u16 });
        }
        at += ENTRY + name_length + extra? as usize + comment? as usize;
    }
    None
}

fn read_at(file: &mut File, start: u64, length: usize) -> Option<Vec<u8>> {
    let mut bytes = vec![0; length];
    file.seek(SeekFrom::Start(start)).ok()?;
    file.read_exact(&mut bytes).ok()?;
    Some(bytes)
}

/// A number of `width` bytes, the lowest first.
fn number(bytes: &[u8], at: usize, width: usize) -> Option<u64> {
    Some(bytes.get(at..at + width)?.iter().rev().fold(0, |number, byte| number << 8 | u64::from(*byte)))
}
