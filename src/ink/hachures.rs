//! Hachures and light of a style.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

use super::style::{PART, STEP, part, step, within};
use crate::plan::{Light, LightAzimuth, Tone};
use crate::relief::SlopeRules;

/// Least and greatest of numbers, degrees.
const SLOPE: [f64; 2] = [0.5, 60.0];
const BLACK_AT: [f64; 2] = [5.0, 90.0];
const TURN: [f64; 2] = [5.0, 360.0];
const AZIMUTH: [f64; 2] = [-360.0, 360.0];
const ALTITUDE: [f64; 2] = [1.0, 90.0];

/// Strokes down the slope that give tone. Lengths are millimetres on the sheet.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct HachureStyle {
    /// What their darkness says: `lehmann` the slope, `shadow` the light, `both` the mean of the two; `none` draws none.
    pub tone: Tone,
    /// How far apart they stand at most; closer where the pen is too fine for the tone.
    #[serde(deserialize_with = "step")]
    #[schemars(range(min = STEP[0], max = STEP[1]))]
    pub spacing: f64,
    /// About how long they are at most.
    #[serde(deserialize_with = "step")]
    #[schemars(range(min = STEP[0], max = STEP[1]))]
    pub length: f64,
    /// Slope in degrees under which there are none.
    #[serde(deserialize_with = "slope")]
    #[schemars(range(min = SLOPE[0], max = SLOPE[1]))]
    pub min_slope: f64,
    /// Degrees by which one turns on the map at most.
    #[serde(deserialize_with = "turn")]
    #[schemars(range(min = TURN[0], max = TURN[1]))]
    pub max_turn: f64,
    /// Slope in degrees that is black: 45 is Lehmann's, 50 Müffling's, 60 Bavaria's, 80 Austria's.
    #[serde(deserialize_with = "black_at")]
    #[schemars(range(min = BLACK_AT[0], max = BLACK_AT[1]))]
    pub black_at: f64,
    /// Most of the paper that is ink in views; plans go up to black.
    #[serde(deserialize_with = "part")]
    #[schemars(range(min = PART[0], max = PART[1]))]
    pub most_black: f64,
    /// Width of the farthest strokes as a share of the nearest: tone fades less with distance than outlines do.
    #[serde(deserialize_with = "part")]
    #[schemars(range(min = PART[0], max = PART[1]))]
    pub far: f64,
}

/// Where light comes from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct LightStyle {
    /// Degrees clockwise from the y axis of the DEM's coordinates; else from 45 degrees left of where the eye looks, in a flight at its first frame, and from
    /// the north-west in plans.
    #[serde(deserialize_with = "azimuth", skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = AZIMUTH[0], max = AZIMUTH[1]))]
    pub azimuth: Option<f64>,
    /// Degrees above the horizon.
    #[serde(deserialize_with = "altitude")]
    #[schemars(range(min = ALTITUDE[0], max = ALTITUDE[1]))]
    pub altitude: f64,
}

impl Default for HachureStyle {
    fn default() -> Self {
        Self {
            tone: Tone::Shadow,
            spacing: 1.0,
            length: 14.0,
            min_slope: 3.0,
            max_turn: 60.0,
            black_at: 45.0,
            most_black: 0.5,
            far: 0.36,
        }
    }
}

impl Default for LightStyle {
    fn default() -> Self {
        Self { azimuth: None, altitude: 45.0 }
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl HachureStyle {
    /// When their lines end; none where there are none.
    pub fn rules(&self) -> Option<SlopeRules> {
        (self.tone != Tone::None).then_some(SlopeRules { min_slope: self.min_slope, max_turn: self.max_turn })
    }
}

impl LightStyle {
    /// Degrees from where the eye looks, where nothing is said.
    const OF_VIEW: f64 = -45.0;
}

/// What other stages and tests look into.
#[doc(hidden)]
impl LightStyle {
    /// The same as planned.
    pub fn light(&self) -> Light {
        let azimuth = self.azimuth.map_or(LightAzimuth::View(Self::OF_VIEW), LightAzimuth::World);
        Light { azimuth, altitude: self.altitude }
    }
}

fn slope<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    within(from, SLOPE, "degrees of slope")
}

fn black_at<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    within(from, BLACK_AT, "degrees of slope")
}

fn turn<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    within(from, TURN, "degrees")
}

fn azimuth<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f64>, D::Error> {
    within(from, AZIMUTH, "degrees").map(Some)
}

fn altitude<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    within(from, ALTITUDE, "degrees")
}
