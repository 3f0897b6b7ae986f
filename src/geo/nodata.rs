//! Numbers that mark no data because the user says so.

use std::fmt::{self, Display, Formatter};

/// From here on numbers are written with an exponent.
const LONG: f64 = 1e15;

/// Numbers of a file that are no elevations, beside the one that it declares: single ones and whole ranges, as the file
/// has them, before scale and unit. `Display` writes them as one gives them: `-9999,9000..65535`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Nodata {
    /// Lowest and highest number of each range; both the same for a single number.
    pub(super) ranges: Vec<[f64; 2]>,
}

impl Nodata {
    /// Of ranges from a lowest to a highest number, both included.
    pub fn new(ranges: Vec<[f64; 2]>) -> Self {
        Self { ranges }
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

/// A number that has hundreds of digits has an exponent.
pub(super) fn digits(number: f64) -> String {
    if number.abs() < LONG { number.to_string() } else { format!("{number:e}") }
}
