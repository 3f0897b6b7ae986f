//! Numbers that are no heights, or not as they stand: marks, units, signs, pictures, depths. Each is told, and what the
//! telling advises gives the land as it is.

mod called;
mod impossible;
mod odd;
mod pictures;
mod seas;

use std::path::{Path, PathBuf};

use gdal::raster::{Buffer, ColorInterpretation, GdalType};
use gdal::spatial_ref::SpatialRef;
use gdal::{DriverManager, Metadata};
use hachure::dem::Dem;
use hachure::door::cli::values;
use hachure::geo::{ReadOptions, read, read_all};
use tempfile::TempDir;

use crate::common::words;

/// Columns and rows of the land here.
const SIDE: usize = 80;
/// Less memory than any tile: samples stay in their file.
const FILED: u64 = 1 << 11;

/// 400 to 1300 m, whole: two hills of 30 m cells.
fn land() -> Vec<f64> {
    let hill = |c: f64, r: f64, height: f64| height * (-(c * c + r * r) / 200.0).exp();
    let at = |i: usize| ((i % SIDE) as f64, (i / SIDE) as f64);
    let height =
        |(c, r): (f64, f64)| 400.0 + hill(c - 30.0, r - 25.0, 900.0) + hill(c - 60.0, r - 55.0, 500.0) + 0.3 * c;
    (0..SIDE * SIDE).map(|i| height(at(i)).round()).collect()
}

/// The land with `mark` in a corner, 225 samples of it.
fn marked(mark: f64, land: &[f64]) -> Vec<f64> {
    let is_hole = |i: usize| i % SIDE < 15 && i / SIDE < 15;
    land.iter().enumerate().map(|(i, height)| if is_hole(i) { mark } else { *height }).collect()
}

/// A raster of bands of the land's size.
struct Bands<T> {
    bands: Vec<Vec<T>>,
    epsg: u32,
    transform: [f64; 6],
    colours: Vec<ColorInterpretation>,
    names: Vec<&'static str>,
    said: Vec<(&'static str, &'static str)>,
}

impl<T: GdalType + Copy> Bands<T> {
    fn new(bands: Vec<Vec<T>>) -> Self {
        let transform = [500_000.0, 30.0, 0.0, 5_000_000.0, 0.0, -30.0];
        Self { bands, epsg: 32632, transform, colours: Vec::new(), names: Vec::new(), said: Vec::new() }
    }

    fn write(self, path: &Path) -> PathBuf {
        let driver = DriverManager::get_driver_by_name("GTiff").unwrap();
        let mut file = driver.create_with_band_type::<T, _>(path, SIDE, SIDE, self.bands.len()).unwrap();
        file.set_geo_transform(&self.transform).unwrap();
        file.set_spatial_ref(&SpatialRef::from_epsg(self.epsg).unwrap()).unwrap();
        let mut colours = self.colours.into_iter();
        for (i, values) in self.bands.into_iter().enumerate() {
            let mut band = file.rasterband(i + 1).unwrap();
            colours.next().into_iter().for_each(|colour| band.set_color_interpretation(colour).unwrap());
            self.names.get(i).into_iter().for_each(|name| band.set_description(name).unwrap());
            self.said.iter().for_each(|(key, value)| band.set_metadata_item(key, value, "").unwrap());
            band.write((0, 0), (SIDE, SIDE), &mut Buffer::new((SIDE, SIDE), values)).unwrap();
        }
        file.close().unwrap();
        path.to_owned()
    }
}

/// One band of these numbers, as they are stored in `T`.
fn one<T: GdalType + Copy>(numbers: &[f64], stored: impl Fn(f64) -> T) -> Bands<T> {
    Bands::new(vec![numbers.iter().map(|number| stored(*number)).collect()])
}

fn folder() -> TempDir {
    // The first call takes drivers from GDAL; no other thread may be using it meanwhile.
    let _ = read(Path::new(""), &with_steps());
    tempfile::tempdir().unwrap()
}

/// What is assumed of a DEM, whether its samples are held or stay in their file: both say the same.
fn assumed(paths: &[PathBuf], options: &ReadOptions) -> Vec<String> {
    let held = read_all(paths, options, &|_, _| ()).unwrap();
    assert!(!held.is_filed());
    // What is warped is held or refused.
    if let Ok(filed) = read_all(paths, &ReadOptions { memory: FILED, ..options.clone() }, &|_, _| ()) {
        let survey = filed.survey(&|_| ()).unwrap();
        let all = [filed.history().assumed(), &survey.assumed].concat();
        assert_eq!(all, held.history().assumed(), "a DEM in its file says something else");
    }
    words(held.history().assumed())
}

/// Numbers as they stand in the file: the land here is in whole metres, and what is looked for is not their stairs.
fn with_steps() -> ReadOptions {
    ReadOptions { keep_steps: true, ..Default::default() }
}

/// The only clause that is assumed of a file, with all `words`.
fn doubt(path: &Path, words: &[&str]) -> String {
    let clauses = assumed(&[path.to_owned()], &with_steps());
    assert_eq!(clauses.len(), 1, "{}: {clauses:?}", path.display());
    words.iter().for_each(|word| assert!(clauses[0].contains(word), "no {word:?}: {}", clauses[0]));
    clauses[0].clone()
}

/// The DEM read with the first flag of that name that a line advises, after which nothing is assumed.
fn cured(path: &Path, line: &str, flag: &str) -> Dem {
    let rest = line.split_once(flag).unwrap_or_else(|| panic!("no {flag}: {line}")).1;
    let value = rest.trim_start().split([' ', ')', ':', ';']).next().unwrap().trim_end_matches(',');
    let mut options = with_steps();
    match flag {
        "--nodata" => options.nodata = values::nodata(value).unwrap(),
        "--elevation-unit" => options.elevation_unit = Some(values::elevation_unit(value).unwrap()),
        "--encoding" => options.encoding = Some(values::encoding(value).unwrap()),
        _ => panic!("{flag}"),
    }
    assert_eq!(assumed(&[path.to_owned()], &options), Vec::<String>::new(), "{flag} {value}");
    read(path, &options).unwrap()
}

/// That the heights are those given, NaN at voids, within `metres`.
fn same(dem: &Dem, heights: &[f64], metres: f64) {
    assert_eq!((dem.columns(), dem.rows()), (SIDE, SIDE));
    for (i, height) in heights.iter().enumerate() {
        let read = dem.height(i % SIDE, i / SIDE).map_or(f64::NAN, f64::from);
        let off = if height.is_nan() { f64::from(u8::from(!read.is_nan())) } else { (read - height).abs() };
        assert!(off <= metres, "sample {i}: {read} m, not {height} m");
    }
}
