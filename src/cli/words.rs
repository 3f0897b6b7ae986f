//! What the core says, in the words of the command line: flags in the place of settings, remedies, exit codes.

use std::io::ErrorKind;

use clap::CommandFactory;

use super::Arguments;
use crate::error::{Error, Message, Setting, SettingForm, shown};

/// Exit code for "failed".
pub const FAILED: u8 = 1;

/// Exit code for "wrong usage".
pub const USAGE: u8 = 2;

/// Exit code for "try again".
pub const TRY_AGAIN: u8 = 75;

/// How a setting is typed.
pub fn flag(setting: Setting) -> &'static str {
    match setting {
        Setting::AllowRemote => "--allow-remote",
        Setting::Altitude => "--altitude",
        Setting::At => "--at",
        Setting::Azimuth => "--azimuth",
        Setting::Band => "--band",
        Setting::Border => "--border",
        Setting::Cache => "--cache",
        Setting::CacheSize => "--cache-size",
        Setting::Cell => "--cell",
        Setting::CellOf => "--cell-of",
        Setting::Clearance => "--clearance",
        Setting::Count => "--count",
        Setting::Credits => "--credits",
        Setting::Crop => "--crop",
        Setting::Crs => "--crs",
        Setting::Dem => "DEM",
        Setting::Dpi => "--dpi",
        Setting::Duration => "--duration",
        Setting::Eye => "--eye",
        Setting::Encoding => "--encoding",
        Setting::ElevationUnit => "--elevation-unit",
        Setting::ErrorPx => "--error-px",
        Setting::Exaggeration => "--exaggeration",
        Setting::FillVoids => "--fill-voids",
        Setting::Georeferenced => "--georeferenced",
        Setting::Grid => "--grid",
        Setting::Fov => "--fov",
        Setting::Generalise => "--generalise",
        Setting::Height => "--height",
        Setting::Hidden => "--hidden",
        Setting::Json => "--json",
        Setting::KeepSteps => "--keep-steps",
        Setting::Level => "--level",
        Setting::Levels => "--levels",
        Setting::LonLat => "--lonlat",
        Setting::LookAt => "--look-at",
        Setting::Mask => "--mask",
        Setting::Memory => "--memory",
        Setting::Methods => "--methods",
        Setting::ChannelArea => "--channel-area",
        Setting::Creases => "--creases",
        Setting::Hachures => "--hachures",
        Setting::Lines => "--lines",
        Setting::MinGap => "--min-gap",
        Setting::MinJump => "--min-jump",
        Setting::Nodata => "--nodata",
        Setting::Margin => "--margin",
        Setting::Neatline => "--neatline",
        Setting::North => "--north",
        Setting::Fps => "--fps",
        Setting::Frames => "--frames",
        Setting::Of => "--of",
        Setting::Only => "--only",
        Setting::Orbit => "--orbit",
        Setting::Order => "--order",
        Setting::Output => "--output",
        Setting::Page => "--page",
        Setting::Path => "--path",
        Setting::Plan => "--plan",
        Setting::Preview => "--preview",
        Setting::Radius => "--radius",
        Setting::Resample => "--resample",
        Setting::Scale => "--scale",
        Setting::Shard => "--shard",
        Setting::ShardFromEnv => "--shard-from-env",
        Setting::Share => "--share",
        Setting::Sheet => "--sheet",
        Setting::Size => "--size",
        Setting::Sizes => "--sizes",
        Setting::Style => "--style",
        Setting::Title => "--title",
        Setting::Video => "--video",
        Setting::ViewLine => "--view-line",
        Setting::Views => "--views",
        Setting::Warp => "--no-warp",
        Setting::Wide => "--wide",
    }
}

/// A value of the user's own for a setting, as the help has it.
fn placeholder(setting: Setting) -> String {
    let known = argument(setting);
    let values = known.as_ref().and_then(clap::Arg::get_value_names);
    values.and_then(<[_]>::first).map_or_else(|| flag(setting).to_owned(), ToString::to_string)
}

/// What stands between a flag and its value.
fn sign(setting: Setting) -> char {
    if argument(setting).is_some_and(|known| known.is_require_equals_set()) { '=' } else { ' ' }
}

/// The argument by which a setting is typed; `None` for one without a flag.
fn argument(setting: Setting) -> Option<clap::Arg> {
    let (command, long) = (Arguments::command(), flag(setting).strip_prefix("--")?);
    let mut flags = command.get_subcommands().flat_map(clap::Command::get_arguments);
    flags.find(|known| known.get_long() == Some(long)).cloned()
}

