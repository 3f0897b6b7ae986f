//! The motion picture of frames: where it may stand, and its making, with progress.

use std::path::{Path, PathBuf};

use super::progress::Progress;
use super::talk::Talk;
use crate::error::{Error, Result, Setting, shown};
use crate::files::Taken;
use crate::job::{Film, Inks};

/// A film at `path`, which may be none of its pictures, and none of the files `taken`.
///
/// # Errors
/// [`Error::Setting`]; as [`Film::new`].
pub(crate) fn of(path: &Path, fps: f64, mut taken: Taken, pictures: &[PathBuf]) -> Result<Film> {
    let plain = |path: &Path| crate::files::straight(&std::path::absolute(path).unwrap_or_else(|_| path.to_owned()));
    let film = plain(path);
    if pictures.iter().any(|picture| plain(picture) == film) {
        let what = format!("{} is a frame", shown(path));
        return Err(Error::setting(Setting::Video, what, "give it a name of its own"));
    }
    taken.take(Setting::Video, path)?;
    Film::new(path, fps)
}

/// Makes it of pictures.
///
/// # Errors
/// As [`Film::make`].
pub(crate) fn make(film: &Film, pictures: &[PathBuf], inks: &Inks, progress: &Progress, talk: &Talk) -> Result<()> {
    film.make(pictures, inks, &|share| progress.film(share))?;
    talk.say(&film.described(pictures.len()))
}
