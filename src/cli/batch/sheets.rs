//! The sheets of a map: squares of a grid, each a drawing of its own with some land around it.

use std::collections::BTreeSet;
use std::path::PathBuf;

use glam::DVec2;

use super::entry::BatchEntry;
use crate::cache::Cache;
use crate::cli::talk::Talk;
use crate::cli::values;
use crate::dem::{Crs, Dem};
use crate::error::{Error, Result, Setting, shown};
use crate::message;

/// Most sheets of a map.
const MOST: f64 = 1e5;
/// Places along a side of a rectangle at which is looked where it runs in another system.
const LOOKS: u32 = 16;
/// Samples across and down that are looked at together.
const BLOCK: usize = 16;
/// What stands for the name of a sheet in the names of files.
const MARK: &str = "{sheet}";

/// The flags, as typed.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Sheets")]
pub(super) struct SheetArguments {
    /// Make each drawing once for each sheet of a map, squares of this system of coordinates in which there is land of the DEM;
    /// names of outputs hold {sheet}, which becomes the sheet's south-western corner; sheets without any of --lines are drawn
    /// without. In a system that is turned against that
    /// of the DEM plans show the least upright rectangle around the sheet
    #[arg(long, value_name = "EPSG:N", value_parser = values::epsg, requires = "sheet")]
    grid: Option<u32>,
    /// The side of a sheet
    #[arg(long, value_name = "10km", value_parser = values::distance, requires = "grid")]
    sheet: Option<f64>,
    /// Land around each sheet that is drawn from too; of a plan it stays off the page. A plan of a DEM that fits --memory is drawn
    /// from all of it, so that lines run on from sheet to sheet
    #[arg(long, value_name = "2km", value_parser = values::distance, requires = "grid", default_value = "0m")]
    halo: f64,
}

/// Squares of a grid.
struct SheetGrid {
    crs: Crs,
    /// Metres, and units of the grid.
    side: f64,
    halo: f64,
    metres: f64,
}

impl SheetArguments {
    /// The drawings, one for each sheet where a grid is given.
    ///
    /// # Errors
    /// [`Error::Setting`]; whatever keeps a DEM from being read.
    pub(super) fn sheets(&self, entries: Vec<BatchEntry>, cache: &Cache, talk: &Talk) -> Result<Vec<BatchEntry>> {
        let (Some(code), Some(side)) = (self.grid, self.sheet) else { return self.without_grid(entries) };
        if side <= 0.0 {
            return Err(Error::setting(Setting::Sheet, "a sheet of no length holds nothing", "give its side, as 10km"));
        }
        let crs = Crs::from_epsg(code)?;
        let Some(metres) = crs.metres_per_unit() else {
            let what = format!("{} counts degrees, a sheet is so many metres long", crs.label());
            return Err(Error::setting(Setting::Grid, what, "give a system of metres, as that of a UTM zone"));
        };
        let grid = SheetGrid { crs, side: side / metres, halo: self.halo / metres, metres };
        let (mut sheets, mut last): (Vec<BatchEntry>, Option<(String, Dem)>) = Default::default();
        for entry in entries {
            let of = entry.draw.scene();
            if last.as_ref().is_none_or(|(other, _)| *other != of) {
                last = entry
                    .draw
                    .open(cache.clone())
                    .and_then(|reading| entry.draw.terrain.read(reading, talk))
                    .ok()
                    .map(|dem| (of, dem));
            }
            // What cannot be read fails as the drawing is made.
            let Some((_, dem)) = &last else {
                sheets.push(entry);
                continue;
            };
            for corner in grid.corners(dem)? {
                sheets.push(grid.sheet(&entry, dem, corner)?);
            }
        }
        match sheets.is_empty() {
            true => Err(Error::setting(
                Setting::Grid,
                "no sheet holds land of a DEM",
                "give the system in which the DEM lies",
            )),
            false => Ok(sheets),
        }
    }

    /// The drawings as they are, none of which may ask for sheets.
    fn without_grid(&self, entries: Vec<BatchEntry>) -> Result<Vec<BatchEntry>> {
        let has_mark = |path: &&PathBuf| path.to_string_lossy().contains(MARK);
        let marked = entries.iter().flat_map(|entry| entry.draw.outputs.files().0).find(has_mark);
        marked.map_or(Ok(()), |path| {
            let what = format!("{} is named after sheets, and there are none", shown(path));
            Err(Error::setting(
                Setting::Output,
                what,
                message!["add ", Setting::Grid.with_value(), ", or name it without"],
            ))
        })?;
        Ok(entries)
    }
}

