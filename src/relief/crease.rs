//! Which lines of the land are asked for.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{ChannelArea, SlopeRules};

/// Lines that the land has by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Crease {
    /// Where water gathers and runs.
    Drainage,
    /// Where water parts.
    Ridges,
    /// Where land and flat water meet.
    Shores,
}

impl Crease {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Drainage, Self::Ridges, Self::Shores];

    /// What users call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Drainage => "drainage",
            Self::Ridges => "ridges",
            Self::Shores => "shores",
        }
    }
}

/// All that decides which lines of the land there are.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct LandWanted {
    /// Of the land itself.
    pub creases: Vec<Crease>,
    /// Where channels begin.
    pub channel_area: ChannelArea,
    /// What tells the lines that the user gives from any others; empty where there are none.
    pub own: String,
    /// What the layers of those are called, by their numbers.
    pub own_layers: Vec<String>,
    /// When lines down its slopes end; none where there are none.
    pub slopes: Option<SlopeRules>,
}

impl LandWanted {
    /// Whether there are none.
    pub(crate) fn is_nothing(&self) -> bool {
        self.creases.is_empty() && self.own.is_empty() && self.slopes.is_none()
    }
}
