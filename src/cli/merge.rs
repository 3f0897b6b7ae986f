//! `hachure merge`: whether all that the processes of a sequence were to make is there.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::film;
use super::progress::{Progress, ProgressForm};
use super::talk::Talk;
use crate::error::{Error, Result, Setting, shown};
use crate::files::Taken;
use crate::job::{Frames, Merged};

/// The end of `hachure merge --help`.
const EXAMPLES: &str = "\
Looks at the manifests that each process leaves in the folder and at every file that they name: \
whether it is there, whole, and made of what it was to be made of. Ends with 0 where all is there, else with 1.

Example:
  hachure merge frames/

  What shards drew on several machines, as a motion picture:
  hachure merge frames/ --video flight.mp4";

/// Flags of `hachure merge`, as typed.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct MergeArguments {
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
/// As [`Merged::all`]; [`Error::Incomplete`] where something is missing.
pub(crate) fn run(arguments: &MergeArguments, talk: &Talk) -> Result<()> {
    let all = Merged::all(&arguments.folder)?;
    all.iter().try_for_each(|merged| tell(merged, &arguments.folder, talk))?;
    let missing: usize = all.iter().map(Merged::missing).sum();
    if missing > 0 {
        let what = format!("{}: {missing} are missing", shown(&arguments.folder));
        return Err(Error::incomplete(what, "run the command that made the others again: it makes what is missing"));
    }
    arguments.video.as_deref().map_or(Ok(()), |video| make(video, &all, &arguments.folder, talk))
}

/// Says what is there of a sequence, and what is missing.
fn tell(merged: &Merged, folder: &Path, talk: &Talk) -> Result<()> {
    let (count, whole) = (merged.manifest.count, merged.whole.numbers().len());
    let s = if merged.manifests == 1 { "" } else { "s" };
    talk.answer(&format!(
        "{}: {whole} of {count} are whole, by {} manifest{s} of {}",
        shown(folder),
        merged.manifests,
        merged.manifest.of
    ))?;
    let list = |what: &str, frames: &Frames| match frames.last() {
        None => Ok(()),
        Some(_) => talk.answer(&format!("{what}: {frames}")),
    };
    list("missing or not whole", &merged.broken)?;
    list("in no manifest", &merged.unknown)?;
    let counts: BTreeSet<u32> = merged.absent.iter().map(|shard| shard.count).collect();
    for count in counts {
        let shards: Frames =
            merged.absent.iter().filter(|shard| shard.count == count).map(|shard| shard.index).collect();
        talk.answer(&format!("never ran: shard {shards} of {count}"))?;
    }
    merged.failed.iter().try_for_each(|(n, why)| talk.answer(&format!("{n} failed: {why}")))
}

/// Makes a motion picture of what is there.
fn make(video: &Path, all: &[Merged], folder: &Path, talk: &Talk) -> Result<()> {
    let mut flights =
        all.iter().filter_map(|merged| Some((merged, merged.manifest.fps?, merged.manifest.inks.as_ref()?)));
    let Some((merged, fps, inks)) = flights.next_back() else {
        return Err(Error::setting(Setting::Video, "no flight is in the folder", "make it of the frames of a flight"));
    };
    let Some(pictures) = &merged.pictures else {
        return Err(Error::setting(Setting::Video, "the frames have no pictures", "draw them as .png too"));
    };
    let pictures: Vec<PathBuf> = pictures.iter().map(|path| folder.join(path)).collect();
    let film = film::of(video, fps, Taken::inputs(pictures.iter().map(PathBuf::as_path)), &pictures)?;
    let progress = Progress::start(talk, ProgressForm::Bar, 0);
    film::make(&film, &pictures, inks, &progress, talk)
}
