//! Files that are read whole: a pipe or a device in the place of one would be waited for.

use std::fs::{self, File};
use std::io;
use std::path::Path;

/// Opens a file that is neither pipe nor device nor folder.
///
/// # Errors
/// The system's, and for what is no regular file.
pub(crate) fn open(path: &Path) -> io::Result<File> {
    match fs::metadata(path)?.is_file() {
        true => File::open(path),
        false => Err(io::Error::other("it is no regular file")),
    }
}
