//! From the numbers of a band to metres, or to a void.

use gdal::raster::GdalDataType;

use super::choice::SIGNED_BYTE;
use super::depth::is_depth;
use super::source::{Source, heard};
use crate::dem::{Crs, History};
use crate::error::{Error, Message, Result, Setting};
use crate::geo::{ElevationUnit, Encoding, Nodata, ReadOptions};
use crate::message;

/// At and below this many metres an elevation is a mark for no data, declared or not: -32767, -32768, -3.4e38.
const DEEPEST: f64 = -32767.0;
/// Above this many metres too: 9.97e36, 1e20. No mountain of the solar system reaches a quarter of it.
const HIGHEST: f64 = 100_000.0;

/// Lowest and highest of all land on Earth, metres: the Challenger Deep and Everest, and a little more.
pub(super) const EARTH: [f64; 2] = [-11_100.0, 8_900.0];

/// Units below this many metres are small enough for elevations to reach the marks.
const SMALL_UNIT: f64 = 0.09;

/// How the numbers of one band become metres.
#[derive(Debug, Clone)]
pub(super) struct Elevation {
    scale: f64,
    offset: f64,
    /// Metres per unit of the scaled number.
    factor: f64,
    nodata: Option<f64>,
    kind: GdalDataType,
    /// Void because the user says so.
    said: Nodata,
    encoding: Option<Encoding>,
    /// Whether the upper half of unsigned numbers is below zero.
    signed: bool,
    /// Whether the metres are depths.
    depth: bool,
    /// Whether the place is on Earth, or nobody says where it is.
    on_earth: bool,
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
    /// The rules of the band of `source`, whose places are in `crs`; `options` overrule what the file says. What was found
    /// goes to `history`.
    pub(super) fn of(source: &Source, crs: &Crs, options: &ReadOptions, history: &mut History) -> Result<Self> {
        let band = source.band()?;
        let plain = Self {
            scale: 1.0,
            offset: 0.0,
            factor: 1.0,
            nodata: None,
            kind: GdalDataType::Float64,
            said: options.nodata.clone(),
            encoding: options.encoding,
            signed: source.is_signed(options.encoding),
            depth: false,
            on_earth: crs.is_of_earth(),
        };
        if options.encoding.is_some_and(Encoding::is_picture) {
            // The colours' own scale, unit and nodata are those of a picture.
            return Ok(Self { factor: options.elevation_unit.map_or(1.0, ElevationUnit::metres), ..plain });
        }
        let elevation = Self {
            scale: band.scale().unwrap_or(1.0),
            offset: band.offset().unwrap_or(0.0),
            factor: factor(source, crs, options.elevation_unit, history)?,
            nodata: band.no_data_value(),
            kind: band.band_type(),
            ..plain
        };
        let Self { scale, offset, .. } = elevation;
        if !scale.is_finite() || scale == 0.0 || !offset.is_finite() {
            return Err(source.error(
                format!("its band has scale {scale} and offset {offset}"),
                "give it sound ones: `gdal_translate -a_scale 1 -a_offset 0 IN OUT.tif`",
            ));
        }
        if scale != 1.0 || offset != 0.0 {
            history.convert(format!("elevations are the file's numbers x {scale} + {offset}, as its band declares"));
        }
        if elevation.is_signed() {
            let most = elevation.modulus() / 2.0 - 1.0;
            let why: Message = match options.encoding {
                Some(Encoding::Signed) => Setting::Encoding.at(Encoding::Signed.name()).into(),
                _ => SIGNED_BYTE.into(),
            };
            history.convert(message![format!("numbers above {most} are below 0 ("), why, ")"]);
        }
        Ok(Self { depth: is_depth(source, &elevation, options.encoding, history)?, ..elevation })
    }

    /// What the number `raw` stands for.
    pub(super) fn reading(&self, raw: f64) -> Reading {
        let number = self.number(raw);
        let value = number * self.scale + self.offset;
        let metres = value * self.factor;
        if self.is_void(raw) || !metres.is_finite() || (number != raw && self.is_void(number)) {
            return Reading::Void;
        }
        // Marks are written in the file's own unit, but one much smaller than a metre reaches them with elevations.
        let mark = if self.factor < SMALL_UNIT { metres } else { value };
        // Tenths of a metre in 16 bits still end at -32768: the mark is in the number, not in the metres.
        let lowest_numbers = self.kind == GdalDataType::Int16 && raw <= DEEPEST;
        match lowest_numbers || mark <= DEEPEST || metres > HIGHEST {
            true => Reading::Sentinel,
            false => Reading::Metres(if self.depth { -metres } else { metres }),
        }
    }

