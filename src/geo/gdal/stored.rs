//! Numbers as a file stores them: a decimal that a user types is compared, and shown, with as many digits.

use gdal::raster::GdalDataType;

use crate::geo::nodata::{Nodata, digits};

impl Nodata {
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

/// A number with no more digits than it is stored with.
pub(super) fn shown(number: f64, kind: GdalDataType) -> String {
    // The shortest decimal that becomes the same number in 32 bits.
    let short = if kind == GdalDataType::Float32 { (number as f32).to_string().parse() } else { Ok(number) };
    digits(short.unwrap_or(number))
}
