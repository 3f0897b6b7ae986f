//! The grid that is drawn: north-up, in metres, and which samples of the files it takes.
//!
//! A projected north-up grid is taken as it is, where its map is true to the ground within a percent. Degrees and maps that
//! are not are warped to the map that is true around the middle of what is drawn (see `metric`), turned grids and grids to
//! be resampled in their own system; square cells, at whole multiples of their size, as many as fit into the largest
//! rectangle inside the data. A map so sheared that this leaves little is kept whole, with voids beside it and outside the
//! crop. Not handled: DEMs so wide that one map cannot show them.

use std::path::Path;

use glam::DVec2;

use super::crop::carried;
use super::crs::CrsPath;
use super::cut::{Cut, is_inside};
use super::grid::{GeoGrid, span};
use super::ground::{Ground, places};
use super::inscribed::largest;
use super::layer::reach;
use super::limits::{Whole, more_room, too_many};
use super::metric::{degrees, is_polar, metric};
use super::source::MIN_SIDE;
use crate::dem::{Crs, History, MAX_SAMPLES, Window};
use crate::error::{Error, Message, Result, Setting};
use crate::geo::ReadOptions;
use crate::message;

/// Pixels from the border of the files to where cubic convolution has all its samples.
const BORDER: f64 = 1.5;
/// Digits of a crop: centimetres of a northing, a tenth of a metre in degrees.
pub(super) const CROP_DIGITS: i32 = 9;
/// Samples along a side from which something is left when it is warped.
const WARPED_SIDE: usize = 5;
/// Widest and highest DEM in degrees that a zone of UTM shows within two percent of its true size.
const WIDEST: f64 = 20.0;
const HIGHEST: f64 = 30.0;
/// Least share of a map off the ground that the rectangle inside its data must hold, for the rest to be left out.
const INSIDE: f64 = 0.75;

/// What is drawn of the files' grid.
#[derive(Debug)]
pub(super) struct Target {
    /// North-up, in a system of lengths.
    pub grid: GeoGrid,
    /// The samples to read for it.
    pub window: Window,
    /// Whether it must be warped; else `window` is the grid.
    pub warps: bool,
    /// What of it is drawn, where that is not all.
    pub cut: Option<Cut>,
}

/// What is asked of the files' grid; `path` is the first file, for messages.
struct Asked<'a> {
    files: &'a GeoGrid,
    path: &'a Path,
    /// The samples inside the crop.
    window: Window,
    /// In the coordinates of `files`.
    crop: Option<[f64; 4]>,
    /// The system in which crops are typed.
    typed: &'a Crs,
    options: &'a ReadOptions,
}

impl Target {
    /// For the grid of the files; `path` is the first, for messages; `crop` is in the coordinates of `files`, and `typed` the
    /// system in which another would be typed. Fails when too little is left.
    pub(super) fn of(
        files: &GeoGrid,
        path: &Path,
        crop: Option<[f64; 4]>,
        typed: &Crs,
        options: &ReadOptions,
        history: &mut History,
    ) -> Result<Self> {
        let window = match crop {
            None => files.whole(),
            Some(crop) => files.window(crop).ok_or_else(|| outside(files, path, typed))?,
        };
        check_sides(window.size, files, path)?;
        let asked = Asked { files, path, window, crop, typed, options };
        let off = Ground::of(files, window).filter(Ground::is_off);
        let truer = off.as_ref().and_then(|off| asked.truer(off));
        let warped = truer.as_ref().zip(off.as_ref()).filter(|_| options.warp);
        let held = warped.map(|(crs, off)| asked.held(crs, off, history));
        let (held, more) =
            held.map_or((None, None), |held| held.map_or_else(|more| (None, more), |held| (Some(held), None)));
        let target = if files.crs.is_geographic() {
            asked.onto(&asked.zone()?, None, history)?
        } else if let Some(target) = held {
            target
        } else if files.is_north_up() && options.resample.is_none() {
            Self { grid: files.part(window), window, warps: false, cut: None }
        } else {
            asked.onto(&files.crs, None, history)?
        };
        check_sides([target.grid.columns, target.grid.rows], files, path)?;
        if let Some(off) = Ground::of(&target.grid, target.grid.whole()).filter(Ground::is_off) {
            let truer = truer.filter(|truer| *truer != target.grid.crs);
            history.assume(off_the_ground(&off, truer.as_ref(), more, options));
        }
        Ok(target)
    }

