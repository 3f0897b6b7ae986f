//! `hachure merge`: whether all that the processes of a sequence were to make is there.

use std::path::{Path, PathBuf};

use super::film;
use super::talk::Talk;
use crate::error::{Error, Result, Setting, shown};
use crate::job::{Film, Frames, Merged};

/// The end of `hachure merge --help`.
const EXAMPLES: &str = "\
Looks at the manifests that each process leaves in the folder (hachure-0-of-4.json and so on) and at every file that they
name: whether it is there, whole, and made of what it was to be made of. Ends with 0 where all is there, else with 1.

Example:
  hachure merge frames/

  What shards drew on several machines, as a motion picture:
  hachure merge frames/ --video flight.mp4";

/// Flags of `hachure merge`, as typed.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct MergeArguments {
    /// The folder into which frames or drawings were made
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Make a motion picture of the frames, if all are there: .mp4, .mov, .mkv or .webm by ffmpeg, where it is installed;
    /// .gif; .png, which is animated
    #[arg(long, value_name = "OUT.mp4|.gif|.png")]
    video: Option<PathBuf>,
}

/// Looks, and says what is missing.
///
/// # Errors
/// As [`Merged::of`]; [`Error::Incomplete`] where something is missing.
pub fn run(arguments: &MergeArguments, talk: &Talk) -> Result<()> {
    let merged = Merged::of(&arguments.folder)?;
    let (count, whole) = (merged.manifest.count, merged.whole.numbers().len());
    let s = if merged.manifests == 1 { "" } else { "s" };
    talk.answer(&format!(
        "{}: {whole} of {count} are whole, by {} manifest{s} of {}",
        shown(&arguments.folder),
        merged.manifests,
        merged.manifest.of
    ))?;
    let list = |what: &str, frames: &Frames| match frames.last() {
        None => Ok(()),
        Some(_) => talk.answer(&format!("{what}: {frames}")),
    };
    list("missing or not whole", &merged.broken)?;
    list("in no manifest", &merged.unknown)?;
    if merged.is_whole() {
        return arguments.video.as_deref().map_or(Ok(()), |video| make(video, &merged, &arguments.folder, talk));
    }
    merged.absent.iter().try_for_each(|[index, count]| talk.answer(&format!("shard {index}/{count} never ran")))?;
    merged.failed.iter().try_for_each(|(n, why)| talk.answer(&format!("{n} failed: {why}")))?;
    let what = format!("{}: {} of {count} are missing", shown(&arguments.folder), count as usize - whole);
    Err(Error::incomplete(what, "run the command that made the others again: it makes what is missing"))
}

/// Makes a motion picture of what is there.
fn make(video: &Path, merged: &Merged, folder: &Path, talk: &Talk) -> Result<()> {
    let (Some(fps), Some(inks)) = (merged.manifest.fps, &merged.manifest.inks) else {
        let what = format!("{} do not move", merged.manifest.of);
        return Err(Error::setting(Setting::Video, what, "make it of the frames of a flight"));
    };
    let Some(pictures) = &merged.pictures else {
        return Err(Error::setting(Setting::Video, "the frames have no pictures", "draw them as .png too"));
    };
    let film = Film::new(video, fps)?;
    let pictures: Vec<PathBuf> = pictures.iter().map(|path| folder.join(path)).collect();
    film::make(&film, &pictures, inks, talk)
}
