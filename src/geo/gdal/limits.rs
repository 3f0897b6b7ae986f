//! Whether the samples of a DEM are held in memory or stay in their files.
//!
//! What fits the budget is held. Larger DEMs stay in their files, unless all samples are needed at once: where they are
//! warped (a warp of parts gives other bits than one of the whole), where files of several grids are laid together, or
//! where voids are filled (from a hundred samples away). These are refused.

use std::path::{Path, PathBuf};

use super::grid::GeoGrid;
use super::layers::Layers;
use super::target::Target;
use crate::dem::{LARGEST_SIDE, MAX_SAMPLES, held_bytes, mebibytes};
use crate::error::{Error, Message, Result, Setting, shown};
use crate::geo::ReadOptions;
use crate::message;

/// Most samples that are read to be warped: 1 GiB.
const MAX_READ: u64 = 1 << 28;
/// Bytes a sample of the files at work.
const READ_BYTES: u64 = 4;
/// Bytes a sample of the DEM at work while layers are blended, see `seams`.
const SEAM_BYTES: u64 = 28;

/// Why GDAL must have all samples at once.
pub(super) enum Whole {
    /// The files' grid is warped to metres.
    Warped,
    /// This file lies between the samples of others.
    Layers(PathBuf),
    /// Voids are filled.
    Filled,
}

/// Whether a warp to `target` has room within the limits and the budget, whatever memory is free, so that a DEM is the same
/// on every run; else what would give it room, if anything but a smaller part would.
pub(super) fn more_room(target: &Target, options: &ReadOptions) -> std::result::Result<(), Option<Message>> {
    let samples = target.grid.whole().samples();
    if target.window.samples() > MAX_READ {
        return Err(None);
    }
    if samples > MAX_SAMPLES as u64 {
        let metres = target.metres_to_fit((MAX_SAMPLES as u64).min(samples_in(options.memory)));
        return Err(Some(message!["use ", Setting::Resample.at(metres), format!(" for cells of {metres} m")]));
    }
    if held_bytes(samples) > options.memory {
        return Err(Some(message!["give ", mebibytes(held_bytes(samples).div_ceil(1 << 20))]));
    }
    Ok(())
}

/// Samples that fit into so many bytes.
fn samples_in(memory: u64) -> u64 {
    memory / held_bytes(8) * 8
}

/// Whether the samples of `target` are to be held. Fails where they can be neither held nor filed, or memory is short.
pub(super) fn are_held(layers: &Layers, target: &Target, options: &ReadOptions) -> Result<bool> {
    let (grid, path) = (&target.grid, layers.first().path());
    let samples = grid.columns as u64 * grid.rows as u64;
    let laid = laid(layers, grid);
    laid.iter().try_for_each(|(path, read)| check_read(path, *read, samples))?;
    let why = match layers.all() {
        [coarsest, _, ..] => {
            let between = laid.first().map_or(coarsest.path(), |(path, _)| path);
            Some(Whole::Layers(between.to_owned()))
        }
        _ if target.warps => Some(Whole::Warped),
        _ => options.fill_voids.then_some(Whole::Filled),
    };
    if samples > MAX_SAMPLES as u64 || held_bytes(samples) > options.memory {
        return match why {
            Some(why) if samples > MAX_SAMPLES as u64 => {
                Err(too_many(path, grid, &why, target.metres_to_fit(MAX_SAMPLES as u64)))
            }
            Some(why) => Err(over_budget(path, grid, &why, options.memory)),
            None => check_longest(path, grid, target.metres_to_fit(MAX_SAMPLES as u64)).map(|()| false),
        };
    }
    if layers.all().len() > 1 {
        let read = laid.iter().map(|(_, read)| *read).max().unwrap_or(0);
        check_memory(path, read * READ_BYTES + samples * SEAM_BYTES, available_memory())?;
        return Ok(true);
    }
    let work = if target.warps { target.window.samples() } else { 0 };
    if target.warps {
        check_read(path, work, 0)?;
    }
    check_memory(path, ((work + samples) * READ_BYTES).max(held_bytes(samples)), available_memory())?;
    Ok(true)
}

/// Samples to be read of each layer, where there are several, that lies between the samples of `grid`.
fn laid<'a>(layers: &'a Layers, grid: &GeoGrid) -> Vec<(&'a Path, u64)> {
    if layers.all().len() == 1 {
        return Vec::new();
    }
    let needed = layers.all().iter().zip(layers.needed(grid));
    let between = needed.filter_map(|(layer, needed)| match needed {
        Some((window, false)) => Some((layer.path(), window.samples())),
        _ => None,
    });
    between.collect()
}

impl Whole {
    /// The reason, after `fit` or `must be held`.
    fn reason(&self) -> String {
        match self {
            Self::Warped => "where they are warped".into(),
            Self::Layers(path) => format!("where {} is laid between the samples of others", shown(path)),
            Self::Filled => "where voids are filled".into(),
        }
    }

    /// What to do first, so that the samples can stay in their files.
    fn remedy(&self, grid: &GeoGrid) -> String {
        match self {
            Self::Warped => format!("warp it first: `gdalwarp -t_srs {} -r cubic IN OUT.tif`", grid.crs.typed()),
            Self::Layers(_) => {
                format!("lay them together first: `gdalwarp -t_srs {} -r cubic IN... OUT.tif`", grid.crs.typed())
            }
            Self::Filled => "fill them first: `gdal_fillnodata.py IN OUT.tif`".into(),
        }
    }
}

