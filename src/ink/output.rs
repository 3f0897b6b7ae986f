//! Files that get their final name only when they are whole.
//!
//! [`Output::create`] opens a temporary file beside the final one before the work starts, so that a folder that cannot
//! be written fails in the first second; [`Output::write`] fills it, [`Output::publish`] renames it. A dropped output leaves nothing behind; one ended by a
//! signal neither, if its handler calls [`discard_all`]. Nothing
//! is synced to disk: after a power cut the file may be missing, as with any other writer.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

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
        if let Ok(mut list) = UNDER_WAY.lock() {
            list.push(file.path().to_owned());
        }
        Ok(Self { path: path.to_owned(), target, file })
    }

    /// The file it will be, with links followed.
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Lets `write` fill the file through a buffer. It still has no name.
    ///
    /// [`Error::Output`] where writing fails.
    pub fn write(&mut self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
        let mut buffer = BufWriter::new(self.file.as_file_mut());
        let written = write(&mut buffer).and_then(|()| buffer.flush());
        drop(buffer);
        written.map_err(|e| self.failed(&e))
    }

    /// Gives the file its final name, in the place of an older one.
    ///
    /// [`Error::Output`] where renaming fails; then the older file still stands.
    pub fn publish(self) -> Result<()> {
        forget(self.file.path());
        let Self { path, target, file } = self;
        match file.persist(target) {
            Ok(_) => Ok(()),
            Err(e) => Err(Error::Output { path, what: e.error.to_string() }),
        }
    }

    fn failed(&self, e: &io::Error) -> Error {
        Error::Output { path: self.path.clone(), what: e.to_string() }
    }
}

/// Temporary files of outputs under way.
static UNDER_WAY: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn forget(path: &Path) {
    if let Ok(mut list) = UNDER_WAY.lock() {
        list.retain(|p| p != path);
    }
}

/// Removes the temporary files of all outputs under way: for a process about to be ended by a signal.
pub fn discard_all() {
    if let Ok(mut list) = UNDER_WAY.lock() {
        list.drain(..).for_each(|path| drop(fs::remove_file(path)));
    }
}
