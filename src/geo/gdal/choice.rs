//! Which band of a raster holds the elevations, and whether it can: colours and transparency are none.
//!
//! Unless a band is asked for, the one is taken whose name says that it is the elevation, else the first whose name says
//! nothing else, and transparency is passed over. Not handled: names in other languages than English.

use gdal::Metadata;
use gdal::raster::{ColorInterpretation, GdalDataType, RasterBand};

use super::source::Source;
use crate::dem::History;
use crate::error::{Error, Result, Setting};
use crate::geo::{Encoding, ReadOptions};
use crate::message;

/// Words for elevation in the names of bands, and ways of gridding points; of each the surest first.
const NAMES: [&[&str]; 2] = [&["elevation", "dem", "height"], &["idw", "mean"]];
/// How a name ranks that says nothing.
const NEUTRAL: usize = 100;
/// Words in the names of bands that are about elevations and hold none.
const OTHER: [&str; 21] = [
    "uncertainty",
    "error",
    "errors",
    "err",
    "rmse",
    "count",
    "counts",
    "number",
    "density",
    "std",
    "stdev",
    "stddev",
    "deviation",
    "variance",
    "slope",
    "aspect",
    "hillshade",
    "quality",
    "confidence",
    "mask",
    "flag",
];
/// How GDAL before 3.7 says that bytes have a sign.
pub(super) const SIGNED_BYTE: &str = "PIXELTYPE=SIGNEDBYTE";
/// Bands whose names are told.
const TOLD: usize = 12;

impl Source {
    /// The same file with the band that `options` ask for, or else the one that should hold elevations; what was assumed
    /// goes to `history`. Fails where that band is a part of a picture, or the file none of the asked encoding.
    pub(super) fn with_chosen_band(self, options: &ReadOptions, history: &mut History) -> Result<Self> {
        if let Some(encoding) = options.encoding {
            encoding.check(&self)?;
            if encoding.is_picture() {
                history.convert(format!("elevations decoded from three bands ({})", encoding.name()));
                return Ok(Self { band: 1, ..self });
            }
        }
        let chosen = if options.band.is_some() { self } else { self.by_name(history)? };
        chosen.check_type()?;
        let band = chosen.band()?;
        let plain = band.scale().unwrap_or(1.0) == 1.0 && band.offset().unwrap_or(0.0) == 0.0;
        let said = options.elevation_unit.is_some()
            || matches!(options.encoding, Some(Encoding::Elevations | Encoding::Depths));
        if band.band_type() == GdalDataType::UInt8 && plain && !said {
            let (range, why) = match chosen.is_signed(options.encoding) {
                true => ("-128 to 127", "few DEMs have no others"),
                false => ("0 to 255", "a picture or a hillshade has such numbers: then give the DEM it was made from"),
            };
            history.assume(message![
                format!("its 8-bit numbers, {range}, are heights in whole metres ({why}; for heights say "),
                Setting::ElevationUnit.at("m"),
                ")"
            ]);
        }
        Ok(chosen)
    }

    /// Whether the upper half of the band's unsigned numbers is below zero: by `encoding`, or as the file says of bytes.
    pub(super) fn is_signed(&self, encoding: Option<Encoding>) -> bool {
        let says = |band: RasterBand| {
            let said = band.metadata_item("PIXELTYPE", "IMAGE_STRUCTURE");
            band.band_type() == GdalDataType::UInt8
                && said.is_some_and(|said| SIGNED_BYTE.ends_with(&format!("={said}")))
        };
        encoding == Some(Encoding::Signed) || self.band().is_ok_and(says)
    }

