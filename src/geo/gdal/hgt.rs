//! Tiles of the Shuttle mission (.hgt): heights without a header, whose place is their name alone.
//!
//! GDAL reads `N45E006.hgt` and `N45E006.SRTMGL1.hgt`, and refuses copies and renamed ones without a word why.

use std::path::Path;

use super::mistaken::Told;
use super::shell;

/// Lengths of the tiles there are, bytes, each with its columns and rows: 3, 1, 1 x 2 and half a second of arc.
const LENGTHS: [(u64, &str); 4] = [
    (2 * 1201 * 1201, "1201 x 1201"),
    (2 * 3601 * 3601, "3601 x 3601"),
    (2 * 1801 * 3601, "1801 x 3601"),
    (2 * 7201 * 7201, "7201 x 7201"),
];
/// Letters of `N45E006`.
const CORNER: usize = 7;

/// Why GDAL refused a file of `length` bytes that is called as a tile is.
pub(super) fn what(path: &Path, length: u64) -> Option<Told> {
    let name = path.file_name()?.to_string_lossy().into_owned();
    if !name.to_ascii_lowercase().ends_with(".hgt") {
        return None;
    }
    if !LENGTHS.iter().any(|(known, _)| *known == length) {
        let [(three, columns), (one, more), ..] = LENGTHS;
        let what = format!("is no whole .hgt tile: it has {length} bytes, not {three} ({columns}) or {one} ({more})");
        return Some((what, "copy or download it again".into()));
    }
    let what = "is a .hgt tile, whose place is its name alone, and this name says none that is understood".to_owned();
    let from = shell::file(path.as_os_str());
    let remedy = match corner(&name) {
        Some(corner) => format!("copy it to a name that does: `cp -n {from} {corner}.hgt`"),
        None => format!(
            "copy it to the name of its south-west corner, for 45 degrees north and 6 east for instance: \
             `cp -n {from} N45E006.hgt`"
        ),
    };
    Some((what, remedy))
}

/// The corner somewhere in a name, as GDAL wants it.
pub(super) fn corner(name: &str) -> Option<String> {
    let name = name.to_ascii_uppercase();
    let is_corner = |part: &str| {
        let number = |part: &str| part.bytes().all(|b| b.is_ascii_digit()).then(|| part.parse::<u32>().ok()).flatten();
        let latitude = part.starts_with(['N', 'S']) && number(&part[1..3]).is_some_and(|degrees| degrees <= 90);
        latitude && part[3..].starts_with(['E', 'W']) && number(&part[4..]).is_some_and(|degrees| degrees <= 180)
    };
    let parts = (0..name.len()).filter_map(|at| name.get(at..at + CORNER));
    parts.filter(|part| part.is_ascii()).find(|part| is_corner(part)).map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_found_in_names() {
        let found = |name| corner(name).unwrap_or_default();
        assert_eq!(found("N45W074T86.hgt"), "N45W074");
        assert_eq!(found("n45e006 (1).hgt"), "N45E006");
        assert_eq!(found("tile_s07w080_v3.hgt"), "S07W080");
        assert_eq!(found("srtm tile.hgt"), "");
        assert_eq!(found("N99E006.hgt"), "", "no such latitude");
        assert_eq!(found("höheN45E00ä.hgt"), "");
    }
}
