//! Words for people that speak of settings without saying how one sets them.
//!
//! A program over this library sets a crop by a flag, another by a box dragged with a mouse. So errors and warnings name the
//! [`Setting`] and, where one is meant, its value; whoever talks to the user puts in his own words for it.

use std::fmt::{self, Display, Formatter};

use super::plain;

/// What a user of this library may set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub enum Setting {
    /// Which adapter is opened.
    Adapter,
    /// Whether files on a network are opened.
    AllowRemote,
    /// Degrees above the horizon.
    Altitude,
    /// Degrees clockwise from north.
    Azimuth,
    /// The band with the elevations.
    Band,
    /// Whether the rim is drawn.
    Border,
    /// The folder in which things are kept.
    Cache,
    /// Metres between samples of files that do not say.
    Cell,
    /// The part that is taken.
    Crop,
    /// The coordinate system of places that are given.
    Crs,
    /// The file or files of the DEM.
    Dem,
    /// Where the eye stands, on the map.
    Eye,
    /// What the numbers of a file stand for.
    Encoding,
    /// The unit of elevations.
    ElevationUnit,
    /// How far facets may deviate on the page.
    ErrorPx,
    /// Factor on elevations.
    Exaggeration,
    /// Whether voids are filled.
    FillVoids,
    /// The file of what was done.
    Json,
    /// How fine facets are.
    Level,
    /// Several of them.
    Levels,
    /// Where the eye stands, on the globe.
    LonLat,
    /// What the middle of the page shows.
    LookAt,
    /// The file of the mask.
    Mask,
    /// Bytes for samples and normals.
    Memory,
    /// How silhouettes are found.
    Method,
    /// Several methods.
    Methods,
    /// Numbers that are no data.
    Nodata,
    /// The file or folder that is written.
    Output,
    /// Metres of the cells that are resampled to.
    Resample,
    /// What neighbouring facets share.
    Share,
    /// Pixels of the page.
    Size,
    /// Several pages.
    Sizes,
    /// The file of views.
    Views,
    /// Whether away surface counts wherever it touches.
    Wide,
}

impl Setting {
    /// All of them.
    pub const ALL: [Self; 34] = [
        Self::Adapter,
        Self::AllowRemote,
        Self::Altitude,
        Self::Azimuth,
        Self::Band,
        Self::Border,
        Self::Cache,
        Self::Cell,
        Self::Crop,
        Self::Crs,
        Self::Dem,
        Self::Eye,
        Self::Encoding,
        Self::ElevationUnit,
        Self::ErrorPx,
        Self::Exaggeration,
        Self::FillVoids,
        Self::Json,
        Self::Level,
        Self::Levels,
        Self::LonLat,
        Self::LookAt,
        Self::Mask,
        Self::Memory,
        Self::Method,
        Self::Methods,
        Self::Nodata,
        Self::Output,
        Self::Resample,
        Self::Share,
        Self::Size,
        Self::Sizes,
        Self::Views,
        Self::Wide,
    ];

    /// The setting at this value.
    pub fn at(self, value: impl Display) -> Part {
        Part::Setting(self, Some(value.to_string()))
    }
}

/// The name, in words.
impl Display for Setting {
    fn fmt(&self, to: &mut Formatter<'_>) -> fmt::Result {
        to.write_str(match self {
            Self::Adapter => "adapter",
            Self::AllowRemote => "allow remote",
            Self::Altitude => "altitude",
            Self::Azimuth => "azimuth",
            Self::Band => "band",
            Self::Border => "border",
            Self::Cache => "cache",
            Self::Cell => "cell",
            Self::Crop => "crop",
            Self::Crs => "CRS",
            Self::Dem => "DEM",
            Self::Eye => "eye",
            Self::Encoding => "encoding",
            Self::ElevationUnit => "elevation unit",
            Self::ErrorPx => "error in px",
            Self::Exaggeration => "exaggeration",
            Self::FillVoids => "fill voids",
            Self::Json => "JSON file",
            Self::Level => "level",
            Self::Levels => "levels",
            Self::LonLat => "longitude and latitude",
            Self::LookAt => "look-at",
            Self::Mask => "mask file",
            Self::Memory => "memory",
            Self::Method => "method",
            Self::Methods => "methods",
            Self::Nodata => "nodata",
            Self::Output => "output",
            Self::Resample => "resample",
            Self::Share => "share",
            Self::Size => "size",
            Self::Sizes => "sizes",
            Self::Views => "file of views",
            Self::Wide => "wide",
        })
    }
}

/// A piece of a message.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Part {
    /// As they are.
    Words(String),
    /// A setting and, where one is meant, its value.
    Setting(Setting, Option<String>),
}

/// Words and settings in the order of a sentence; see [`message!`](crate::message).
#[derive(Debug, Clone, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub struct Message(Vec<Part>);

impl Message {
    /// Its pieces, one after the other.
    pub fn parts(&self) -> &[Part] {
        &self.0
    }

    /// Adds another at the end.
    pub fn push(&mut self, more: impl Into<Self>) {
        self.0.append(&mut more.into().0);
    }

    /// The same on one line that moves nothing on a terminal.
    pub(crate) fn plain(self) -> Self {
        let piece = |part| match part {
            Part::Words(words) => Part::Words(plain(words)),
            Part::Setting(setting, value) => Part::Setting(setting, value.map(plain)),
        };
        Self(self.0.into_iter().map(piece).collect())
    }

    /// The sentence, with `spelled` in the place of settings.
    pub fn told(&self, spelled: impl Fn(Setting, Option<&str>) -> String) -> String {
        let piece = |part: &Part| match part {
            Part::Words(words) => words.clone(),
            Part::Setting(setting, value) => spelled(*setting, value.as_deref()),
        };
        self.0.iter().map(piece).collect()
    }
}

/// Settings by their names.
impl Display for Message {
    fn fmt(&self, to: &mut Formatter<'_>) -> fmt::Result {
        to.write_str(&self.told(|setting, value| match value {
            Some(value) => format!("{setting} {value}"),
            None => setting.to_string(),
        }))
    }
}

impl From<Part> for Message {
    fn from(part: Part) -> Self {
        Self(vec![part])
    }
}

impl From<String> for Message {
    fn from(words: String) -> Self {
        Part::Words(words).into()
    }
}

impl From<&str> for Message {
    fn from(words: &str) -> Self {
        words.to_owned().into()
    }
}

impl From<Setting> for Message {
    fn from(setting: Setting) -> Self {
        Part::Setting(setting, None).into()
    }
}

/// A [`Message`](crate::error::Message) of words, settings and other messages: `message!["use a smaller ", Setting::Size]`.
#[macro_export]
macro_rules! message {
    ($($part:expr),+ $(,)?) => {{
        let mut message = $crate::error::Message::default();
        $(message.push($part);)+
        message
    }};
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_says_settings_in_the_words_of_whoever_tells_it() {
        let more = format!(" (it is {} MiB)", 3);
        let message = message!["give ", Setting::Memory.at("4MiB"), more, ", or use ", Setting::Crop];
        assert_eq!(message.to_string(), "give memory 4MiB (it is 3 MiB), or use crop");
        let told = message.told(|setting, value| format!("<{setting:?}{}>", value.unwrap_or_default()));
        assert_eq!(told, "give <Memory4MiB> (it is 3 MiB), or use <Crop>");
    }

    #[test]
    fn each_setting_is_there_once_under_a_name_of_its_own() {
        let names: std::collections::HashSet<_> = Setting::ALL.iter().map(Setting::to_string).collect();
        assert_eq!(names.len(), Setting::ALL.len());
    }
}
