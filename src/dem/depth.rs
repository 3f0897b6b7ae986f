//! Depths below zero, told from heights by what the file says of its band, in the words of the CF conventions.
//!
//! `positive` is sure, and so is the standard name; the long name is for people, and where it alone speaks of depth the
//! numbers have a say: those that are below zero already are heights. Not handled: other words and languages.

use gdal::Metadata;

use super::choice::has_word;
use super::elevation::{Elevation, Reading};
use super::glance::windows;
use super::grid::Window;
use super::history::History;
use super::mosaic::block;
use super::source::Source;
use crate::error::Result;

/// Words of a standard name that is one of heights, whatever else says depth.
const UPWARD: [&str; 3] = ["height", "altitude", "elevation"];

/// Whether the band of `source` holds depths; what was found goes to `history`. `elevation` are its rules so far.
pub(super) fn is_depth(source: &Source, elevation: &Elevation, history: &mut History) -> Result<bool> {
    let attribute = |name: &str| attribute(source, name).unwrap_or_default();
    let says_depth = |name: &str| has_word(name, "depth");
    let positive = attribute("positive").to_lowercase();
    let (standard, long) = (attribute("standard_name"), attribute("long_name"));
    let negate = |history: &mut History, why: &str| {
        history.convert(format!("depths x -1 to heights ({why})"));
        Ok(true)
    };
    match positive.trim() {
        "up" => return Ok(false),
        "down" => return negate(history, "its band says positive: down"),
        _ => {}
    }
    if says_depth(&standard) {
        return negate(history, &format!("its standard name is \"{standard}\""));
    }
    if !says_depth(&long) || UPWARD.iter().any(|word| has_word(&standard, word)) {
        return Ok(false);
    }
    if is_mostly_negative(source, elevation)? {
        history.assume(format!(
            "most numbers are below zero because they are heights already, though the long name is \"{long}\" (if they \
             are depths, turn them over: `gdal_translate -a_scale -1 IN OUT.tif`)"
        ));
        return Ok(false);
    }
    negate(history, &format!("its long name is \"{long}\""))
}

/// What the file says of the band, or of the variable that it comes from.
fn attribute(source: &Source, name: &str) -> Option<String> {
    let band = source.band().ok()?;
    if let Some(said) = band.metadata_item(name, "") {
        return Some(said);
    }
    let variable = band.metadata_item("NETCDF_VARNAME", "").or_else(|| {
        // A conversion may keep what was said of all variables, and not which one the band is.
        let all = source.dataset.metadata_domain("").unwrap_or_default();
        let of = |key: &str| -> Vec<String> {
            all.iter().filter_map(|line| line.split_once(key).map(|(name, _)| name.to_owned())).collect()
        };
        let axes: Vec<_> = ["#axis=", "#bounds="].into_iter().flat_map(of).collect();
        let mut placed = ["#positive=", "#standard_name=", "#long_name="].into_iter().flat_map(of).collect::<Vec<_>>();
        placed.retain(|name| !axes.contains(name) && !is_place(name));
        placed.sort_unstable();
        placed.dedup();
        let alone = source.dataset.raster_count() == 1 && placed.len() == 1;
        if alone { placed.pop() } else { band.description().ok().filter(|name| !name.is_empty()) }
    });
    variable
        .and_then(|variable| source.dataset.metadata_item(&format!("{variable}#{name}"), ""))
        .or_else(|| source.dataset.metadata_item(name, "").filter(|_| source.dataset.raster_count() == 1))
}

/// Whether a variable is one of the coordinates, or of the system they are in.
fn is_place(name: &str) -> bool {
    let names = ["x", "y", "lon", "lat", "longitude", "latitude", "easting", "northing", "time", "crs", "spatial_ref"];
    names.contains(&name.to_lowercase().as_str()) || name == "NC_GLOBAL"
}

/// Whether most numbers of a few windows are below zero.
fn is_mostly_negative(source: &Source, elevation: &Elevation) -> Result<bool> {
    let (mut negative, mut positive) = (0, 0);
    for Window { first, size } in windows([source.columns, source.rows]) {
        for raw in block::<f64>(source, &source.band()?, first, size)? {
            match elevation.reading(raw) {
                Reading::Metres(metres) if metres < 0.0 => negative += 1,
                Reading::Metres(metres) if metres > 0.0 => positive += 1,
                _ => {}
            }
        }
    }
    Ok(negative > positive)
}
