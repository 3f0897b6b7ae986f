//! Heights so coarse for their cells, or DEMs so large, that a drawing of them cannot be right: said before anything is
//! drawn. Cells below a millimetre were refused before.

use super::blank::length;
use super::talk::Talk;
use crate::dem::Dem;

/// No land is wider than once around the Earth, metres.
const AROUND: f64 = 4.01e7;
/// Share of a cell by which heights may be rounded: beyond, steps of rounding show as slopes.
const ROUGH: f64 = 0.1;

/// Warns of a DEM whose cells or extent make no sense as metres, and says where it lies.
pub(crate) fn warn(dem: &Dem, exaggeration: f64, talk: &Talk) {
    let (cell, [west, south, east, north]) = (dem.cell().min_element(), dem.extent());
    let wide = (east - west).max(north - south);
    let highest = dem.range().map_or(0.0, |range| range.into_iter().fold(0.0_f32, |most, z| most.max(z.abs())));
    let rounding = f64::from(highest) * f64::from(f32::EPSILON) / 2.0 / exaggeration;
    let what = if rounding > ROUGH * cell {
        format!("its cells are {} wide, and its heights are known to {}", length(cell), length(rounding))
    } else if wide > AROUND {
        format!("it is {} wide, more than once around the Earth", length(wide))
    } else {
        return;
    };
    let (file, lies) = (dem.georeference().file(), format!("W {west} S {south} E {east} N {north}"));
    let named = if file.label().is_empty() { "no coordinate system".to_owned() } else { file.label() };
    talk.warn(&format!(
        "the DEM is drawn as land of {} across ({lies} m; {named}): {what}; where that is not so, place it anew with \
         `gdal_translate -a_srs EPSG:N -a_ullr W N E S IN OUT.tif`",
        length(wide)
    ));
}
