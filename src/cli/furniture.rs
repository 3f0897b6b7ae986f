//! Flags of what stands around a picture: title, neatline, view line, credits.

use std::path::{Path, PathBuf};

use glam::DVec2;

use super::viewpoint::View;
use super::words::short;
use crate::dem::{Crs, Dem, FileSamples};
use crate::error::{Error, Result, Setting, shown};
use crate::ink::furniture::{Credits, Furniture, Texts};

/// What stands between the parts of a line: where it breaks, the dot goes.
const BETWEEN: &str = " · ";
/// A space at which no line breaks, and a narrow one that parts thousands.
const SPACE: &str = "\u{a0}";
const NARROW: char = '\u{202f}';
/// From which number on thousands are parted.
const LARGE: f64 = 10_000.0;

/// The flags, as typed.
#[derive(Debug, Clone, Default, clap::Args)]
#[command(next_help_heading = "Furniture")]
pub(crate) struct FurnitureArguments {
    /// Write a title below the picture; capitals are spaced out
    ///
    /// What is asked of furniture takes its room from the picture, and margins stay blank; without --page the sheet grows instead, with
    /// margins of its own, and the picture keeps its pixels. The mask stays as it is. In a batch over sheets of a map {sheet} is the
    /// sheet's name.
    #[arg(long, value_name = "TEXT", value_parser = text)]
    title: Option<String>,
    /// Frame the picture with two rules, a thin one along its edge and a thick one around that, in the place of registration marks
    #[arg(long)]
    neatline: bool,
    /// Write below it from where the land is seen, in which direction, how wide, and by how much heights are exaggerated; of a plan
    /// its scale and its system of coordinates
    #[arg(long)]
    view_line: bool,
    /// Write below it what the files of the DEM say of themselves (description, artist, copyright, attribution), else their name, their
    /// samples and their system of coordinates; or your own words, after =
    #[arg(long, value_name = "TEXT", value_parser = text, num_args = 0..=1, require_equals = true)]
    credits: Option<Option<String>>,
}

/// A text that says something.
fn text(text: &str) -> std::result::Result<String, String> {
    match text.trim() {
        "" => Err("want some words".to_owned()),
        words => Ok(words.to_owned()),
    }
}

impl FurnitureArguments {
    /// What is wanted.
    pub(crate) fn furniture(&self) -> Furniture {
        Furniture {
            title: self.title.clone(),
            neatline: self.neatline,
            view_line: self.view_line,
            credits: self.credits.clone().map(|own| own.map_or(Credits::OfFiles, Credits::Own)),
        }
    }

    /// Whether rules frame the picture.
    pub(crate) fn is_framed(&self) -> bool {
        self.neatline
    }

    /// A sheet of a map is called so.
    pub(crate) fn on_sheet(&mut self, mark: &str, name: &str) {
        let own = self.credits.iter_mut().flatten();
        self.title.iter_mut().chain(own).for_each(|text| *text = text.replace(mark, name));
    }

    /// Refuses it for frames, which would bear the same words thousands of times.
    ///
    /// # Errors
    /// [`Error::Setting`].
    pub(crate) fn refuse_for_frames(&self) -> Result<()> {
        let given = [
            (Setting::Title, self.title.is_some()),
            (Setting::Neatline, self.neatline),
            (Setting::ViewLine, self.view_line),
            (Setting::Credits, self.credits.is_some()),
        ];
        let refuse =
            |setting| Error::setting(setting, "goes with drawings, frames of a flight have none", "leave it out");
        given.into_iter().find(|(_, given)| *given).map_or(Ok(()), |(setting, _)| Err(refuse(setting)))
    }
}

/// The texts of a view of a DEM read from these files, heights times `exaggeration`.
pub(crate) fn of_view(view: &View, exaggeration: f64, dems: &[PathBuf], dem: &Dem) -> Texts {
    let camera = &view.camera;
    let place = view.lonlat.map_or_else(|| in_file(view.file), in_degrees);
    let parts = [
        format!("From {place} at {}", metres(camera.eye.z / exaggeration)),
        format!("looking {}° from {} north, {}", bearing(view.azimuth), view.norths.north, tilt(camera.altitude)),
        format!("field of view {}°", tenths(camera.fov)),
        if exaggeration == 1.0 {
            "heights not exaggerated".to_owned()
        } else {
            format!("heights × {}", short(exaggeration))
        },
    ];
    Texts { view_line: line(parts), credits: credits(dems, dem, "") }
}

/// The texts of a plan of an area of a DEM, metres of its world, at a scale.
///
/// # Errors
/// As [`Georeference::lonlat`](crate::dem::Georeference::lonlat).
pub(crate) fn of_plan(scale: f64, [west, south, east, north]: [f64; 4], dems: &[PathBuf], dem: &Dem) -> Result<Texts> {
    let georeference = dem.georeference();
    let middle = DVec2::new(west + east, south + north) / 2.0;
    let place = match georeference.lonlat(middle)? {
        Some(lonlat) => Some(in_degrees(lonlat)),
        None => georeference.place_in(georeference.file(), middle).map(in_file),
    };
    let label = georeference.world().label();
    let north = (!label.is_empty()).then(|| format!("{label}, grid north up"));
    let credits = credits(dems, dem, &label);
    let parts = [
        Some(format!("1 : {}", grouped(scale))),
        Some(format!("1 cm to {}", distance(scale / 100.0))),
        place.map(|place| format!("middle at {place}")),
        north,
    ];
    Ok(Texts { view_line: line(parts.into_iter().flatten()), credits })
}

/// Parts of a line, which breaks between them alone.
fn line(parts: impl IntoIterator<Item = String>) -> String {
    let parts: Vec<String> = parts.into_iter().map(|part| part.replace(' ', SPACE)).collect();
    parts.join(BETWEEN)
}

