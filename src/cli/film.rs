//! The making of a motion picture, with progress.

use std::path::PathBuf;

use super::talk::Talk;
use crate::error::Result;
use crate::job::{Film, Inks};

/// Makes it of pictures.
///
/// # Errors
/// As [`Film::make`].
pub fn make(film: &Film, pictures: &[PathBuf], inks: &Inks, talk: &Talk) -> Result<()> {
    film.make(pictures, inks, &|share| talk.progress("making the motion picture", share.min(0.999)))?;
    talk.progress("", 1.0);
    talk.say(&film.described(pictures.len()))
}
