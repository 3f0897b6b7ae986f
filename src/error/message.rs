//! Words for people that speak of settings without saying how one sets them.
//!
//! A program over this library sets a crop by a flag, another by a box dragged with a mouse. So errors and warnings name the
//! [`Setting`] and, where one is meant, its value; whoever talks to the user puts in his own words for it.

use std::fmt::{self, Display, Formatter};

use super::plain;

/// The settings, from one list: what each is, and its name in words.
macro_rules! settings {
    ($($(#[$doc:meta])+ $setting:ident = $name:literal,)+) => {
        /// What a user of this library may set. Some belong to no function of the library but to programs over it, which
        /// name several outputs, say: [`files::Taken`](crate::files::Taken) speaks of those.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
        pub enum Setting {
            $($(#[$doc])+ $setting,)+
        }

        impl Setting {
            /// All of them.
            pub const ALL: [Self; [$($name),+].len()] = [$(Self::$setting),+];
        }

        /// The name, in words.
        impl Display for Setting {
            fn fmt(&self, to: &mut Formatter<'_>) -> fmt::Result {
                to.write_str(match self {
                    $(Self::$setting => $name,)+
                })
            }
        }
    };
}

settings! {
    /// Whether files on a network are opened.
    AllowRemote = "allow remote",
    /// Degrees above the horizon.
    Altitude = "altitude",
    /// Degrees clockwise from north.
    Azimuth = "azimuth",
    /// A pixel that is asked about.
    At = "pixel",
    /// The band with the elevations.
    Band = "band",
    /// Whether the rim is drawn.
    Border = "border",
    /// The folder in which things are kept.
    Cache = "cache",
    /// Bytes of what is kept.
    CacheSize = "cache size",
    /// Who made the DEM.
    Credits = "credits",
    /// Metres between samples of files that do not say.
    Cell = "cell",
    /// The file whose grid is drawn.
    CellOf = "cell of",
    /// From how much land on water runs in a channel.
    ChannelArea = "channel area",
    /// Metres that a flight keeps above the ground.
    Clearance = "clearance",
    /// Frames of a flight in all.
    Count = "count",
    /// Lines of the land.
    Creases = "creases",
    /// The part that is taken.
    Crop = "crop",
    /// The coordinate system of places that are given.
    Crs = "CRS",
    /// Pixels of a picture for each inch of the sheet.
    Dpi = "dpi",
    /// The file or files of the DEM.
    Dem = "DEM",
    /// Seconds of a flight.
    Duration = "duration",
    /// Where the eye stands, on the map.
    Eye = "eye",
    /// What the numbers of a file stand for.
    Encoding = "encoding",
    /// The unit of elevations.
    ElevationUnit = "elevation unit",
    /// How far facets may deviate on the page.
    ErrorPx = "error in px",
    /// Factor on elevations.
    Exaggeration = "exaggeration",
    /// Strokes for tone.
    Hachures = "hachures",
    /// Whether voids are filled.
    FillVoids = "fill voids",
    /// The file of the lines on the map.
    Georeferenced = "file of lines on the map",
    /// The grid of a map's sheets.
    Grid = "grid",
    /// Degrees across the page.
    Fov = "field of view",
    /// Metres of what is smoothed away.
    Generalise = "generalise",
    /// How high a flight is.
    Height = "height",
    /// Whether hidden lines are drawn.
    Hidden = "hidden",
    /// The file of what was done.
    Json = "JSON file",
    /// Whether heights stay as coarse as the file has them.
    KeepSteps = "keep steps",
    /// How fine facets are.
    Level = "level",
    /// Several of them.
    Levels = "levels",
    /// Files of lines of the user's own.
    Lines = "lines",
    /// Where the eye stands, on the globe.
    LonLat = "longitude and latitude",
    /// What the middle of the page shows.
    LookAt = "look-at",
    /// The file of the mask.
    Mask = "mask file",
    /// Bytes for samples and normals.
    Memory = "memory",
    /// Several methods.
    Methods = "methods",
    /// How near to each other lines may be.
    MinGap = "min gap",
    /// How much farther what lies behind a line must be.
    MinJump = "min jump",
    /// Numbers that are no data.
    Nodata = "nodata",
    /// The blank edge of the sheet.
    Margin = "margin",
    /// Whether rules frame the picture.
    Neatline = "neatline",
    /// What azimuths are counted from.
    North = "north",
    /// The jobs that are done.
    Frames = "frames",
    /// Pictures a second.
    Fps = "fps",
    /// A place that is asked about.
    Of = "place",
    /// The case that is run alone.
    Only = "case",
    /// What a flight circles.
    Orbit = "orbit",
    /// Which files lie on top.
    Order = "order",
    /// The file or folder that is written.
    Output = "output",
    /// The sheet of paper.
    Page = "page",
    /// The file of the way that a flight takes.
    Path = "path",
    /// Whether the land is drawn from straight above.
    Plan = "plan",
    /// Metres from what a flight circles.
    Radius = "radius",
    /// Metres of the cells that are resampled to.
    Resample = "resample",
    /// Millimetres of land for one of the sheet.
    Scale = "scale",
    /// Which share of the jobs is done.
    Shard = "shard",
    /// Whether the environment says which.
    ShardFromEnv = "shard from the environment",
    /// The picture of a flight from above.
    Preview = "preview",
    /// What neighbouring facets share.
    Share = "share",
    /// The side of a map's sheets.
    Sheet = "sheet",
    /// Pixels of the page.
    Size = "size",
    /// Several pages.
    Sizes = "sizes",
    /// The look of the drawing.
    Style = "style",
    /// What the picture is called.
    Title = "title",
    /// The motion picture.
    Video = "video",
    /// Whether it is said from where the land is seen.
    ViewLine = "view line",
    /// The file of views.
    Views = "file of views",
    /// Whether maps off the ground stay as they are.
    Warp = "no warp",
    /// Whether away surface counts wherever it touches.
    Wide = "wide",
}

impl Setting {
    /// The setting at this value.
    pub fn at(self, value: impl Display) -> MessagePart {
        MessagePart::Setting(self, SettingForm::At(value.to_string()))
    }

    /// The setting at a value of the user's own.
    pub(crate) fn with_value(self) -> MessagePart {
        MessagePart::Setting(self, SettingForm::WithValue)
    }

    /// A value of the user's own for the setting, which is not named.
    pub fn value(self) -> MessagePart {
        MessagePart::Setting(self, SettingForm::Value)
    }
}

/// How much of a setting stands in a message.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum SettingForm {
    /// Itself.
    Name,
    /// Itself, at this value.
    At(String),
    /// Itself, at a value of the user's own.
    WithValue,
    /// Such a value alone.
    Value,
}

/// A piece of a message.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum MessagePart {
    /// As they are.
    Words(String),
    /// A setting, and how much of it is said.
    Setting(Setting, SettingForm),
}

/// Words and settings in the order of a sentence; see [`message!`](crate::message).
#[derive(Debug, Clone, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub struct Message(Vec<MessagePart>);

impl Message {
    /// Adds another at the end.
    pub fn push(&mut self, more: impl Into<Self>) {
        self.0.append(&mut more.into().0);
    }

    /// The same on one line that moves nothing on a terminal.
    pub(crate) fn plain(self) -> Self {
        let piece = |part| match part {
            MessagePart::Words(words) => MessagePart::Words(plain(words)),
            MessagePart::Setting(setting, SettingForm::At(value)) => {
                MessagePart::Setting(setting, SettingForm::At(plain(value)))
            }
            other @ MessagePart::Setting(..) => other,
        };
        Self(self.0.into_iter().map(piece).collect())
    }

    /// The sentence, with `spelled` in the place of settings.
    pub fn told(&self, spelled: impl Fn(Setting, &SettingForm) -> String) -> String {
        let piece = |part: &MessagePart| match part {
            MessagePart::Words(words) => words.clone(),
            MessagePart::Setting(setting, form) => spelled(*setting, form),
        };
        self.0.iter().map(piece).collect()
    }
}

/// Settings by their names.
impl Display for Message {
    fn fmt(&self, to: &mut Formatter<'_>) -> fmt::Result {
        to.write_str(&self.told(|setting, form| match form {
            SettingForm::At(value) => format!("{setting} {value}"),
            SettingForm::Name | SettingForm::WithValue | SettingForm::Value => setting.to_string(),
        }))
    }
}

impl From<MessagePart> for Message {
    fn from(part: MessagePart) -> Self {
        Self(vec![part])
    }
}

impl From<String> for Message {
    fn from(words: String) -> Self {
        MessagePart::Words(words).into()
    }
}

impl From<&str> for Message {
    fn from(words: &str) -> Self {
        words.to_owned().into()
    }
}

impl From<Setting> for Message {
    fn from(setting: Setting) -> Self {
        MessagePart::Setting(setting, SettingForm::Name).into()
    }
}

/// A [`Message`](crate::error::Message) of words, settings and other messages: `message!["use a smaller ", Setting::Size]`.
#[doc(hidden)]
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
        let told = message.told(|setting, form| format!("<{setting:?} {form:?}>"));
        assert_eq!(told, "give <Memory At(\"4MiB\")> (it is 3 MiB), or use <Crop Name>");
        let own = message!["say ", Setting::Cell.with_value(), " or ", Setting::Crop.value()];
        assert_eq!(own.to_string(), "say cell or crop");
        assert_eq!(own.told(|setting, form| format!("<{setting:?} {form:?}>")), "say <Cell WithValue> or <Crop Value>");
    }

    #[test]
    fn each_setting_is_there_once_under_a_name_of_its_own() {
        let names: std::collections::HashSet<_> = Setting::ALL.iter().map(Setting::to_string).collect();
        assert_eq!(names.len(), Setting::ALL.len());
    }
}
