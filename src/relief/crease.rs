//! Which lines of the land are asked for.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