    /// Cell size in metres at which no more than `fit` samples are left.
    pub(super) fn metres_to_fit(&self, fit: u64) -> f64 {
        let cell = self.grid.cell() * self.grid.crs.metres_per_unit().unwrap_or(1.0);
        let samples = self.grid.columns as f64 * self.grid.rows as f64;
        // A percent more, for rows and columns are whole.
        rounded_up((cell.x * cell.y * samples / fit as f64).sqrt() * 1.01)
    }
}

impl Asked<'_> {
    /// The map around the middle, where it is truer to the ground than that of the files, which is `off` it.
    fn truer(&self, off: &Ground) -> Option<Crs> {
        let truer = metric(&self.files.crs, self.files.centre(self.window))?;
        let mut places = places(self.files, self.window).to_vec();
        CrsPath::between(&self.files.crs, &truer)?.carry(&mut places);
        places.retain(|place| place.is_finite());
        (Ground::at(&truer, &places)?.off() < off.off()).then_some(truer)
    }

    /// Warped from a map `off` the ground to `crs`; where the outcome cannot be held, what would make it fit instead, if
    /// anything but a smaller part would.
    fn held(&self, crs: &Crs, off: &Ground, history: &mut History) -> std::result::Result<Target, Option<Message>> {
        let mut own = History::default();
        let target = self.onto(crs, Some(off), &mut own).map_err(|error| match error {
            Error::Limit { .. } => Some(message!["use larger cells with ", Setting::Resample.with_value()]),
            _ => None,
        })?;
        more_room(&target, self.options).map_or_else(Err, |()| {
            history.take(own, None);
            Ok(target)
        })
    }

    /// Warped to `crs`, from a map that may be `off` the ground.
    fn onto(&self, crs: &Crs, off: Option<&Ground>, history: &mut History) -> Result<Target> {
        let Self { files, path, window, crop, .. } = *self;
        let way = CrsPath::between(&files.crs, crs).ok_or_else(|| lost(path))?;
        let back = CrsPath::between(crs, &files.crs).ok_or_else(|| lost(path))?;
        let unit = crs.metres_per_unit().ok_or_else(|| lost(path))?;
        let area = cell_area(files, window, &way).ok_or_else(|| lost(path))?;
        let cell = match self.options.resample {
            Some(metres) => metres / unit,
            None if files.crs == *crs => area.sqrt(),
            None => rounded(area.sqrt(), 3),
        };
        let all = lattice_around(files, window, &way, crs, cell).ok_or_else(|| lost(path))?;
        let region = Region { files, crop, back };
        let inside =
            |at: &[[usize; 2]]| region.holds(at.iter().map(|[c, r]| all.sample(*c as f64, *r as f64)).collect());
        check_extent(&all, cell * unit, path)?;
        let part = largest(all.columns, all.rows, inside).ok_or_else(|| too_small(files, path, cell * unit, crs))?;
        let [across, down] = window.size.map(|samples| (samples as f64 - 2.0 * BORDER).max(1.0));
        let share = part.samples() as f64 * cell * cell / (area * across * down);
        let (part, kept, cut) = match (off, crop) {
            (Some(_), None) if share < INSIDE => (all.whole(), "all of the data, voids beside them", None),
            (Some(_), Some(crop)) if share < INSIDE => {
                (all.whole(), "all inside the crop, voids beside it", Some(Cut { crop, crs: files.crs.clone() }))
            }
            _ => (part, "the largest rectangle inside the data", None),
        };
        let grid = all.part(part);
        let window = reach(&grid, files).ok_or_else(|| lost(path))?;
        history.convert(format!(
            "warped from {} to {}, cubic, {} x {} square cells of {} m, {kept}",
            off.map_or_else(
                || turned(files),
                |off| format!("a map off the ground ({}; {})", files.crs.label(), off.words())
            ),
            if files.crs == *crs { "north-up".to_owned() } else { crs.label() },
            grid.columns,
            grid.rows,
            rounded(cell * unit, 6),
        ));
        Ok(Target { grid, window, warps: true, cut })
    }

    /// The system in metres for degrees. Fails where they span too much of the globe for one.
    fn zone(&self) -> Result<Crs> {
        let Self { files, path, window, .. } = *self;
        let part = files.part(window);
        let [west, south, east, north] = part.extent();
        let per_unit = 360.0 / files.crs.turn().unwrap_or(360.0);
        let [width, height] = [(east - west) * per_unit, (north - south) * per_unit];
        let middle = files.centre(window);
        let polar = is_polar(degrees(&files.crs, middle).ok_or_else(|| lost(path))?.y);
        if height > HIGHEST || (width > WIDEST && !polar) {
            let mut remedy = message![format!("take at most {WIDEST} x {HIGHEST} degrees")];
            if self.typed.as_defined() == files.crs.as_defined() {
                remedy.push(", for instance `");
                remedy.push(Setting::Crop.at(middle_part(files, &part, per_unit)));
                remedy.push("`");
            }
            let what = format!("spans {width:.0} x {height:.0} degrees, too much of the globe for one map in metres");
            return Err(Error::input(path, what, remedy));
        }
        metric(&files.crs, middle).ok_or_else(|| lost(path))
    }
}

