//! `hachure cache`: what is kept of DEMs and truths; and the flags of every subcommand that keeps some.

use std::fmt::{self, Display, Formatter};
use std::path::PathBuf;
use std::time::SystemTime;

use super::reference;
use super::talk::Talk;
use super::terrain::{TerrainArguments, warn_of_survey};
use super::values;
use super::words::told;
use crate::cache::{Cache, Cleared, SIZE, ShelfEntry};
use crate::error::{Error, Result, shown};
use crate::surface::Surface;

/// The end of `hachure cache --help`.
const EXAMPLES: &str = "\
Examples:
  What is there, the one used last first:
  hachure cache

  Make what views of a large DEM need, before anybody waits for it:
  hachure cache --make large.tif

  Remove all that nobody uses at the moment:
  hachure cache --clear";

/// Flags that say where things are kept.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Cache")]
pub(crate) struct CacheArguments {
    /// The folder in which things are kept for later runs [default: the user's folder for caches]
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// Bytes it may take, in B, KiB, MiB, GiB or TiB; beyond, what was used longest ago goes
    #[arg(long, value_name = "SIZE", value_parser = size, default_value_t = Size(SIZE))]
    cache_size: Size,
}

/// Flags of `hachure cache`, as typed.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES, after_long_help = reference::of(&[reference::KEPT, EXAMPLES]), mut_arg("dems", |dems| dems.required(false).requires("make")))]
pub(crate) struct CacheCommand {
    /// Remove all that is not in use
    #[arg(long, conflicts_with = "make")]
    clear: bool,
    /// Make what is kept of the DEM, read with the flags given
    #[arg(long, requires = "dems")]
    make: bool,
    #[command(flatten)]
    terrain: TerrainArguments,
    #[command(flatten)]
    cache: CacheArguments,
}

/// Bytes, as the flags have them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Size(u64);

fn size(text: &str) -> std::result::Result<Size, String> {
    values::bytes(text).map(Size)
}

impl Display for Size {
    fn fmt(&self, to: &mut Formatter<'_>) -> fmt::Result {
        const UNITS: [&str; 5] = ["B", "KiB", "MiB", "GiB", "TiB"];
        let power = (0..UNITS.len()).rev().find(|power| self.0 >> (10 * power) > 0).unwrap_or(0);
        let number = self.0 as f64 / (1_u64 << (10 * power)) as f64;
        write!(to, "{}{}", (number * 10.0).round() / 10.0, UNITS[power])
    }
}

impl CacheArguments {
    /// The cache that they mean.
    pub(crate) fn cache(&self) -> Cache {
        self.cache.clone().map_or_else(Cache::of_user, Cache::in_folder).with_size(self.cache_size.0)
    }
}

/// Lists, clears or makes.
///
/// # Errors
/// Those of reading a DEM; [`crate::error::Error::Output`] where standard output takes no more.
pub(crate) fn run(arguments: &CacheCommand, talk: &Talk) -> Result<()> {
    let cache = arguments.cache.cache();
    if arguments.make {
        return make(&arguments.terrain, &cache, talk);
    }
    let Some(folder) = cache.folder() else {
        return talk.answer("nothing is kept: this system names no folder for caches; give --cache DIR");
    };
    if arguments.clear {
        let Cleared { files, bytes, stayed } = cache.clear();
        let left = if stayed == 0 { String::new() } else { format!("; {stayed} in use or not to be removed stay") };
        return talk.answer(&format!("{}: {files} files of {} removed{left}", shown(folder), Size(bytes)));
    }
    let files = cache.list();
    let now = SystemTime::now();
    files.iter().try_for_each(|file| talk.answer(&line(file, now)))?;
    let bytes = files.iter().map(|file| file.bytes).sum();
    let (used, most) = (Size(bytes), Size(cache.size()));
    talk.answer(&format!("{}: {} files, {used} of {most}", shown(folder), files.len()))
}

/// Name, kind, size, last use and what it is of.
fn line(ShelfEntry { name, kind, bytes, used, of }: &ShelfEntry, now: SystemTime) -> String {
    let seconds = now.duration_since(*used).map_or(0, |age| age.as_secs());
    let (number, unit) = match seconds {
        0..120 => (seconds, "s"),
        120..7200 => (seconds / 60, "min"),
        7200..172_800 => (seconds / 3600, "h"),
        _ => (seconds / 86_400, "days"),
    };
    let of = of.as_deref().filter(|of| !of.is_empty()).unwrap_or("-");
    format!("{name}  {kind:8}  {:>9}  used {number} {unit} ago  {of}", Size(*bytes).to_string())
}

fn make(terrain: &TerrainArguments, cache: &Cache, talk: &Talk) -> Result<()> {
    let dem = terrain.read(terrain.open(&terrain.dems, 1.0, cache.clone())?, talk)?;
    let label = dem.label();
    if !dem.is_filed() {
        return talk
            .say(&format!("{label}: nothing to keep, it is held in memory (see --memory) and read in a moment"));
    }
    let (on_disk, surface) = (dem.stamp().is_some(), Surface::new(dem));
    if cache.folder().is_none() || !on_disk {
        return talk.say(&format!("{label}: nothing to keep, it or the cache is not on the disk"));
    }
    cache.prepare(&surface, &|message| talk.warn(&told(message)), &|done| {
        talk.progress("looking at every sample", done)
    })?;
    talk.progress("looking at every sample", 1.0);
    warn_of_survey(surface.dem(), talk)?;
    if !cache.keeps(surface.dem()) {
        let folder = cache.folder().map(shown).unwrap_or_default();
        let what = format!("{label}: what was made is not kept in {folder}");
        return Err(Error::limit(what, "give a folder that can be written, with --cache DIR"));
    }
    talk.say(&format!("{label}: ready"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_printed_as_they_are_typed() {
        for text in ["2GiB", "1.5MiB", "512B", "1TiB"] {
            assert_eq!(size(text).map(|size| size.to_string()), Ok(text.to_owned()));
        }
    }
}
