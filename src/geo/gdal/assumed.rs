//! What has to be assumed of the numbers of a DEM's files, in words.

use std::path::Path;

use super::doubt::{doubts, other_units, sentinels};
use super::elevation::Elevation;
use super::tally::Tally;
use crate::error::{Message, Setting, shown};
use crate::geo::Nodata;
use crate::message;

/// Files whose doubtful heights are told one by one.
const FILES: usize = 3;

/// A file with the rules and the tally of its numbers.
pub(super) struct Tallied<'a> {
    pub path: &'a Path,
    pub elevation: &'a Elevation,
    pub tally: &'a Tally,
}

/// Of numbers that are void by their impossible value alone, and of those that hardly are heights; files are named where
/// there are `several`.
pub(super) fn assumed(files: &[Tallied<'_>], several: bool) -> Vec<Message> {
    marked(files).into_iter().chain(doubted(files, several)).collect()
}

/// Units in which all numbers of a file would be elevations, where in metres they are too high or deep for any.
pub(super) fn units(files: &[Tallied<'_>]) -> Option<Message> {
    files.iter().find_map(|file| other_units(file.tally, file.elevation))
}

/// What is void by its impossible value alone, in all files.
fn marked(files: &[Tallied<'_>]) -> Option<Message> {
    let with_marks: Vec<_> = files.iter().filter(|file| file.tally.marks > 0).collect();
    let marks = with_marks.iter().map(|file| file.tally.marks).sum::<usize>();
    let first = with_marks.first()?;
    let mut numbers: Vec<_> = with_marks.iter().flat_map(|file| sentinels(file.tally, file.elevation)).collect();
    numbers.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
    numbers.dedup();
    let remedy = match numbers.as_slice() {
        [] => match units(files) {
            Some(units) => message!["if they are heights in another unit, add ", units],
            None => message!["if they are heights, say their unit with ", Setting::ElevationUnit],
        },
        numbers => {
            let declared = match numbers {
                [[low, high]] if low == high => {
                    let number = Nodata::new(vec![[*low, *high]]);
                    format!(", or declare it with `gdal_translate -a_nodata {number} IN OUT.tif`")
                }
                _ => String::new(),
            };
            let said = first.elevation.said().with(numbers);
            message!["no such nodata is declared; name it with ", Setting::Nodata.at(said), declared]
        }
    };
    let voids = format!("{marks} samples at or below -32767 or above 100000 m are voids (");
    Some(message![voids, remedy, ")"])
}

/// What hardly is a height, file by file.
fn doubted(files: &[Tallied<'_>], several: bool) -> Vec<Message> {
    let of = |file: &Tallied<'_>| doubts(file.tally, file.elevation);
    let named = |path: &Path, clause: Message| match several {
        true => message![format!("{}: ", shown(path)), clause],
        false => clause,
    };
    let doubted: Vec<_> =
        files.iter().map(|file| (file.path, of(file))).filter(|(_, found)| !found.is_empty()).collect();
    let more = doubted.len().saturating_sub(FILES);
    let first = doubted.into_iter().take(FILES);
    let mut told: Vec<_> =
        first.flat_map(|(path, found)| found.into_iter().map(move |clause| named(path, clause))).collect();
    if more > 0 {
        told.push(format!("numbers of {more} more files are heights, of which the like holds").into());
    }
    told
}
