//! From the numbers of a band to metres, or to a void.

use gdal::raster::GdalDataType;

use super::source::Source;
use crate::error::Result;

/// At and below this many metres an elevation is a mark for no data, declared or not: -32767, -32768, -3.4e38.
const DEEPEST: f64 = -32767.0;
/// Above this many metres too: 9.97e36, 1e20. No mountain of the solar system reaches a quarter of it.
const HIGHEST: f64 = 100_000.0;

/// Metres per international foot, exact.
const FOOT: f64 = 0.3048;
/// Metres per US survey foot: 1200 / 3937.
const US_FOOT: f64 = 1200.0 / 3937.0;

/// How the numbers of one band become metres.
#[derive(Debug, Clone, Copy)]
pub(super) struct Elevation {
    scale: f64,
    offset: f64,
    nodata: Option<f64>,
    kind: GdalDataType,
    /// Whether the file says that its elevations are metres.
    pub says_metres: bool,
}

/// What one number of a band is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Reading {
    /// An elevation in metres.
    Metres(f64),
    /// No data, as the file declares, or not a number.
    Void,
    /// No data by its impossible value; the file does not declare it.
    Sentinel,
}

impl Elevation {
    /// The rules of band 1 of `source`. Fails when its elevations are not metres after scale and offset.
    pub fn of(source: &Source) -> Result<Self> {
        let band = source.band()?;
        let unit = band.unit().trim().to_lowercase();
        let elevation = Self {
            scale: band.scale().unwrap_or(1.0),
            offset: band.offset().unwrap_or(0.0),
            nodata: band.no_data_value(),
            kind: band.band_type(),
            says_metres: is_metre(&unit),
        };
        if !elevation.says_metres && !["", "unknown", "unspecified"].contains(&unit.as_str()) {
            return Err(not_metres(source, &unit));
        }
        if !elevation.scale.is_finite() || elevation.scale == 0.0 || !elevation.offset.is_finite() {
            return Err(source.error(
                format!("its band has scale {} and offset {}", elevation.scale, elevation.offset),
                "give it sound ones: `gdal_translate -a_scale 1 -a_offset 0 IN OUT.tif`",
            ));
        }
        Ok(elevation)
    }

    /// What the number `raw` stands for.
    pub fn reading(&self, raw: f64) -> Reading {
        let metres = raw * self.scale + self.offset;
        if self.is_declared_void(raw) || !metres.is_finite() {
            return Reading::Void;
        }
        // Tenths of a metre in 16 bits still end at -32768: the mark is in the number, not in the metres.
        let lowest_numbers = self.kind == GdalDataType::Int16 && raw <= DEEPEST;
        match lowest_numbers || metres <= DEEPEST || metres > HIGHEST {
            true => Reading::Sentinel,
            false => Reading::Metres(metres),
        }
    }

    /// Declared as f64, stored as f32: -3.4028234663852886e38 and -3.40282e38 are the same mark.
    fn is_declared_void(&self, raw: f64) -> bool {
        self.nodata
            .is_some_and(|nodata| raw == nodata || (self.kind == GdalDataType::Float32 && raw as f32 == nodata as f32))
    }
}

fn is_metre(unit: &str) -> bool {
    ["m", "m.", "metre", "metres", "meter", "meters"].contains(&unit)
}

/// Metres per unit, for the units elevations are found in.
fn metres_per(unit: &str) -> Option<f64> {
    let words: String = unit.chars().map(|c| if c.is_alphanumeric() { c } else { ' ' }).collect();
    let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
    Some(match words.as_str() {
        "ft" | "foot" | "feet" | "international foot" | "international feet" => FOOT,
        "us survey foot" | "us survey feet" | "us ft" | "us foot" | "us feet" | "ftus" | "usft" | "foot us" => US_FOOT,
        "cm" | "centimetre" | "centimetres" | "centimeter" | "centimeters" => 0.01,
        "dm" | "decimetre" | "decimetres" | "decimeter" | "decimeters" => 0.1,
        "mm" | "millimetre" | "millimetres" | "millimeter" | "millimeters" => 0.001,
        "km" | "kilometre" | "kilometres" | "kilometer" | "kilometers" => 1000.0,
        _ => return None,
    })
}

fn not_metres(source: &Source, unit: &str) -> crate::error::Error {
    let what = format!("its elevations are in \"{unit}\", not metres");
    match metres_per(unit) {
        // gdal_translate drops the unit when it scales, as it should here; gdalwarp keeps or loses it by format.
        Some(factor) => source
            .error(what, format!("convert them first: `gdal_translate -ot Float32 -scale 0 1 0 {factor} IN OUT.tif`")),
        None => source.error(
            what,
            "convert them first: `gdal_translate -ot Float32 -scale 0 1 0 F IN OUT.tif` with F metres per unit",
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: Elevation =
        Elevation { scale: 1.0, offset: 0.0, nodata: None, kind: GdalDataType::Float32, says_metres: true };

    #[test]
    fn sentinels_end_where_elevations_begin() {
        assert_eq!(PLAIN.reading(-32767.0), Reading::Sentinel);
        assert_eq!(PLAIN.reading(-32766.0), Reading::Metres(-32766.0));
        assert_eq!(PLAIN.reading(100_000.0), Reading::Metres(100_000.0));
        assert_eq!(PLAIN.reading(1e20), Reading::Sentinel);
        assert_eq!(PLAIN.reading(f64::NAN), Reading::Void);
    }

    #[test]
    fn sixteen_bits_of_decimetres_keep_their_mark() {
        let decimetres = Elevation { scale: 0.1, kind: GdalDataType::Int16, ..PLAIN };
        assert_eq!(decimetres.reading(-32768.0), Reading::Sentinel);
        assert_eq!(decimetres.reading(-4000.0), Reading::Metres(-400.0));
        let millimetres = Elevation { scale: 0.001, kind: GdalDataType::Int32, ..PLAIN };
        assert_eq!(millimetres.reading(-32768.0), Reading::Metres(-32.768));
    }

    #[test]
    fn nodata_is_compared_as_stored() {
        let declared = Elevation { nodata: Some(-3.40282346638529e38), ..PLAIN };
        assert_eq!(declared.reading(f64::from(f32::MIN)), Reading::Void);
        let not_a_number = Elevation { nodata: Some(f64::NAN), ..PLAIN };
        assert_eq!(not_a_number.reading(5.0), Reading::Metres(5.0));
    }
}
