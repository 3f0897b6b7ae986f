//! What made a file, told in the file itself: so that it is known to be done when it is met again.
//!
//! PNG says it in text chunks, SVG in its metadata, PDF in its document information: always within the first bytes, as plain
//! text. The adapter is noted beside it and is no part of the name: drivers may draw otherwise, and do not change what was
//! asked.

use std::fmt::{self, Display, Formatter};
use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

/// What stands before the name.
const MARK: &str = "hachure-job ";
/// Digits of the name.
const DIGITS: usize = 32;
/// Bytes of a file in which the name is to be found.
const HEAD: u64 = 4096;
/// Bytes of a file in which its end is to be found.
const TAIL: u64 = 16;
/// What whole files end with: the last chunk of a PNG, the last tag of an SVG, the mark of a PDF.
const ENDS: [&[u8]; 3] = [b"IEND", b"</svg>", b"%%EOF"];

/// What made a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Seal {
    /// The name of all that it was made of.
    pub job: u128,
    /// By which adapter and driver.
    pub adapter: String,
}

/// The mark and the name.
impl Display for Seal {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{MARK}{:0DIGITS$x}", self.job)
    }
}

impl Seal {
    /// The program that made it.
    pub const SOFTWARE: &str = concat!("hachure ", env!("CARGO_PKG_VERSION"));

    /// The name that a file bears; `None` where it bears none, or was cut off.
    ///
    /// # Errors
    /// The system's, above all where there is no such file.
    pub(crate) fn job_of(path: &Path) -> io::Result<Option<u128>> {
        // A pipe would be waited for.
        if !fs::metadata(path)?.is_file() {
            return Ok(None);
        }
        let (mut file, mut head, mut tail) = (File::open(path)?, Vec::new(), Vec::new());
        (&mut file).take(HEAD).read_to_end(&mut head)?;
        file.seek(SeekFrom::Start(file.metadata()?.len().saturating_sub(TAIL)))?;
        file.take(TAIL).read_to_end(&mut tail)?;
        if !ENDS.iter().any(|end| tail.windows(end.len()).any(|bytes| bytes == *end)) {
            return Ok(None);
        }
        let mark = head.windows(MARK.len()).position(|bytes| bytes == MARK.as_bytes());
        let digits = mark.and_then(|at| head.get(at + MARK.len()..at + MARK.len() + DIGITS));
        let digits = digits.and_then(|digits| std::str::from_utf8(digits).ok());
        Ok(digits.and_then(|digits| u128::from_str_radix(digits, 16).ok()))
    }

    /// The text chunks of a PNG.
    pub(super) fn write_into<W: io::Write>(&self, png: &mut ::png::Encoder<'_, W>) -> io::Result<()> {
        let chunks = [("Software", Self::SOFTWARE), ("Source", &self.to_string()), ("Comment", &self.adapter)];
        // Latin-1 alone is allowed there.
        let plain = |text: &str| text.replace(|c: char| !c.is_ascii(), "?");
        chunks.into_iter().try_for_each(|(keyword, text)| {
            png.add_text_chunk(keyword.to_owned(), plain(text)).map_err(io::Error::other)
        })
    }
}