/// What is said of a map that is drawn though it is `off` the ground; `truer` is one that would be better,
/// and `more` what would let it be warped here.
fn off_the_ground(off: &Ground, truer: Option<&Crs>, more: Option<Message>, options: &ReadOptions) -> Message {
    let what = format!(
        "map metres are metres on the ground (this map is off it: {}, slopes are drawn {}; ",
        off.words(),
        off.slopes()
    );
    let first = |crs: &Crs| format!("warp it first: `gdalwarp -t_srs {} -r cubic IN OUT.tif`)", crs.typed());
    match truer {
        None => message![what, "take a smaller part with ", Setting::Crop, ")"],
        Some(crs) if options.warp => {
            let mut remedy = message![what, "it cannot be warped here; take a part with ", Setting::Crop, ", "];
            if let Some(more) = more {
                remedy.push(more);
                remedy.push(", ");
            }
            remedy.push("or ");
            remedy.push(first(crs));
            remedy
        }
        Some(crs) => message![what, "leave out ", Setting::Warp, ", or ", first(crs)],
    }
}

/// The part of the files that a warped grid may cover.
struct Region<'a> {
    files: &'a GeoGrid,
    crop: Option<[f64; 4]>,
    back: CrsPath,
}

impl Region<'_> {
    /// Which of `places` in the target's system lie where cubic convolution has all its samples, and inside the crop.
    fn holds(&self, mut places: Vec<DVec2>) -> Vec<bool> {
        self.back.carry(&mut places);
        let cropped = |place: &DVec2| self.crop.is_none_or(|crop| is_inside(crop, *place, &self.files.crs));
        let cropped: Vec<_> = places.iter().map(cropped).collect();
        self.files.pixels(&mut places);
        let low = DVec2::splat(BORDER);
        let far = DVec2::new(self.files.columns as f64, self.files.rows as f64) - BORDER;
        let within = |place: &DVec2| place.cmpge(low).all() && place.cmple(far).all();
        places.iter().zip(cropped).map(|(place, cropped)| cropped && within(place)).collect()
    }
}

/// A crop in the middle of `part` that one map shows, in the units of the files.
fn middle_part(files: &GeoGrid, part: &GeoGrid, degrees: f64) -> String {
    let ([west, south, east, north], centre) = (part.extent(), files.centre(files.whole()));
    let middle = part.centre(part.whole());
    let half = DVec2::new(WIDEST, HIGHEST) / degrees / 2.0;
    let [low, high] = [(middle - half).max(DVec2::new(west, south)), (middle + half).min(DVec2::new(east, north))];
    let round = |value: f64| rounded(value, 6);
    let west = files.crs.near(low.x, centre.x);
    format!("{},{},{},{}", round(west), round(low.y), round(west + high.x - low.x), round(high.y))
}

/// Size of the cell in the middle of `window`, squares of the unit that `way` leads to.
fn cell_area(files: &GeoGrid, window: Window, way: &CrsPath) -> Option<f64> {
    let middle = files.to_crs.inverse().transform_point2(files.centre(window));
    let mut corners = [DVec2::ZERO, DVec2::X, DVec2::Y].map(|step| files.to_crs.transform_point2(middle + step));
    way.carry(&mut corners);
    let area = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]).abs();
    (area.is_finite() && area > 0.0).then_some(area)
}

/// All places at whole multiples of `cell` around a window of the files.
fn lattice_around(files: &GeoGrid, window: Window, way: &CrsPath, crs: &Crs, cell: f64) -> Option<GeoGrid> {
    let mut places = files.outline(window);
    way.carry(&mut places);
    let [low, high] = span(&places);
    let (low, high) = ((low / cell).floor(), (high / cell).ceil());
    let size = high - low + 1.0;
    let matrix = glam::DMat2::from_diagonal(DVec2::new(cell, -cell));
    let corner = DVec2::new(low.x - 0.5, high.y + 0.5) * cell;
    let to_crs = glam::DAffine2::from_mat2_translation(matrix, corner);
    let sound = places.iter().all(|place| place.is_finite()) && size.max_element() < 1e9;
    sound.then(|| GeoGrid { crs: crs.clone(), to_crs, columns: size.x as usize, rows: size.y as usize })
}

