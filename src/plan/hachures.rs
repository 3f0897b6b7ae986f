//! Hachures: what their darkness says of the land, and how far apart they stand.
//!
//! Lehmann (1799): the share of the paper that is ink grows as the slope, from none on level land to all at 45 degrees; others
//! let it be all at 50 (Müffling), 60 (Bavaria) or 80 (Austria). Shadow: Lambert's law against level land, so that this is blank
//! and what is turned to the light too. Both: their mean.

use glam::{DVec2, DVec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The share of the broadest stroke that makes the tone between strokes without ends: what is left makes up for these.
const FULL: f64 = 0.7;

/// What the darkness of hachures says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Tone {
    /// No hachures.
    None,
    /// How steep the land is.
    #[default]
    Lehmann,
    /// How far it is turned from the light.
    Shadow,
    /// The mean of the two.
    Both,
}

impl Tone {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::None, Self::Lehmann, Self::Shadow, Self::Both];

    /// What users call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Lehmann => "lehmann",
            Self::Shadow => "shadow",
            Self::Both => "both",
        }
    }
}

/// Where light comes from, degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Clockwise from the y axis of the world.
    pub azimuth: LightAzimuth,
    /// Above the horizon.
    pub altitude: f64,
}

/// What an azimuth of light is counted from, degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LightAzimuth {
    /// The y axis of the world.
    World(f64),
    /// Where the eye looks.
    View(f64),
}

impl Light {
    /// The same of the world, for an eye that looks there.
    pub(crate) fn seen_from(self, azimuth: f64) -> Self {
        let of_world = match self.azimuth {
            LightAzimuth::World(light) => light,
            LightAzimuth::View(turn) => azimuth + turn,
        };
        Self { azimuth: LightAzimuth::World(of_world), ..self }
    }

    /// Unit vector to the light, of an eye that looks there: east, north, up.
    fn towards(self, azimuth: f64) -> DVec3 {
        let (LightAzimuth::World(light) | LightAzimuth::View(light)) = self.seen_from(azimuth).azimuth;
        let ((sin_a, cos_a), (sin_e, cos_e)) = (light.to_radians().sin_cos(), self.altitude.to_radians().sin_cos());
        DVec3::new(sin_a * cos_e, cos_a * cos_e, sin_e)
    }
}

/// How the hachures of a page are to look.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hachures {
    /// What their darkness says.
    pub tone: Tone,
    /// Slope that is black, degrees.
    pub black_at: f64,
    /// Most of the paper that is ink, a share.
    pub most_black: f64,
    /// How far apart strokes stand at most, px.
    pub spacing: f64,
    /// How broad they are at most, px: where that does not make the tone they stand closer.
    pub broadest: f64,
    /// About how long they are at most, px.
    pub length: f64,
    /// Lengths up to which one is left out, and from which it is whole, in what strokes about it are apart.
    pub shortest: [f64; 2],
    /// Where light comes from.
    pub light: Light,
}

/// The tone of the land as one eye sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shade {
    hachures: Hachures,
    light: DVec3,
    exaggeration: f64,
}

impl Hachures {
    /// Of views: shorter ones are but ticks.
    pub const SHORTEST: [f64; 2] = [1.0, 3.0];
    /// Of maps, where they tell of a slope.
    const SHORTEST_ON_MAP: [f64; 2] = [0.5, 1.5];

    /// The same on a map, where black is black and short strokes count.
    pub fn on_map(self) -> Self {
        Self { most_black: 1.0, shortest: Self::SHORTEST_ON_MAP, ..self }
    }

    /// The least of that, px.
    pub(crate) fn least_apart(&self) -> f64 {
        self.apart(self.most_black)
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Hachures {
    /// The tone for an eye that looks to this azimuth of the world, degrees, at heights exaggerated by a factor.
    pub fn shade(&self, azimuth: f64, exaggeration: f64) -> Shade {
        Shade { hachures: *self, light: self.light.towards(azimuth), exaggeration }
    }

    /// How far apart strokes of a tone stand, px.
    pub fn apart(&self, black: f64) -> f64 {
        self.spacing.min(FULL * self.broadest / black.max(f64::MIN_POSITIVE))
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Shade {
    /// The share of the paper that is ink on land of this gradient: exaggerated metres for a metre east and north.
    pub fn black(&self, gradient: DVec2) -> f64 {
        let by_slope = || (gradient.length() / self.exaggeration).atan().to_degrees() / self.hachures.black_at;
        // Against level land.
        let lit = || (-gradient).extend(1.0).normalize().dot(self.light) / self.light.z;
        let by_light = || (1.0 - lit().max(0.0)).max(0.0);
        let black = match self.hachures.tone {
            Tone::None => 0.0,
            Tone::Lehmann => by_slope(),
            Tone::Shadow => by_light(),
            Tone::Both => f64::midpoint(by_slope().min(1.0), by_light()),
        };
        black.min(self.hachures.most_black)
    }
}