/// What the files say of themselves, else which they are, and their system where that is not `told` already.
fn credits(dems: &[PathBuf], dem: &Dem, told: &str) -> String {
    let said = dem.history().credits();
    if !said.is_empty() {
        return said.join(BETWEEN);
    }
    let name = |path: &PathBuf| shown(path.file_name().map_or(path.as_path(), Path::new));
    let name = match dems {
        [] => dem.label(),
        [first] => name(first),
        [first, others @ ..] => format!("{} and {} more", name(first), others.len()),
    };
    let of_files = dem.history().samples();
    let label = of_files.and_then(|samples| samples.crs.as_ref()).map(Crs::label);
    let parts = [
        Some(format!("Terrain: {name}")),
        of_files.and_then(|of_files| samples(of_files, dems.len() > 1)),
        label.filter(|label| label != told && !label.is_empty()),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join(BETWEEN)
}

/// How many samples a file has, or each of several, and how far apart; `None` where several have neither in common.
fn samples(FileSamples { size, cell, crs }: &FileSamples, is_of_each: bool) -> Option<String> {
    let each = if is_of_each { " each," } else { "" };
    let size = size.map(|[columns, rows]| format!("{columns} × {rows} samples{each}"));
    let apart = cell.zip(crs.as_ref()).map(|(cell, crs)| format!(" {} apart", spacing(cell, crs)));
    match (size, apart) {
        (None, None) => None,
        (size, None) => size.map(|size| size.trim_end_matches(',').to_owned()),
        (size, Some(apart)) => Some(size.unwrap_or_else(|| "samples".to_owned()) + &apart),
    }
    .map(|words| words.replace(' ', SPACE))
}

/// The sides of a cell in the unit of its system, arc seconds for a small one in degrees.
fn spacing(cell: DVec2, crs: &Crs) -> String {
    let (sides, unit) = match (crs.turn(), crs.metres_per_unit()) {
        (Some(turn), _) => match cell * 360.0 / turn {
            degrees if degrees.max_element() < 0.1 => (degrees * 3600.0, "″".to_owned()),
            degrees => (degrees, "°".to_owned()),
        },
        (None, Some(1.0)) => (cell, " m".to_owned()),
        (None, _) => (cell, format!(" × {}", crs.units())),
    };
    match sides.to_array().map(short) {
        [across, down] if across == down => across + &unit,
        [across, down] => format!("{across} × {down}{unit}"),
    }
}

/// Longitude and latitude, to some ten metres.
fn in_degrees(lonlat: DVec2) -> String {
    let side = |degrees: f64, [plus, minus]: [char; 2]| {
        format!("{:.4}°{NARROW}{}", degrees.abs(), if degrees < 0.0 { minus } else { plus })
    };
    format!("{}, {}", side(lonlat.y, ['N', 'S']), side(lonlat.x, ['E', 'W']))
}

/// Coordinates of the file.
fn in_file(place: DVec2) -> String {
    format!("E {}, N {}", grouped(place.x), grouped(place.y))
}

fn metres(height: f64) -> String {
    format!("{}{SPACE}m", grouped(height))
}

fn distance(metres: f64) -> String {
    match metres {
        metres if metres >= 1000.0 => format!("{} km", hundredths(metres / 1000.0)),
        metres => format!("{} m", hundredths(metres)),
    }
}

/// An altitude with one decimal at most.
fn tilt(degrees: f64) -> String {
    match tenths(degrees.abs()).as_str() {
        "0" => "level".to_owned(),
        off => format!("{off}° {}", if degrees < 0.0 { "down" } else { "up" }),
    }
}

/// A bearing with one decimal at most, below 360.
fn bearing(degrees: f64) -> String {
    let text = tenths(degrees);
    if text == "360" { "0".to_owned() } else { text }
}

/// With one decimal at most.
fn tenths(number: f64) -> String {
    format!("{}", (number * 10.0).round() / 10.0 + 0.0)
}

/// With two decimals at most.
fn hundredths(number: f64) -> String {
    format!("{}", (number * 100.0).round() / 100.0 + 0.0)
}

/// A whole number, thousands of large ones apart.
fn grouped(number: f64) -> String {
    let whole = number.abs().round();
    let digits = format!("{whole:.0}");
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && whole >= LARGE && (digits.len() - i).is_multiple_of(3) {
            text.push(NARROW);
        }
        text.push(digit);
    }
    if number < 0.0 && whole > 0.0 { format!("−{text}") } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_as_on_maps() {
        assert_eq!([grouped(312.4), grouped(9999.0), grouped(-0.2), grouped(-430.0)], ["312", "9999", "0", "−430"]);
        assert_eq!([grouped(25_000.0), grouped(4_183_300.4)], ["25\u{202f}000", "4\u{202f}183\u{202f}300"]);
        assert_eq!([distance(250.0), distance(2500.0), distance(0.5)], ["250 m", "2.5 km", "0.5 m"]);
        assert_eq!([tenths(318.04), tenths(-0.01), tenths(50.0)], ["318", "0", "50"]);
        assert_eq!([bearing(318.04), bearing(359.94), bearing(359.96)], ["318", "359.9", "0"]);
        assert_eq!([tilt(-89.6), tilt(0.04), tilt(12.0)], ["89.6° down", "level", "12° up"]);
        assert_eq!(in_degrees(DVec2::new(-122.478_13, 37.0)), "37.0000°\u{202f}N, 122.4781°\u{202f}W");
    }

    #[test]
    fn lines_break_between_their_parts_alone() {
        let line = line(["From here at 3 m".to_owned(), "level".to_owned()]);
        assert_eq!(line.matches(' ').count(), 2, "{line}");
        assert!(line.contains(BETWEEN));
    }
}