/// What is odd about the files' grid.
fn turned(files: &GeoGrid) -> String {
    match (files.crs.is_geographic(), files.is_north_up()) {
        (true, _) if files.crs.name().is_empty() => "degrees".into(),
        (true, _) => format!("degrees ({})", files.crs.label()),
        (false, false) => "rows that do not run from west to east".into(),
        (false, true) => format!("cells of {} {}", files.cell().x, files.crs.units()),
    }
}

fn check_sides([width, height]: [usize; 2], files: &GeoGrid, path: &Path) -> Result<()> {
    if width >= MIN_SIDE && height >= MIN_SIDE {
        return Ok(());
    }
    let (cell, units) = (files.cell(), files.crs.units());
    Err(Error::input(
        path,
        message![Setting::Crop, format!(" leaves {width} x {height} samples; a surface needs at least 2 x 2")],
        format!("widen it: the samples are {} and {} {units} apart", cell.x, cell.y),
    ))
}

/// No more places to look at than a DEM twice too large has.
fn check_extent(all: &GeoGrid, metres: f64, path: &Path) -> Result<()> {
    let samples = all.columns as f64 * all.rows as f64;
    let most = 4.0 * MAX_SAMPLES as f64;
    if samples <= most {
        return Ok(());
    }
    let fit = rounded_up(metres * (samples / MAX_SAMPLES as f64).sqrt());
    Err(too_many(path, all, &Whole::Warped, fit))
}

fn lost(path: &Path) -> Error {
    let what = "its place cannot be put on a map in metres";
    let remedy = "name the system that its coordinates are in: `gdal_translate -a_srs EPSG:CODE IN OUT.tif`";
    Error::input(path, what, remedy)
}

fn too_small(files: &GeoGrid, path: &Path, metres: f64, crs: &Crs) -> Error {
    if files.columns < WARPED_SIDE || files.rows < WARPED_SIDE {
        let what =
            format!("is {} x {} samples; to be warped to metres it needs at least 5 x 5", files.columns, files.rows);
        return Error::input(path, what, "give a larger grid");
    }
    Error::input(
        path,
        format!("no 2 x 2 cells of {metres} m lie inside the data"),
        message![
            "give smaller cells with ",
            Setting::Resample.with_value(),
            format!(
                ", more of the DEM, or warp it yourself with voids beside it: \
                 `gdalwarp -t_srs {} -r cubic -dstnodata -32768 IN OUT.tif`",
                crs.typed()
            )
        ],
    )
}

fn outside(files: &GeoGrid, path: &Path, typed: &Crs) -> Error {
    let elsewhere = if *typed == files.crs { None } else { carried(files.extent(), &files.crs, &typed.as_defined()) };
    let ([west, south, east, north], units) = match elsewhere {
        Some(extent) => (extent.map(|edge| rounded(edge, CROP_DIGITS)), typed.units()),
        None => (files.extent_in_file(), files.crs.units()),
    };
    Error::input(
        path,
        message!["no sample lies inside ", Setting::Crop],
        message!["give ", Setting::Crop.value(), format!(" within {west},{south},{east},{north} {units}")],
    )
}

/// To so many significant digits.
pub(super) fn rounded(value: f64, digits: i32) -> f64 {
    scale(value, digits).map_or(value, |scale| (value * scale).round() / scale)
}

/// Upward to two significant digits.
fn rounded_up(value: f64) -> f64 {
    scale(value, 2).map_or(value, |scale| (value * scale).ceil() / scale)
}

/// The power of ten by which `value` has so many digits before its point; `None` for 0 and where there is no such power.
fn scale(value: f64, digits: i32) -> Option<f64> {
    let power = f64::from(digits - 1) - value.abs().log10().floor();
    let scale = 10f64.powf(power);
    (power.abs() < 300.0 && scale.is_normal()).then(|| 10f64.powi(power as i32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits() {
        assert_eq!(rounded(27.4961, 3), 27.5);
        assert_eq!(rounded_up(111.2), 120.0);
        assert_eq!(rounded_up(0.0451), 0.046);
        for odd in [0.0, -0.0, f64::MIN_POSITIVE, 5e-324, f64::MAX, f64::INFINITY] {
            assert_eq!((rounded(odd, 3), rounded_up(odd)), (odd, odd));
        }
        assert!(rounded(f64::NAN, 3).is_nan() && rounded_up(f64::NAN).is_nan());
    }
}
