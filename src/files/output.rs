//! Files that get their final name only when they are whole, and standard output, which gets its bytes only then.
//!
//! [`Output::create`] opens a temporary file beside the final one before the work starts, so that a folder that cannot
//! be written fails in the first second; [`Output::write`] fills it, [`Output::publish`] renames it. A dropped output
//! leaves nothing behind; one ended by a signal neither, with [`signals`](super::signals). [`Output::stdout`] holds
//! its bytes in memory instead until they are published.
//!
//! Does not handle: power cuts. Nothing is synced to disk, the file may be missing then, as with any other writer.

use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use tempfile::TempPath;

use crate::error::{Error, Result, shown};

/// What names of temporary files begin with.
const TEMPORARY: &str = ".hachure-";

/// A file being made, or bytes for standard output.
#[derive(Debug)]
pub struct Output {
    /// As the user named it, for messages.
    path: PathBuf,
    place: Destination,
}

#[derive(Debug)]
enum Destination {
    File {
        /// Where it goes: `path` with links followed, so that a link stays one.
        target: PathBuf,
        /// Open until [`Output::close`].
        file: Option<File>,
        temporary: TempPath,
    },
    Stdout(Vec<u8>),
}

impl Output {
    /// Opens a temporary file in the folder of `path`.
    ///
    /// [`Error::Output`] where the folder is missing or cannot be written, or `path` is there and no regular file.
    pub fn create(path: &Path) -> Result<Self> {
        Self::create_as(path, TEMPORARY)
    }

    /// The same with a temporary name that begins so.
    ///
    /// [`Error::Output`] as [`Self::create`].
    pub fn create_as(path: &Path, temporary: &str) -> Result<Self> {
        let failed = |why: io::Error| Error::output(path, &why);
        let wrong = |what: &str| failed(io::Error::other(what));
        let target = match fs::metadata(path) {
            Ok(meta) if meta.is_dir() => return Err(wrong("it is a folder")),
            // A rename would put a plain file in the place of a device or a pipe.
            Ok(meta) if !meta.is_file() => return Err(wrong("it is no regular file")),
            Ok(_) => fs::canonicalize(path).map_err(failed)?,
            Err(_) if names_no_file(path) => return Err(wrong("it names no file")),
            Err(e) if e.kind() == ErrorKind::NotFound => path.to_owned(),
            // Too long a name, above all: the temporary file would have a short one.
            Err(e) => return Err(failed(e)),
        };
        let folder = target.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if !folder.is_dir() {
            return Err(wrong(&format!("there is no folder {}", shown(folder))));
        }
        let mut builder = tempfile::Builder::new();
        builder.prefix(temporary);
        // As for any new file: the system takes the user's umask off.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        // Made and noted at once: a signal between the two would leave the file behind.
        let mut under_way = UNDER_WAY.lock().unwrap_or_else(PoisonError::into_inner);
        let (file, temporary) = builder.tempfile_in(folder).map_err(failed)?.into_parts();
        under_way.push(temporary.to_path_buf());
        drop(under_way);
        Ok(Self { path: path.to_owned(), place: Destination::File { target, file: Some(file), temporary } })
    }

    /// Collects bytes for standard output.
    pub fn stdout() -> Self {
        Self { path: "standard output".into(), place: Destination::Stdout(Vec::new()) }
    }

    /// The file it will be, with links followed; `None` for standard output.
    pub fn target(&self) -> Option<&Path> {
        match &self.place {
            Destination::File { target, .. } => Some(target),
            Destination::Stdout(_) => None,
        }
    }

    /// Lets `write` fill the file through a buffer. It still has no name, and standard output no byte.
    ///
    /// [`Error::Output`] where writing fails.
    pub fn write(&mut self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
        let written = match &mut self.place {
            Destination::File { file: Some(file), .. } => {
                let mut buffer = BufWriter::new(file);
                write(&mut buffer).and_then(|()| buffer.flush())
            }
            Destination::File { file: None, .. } => Err(io::Error::other("it is closed")),
            Destination::Stdout(bytes) => write(bytes),
        };
        written.map_err(|why| Error::output(&self.path, &why))
    }

    /// Lets `write` make the file by its temporary name, for libraries that open files themselves.
    ///
    /// [`Error::Output`] where that fails.
    pub fn write_by_name(&mut self, write: impl FnOnce(&Path) -> io::Result<()>) -> Result<()> {
        self.close();
        let written = match &self.place {
            Destination::File { temporary, .. } => write(temporary),
            Destination::Stdout(_) => Err(io::Error::other("it has no name")),
        };
        written.map_err(|why| Error::output(&self.path, &why))
    }