/// A number by its first three digits.
pub(crate) fn short(number: f64) -> String {
    if number == 0.0 || !number.is_finite() {
        return if number.is_finite() { "0".to_owned() } else { "endlessly much".to_owned() };
    }
    let decimals = (2.0 - number.abs().log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{number:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A message with flags.
pub fn told(message: &Message) -> String {
    message.told(|setting, form| match form {
        SettingForm::Name => flag(setting).to_owned(),
        SettingForm::At(value) => format!("{} {value}", flag(setting)),
        SettingForm::WithValue => format!("{}{}{}", flag(setting), sign(setting), placeholder(setting)),
        SettingForm::Value => placeholder(setting),
    })
}

/// An error as one line: what, where, remedy.
pub fn line(error: &Error) -> String {
    match error {
        Error::Input { path, what, remedy } => format!("{}: {}; {}", shown(path), told(what), told(remedy)),
        Error::Setting { setting, what, remedy } => format!("{}: {}; {}", flag(*setting), told(what), told(remedy)),
        Error::Limit { what, remedy }
        | Error::Scene { what, remedy }
        | Error::Incomplete { what, remedy }
        | Error::Ended { what, remedy } => format!("{}; {}", told(what), told(remedy)),
        Error::Output { why, .. } => format!("{error}; {}", way_out(*why)),
        Error::Gpu { .. } => format!("{error}; try `--adapter cpu`, a smaller --size or a lower --level"),
        Error::DeviceLost { .. } => format!("{error}; try again, or use `--adapter cpu`"),
        Error::NoAdapter { .. } | Error::Mistake { .. } => error.to_string(),
    }
}

/// The process's exit code for an error: 1 failed, 2 wrong usage, 75 try again.
pub fn exit_code(error: &Error) -> u8 {
    match error {
        Error::Setting { .. } => USAGE,
        Error::DeviceLost { .. } | Error::Ended { .. } => TRY_AGAIN,
        _ => FAILED,
    }
}

/// What to do about the reason not to write.
fn way_out(why: ErrorKind) -> &'static str {
    match why {
        ErrorKind::FileTooLarge => "allow larger files (`ulimit -f unlimited`)",
        ErrorKind::StorageFull => "make room there or choose another output path",
        _ => "choose another output path",
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;
    use crate::message;

    #[test]
    fn values_of_the_users_own_stand_as_in_the_help() {
        let settings = [Setting::Band, Setting::Cell, Setting::Resample, Setting::Cache, Setting::Crop];
        assert_eq!(
            settings.map(|setting| told(&setting.with_value().into())),
            ["--band N", "--cell M", "--resample M", "--cache DIR", "--crop E0,N0,E1,N1"]
        );
        assert_eq!(told(&Setting::Credits.with_value().into()), "--credits=TEXT", "a flag that stands alone too");
        let within = message!["give ", Setting::Crop.value(), " within 1,2,3,4 m"];
        assert_eq!(told(&within), "give E0,N0,E1,N1 within 1,2,3,4 m");
        assert_eq!(placeholder(Setting::Dem), "DEM");
    }

    #[test]
    fn every_error_has_its_line_and_its_code() {
        let on_disk = |code| Error::output("a.png".as_ref(), &std::io::Error::from_raw_os_error(code));
        let [what, remedy] = ["it is odd", "mend it"].map(str::to_owned);
        let scene = Error::Scene { what: what.clone().into(), remedy: message!["turn ", Setting::Azimuth] };
        let cases = [
            (
                Error::input("a.tif".as_ref(), "it is odd", message!["use ", Setting::Crop]),
                "a.tif: it is odd; use --crop",
                1,
            ),
            (Error::setting(Setting::Size, "it is odd", "mend it"), "--size: it is odd; mend it", 2),
            (on_disk(2), "choose another output path", 1),
            (on_disk(27), "; allow larger files (`ulimit -f unlimited`)", 1),
            (on_disk(28), "; make room there or choose another output path", 1),
            (Error::limit("it is odd", message!["use a lower ", Setting::Level]), "it is odd; use a lower --level", 1),
            (scene, "it is odd; turn --azimuth", 1),
            (Error::NoAdapter { what: what.clone(), remedy }, "no GPU adapter: it is odd; mend it", 1),
            (
                Error::Gpu { what: what.clone() },
                "the GPU failed: it is odd; try `--adapter cpu`, a smaller --size or a lower --level",
                1,
            ),
            (Error::DeviceLost { what }, "the GPU was lost: it is odd; try again, or use `--adapter cpu`", 75),
            (Error::mistake("it is odd"), "it is odd; that is hachure's mistake, please report it with the command", 1),
        ];
        for (error, end, code) in cases {
            let line = line(&error);
            match &error {
                Error::Output { what, .. } => {
                    assert!(
                        line.starts_with(&format!("a.png: cannot be written ({what}); ")) && line.ends_with(end),
                        "{line}"
                    )
                }
                _ => assert_eq!(line, end),
            }
            assert_eq!(exit_code(&error), code, "{line}");
        }
    }

    #[test]
    fn every_setting_is_a_flag_that_can_be_typed() {
        let command = Arguments::command();
        let of = |command: &clap::Command| {
            command
                .get_arguments()
                .filter_map(|flag| flag.get_long())
                .map(|flag| format!("--{flag}"))
                .collect::<Vec<_>>()
        };
        let known: HashSet<String> = command.get_subcommands().flat_map(of).collect();
        let typed = Setting::ALL.map(flag);
        let unknown: Vec<_> = typed.into_iter().filter(|flag| *flag != "DEM" && !known.contains(*flag)).collect();
        assert!(unknown.is_empty(), "{unknown:?} are no flags");
        assert_eq!(HashSet::from(typed).len(), typed.len(), "each has its own");
        assert!(!known.contains("--colour"), "a flag that nobody has is not known");
    }
}