impl SheetGrid {
    /// South-western corners of the sheets that hold land, from south to north and from west to east, in sides.
    fn corners(&self, dem: &Dem) -> Result<Vec<[i64; 2]>> {
        let ([west, south, east, north], georeference) = (dem.extent(), dem.georeference());
        let outline = outline([DVec2::new(west, south), DVec2::new(east, north)]);
        let places: Vec<DVec2> = outline.filter_map(|place| georeference.place_in(&self.crs, place)).collect();
        let Some(first) = places.first() else {
            let what = format!("the DEM has no place in {}", self.crs.label());
            return Err(Error::setting(Setting::Grid, what, "give the system in which the DEM lies"));
        };
        let low = places.iter().fold(*first, |low, place| low.min(*place)) / self.side;
        let high = places.iter().fold(*first, |high, place| high.max(*place)) / self.side;
        // Of sides next to nothing there may be more than integers count.
        let [across, up] = (high.ceil() - low.floor()).max(DVec2::ONE).to_array();
        if !(across * up).is_finite() || across * up > MOST {
            let what = format!("makes over {MOST} sheets");
            return Err(Error::setting(Setting::Sheet, what, message!["use a larger ", Setting::Sheet]));
        }
        let thinned = dem.thinned()?;
        let mut corners: Vec<[i64; 2]> = self.with_land(&thinned, dem).into_iter().collect();
        corners.sort_unstable_by_key(|[column, row]| [*row, *column]);
        Ok(corners)
    }

    /// The sheets in which samples fall, block by block: where all corners of one fall in a sheet, so does it.
    fn with_land(&self, thinned: &Dem, dem: &Dem) -> BTreeSet<[i64; 2]> {
        let sheet_of = |column: usize, row: usize| {
            let world = thinned.position(column, row).truncate();
            let place = dem.georeference().place_in(&self.crs, world)? / self.side;
            Some([place.x.floor() as i64, place.y.floor() as i64])
        };
        let (columns, rows) = (thinned.columns(), thinned.rows());
        let blocks =
            (0..rows).step_by(BLOCK).flat_map(|row| (0..columns).step_by(BLOCK).map(move |column| [column, row]));
        let mut sheets = BTreeSet::new();
        for [left, top] in blocks {
            let (right, bottom) = ((left + BLOCK).min(columns) - 1, (top + BLOCK).min(rows) - 1);
            let inside = || (top..=bottom).flat_map(move |row| (left..=right).map(move |column| [column, row]));
            let land = || inside().filter(|[column, row]| thinned.height(*column, *row).is_some());
            let at_corners = [[left, top], [right, top], [left, bottom], [right, bottom]].map(|[c, r]| sheet_of(c, r));
            match at_corners[0].filter(|first| at_corners.iter().all(|sheet| *sheet == Some(*first))) {
                Some(sheet) => sheets.extend(land().next().map(|_| sheet)),
                None => sheets.extend(land().filter_map(|[column, row]| sheet_of(column, row))),
            }
        }
        sheets
    }

    /// The drawing of a sheet.
    fn sheet(&self, entry: &BatchEntry, dem: &Dem, corner: [i64; 2]) -> Result<BatchEntry> {
        let low = DVec2::new(corner[0] as f64, corner[1] as f64) * self.side;
        let georeference = dem.georeference();
        let in_world = |place: DVec2| georeference.world_place(&self.crs, place);
        let in_file = |place: DVec2| georeference.place_in(georeference.file(), in_world(place)?);
        let bounds = |grown: f64, carry: &dyn Fn(DVec2) -> Option<DVec2>| {
            let places: Vec<DVec2> = outline([low - grown, low + self.side + grown]).filter_map(carry).collect();
            let first = places.first()?;
            let least = places.iter().fold(*first, |low, place| low.min(*place));
            let most = places.iter().fold(*first, |high, place| high.max(*place));
            Some([least.x, least.y, most.x, most.y])
        };
        let name = self.name(low);
        let nowhere = || {
            let what = format!("sheet {name} has no place in {}", georeference.file().label());
            Error::setting(Setting::Grid, what, "give the system in which the DEM lies")
        };
        // Of samples that are held a plan is a window over the whole: lines run on from sheet to sheet.
        let is_window = entry.draw.scale().is_some() && !dem.is_filed();
        let crop = (!is_window).then(|| bounds(self.halo, &in_file).ok_or_else(nowhere)).transpose()?;
        let area = bounds(0.0, &in_world).ok_or_else(nowhere)?;
        let called = format!("{}, sheet {name}", entry.called);
        let draw = entry.draw.of_sheet(&called, [MARK, &name], crop, area, |path| {
            let text = path.to_string_lossy();
            match text.contains(MARK) {
                true => Ok(PathBuf::from(text.replace(MARK, &name))),
                false => {
                    let what = format!("{} would be each sheet's", shown(path));
                    Err(Error::setting(Setting::Output, what, format!("put {MARK} in its name")))
                }
            }
        })?;
        Ok(BatchEntry { called, draw })
    }

    /// A sheet is called after its corner: in kilometres where these are whole, else in metres.
    fn name(&self, low: DVec2) -> String {
        let metres = low * self.metres;
        let kilometres = self.side * self.metres / 1000.0;
        let unit = if (kilometres - kilometres.round()).abs() < 1e-9 { 1000.0 } else { 1.0 };
        let [east, north] = (metres / unit).to_array().map(|n| n.round() as i64);
        format!("E{east}_N{north}")
    }
}

/// Places along the sides of a rectangle.
fn outline([low, high]: [DVec2; 2]) -> impl Iterator<Item = DVec2> {
    let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
    (0..4 * LOOKS).map(move |i| {
        let (side, share) = ((i / LOOKS) as usize, f64::from(i % LOOKS) / f64::from(LOOKS));
        corners[side].lerp(corners[(side + 1) % 4], share)
    })
}