    /// Another handle on the file being made, for reading it when it has its name.
    ///
    /// # Errors
    /// The system's, and where it is closed or standard output.
    pub fn duplicate(&self) -> io::Result<File> {
        match &self.place {
            Destination::File { file: Some(file), .. } => file.try_clone(),
            Destination::File { .. } | Destination::Stdout(_) => Err(io::Error::other("it is closed")),
        }
    }

    /// Closes the file: for many outputs that wait for each other, of which a system lets only so many be open.
    pub fn close(&mut self) {
        if let Destination::File { file, .. } = &mut self.place {
            *file = None;
        }
    }

    /// Gives the file its final name, in the place of an older one, or standard output its bytes. A reader of those
    /// that has gone away has had what it wanted: that is no error.
    ///
    /// [`Error::Output`] where renaming fails (then the older file still stands) or standard output takes no more.
    pub fn publish(self) -> Result<()> {
        let published = match self.place {
            Destination::File { target, temporary, .. } => {
                let path = temporary.to_path_buf();
                let named = temporary.persist(target).map_err(|e| e.error);
                forget(&path);
                named
            }
            Destination::Stdout(bytes) => print(&bytes),
        };
        published.map_err(|why| Error::output(&self.path, &why))
    }
}

/// Removes temporary files of outputs in a folder that nobody has written to for so long: of processes that were killed.
pub fn remove_left(folder: &Path, age: Duration) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let is_ours = entry.file_name().as_encoded_bytes().starts_with(TEMPORARY.as_bytes());
        let modified = entry.metadata().and_then(|about| about.modified());
        if is_ours && modified.is_ok_and(|at| at.elapsed().is_ok_and(|elapsed| elapsed > age)) {
            // What cannot be removed stays.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Whether it ends in `..`, in a separator or in `/.`, which `Path` passes over and a rename does not.
fn names_no_file(path: &Path) -> bool {
    let bytes = path.as_os_str().as_encoded_bytes();
    let end = bytes.strip_suffix(b".").unwrap_or(bytes);
    path.file_name().is_none() || end.last().is_some_and(|byte| std::path::is_separator(char::from(*byte)))
}

fn print(bytes: &[u8]) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(e) if e.kind() == ErrorKind::BrokenPipe => Ok(()),
        done => done,
    }
}

/// Temporary files of outputs under way, and folders made for them, in the order in which they were made.
static UNDER_WAY: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Makes a folder that goes again, where it is empty then, if the process is ended by a signal before [`forget`].
pub fn make_folder(path: &Path) -> io::Result<()> {
    let mut under_way = UNDER_WAY.lock().unwrap_or_else(PoisonError::into_inner);
    fs::create_dir(path)?;
    under_way.push(path.to_owned());
    Ok(())
}

/// Makes an empty file, where there is none, that goes if the process is ended by a signal before [`forget`].
pub fn make_file(path: &Path) -> io::Result<File> {
    let mut under_way = UNDER_WAY.lock().unwrap_or_else(PoisonError::into_inner);
    let file = File::create_new(path)?;
    under_way.push(path.to_owned());
    Ok(file)
}

/// From here on a signal leaves it alone.
pub fn forget(path: &Path) {
    if let Ok(mut list) = UNDER_WAY.lock() {
        list.retain(|p| p != path);
    }
}

/// The same for a process that has no memory left: asks for none, and leaves what another thread is at.
pub(super) fn discard_now() {
    if let Ok(list) = UNDER_WAY.try_lock() {
        list.iter().rev().for_each(|path| drop(fs::remove_file(path).or_else(|_| fs::remove_dir(path))));
        std::mem::forget(list);
    }
}

/// Removes the temporary files of all outputs under way, and folders made for them where they are empty then: for a
/// process about to be ended by a signal. Whoever makes or names another output from here on waits for that end.
pub(super) fn discard_all() {
    let mut list = UNDER_WAY.lock().unwrap_or_else(PoisonError::into_inner);
    let remove = |path: &PathBuf| fs::remove_file(path).or_else(|_| fs::remove_dir(path));
    list.drain(..).rev().for_each(|path| drop(remove(&path)));
    std::mem::forget(list);
}
