//! Units of length that elevations are found in.

/// A unit of length that elevations are found in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElevationUnit(f64);

impl ElevationUnit {
    /// The metre.
    pub const METRE: Self = Self(1.0);
    /// The international foot, 0.3048 m.
    pub const FOOT: Self = Self(0.3048);
    /// The US survey foot, 1200 / 3937 m.
    pub const US_FOOT: Self = Self(1200.0 / 3937.0);
    /// A tenth of a metre.
    pub const DECIMETRE: Self = Self(0.1);
    /// A hundredth of a metre.
    pub const CENTIMETRE: Self = Self(0.01);
    /// A thousandth of a metre.
    pub const MILLIMETRE: Self = Self(0.001);
    /// A thousand metres.
    pub const KILOMETRE: Self = Self(1000.0);

    /// Metres of it.
    pub const fn metres(self) -> f64 {
        self.0
    }
}
