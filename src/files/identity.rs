//! Which names mean one file.
//!
//! Method: a file that is there is known by its device and inode, so that links of both kinds, `d/..` and folders linked
//! count; one that is not there yet by those of its folder and its name. Elsewhere than on Unix canonical paths stand for
//! both. Cost: a look at the file, or at its folder. Not handled: file systems that hold two names for one that differ in
//! capitals alone, where neither is there yet.

use std::collections::HashMap;
use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result, Setting, shown};

/// What a name means; equal for all names of one file.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) enum Identity {
    /// A file that is there, links followed.
    File(FileNode),
    /// A file that would be made: its folder and its name there.
    New(FileNode, OsString),
}

/// A file or folder as the system tells it from all others.
#[cfg(unix)]
pub(crate) type FileNode = (u64, u64);
/// A file or folder as the system tells it from all others.
#[cfg(not(unix))]
pub type FileNode = PathBuf;

impl Identity {
    /// Of the file called `path`, be it there or not; `None` where not even its folder is.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        if let Ok(node) = node(path) {
            return Some(Self::File(node));
        }
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Some(Self::New(node(folder).ok()?, path.file_name()?.to_owned()))
    }
}

impl Identity {
    /// Of the file that standard output goes to; `None` where it goes elsewhere.
    #[cfg(unix)]
    fn of_stdout() -> Option<Self> {
        use std::os::fd::AsFd;
        use std::os::unix::fs::MetadataExt;
        let file = fs::File::from(io::stdout().as_fd().try_clone_to_owned().ok()?);
        let found = file.metadata().ok().filter(fs::Metadata::is_file)?;
        Some(Self::File((found.dev(), found.ino())))
    }

    /// Nothing is known of it.
    #[cfg(not(unix))]
    fn of_stdout() -> Option<Self> {
        None
    }
}

#[cfg(unix)]
fn node(path: &Path) -> io::Result<FileNode> {
    use std::os::unix::fs::MetadataExt;
    fs::metadata(path).map(|found| (found.dev(), found.ino()))
}

#[cfg(not(unix))]
fn node(path: &Path) -> io::Result<FileNode> {
    fs::canonicalize(path)
}

/// What outputs must not replace, and the outputs so far: each name is compared with all before it.
#[derive(Debug, Default)]
pub(crate) struct Taken {
    names: HashMap<Identity, (PathBuf, Use)>,
}

/// What a file is to a run of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Use {
    /// It is read.
    Input,
    /// It will be written.
    Output,
}

impl Taken {
    /// Files that are read. What is not there cannot be replaced.
    pub(crate) fn inputs<'a>(files: impl IntoIterator<Item = &'a Path>) -> Self {
        let known = |file: &'a Path| Some((Identity::of(file)?, (file.to_owned(), Use::Input)));
        Self { names: files.into_iter().filter_map(known).collect() }
    }

    /// Takes a name for the output that `setting` names.
    ///
    /// # Errors
    /// [`Error::Setting`] where it is a file that is read, or another output.
    pub(crate) fn take(&mut self, setting: Setting, path: &Path) -> Result<()> {
        Identity::of(path).map_or(Ok(()), |identity| self.take_as(setting, path, identity))
    }

    /// Takes standard output, and the file that it goes to, for the output that `setting` names.
    ///
    /// # Errors
    /// As [`Self::take`].
    pub(crate) fn take_stdout(&mut self, setting: Setting) -> Result<()> {
        Identity::of_stdout().map_or(Ok(()), |identity| self.take_as(setting, Path::new("standard output"), identity))
    }

    fn take_as(&mut self, setting: Setting, path: &Path, identity: Identity) -> Result<()> {
        let what = match self.names.get(&identity) {
            None => {
                self.names.insert(identity, (path.to_owned(), Use::Output));
                return Ok(());
            }
            Some((input, Use::Input)) if input == path => format!("{} is read as input", shown(path)),
            Some((input, Use::Input)) => {
                format!("{} is {}, which is read as input", shown(path), shown(input))
            }
            Some((other, Use::Output)) if other == path => format!("{} is another output already", shown(path)),
            Some((other, Use::Output)) => {
                format!("{} is {}, another output already", shown(path), shown(other))
            }
        };
        Err(Error::setting(setting, what, "give each file a name of its own"))
    }
}
