//! Numbers that mark no data because the user says so.

use std::fmt::{self, Display, Formatter};

use gdal::raster::GdalDataType;

/// From here on numbers are written with an exponent.
const LONG: f64 = 1e15;

/// Numbers of a file that are no elevations, beside the one that it declares: single ones and whole ranges, as the file
/// has them, before scale and unit. `Display` writes them as one gives them: `-9999,9000..65535`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Nodata {
    /// Lowest and highest number of each range; both the same for a single number.
    ranges: Vec<[f64; 2]>,
}

impl Nodata {
    /// Of ranges from a lowest to a highest number, both included.
    pub fn new(ranges: Vec<[f64; 2]>) -> Self {
        Self { ranges }
    }

    /// These and more.
    pub(super) fn with(&self, more: &[[f64; 2]]) -> Self {
        Self { ranges: [&self.ranges, more].concat() }
    }

    /// Whether `raw`, stored as a number of `kind`, is one of them: a decimal is compared as it would be stored.
    pub(super) fn holds(&self, raw: f64, kind: GdalDataType) -> bool {
        let stored = |number: f64| if kind == GdalDataType::Float32 { f64::from(number as f32) } else { number };
        self.ranges.iter().any(|[low, high]| raw >= stored(*low) && raw <= stored(*high))
    }
}

impl Display for Nodata {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for (i, [low, high]) in self.ranges.iter().enumerate() {
            let comma = if i == 0 { "" } else { "," };
            write!(f, "{comma}{}", digits(*low))?;
            if low != high {
                write!(f, "..{}", digits(*high))?;
            }
        }
        Ok(())
    }
}

/// A number with no more digits than it is stored with.
pub(super) fn shown(number: f64, kind: GdalDataType) -> String {
    // The shortest decimal that becomes the same number in 32 bits.
    let short = if kind == GdalDataType::Float32 { (number as f32).to_string().parse() } else { Ok(number) };
    digits(short.unwrap_or(number))
}

/// A number that has hundreds of digits has an exponent.
fn digits(number: f64) -> String {
    if number.abs() < LONG { number.to_string() } else { format!("{number:e}") }
}