    /// The number that `raw` stands for where it was stored without its sign; `raw` itself elsewhere.
    pub(super) fn number(&self, raw: f64) -> f64 {
        let modulus = self.modulus();
        if self.is_signed() && raw >= modulus / 2.0 && raw < modulus { raw - modulus } else { raw }
    }

    /// Metres between two heights whose numbers differ by so much.
    pub(super) fn metres_between(&self, numbers: f64) -> f64 {
        (numbers * self.scale * self.factor).abs()
    }

    /// Whether the numbers are stored as whole ones.
    pub(super) fn is_whole(&self) -> bool {
        !matches!(self.kind, GdalDataType::Float32 | GdalDataType::Float64)
    }

    /// Numbers below zero stored without a sign come out as much higher: 2 to the power of its bits. Those of 16 bits may
    /// stand in a larger type since.
    pub(super) fn modulus(&self) -> f64 {
        match self.kind {
            GdalDataType::UInt8 => 256.0,
            GdalDataType::UInt32 => 4_294_967_296.0,
            _ => 65_536.0,
        }
    }

    /// Lowest and highest metres of land on the planet.
    pub(super) fn limits(&self) -> [f64; 2] {
        if self.on_earth { EARTH } else { [f64::NEG_INFINITY, f64::INFINITY] }
    }

    /// The type of the numbers as they are stored.
    pub(super) fn kind(&self) -> GdalDataType {
        self.kind
    }

    /// The numbers that the user calls void.
    pub(super) fn said(&self) -> &Nodata {
        &self.said
    }

    /// Whether the upper half of the numbers is below zero.
    pub(super) fn is_signed(&self) -> bool {
        self.signed
    }

    /// Whether greater numbers lie deeper.
    pub(super) fn is_depth(&self) -> bool {
        self.depth
    }

    /// Whether the numbers are taken for metres as they stand.
    pub(super) fn is_plain_metres(&self) -> bool {
        self.factor == 1.0 && self.scale == 1.0 && self.offset == 0.0
    }

    /// The picture encoding of the file, if it has one.
    pub(super) fn picture(&self) -> Option<Encoding> {
        self.encoding.filter(|encoding| encoding.is_picture())
    }

    /// Declared as f64, stored as f32: -3.4028234663852886e38 and -3.40282e38 are the same mark.
    fn is_void(&self, raw: f64) -> bool {
        let declared = |nodata| raw == nodata || (self.kind == GdalDataType::Float32 && raw as f32 == nodata as f32);
        self.nodata.is_some_and(declared) || self.said.holds(raw, self.kind)
    }

    /// Metres in 32 bits, nothing declared.
    #[cfg(test)]
    pub(crate) fn plain() -> Self {
        Self {
            scale: 1.0,
            offset: 0.0,
            factor: 1.0,
            nodata: None,
            kind: GdalDataType::Float32,
            said: Nodata::default(),
            encoding: None,
            signed: false,
            depth: false,
            on_earth: true,
        }
    }
}

/// Metres per unit: as the user says, the band, or the vertical part of the CRS; else metres are assumed.
fn factor(source: &Source, crs: &Crs, unit: Option<ElevationUnit>, history: &mut History) -> Result<f64> {
    let band = source.band()?.unit();
    let (vertical, vertical_metres) = vertical_unit(source);
    let named = [band.trim().to_owned(), vertical].into_iter().find(|name| !is_blank(name));
    let (factor, name) = match (unit, named) {
        (Some(unit), _) => (unit.metres(), message!["as ", Setting::ElevationUnit, " says"]),
        (None, Some(name)) => {
            let known = metres_per(&name).or(vertical_metres).ok_or_else(|| unknown_unit(source, &name))?;
            (known, format!("\"{name}\"").into())
        }
        (None, None) => {
            let feet = Setting::ElevationUnit.at(ElevationUnit::FOOT.name());
            let or = format!(" or {})", ElevationUnit::US_FOOT.name());
            let clause = message!["elevations are metres (no unit is named; if they are feet, say ", feet, or];
            // Beside feet on the map metres are a surprise.
            match crs.metres_per_unit() {
                None | Some(1.0) => history.assume_as_usual(clause),
                Some(_) => history.assume(clause),
            }
            return Ok(1.0);
        }
    };
    if factor != 1.0 {
        history.convert(message![format!("elevations x {factor} to metres ("), name, ")"]);
    }
    Ok(factor)
}

