//! Units of length that elevations are found in.

/// A unit of length that elevations are found in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElevationUnit {
    name: &'static str,
    metres: f64,
}

impl ElevationUnit {
    /// The metre.
    pub const METRE: Self = Self::of("m", 1.0);
    /// The international foot, 0.3048 m.
    pub const FOOT: Self = Self::of("ft", 0.3048);
    /// The US survey foot, 1200 / 3937 m.
    pub const US_FOOT: Self = Self::of("us-ft", 1200.0 / 3937.0);
    /// A tenth of a metre.
    pub const DECIMETRE: Self = Self::of("dm", 0.1);
    /// A hundredth of a metre.
    pub const CENTIMETRE: Self = Self::of("cm", 0.01);
    /// A thousandth of a metre.
    pub const MILLIMETRE: Self = Self::of("mm", 0.001);
    /// A thousand metres.
    pub const KILOMETRE: Self = Self::of("km", 1000.0);

    /// All of them, feet last.
    pub const ALL: [Self; 7] =
        [Self::METRE, Self::DECIMETRE, Self::CENTIMETRE, Self::MILLIMETRE, Self::KILOMETRE, Self::FOOT, Self::US_FOOT];

    const fn of(name: &'static str, metres: f64) -> Self {
        Self { name, metres }
    }

    /// Its symbol.
    pub const fn name(self) -> &'static str {
        self.name
    }

    /// Metres of it.
    pub const fn metres(self) -> f64 {
        self.metres
    }

    /// The symbols of all in a sentence.
    pub fn any() -> String {
        let [most @ .., last] = Self::ALL.map(Self::name);
        format!("{} or {last}", most.join(", "))
    }
}
