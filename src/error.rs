//! What can go wrong, said so that a user can mend it: what, where, remedy.

use std::path::{Path, PathBuf};

/// `Result` with this crate's [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// Everything this library can fail with. `Display` is one line: what, where, remedy.
#[derive(Debug, Clone, thiserror::Error)]
pub enum Error {
    /// A file that cannot be used as a DEM.
    #[error("{}: {what}; {remedy}", path.display())]
    Input {
        /// The file as the user named it.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
        /// What the user can do.
        remedy: String,
    },
    /// A flag whose value makes no sense, whatever the file.
    #[error("{flag}: {what}; {remedy}")]
    Flag {
        /// The flag with its dashes.
        flag: &'static str,
        /// What is wrong with its value.
        what: String,
        /// What the user can do.
        remedy: String,
    },
    /// A file that cannot be written.
    #[error("{}: cannot be written ({what}); choose another output path", path.display())]
    Output {
        /// The file as the user named it.
        path: PathBuf,
        /// The system's reason.
        what: String,
    },
    /// A scene or page beyond what the lattice, the IDs or this adapter can hold.
    #[error("{what}; {remedy}")]
    Limit {
        /// Which limit, with both numbers.
        what: String,
        /// What the user can do.
        remedy: String,
    },
    /// A view in which there is nothing to do.
    #[error("{what}; {remedy}")]
    Scene {
        /// Which view, and what it lacks.
        what: String,
        /// What the user can do.
        remedy: String,
    },
    /// No GPU and no software driver either, or none of the asked name.
    #[error("no GPU adapter: {what}; {remedy}")]
    NoAdapter {
        /// What was looked for.
        what: String,
        /// How to get one.
        remedy: String,
    },
    /// The GPU driver refused or failed; trying again does not help.
    #[error("the GPU failed: {what}; try `--adapter cpu`, a smaller --size or a lower --level")]
    Gpu {
        /// The driver's words.
        what: String,
    },
    /// A report that cannot be laid out, whatever was compared.
    #[error("the report cannot be made: {what}; that is hachure's mistake, please report it with the command")]
    Report {
        /// Which part, and the library's words.
        what: String,
    },
    /// The device was lost or hung; trying again may help.
    #[error("the GPU was lost: {what}; try again, or use `--adapter cpu`")]
    DeviceLost {
        /// The driver's words.
        what: String,
    },
}

impl Error {
    /// A DEM problem: the file, what is wrong with it, what to do.
    pub fn input(path: &Path, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Input { path: path.to_owned(), what: plain(what.into()), remedy: plain(remedy.into()) }
    }

    /// A flag problem: the flag, what is wrong with its value, what to do.
    pub fn flag(flag: &'static str, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Flag { flag, what: plain(what.into()), remedy: plain(remedy.into()) }
    }

    /// The process exit code of this error: 1 failed, 2 wrong usage, 75 try again.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Flag { .. } => 2,
            Self::DeviceLost { .. } => 75,
            _ => 1,
        }
    }
}

/// One line without control characters: files may hold names that would move the cursor of a terminal.
pub(crate) fn plain(text: String) -> String {
    if text.contains(char::is_control) { text.replace(char::is_control, " ") } else { text }
}
