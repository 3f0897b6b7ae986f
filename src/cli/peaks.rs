//! Peaks in words.

use glam::DVec2;

use crate::dem::Dem;
use crate::error::Result;
use crate::relief::{Base, Peak, peaks};

/// The most prominent peaks of a DEM, a line each, and what their prominence is.
///
/// # Errors
/// As [`peaks()`] and [`Georeference::lonlat`](crate::dem::Georeference::lonlat).
pub(super) fn told(dem: &Dem, count: usize) -> Result<String> {
    let peaks = peaks(dem, count, 1.0)?;
    let mut lines = match peaks.len() {
        0 => "peaks      none: all samples are level, or void".to_owned(),
        listed => format!(
            "peaks      {listed}, the most prominent first; prominence: metres above the highest saddle on ways to higher ground"
        ),
    };
    for (i, peak) in peaks.iter().enumerate() {
        lines += &format!("\npeak {:<5} {}", i + 1, line(dem, peak)?);
    }
    Ok(lines)
}

fn line(dem: &Dem, peak: &Peak) -> Result<String> {
    let Peak { height, prominence, at_edge, .. } = peak;
    let place = |[c, r]: [usize; 2]| place(dem, dem.position(c, r).truncate());
    let base = match peak.base {
        Base::Saddle(at, height) => format!("above the saddle, {height:.1} m at {}", place(at)?),
        Base::Lowest(at, height) => format!("above the lowest sample, {height:.1} m at {}", place(at)?),
        Base::Sea => "above the sea".to_owned(),
    };
    let edge = if *at_edge { "; at the edge, beyond which the land may rise" } else { "" };
    Ok(format!("{height:.1} m at {}, prominence {prominence:.1} m {base}{edge}", place(peak.at)?))
}

/// In the system of the file, and on the globe where that is known.
pub(super) fn place(dem: &Dem, world: DVec2) -> Result<String> {
    let georeference = dem.georeference();
    let file = georeference.file();
    let decimals = if file.is_geographic() { 6 } else { 2 };
    let pair = |place: DVec2, decimals: usize| format!("{:.decimals$},{:.decimals$}", place.x, place.y);
    let on_map = pair(georeference.place_in(file, world).unwrap_or(world), decimals);
    match georeference.lonlat(world)?.filter(|_| !file.is_geographic()) {
        Some(lonlat) => Ok(format!("{on_map} (longitude, latitude {})", pair(lonlat, 6))),
        None => Ok(on_map),
    }
}
