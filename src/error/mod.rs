//! What can go wrong, said so that a user can mend it: what, where, remedy. How settings are spelled and with which code a
//! program ends is for the program to say.

mod message;

use std::io;
use std::path::{Path, PathBuf};

pub use message::{Message, MessagePart, Setting, SettingForm};

/// `Result` with this crate's [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// Everything this library can fail with: what, where, and what may be done about it. `Display` is one line; settings stand
/// in it by their names.
#[derive(Debug, Clone, thiserror::Error)]
pub enum Error {
    /// A file that cannot be used as a DEM.
    #[error("{}: {what}; {remedy}", shown(path))]
    Input {
        /// The file as the user named it.
        path: PathBuf,
        /// What is wrong with it.
        what: Message,
        /// What the user can do.
        remedy: Message,
    },
    /// A setting whose value makes no sense, whatever the file.
    #[error("{setting}: {what}; {remedy}")]
    Setting {
        /// Which one.
        setting: Setting,
        /// What is wrong with its value.
        what: Message,
        /// What the user can do.
        remedy: Message,
    },
    /// A file that cannot be written.
    #[error("{}: cannot be written ({what})", shown(path))]
    Output {
        /// The file as the user named it.
        path: PathBuf,
        /// The reason, in words.
        what: String,
        /// What kind of reason it is.
        why: io::ErrorKind,
    },
    /// A scene or page beyond what the lattice, the IDs or this adapter can hold.
    #[error("{what}; {remedy}")]
    Limit {
        /// Which limit, with both numbers.
        what: Message,
        /// What the user can do.
        remedy: Message,
    },
    /// A view in which there is nothing to do.
    #[error("{what}; {remedy}")]
    Scene {
        /// Which view, and what it lacks.
        what: Message,
        /// What the user can do.
        remedy: Message,
    },
    /// Work of which a part was not done; what was stays.
    #[error("{what}; {remedy}")]
    Incomplete {
        /// How much of it, and why.
        what: Message,
        /// What the user can do.
        remedy: Message,
    },
    /// Work that was asked to end before it was done; it can be taken up again.
    #[error("{what}; {remedy}")]
    Ended {
        /// How far it had come.
        what: Message,
        /// What the user can do.
        remedy: Message,
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
    #[error("the GPU failed: {what}")]
    Gpu {
        /// The driver's words.
        what: String,
    },
    /// The device was lost or hung; trying again may help.
    #[error("the GPU was lost: {what}")]
    DeviceLost {
        /// The driver's words.
        what: String,
    },
    /// Something that no input can cause: a shader, a binding, a template that do not fit together.
    #[error("{what}; that is hachure's mistake, please report it with the command")]
    Mistake {
        /// Which part, and what it lacks.
        what: String,
    },
}

impl Error {
    /// A DEM problem: the file, what is wrong with it, what to do.
    pub fn input(path: &Path, what: impl Into<Message>, remedy: impl Into<Message>) -> Self {
        Self::Input { path: path.to_owned(), what: what.into().plain(), remedy: remedy.into().plain() }
    }

    /// A problem with a setting: which, what is wrong with its value, what to do.
    pub fn setting(setting: Setting, what: impl Into<Message>, remedy: impl Into<Message>) -> Self {
        Self::Setting { setting, what: what.into().plain(), remedy: remedy.into().plain() }
    }

    /// A file that cannot be written: which, and why.
    pub fn output(path: &Path, why: &io::Error) -> Self {
        Self::Output { path: path.to_owned(), what: why.to_string(), why: why.kind() }
    }

    /// Work of which a part was not done: how much, and what to do.
    pub(crate) fn incomplete(what: impl Into<Message>, remedy: impl Into<Message>) -> Self {
        Self::Incomplete { what: what.into(), remedy: remedy.into() }
    }

    /// A limit that is passed: which, with both numbers, and what to do.
    pub fn limit(what: impl Into<Message>, remedy: impl Into<Message>) -> Self {
        Self::Limit { what: what.into(), remedy: remedy.into() }
    }

    /// A mistake of ours in the making of a report: which part, and what it lacks.
    pub(crate) fn no_report(what: impl std::fmt::Display) -> Self {
        Self::mistake(format!("the report cannot be made: {what}"))
    }

    /// A mistake of ours: which part, and what it lacks.
    pub fn mistake(what: impl Into<String>) -> Self {
        Self::Mistake { what: what.into() }
    }
}

thread_local! {
    /// Whether this thread copes where memory ends.
    static COPES: std::cell::Cell<bool> = const { std::cell::Cell::new(false) };
}

/// Does work that copes where memory ends: it is told so, as by `try_reserve`, in the place of an end of the process.
pub(crate) fn without_end<T>(work: impl FnOnce() -> T) -> T {
    let before = COPES.replace(true);
    let done = work();
    COPES.set(before);
    done
}

/// Whether the present work does.
pub(crate) fn copes_without() -> bool {
    COPES.try_with(std::cell::Cell::get).unwrap_or(false)
}

/// A path as it is printed, everywhere: on one line, with what would move the cursor of a terminal or turn its text
/// around escaped, as `\n`, `\x1b` or `\u{202e}`, and bytes that are no UTF-8 as `\xff`.
#[doc(hidden)]
pub fn shown(path: &Path) -> String {
    let mut text = String::new();
    for part in path.as_os_str().as_encoded_bytes().utf8_chunks() {
        for c in part.valid().chars() {
            match c {
                '\n' | '\r' | '\t' => text.extend(c.escape_default()),
                '\0'..='\x1f' | '\x7f' => text += &format!("\\x{:02x}", u32::from(c)),
                _ if is_unprintable(c) => text.extend(c.escape_unicode()),
                _ => text.push(c),
            }
        }
        part.invalid().iter().for_each(|byte| text += &format!("\\x{byte:02x}"));
    }
    text
}

/// One line that moves nothing on a terminal, with spaces in the place of what would: files may hold such words.
pub(crate) fn plain(text: String) -> String {
    if text.contains(is_unprintable) { text.replace(is_unprintable, " ") } else { text }
}

/// Control characters (C0, DEL, C1), separators of lines and paragraphs, and marks that turn the direction of writing.
pub(crate) fn is_unprintable(c: char) -> bool {
    let turns = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    c.is_control() || turns || matches!(c, '\u{2028}' | '\u{2029}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_shown_on_one_line_that_moves_nothing() {
        let cases = [
            ("dem/näh é.tif", "dem/näh é.tif"),
            ("a\nb\tc\rd", r"a\nb\tc\rd"),
            ("\x1b[31mred\x07\x7f", r"\x1b[31mred\x07\x7f"),
            ("\u{9b}2J", r"\u{9b}2J"),
            ("a\u{202e}fit.b\u{2066}\u{200f}\u{2028}", r"a\u{202e}fit.b\u{2066}\u{200f}\u{2028}"),
        ];
        for (name, wanted) in cases {
            assert_eq!(shown(Path::new(name)), wanted);
        }
    }

    #[test]
    #[cfg(unix)]
    fn bytes_that_are_no_text_are_shown_as_numbers() {
        use std::os::unix::ffi::OsStrExt;
        let name = std::ffi::OsStr::from_bytes(b"gr\xfcn\x9b.tif");
        assert_eq!(shown(Path::new(name)), r"gr\xfcn\x9b.tif");
    }
}
