//! Motion pictures: the pictures of a sequence, one after the other, in one file.
//!
//! They are made of the files of the frames, whichever process drew these: by ffmpeg, where it is installed; as an animated PNG
//! or a GIF by ourselves. The file has its name when it is whole. Cost: a decoding of each picture, one in memory at a time
//! with the one before it; of ffmpeg what that takes.

mod apng;
mod ffmpeg;
mod gif;
mod picture;

use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result, Setting, shown};
use crate::files::Output;
use crate::ink::{Colour, Pen, Style};
use crate::message;
use picture::Picture;

/// Endings that ffmpeg is asked for, with its names of their formats.
const BY_FFMPEG: [(&str, &str); 4] = [("mp4", "mp4"), ("mov", "mov"), ("mkv", "matroska"), ("webm", "webm")];
/// Most pictures a second of a GIF, whose clock has 100 ticks: viewers take a delay of one tick for ten.
const MOST_OF_GIF: f64 = 50.0;

/// How a motion picture is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Gif,
    Apng,
    /// ffmpeg's name of it.
    Ffmpeg(&'static str),
}

/// What pictures are drawn with, paper first: a film of few colours is made of their mixtures.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Inks(pub Vec<Colour>);

impl Inks {
    /// Of a style: its paper, and each of its pens as it shows on it.
    pub fn of(style: &Style) -> Self {
        let paper = style.paper;
        let on_paper = |pen: Pen| {
            let channel = |i: usize| {
                let (paper, ink) = (f64::from(paper.0[i]), f64::from(pen.colour.0[i]));
                (paper + pen.opacity * (ink - paper)).round() as u8
            };
            Colour([0, 1, 2].map(channel))
        };
        let mut inks = vec![paper];
        for pen in style.pens.all().map(on_paper) {
            if !inks.contains(&pen) {
                inks.push(pen);
            }
        }
        Self(inks)
    }
}

/// A motion picture to make.
#[derive(Debug)]
pub struct Film {
    path: PathBuf,
    format: Format,
    fps: f64,
}

impl Film {
    /// A film of so many pictures a second. Looks whether it can be made, before any picture is.
    ///
    /// # Errors
    /// [`Error::Setting`] for a name that no format has, more pictures a second than a format takes, and where ffmpeg is
    /// wanted and not installed; [`Error::Output`] where the file cannot be written.
    pub fn new(path: &Path, fps: f64) -> Result<Self> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
        let by_ffmpeg = BY_FFMPEG.into_iter().find(|(known, _)| *known == ending);
        let format = match (ending.as_str(), by_ffmpeg) {
            ("gif", _) => Format::Gif,
            ("png" | "apng", _) => Format::Apng,
            (_, Some((_, name))) => Format::Ffmpeg(name),
            _ => {
                let known: Vec<&str> = BY_FFMPEG.map(|(ending, _)| ending).to_vec();
                let what = format!("{} does not end in .gif, .png or .{}", shown(path), known.join(", ."));
                return Err(Error::setting(Setting::Video, what, "name it so"));
            }
        };
        if format == Format::Gif && fps > MOST_OF_GIF {
            let what = format!("a GIF shows at most {MOST_OF_GIF} pictures a second, not {fps}");
            return Err(Error::setting(
                Setting::Video,
                what,
                message!["use a smaller ", Setting::Fps, ", or a .png or .mp4"],
            ));
        }
        if matches!(format, Format::Ffmpeg(_)) {
            ffmpeg::look()?;
        }
        // Whether it can be written is known before there is a picture.
        drop(Output::create(path)?);
        Ok(Self { path: path.to_owned(), format, fps })
    }

    /// What it comes to with so many pictures, in words.
    pub fn described(&self, pictures: usize) -> String {
        let (path, fps) = (shown(&self.path), self.fps);
        format!("{path}: {pictures} pictures, {fps} a second, {:.2} s", pictures as f64 / fps)
    }

    /// Makes it of pictures in their order; tells `progress` which share is done.
    ///
    /// # Errors
    /// [`Error::Input`] for a picture that cannot be read, or is as large as none before it; [`Error::Output`].
    pub fn make(&self, pictures: &[PathBuf], inks: &Inks, progress: &dyn Fn(f64)) -> Result<()> {
        let mut output = Output::create(&self.path)?;
        let done = |i: usize| progress((i + 1) as f64 / pictures.len() as f64);
        match self.format {
            Format::Ffmpeg(name) => ffmpeg::write(&mut output, name, self.fps, inks, pictures, &done)?,
            Format::Gif => self.write(&mut output, pictures, |out, all| gif::write(out, self.fps, inks, all), &done)?,
            Format::Apng => self.write(&mut output, pictures, |out, all| apng::write(out, self.fps, all), &done)?,
        }
        output.publish()
    }

    /// Lets `write` write pictures that are read as it asks for them. What is wrong with one is told, not that writing ended.
    fn write(
        &self,
        output: &mut Output,
        pictures: &[PathBuf],
        write: impl Fn(&mut dyn io::Write, &mut dyn ExactSizeIterator<Item = io::Result<Picture>>) -> io::Result<()>,
        done: &dyn Fn(usize),
    ) -> Result<()> {
        let (mut wrong, mut size) = (None, None);
        let mut read = pictures.iter().enumerate().map(|(i, path)| {
            done(i);
            let picture = Picture::read(path).and_then(|picture| match *size.get_or_insert(picture.size) {
                first if first == picture.size => Ok(picture),
                [width, height] => Err(Error::input(
                    path,
                    format!("it is no picture of {width}x{height} pixels as the first one"),
                    "draw all frames anew",
                )),
            });
            picture.map_err(|error| {
                wrong = Some(error);
                io::Error::other("a picture")
            })
        });
        let written = output.write(|out| write(out, &mut read));
        drop(read);
        wrong.map_or(written, Err)
    }
}