    /// The band of transparency beside the chosen one, if there is any.
    pub(super) fn alpha(&self) -> Option<RasterBand<'_>> {
        let alpha = |band: &usize| self.colour(*band) == ColorInterpretation::AlphaBand;
        let found = (1..=self.dataset.raster_count()).find(alpha).filter(|band| *band != self.band);
        found.and_then(|band| self.dataset.rasterband(band).ok())
    }

    fn by_name(self, history: &mut History) -> Result<Self> {
        let bands: Vec<_> = (1..=self.dataset.raster_count())
            .filter(|band| self.colour(*band) != ColorInterpretation::AlphaBand)
            .map(|band| (band, self.name_of(band)))
            .collect();
        let Some((band, name)) = bands.iter().min_by_key(|(_, name)| rank(name)) else {
            return Err(self.picture(1));
        };
        if !matches!(self.colour(*band), ColorInterpretation::Undefined | ColorInterpretation::GrayIndex)
            || (bands.len() == 3 && Encoding::of(&self)?.is_some())
        {
            return Err(self.picture(*band));
        }
        if bands.len() > 1 {
            let count = bands.len();
            let all = names(&bands);
            let called = if rank(name) < NEUTRAL { format!(", called {name}") } else { String::new() };
            history.assume(message![
                format!("elevations are in band {band} of {count}{called} ({all}choose another with "),
                Setting::Band.with_value(),
                ")"
            ]);
        }
        Ok(Self { band: *band, ..self })
    }

    /// What a picture is refused with.
    fn picture(&self, band: usize) -> Error {
        if let Ok(Some(encoding)) = Encoding::of(self) {
            let name = encoding.name();
            let what = format!("is a picture with elevations packed into its colours ({name})");
            return self.error(what, message!["add ", Setting::Encoding.at(name), " to decode it"]);
        }
        let colour = match self.colour(band) {
            ColorInterpretation::PaletteIndex => "numbers of colours in a palette",
            ColorInterpretation::AlphaBand => "transparency",
            ColorInterpretation::RedBand => "the red of a picture",
            ColorInterpretation::GreenBand => "the green of a picture",
            ColorInterpretation::BlueBand => "the blue of a picture",
            _ => "a colour of a picture",
        };
        self.error(
            format!("band {band} holds {colour}, not elevations"),
            message![
                "give the DEM that it was made from, or ",
                Setting::Band.at(band),
                " to draw these numbers as heights"
            ],
        )
    }

    fn colour(&self, band: usize) -> ColorInterpretation {
        self.dataset.rasterband(band).map_or(ColorInterpretation::Undefined, |band| band.color_interpretation())
    }

    /// Its description, or the variable of netCDF that it comes from; empty where it has neither.
    fn name_of(&self, band: usize) -> String {
        let Ok(band) = self.dataset.rasterband(band) else { return String::new() };
        let described = band.description().unwrap_or_default();
        if described.is_empty() { band.metadata_item("NETCDF_VARNAME", "").unwrap_or_default() } else { described }
    }
}

/// Numbers and names of bands, if any has a name.
fn names(bands: &[(usize, String)]) -> String {
    if bands.iter().all(|(_, name)| name.is_empty()) {
        return String::new();
    }
    let told = bands.iter().take(TOLD).map(|(band, name)| format!("{band} {name}").trim_end().to_owned());
    let more = if bands.len() > TOLD { ", …" } else { "" };
    format!("the bands are {}{more}; ", told.collect::<Vec<_>>().join(", "))
}

/// How surely a name says that it is the elevation: 0 the surest, [`NEUTRAL`] where it says nothing, more where it is about
/// something else.
pub(super) fn rank(name: &str) -> usize {
    if OTHER.iter().any(|word| has_word(name, word)) {
        return NEUTRAL + 1;
    }
    // Of each group of words first a name that is one, then one that has it among others.
    let is_word = |word: &&str| name.trim().eq_ignore_ascii_case(word);
    let of_group = |group: &&[&str]| {
        let exact = group.iter().position(is_word);
        exact.or_else(|| Some(group.len() + group.iter().position(|word| has_word(name, word))?))
    };
    let places = NAMES.iter().enumerate().find_map(|(i, group)| Some((i, of_group(group)?)));
    places.map_or(NEUTRAL, |(i, place)| i * 2 * NAMES[0].len() + place)
}

/// Whether a text has `word`, small letters, between signs that are no letters or digits.
pub(super) fn has_word(text: &str, word: &str) -> bool {
    text.split(|c: char| !c.is_alphanumeric()).any(|part| part.to_lowercase() == word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_whole() {
        assert!(has_word("Elevation (m)", "elevation") && has_word("z_mean", "mean") && has_word("DEM", "dem"));
        assert!(!has_word("demand", "dem") && !has_word("depths", "depth") && !has_word("", "dem"));
    }

    #[test]
    fn names_rank_by_what_they_say() {
        let names =
            ["elevation", "DEM", "Height", "Elevation (m)", "dem_1", "IDW", "mean", "z_mean", "band", "dem error"];
        let ranks = names.map(rank);
        assert!(ranks.is_sorted_by(|a, b| a < b), "{ranks:?}");
        assert_eq!((rank(""), rank("slope")), (NEUTRAL, NEUTRAL + 1));
    }
}