/// The error for a grid of more than [`MAX_SAMPLES`] that must be held; cells of `metres` make few enough.
pub(super) fn too_many(path: &Path, grid: &GeoGrid, why: &Whole, metres: f64) -> Error {
    let GeoGrid { columns, rows, .. } = grid;
    let samples = *columns as u64 * *rows as u64;
    let reason = why.reason();
    Error::limit(
        format!("{}: {columns} x {rows} = {samples} samples, at most {MAX_SAMPLES} fit {reason}", shown(path)),
        message![why.remedy(grid), ", ", coarser(metres)],
    )
}

fn over_budget(path: &Path, grid: &GeoGrid, why: &Whole, memory: u64) -> Error {
    let samples = grid.columns as u64 * grid.rows as u64;
    let (needed, reason) = (held_bytes(samples).div_ceil(1 << 20), why.reason());
    Error::limit(
        message![
            format!("{}: needs {needed} MiB of memory {reason}, more than ", shown(path)),
            Setting::Memory,
            " allows"
        ],
        message!["give ", mebibytes(needed), format!(" (it is {}), or {}", in_words(memory), why.remedy(grid))],
    )
}

/// So many bytes, in whole MiB from a few on.
fn in_words(bytes: u64) -> String {
    if bytes < 4 << 20 { format!("{} KiB", bytes >> 10) } else { format!("{} MiB", bytes >> 20) }
}

fn check_longest(path: &Path, grid: &GeoGrid, metres: f64) -> Result<()> {
    let GeoGrid { columns, rows, .. } = grid;
    if *columns.max(rows) <= LARGEST_SIDE {
        return Ok(());
    }
    Err(Error::limit(
        format!("{}: {columns} x {rows} samples, at most {LARGEST_SIDE} along a side fit", shown(path)),
        coarser(metres),
    ))
}

/// As many samples of a file as may be read to be warped, beside `held` others.
fn check_read(path: &Path, read: u64, held: u64) -> Result<()> {
    if read > MAX_READ {
        return Err(Error::limit(
            format!("{}: {read} samples would be read to be warped, at most {MAX_READ} fit", shown(path)),
            message![
                "use ",
                Setting::Crop,
                " to take a part, or make it coarser: `gdal_translate -outsize 10% 10% -r average IN OUT.tif`"
            ],
        ));
    }
    check_memory(path, (read + held) * READ_BYTES, available_memory())
}

fn check_memory(path: &Path, needed: u64, available: Option<u64>) -> Result<()> {
    match available {
        Some(available) if available < needed => Err(Error::limit(
            format!("{}: needs {} MiB of memory, {} MiB are free", shown(path), needed >> 20, available >> 20),
            message![
                "use ",
                Setting::Crop,
                " to take a part, or ",
                Setting::Resample.with_value(),
                " for larger cells"
            ],
        )),
        _ => Ok(()),
    }
}

/// Fewer samples: a part of them, or cells of so many metres.
fn coarser(metres: f64) -> Message {
    let cells = format!(" for cells of {metres} m");
    message!["use ", Setting::Crop, " to take a part, or ", Setting::Resample.at(metres), cells]
}

/// Bytes of memory that new work may take, where the system says so (Linux).
fn available_memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    line.trim().trim_end_matches(" kB").parse::<u64>().ok().map(|kib| kib * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_checked_before_it_is_taken() {
        let path = Path::new("a.tif");
        assert!(check_memory(path, 100 << 20, Some(100 << 20)).is_ok());
        assert!(check_memory(path, 100 << 20, None).is_ok());
        let said = check_memory(path, 200 << 20, Some(100 << 20)).unwrap_err().to_string();
        assert_eq!(said.split(';').next(), Some("a.tif: needs 200 MiB of memory, 100 MiB are free"));
    }
    /// What more room a warp to squares of 10 m, so many along a side, needs with so much memory.
    fn room(side: usize, memory: u64) -> std::result::Result<(), Option<String>> {
        let matrix = glam::DMat2::from_diagonal(glam::DVec2::new(10.0, -10.0));
        let to_crs = glam::DAffine2::from_mat2_translation(matrix, glam::DVec2::ZERO);
        let grid = GeoGrid { crs: crate::dem::Crs::unknown(), to_crs, columns: side, rows: side };
        let window = crate::dem::Window { first: [0; 2], size: [side; 2] };
        let target = Target { grid, window, warps: true, cut: None };
        let options = ReadOptions { memory, ..Default::default() };
        more_room(&target, &options).map_err(|more| more.map(|more| more.to_string()))
    }

    #[test]
    fn what_would_make_room_for_a_warp_is_named() {
        assert_eq!(room(2000, 1 << 30), Ok(()));
        assert_eq!(room(2000, 47 << 20), Ok(()));
        assert_eq!(room(2000, 46 << 20), Err(Some("give memory 47MiB".into())));
        // Beyond the limit no memory helps; cells of which no more than fit.
        let said = room(6000, 1 << 40).unwrap_err().unwrap_or_default();
        assert_eq!(said, "use resample 11 for cells of 11 m");
        assert!(room(6000 * 10 / 11, 1 << 40).is_ok());
        assert_eq!(room(17_000, 1 << 40), Err(None), "more than are read at once");
        assert_eq!([in_words(500 << 10), in_words(100 << 20)], ["500 KiB", "100 MiB"]);
    }
}
