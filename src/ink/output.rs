//! Files that get their final name only when they are whole.
//!
//! [`Output::create`] opens a temporary file beside the final one before the work starts, so that a folder that cannot
//! be written fails in the first second; [`Output::commit`] renames it. A dropped output leaves nothing behind. Nothing
//! is synced to disk: after a power cut the file may be missing, as with any other writer.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::error::{Error, Result};

/// A file being made.
#[derive(Debug)]
pub struct Output {
    /// As the user named it, for messages.
    path: PathBuf,
    /// Where it goes: `path` with links followed, so that a link stays one.
    target: PathBuf,
    file: NamedTempFile,
}

impl Output {
    /// Opens a temporary file in the folder of `path`.
    ///
    /// [`Error::Output`] where the folder is missing or cannot be written, or `path` is there and no regular file.
    pub fn create(path: &Path) -> Result<Self> {
        let failed = |what: String| Error::Output { path: path.to_owned(), what };
        let target = match fs::metadata(path) {
            Ok(meta) if meta.is_dir() => return Err(failed("it is a folder".into())),
            // A rename would put a plain file in the place of a device or a pipe.
            Ok(meta) if !meta.is_file() => return Err(failed("it is no regular file".into())),
            Ok(_) => fs::canonicalize(path).map_err(|e| failed(e.to_string()))?,
            Err(_) if path.file_name().is_none() => return Err(failed("it names no file".into())),
            Err(_) => path.to_owned(),
        };
        let folder = target.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if !folder.is_dir() {
            return Err(failed(format!("there is no folder {}", folder.display())));
        }
        let mut builder = tempfile::Builder::new();
        builder.prefix(".hachure-");
        // As for any new file: the system takes the user's umask off.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let file = builder.tempfile_in(folder).map_err(|e| failed(e.to_string()))?;
        Ok(Self { path: path.to_owned(), target, file })
    }

    /// Lets `write` fill the file through a buffer, then gives it its final name, in the place of an older one.
    ///
    /// [`Error::Output`] where writing or renaming fails; then the older file still stands.
    pub fn commit(mut self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
        let mut buffer = BufWriter::new(self.file.as_file_mut());
        let written = write(&mut buffer).and_then(|()| buffer.flush());
        drop(buffer);
        written
            .and_then(|()| self.file.persist(&self.target).map_err(|e| e.error))
            .map_err(|e| Error::Output { path: self.path, what: e.to_string() })?;
        Ok(())
    }
}
