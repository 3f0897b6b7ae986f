//! What the numbers of a file stand for where they are not what the file says.

/// How elevations are packed into the numbers of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// Three bands of 8 bits: -10000 + (R x 65536 + G x 256 + B) / 10 metres.
    TerrainRgb,
    /// Three bands of 8 bits: R x 256 + G + B / 256 - 32768 metres.
    Terrarium,
    /// Unsigned numbers, the upper half of which are below 0: 65535 of 16 bits is -1.
    Signed,
    /// The numbers are heights, whatever the file says of depths.
    Elevations,
    /// They are depths: the greater, the deeper.
    Depths,
}

impl Encoding {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::TerrainRgb, Self::Terrarium, Self::Signed, Self::Elevations, Self::Depths];

    /// Its name, as one asks for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::TerrainRgb => "terrain-rgb",
            Self::Terrarium => "terrarium",
            Self::Signed => "signed",
            Self::Elevations => "elevations",
            Self::Depths => "depths",
        }
    }
}
