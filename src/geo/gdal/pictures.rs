//! Elevations packed into the three colours of a picture.
//!
//! Formulas: Mapbox Terrain-RGB v1, and Terrarium of Mapzen. Which of the two a picture is, if any, shows when a few of
//! its windows are decoded: the heights are on Earth, and the colour that counts most hardly changes from one pixel to
//! the next, while in a picture for people all three change alike. Not handled: pictures that were compressed with
//! losses or resampled, whose heights jump.

use gdal::raster::{ColorInterpretation, GdalDataType, RasterBand};

use super::elevation::EARTH;
use super::glance::windows;
use super::layer::block;
use super::source::Source;
use crate::dem::Window;
use crate::error::{Result, Setting};
use crate::geo::Encoding;
use crate::message;

/// Share of samples whose heights must be on Earth.
const ON_EARTH: f64 = 0.99;
/// Most that the first colour may change beside the others.
const STEADY: f64 = 0.1;

impl Encoding {
    /// Those of pictures.
    pub(super) const PICTURES: [Self; 2] = [Self::TerrainRgb, Self::Terrarium];

    /// Whether three bands make one elevation.
    pub(super) fn is_picture(self) -> bool {
        Self::PICTURES.contains(&self)
    }

    fn metres(self, [red, green, blue]: [u8; 3]) -> f64 {
        let [red, green, blue] = [red, green, blue].map(f64::from);
        match self {
            // One division, so that a decimal typed by hand is the same number.
            Self::TerrainRgb => (red * 65536.0 + green * 256.0 + blue - 100_000.0) / 10.0,
            Self::Terrarium => red * 256.0 + green + blue / 256.0 - 32768.0,
            Self::Signed | Self::Elevations | Self::Depths => red,
        }
    }

    /// Metres of a block of a picture, NaN where all three colours are the number that it declares void, where it is black
    /// and where it is transparent.
    pub(super) fn decode(self, source: &Source, from: [usize; 2], size: [usize; 2]) -> Result<Vec<f64>> {
        let void = source.band()?.no_data_value();
        let colours = colours(source, from, size)?;
        let metres = |colour| if is_void(colour, void) { f64::NAN } else { self.metres(colour) };
        Ok(colours.into_iter().map(metres).collect())
    }

    /// The encoding of pictures that this one shows, if any.
    pub(super) fn of(source: &Source) -> Result<Option<Self>> {
        for encoding in Self::PICTURES {
            if encoding.fits(source)? {
                return Ok(Some(encoding));
            }
        }
        Ok(None)
    }

    /// Fails unless `source` is a picture of elevations packed so.
    pub(super) fn check(self, source: &Source) -> Result<()> {
        if !self.is_picture() || self.fits(source)? {
            return Ok(());
        }
        let remedy = match Self::of(source)? {
            Some(other) => message!["give ", Setting::Encoding.at(other.name()), ": it is that"],
            None => message!["leave ", Setting::Encoding, " out, or give the picture that has elevations"],
        };
        Err(source.error(format!("is no picture of elevations as {} packs them", self.name()), remedy))
    }

    /// Whether `source` has three bands of 8 bits that decode to land.
    fn fits(self, source: &Source) -> Result<bool> {
        let bands = source.dataset.raster_count();
        let byte = |band: usize| source.dataset.rasterband(band).is_ok_and(|b| b.band_type() == GdalDataType::UInt8);
        if !(1..=3).all(byte) || bands > 4 || (bands == 4 && opacity(source).is_none()) {
            return Ok(false);
        }
        let void = source.band()?.no_data_value();
        let (mut seen, mut on_earth, mut changes) = (0, 0, [0; 3]);
        for Window { first, size } in windows([source.columns, source.rows]) {
            let colours = colours(source, first, size)?;
            let is_void = |colour: [u8; 3]| is_void(colour, void);
            for row in colours.chunks_exact(size[0]) {
                let valid = row.iter().filter(|colour| !is_void(**colour));
                seen += valid.clone().count();
                on_earth += valid.filter(|colour| (EARTH[0]..=EARTH[1]).contains(&self.metres(**colour))).count();
                for pair in row.windows(2).filter(|pair| !pair.iter().any(|colour| is_void(*colour))) {
                    (0..3).for_each(|i| changes[i] += u64::from(pair[0][i].abs_diff(pair[1][i])));
                }
            }
        }
        let [first, second, third] = changes.map(|sum| sum as f64);
        let land = seen > 0 && on_earth as f64 >= ON_EARTH * seen as f64;
        Ok(land && first <= STEADY * second.max(third))
    }
}

/// Whether a colour is no data: black is in both, declared or not.
fn is_void(colour: [u8; 3], declared: Option<f64>) -> bool {
    colour == [0; 3] || declared.is_some_and(|void| colour.map(f64::from) == [void; 3])
}

/// The fourth band, where it is transparency: called so, or by no name beside red, green and blue.
fn opacity(source: &Source) -> Option<RasterBand<'_>> {
    let colour = |band: &RasterBand| band.color_interpretation();
    let coloured = [ColorInterpretation::RedBand, ColorInterpretation::GreenBand, ColorInterpretation::BlueBand];
    let is_coloured =
        || (1..).zip(coloured).all(|(i, known)| source.dataset.rasterband(i).is_ok_and(|band| colour(&band) == known));
    let fourth = source.dataset.rasterband(4).ok().filter(|_| source.dataset.raster_count() == 4)?;
    let is_transparency = match colour(&fourth) {
        ColorInterpretation::AlphaBand => true,
        ColorInterpretation::Undefined => is_coloured(),
        _ => false,
    };
    is_transparency.then_some(fourth)
}

/// The first three bands of a block, pixel by pixel; black where it is transparent.
fn colours(source: &Source, from: [usize; 2], size: [usize; 2]) -> Result<Vec<[u8; 3]>> {
    let band = |i: usize| {
        let band = source.dataset.rasterband(i).map_err(|_| source.unreadable(None))?;
        block::<u8>(source, &band, from, size)
    };
    let [red, green, blue] = [band(1)?, band(2)?, band(3)?];
    let mut colours: Vec<_> =
        red.into_iter().zip(green).zip(blue).map(|((red, green), blue)| [red, green, blue]).collect();
    if let Some(band) = opacity(source) {
        let opaque = block::<f32>(source, &band, from, size)?;
        colours.iter_mut().zip(opaque).filter(|(_, opaque)| *opaque == 0.0).for_each(|(colour, _)| *colour = [0; 3]);
    }
    Ok(colours)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas() {
        assert_eq!(Encoding::TerrainRgb.metres([1, 134, 160]), 0.0);
        assert_eq!(Encoding::TerrainRgb.metres([0, 0, 1]), -9999.9);
        assert_eq!(Encoding::Terrarium.metres([128, 0, 0]), 0.0);
        assert_eq!(Encoding::Terrarium.metres([131, 232, 128]), 1000.5);
    }
}