fn is_blank(unit: &str) -> bool {
    ["", "unknown", "unspecified"].contains(&unit.to_lowercase().as_str())
}

/// Name and metres of the vertical unit of a compound CRS, which counts where the band itself names no unit.
fn vertical_unit(source: &Source) -> (String, Option<f64>) {
    let (reference, _) = heard(|| source.dataset.spatial_ref());
    let Some(reference) = reference.ok().filter(|r| r.is_compound()) else { return Default::default() };
    let unit = |child| reference.get_attr_value("COMPD_CS|VERT_CS|UNIT", child).ok().flatten();
    (unit(0).unwrap_or_default(), unit(1).and_then(|factor| factor.parse().ok()))
}

/// Metres per unit, for the units elevations are found in.
fn metres_per(unit: &str) -> Option<f64> {
    let words: String = unit.to_lowercase().chars().map(|c| if c.is_alphanumeric() { c } else { ' ' }).collect();
    let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
    Some(match words.as_str() {
        "m" | "metre" | "metres" | "meter" | "meters" => 1.0,
        "ft" | "foot" | "feet" | "international foot" | "international feet" => ElevationUnit::FOOT.metres(),
        "us survey foot" | "us survey feet" | "us ft" | "us foot" | "us feet" | "ftus" | "usft" | "foot us" => {
            ElevationUnit::US_FOOT.metres()
        }
        "cm" | "centimetre" | "centimetres" | "centimeter" | "centimeters" => 0.01,
        "dm" | "decimetre" | "decimetres" | "decimeter" | "decimeters" => 0.1,
        "mm" | "millimetre" | "millimetres" | "millimeter" | "millimeters" => 0.001,
        "km" | "kilometre" | "kilometres" | "kilometer" | "kilometers" => 1000.0,
        _ => return None,
    })
}

fn unknown_unit(source: &Source, unit: &str) -> Error {
    let what = format!("its elevations are in \"{unit}\", which is no known unit of length");
    source.error(what, message!["say which it is with ", Setting::ElevationUnit.at(ElevationUnit::any())])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentinels_end_where_elevations_begin() {
        assert_eq!(Elevation::plain().reading(-32767.0), Reading::Sentinel);
        assert_eq!(Elevation::plain().reading(-32766.0), Reading::Metres(-32766.0));
        assert_eq!(Elevation::plain().reading(100_000.0), Reading::Metres(100_000.0));
        assert_eq!(Elevation::plain().reading(1e20), Reading::Sentinel);
        assert_eq!(Elevation::plain().reading(f64::NAN), Reading::Void);
    }

    #[test]
    fn sixteen_bits_of_decimetres_keep_their_mark() {
        let decimetres = Elevation { scale: 0.1, kind: GdalDataType::Int16, ..Elevation::plain() };
        assert_eq!(decimetres.reading(-32768.0), Reading::Sentinel);
        assert_eq!(decimetres.reading(-4000.0), Reading::Metres(-400.0));
        let scaled = Elevation { scale: 0.001, kind: GdalDataType::Int32, ..Elevation::plain() };
        assert_eq!(scaled.reading(-32768.0), Reading::Metres(-32.768));
    }

    #[test]
    fn marks_are_written_in_the_unit_of_the_file() {
        let feet = Elevation { factor: ElevationUnit::FOOT.metres(), ..Elevation::plain() };
        assert_eq!(feet.reading(-32767.0), Reading::Sentinel);
        assert_eq!(feet.reading(1000.0), Reading::Metres(304.8));
        let millimetres = Elevation { factor: 0.001, kind: GdalDataType::Int32, ..Elevation::plain() };
        assert_eq!(millimetres.reading(-32768.0), Reading::Metres(-32.768));
    }

    #[test]
    fn nodata_is_compared_as_stored() {
        let declared = Elevation { nodata: Some(-3.40282346638529e38), ..Elevation::plain() };
        assert_eq!(declared.reading(f64::from(f32::MIN)), Reading::Void);
        let not_a_number = Elevation { nodata: Some(f64::NAN), ..Elevation::plain() };
        assert_eq!(not_a_number.reading(5.0), Reading::Metres(5.0));
    }
}
