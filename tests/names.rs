//! Names of files, whatever they hold: printed on one line that moves nothing, refused in time where they name no file.
//! And what help says of defaults, an eye on the ground, and how many tiles there are.

use std::fs;
use std::path::Path;

use clap::CommandFactory;
use hachure::door::cli::Arguments;
use hachure::door::cli::choices::default_share;
use hachure::door::cli::viewpoint::{FOV, SIZE};
use hachure::door::cli::{flight, info, page};
use hachure::door::plan::detail::ERROR_PX;
use hachure::ink::{Sheet, Style};

use crate::cli::{DRAW, Place, refuses, stderr};

/// A name that colours, rings, climbs, turns around and begins lines.
const WILD: &str = "a\x1b[31m\x07\u{9b}2K\u{202e}b\nerror: c\r";
/// The same as it is printed.
const TAME: &str = r"a\x1b[31m\x07\u{9b}2K\u{202e}b\nerror: c\r";

/// Fails where a text holds what moves a terminal, lines apart.
fn tame(text: &[u8]) {
    let text = std::str::from_utf8(text).expect("text");
    let wild = text.chars().find(|c| c.is_control() && *c != '\n' || *c == '\u{202e}');
    assert!(wild.is_none(), "{wild:?} in {text:?}");
    assert!(!text.lines().any(|line| line.starts_with("error: c")), "{text:?}");
}

#[test]
#[cfg(unix)]
fn wild_names_are_printed_tame_everywhere() {
    let place = Place::new();
    let named = |ending: &str| format!("{WILD}{ending}");
    let (dem, other, png) = (named(".asc"), named("2.asc"), named(".png"));
    fs::copy(place.path("hill.asc"), place.path(&dem)).expect("a copy");
    // Laid beside the first, in other words: clauses of its history name it.
    let text = fs::read_to_string(place.path("hill.asc")).expect("hill.asc");
    fs::write(place.path(&other), text.replace("xllcorner 500000", "xllcorner 500404")).expect("a copy");
    fs::write(place.path(&named(".tif")), "II*\0 no TIFF").expect("a file");
    let size = ["--size", "64x48"];
    let cases: Vec<(Vec<&str>, bool)> = vec![
        (vec!["info", &dem], true),
        (vec!["info", &dem, &other], true),
        ([&["draw", &dem, "-o", &png][..], &size].concat(), true),
        ([&["draw", &dem, &other, "-o", &png][..], &size].concat(), true),
        (vec!["info", WILD], false),
        (vec!["draw", "hill.asc", "-o", WILD], false),
        (vec!["draw", &dem, "-o", &dem], false),
        (vec!["compare", "hill.asc", "-o", &dem], false),
    ];
    for (arguments, succeeds) in cases {
        let output = place.run(&arguments);
        assert_eq!(output.status.success(), succeeds, "{arguments:?}: {}", stderr(&output));
        tame(&output.stdout);
        tame(&output.stderr);
        let said = [output.stdout, output.stderr].concat();
        assert!(String::from_utf8_lossy(&said).contains(TAME), "{arguments:?}: {}", String::from_utf8_lossy(&said));
    }
    // GDAL quotes the name in words of its own.
    let output = place.run(&["info", &named(".tif")]);
    tame(&output.stderr);
    let said = stderr(&output);
    assert!(said.contains(TAME) && said.lines().count() == 1, "{said}");
}

#[test]
#[cfg(unix)]
fn names_that_are_no_text_are_printed_byte_by_byte() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let place = Place::new();
    let name = OsStr::from_bytes(b"gr\xfcn\x9b.png");
    let mut command = place.command(&DRAW[..3]);
    let output = command.arg(name).args(["--size", "64x48"]).output().expect("hachure runs");
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(String::from_utf8_lossy(&output.stdout).contains(r"gr\xfcn\x9b.png: "), "{output:?}");
    assert!(Path::new(&place.path("x").with_file_name(name)).is_file(), "the name itself stays");
}

#[test]
fn paths_are_printed_by_one_function() {
    let mut open = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("src")];
    let mut seen = 0;
    while let Some(path) = open.pop() {
        if path.is_dir() {
            open.extend(fs::read_dir(&path).expect("a folder").map(|entry| entry.expect("an entry").path()));
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            seen += 1;
            let source = fs::read_to_string(&path).expect("a source");
            assert!(!source.contains(".display()"), "{}: print it with error::shown", path.display());
        }
    }
    assert!(seen > 100, "only {seen} sources");
}

#[test]
fn names_that_no_file_can_have_are_refused_before_the_work() {
    let long = format!("{}.png", "x".repeat(252));
    let folder = |name: &str| format!("there/{name}");
    let names = [long.clone(), folder(&long), "o.png/".into(), "o.png/.".into(), "hill.asc/o.png".into()];
    for name in &names {
        // No adapter of that name: an error that comes first is one before the work.
        let draw = ["draw", "hill.asc", "--size", "64x48", "--adapter", "none of this name"];
        let place = Place::new();
        for output in [vec!["-o", name], vec!["-o", "out.png", "--mask", name], vec!["-o", "out.png", "--json", name]] {
            refuses(&place, &[&draw[..], &output].concat(), 1, "cannot be written");
        }
    }
    let place = Place::new();
    fs::write(place.path("old.png"), "old").expect("a file");
    fs::create_dir(place.path("dir.png")).expect("a folder");
    for name in ["old.png/", "old.png/.", "dir.png", "dir.png/", "dir.png/."] {
        let output = place.run(&["draw", "hill.asc", "-o", name, "--adapter", "none of this name"]);
        assert_eq!(output.status.code(), Some(1), "{name}");
        assert!(stderr(&output).contains("cannot be written"), "{name}: {}", stderr(&output));
    }
    assert_eq!(fs::read(place.path("old.png")).expect("old.png"), b"old");
    // The longest name that a file can have.
    let longest = format!("{}.png", "x".repeat(251));
    assert!(place.run(&["draw", "hill.asc", "-o", &longest, "--size", "64x48"]).status.success());
}

/// Numbers and choices that help texts call defaults, with the flag.
fn defaults(command: &clap::Command) -> Vec<(String, String)> {
    let of_arg = |arg: &clap::Arg| {
        let help = arg.get_help().map(ToString::to_string).unwrap_or_default();
        let typed = help.split("[default: ").nth(1)?.split(']').next()?.to_owned();
        let choices = arg.get_possible_values();
        let is_value = typed.contains(|c: char| c.is_ascii_digit()) || choices.iter().any(|v| v.matches(&typed, true));
        is_value.then(|| (arg.get_id().to_string(), typed))
    };
    let inner = command.get_subcommands().flat_map(defaults);
    command.get_arguments().filter_map(of_arg).chain(inner).collect()
}

#[test]
fn help_says_the_defaults_that_the_code_has() {
    let share = default_share().to_owned();
    let style = Style::default();
    let size = format!("{}x{}", SIZE.width, SIZE.height);
    let drawing = [
        ("error_px", ERROR_PX.to_string()),
        ("share", share),
        ("page", format!("{} mm across, as --size is shaped", Sheet::WIDTH)),
        ("margin", page::MARGIN.to_string()),
        ("dpi", format!("{} with --page, else as --size has it", page::DPI)),
        ("min_jump", format!("as the style has it, {}", style.min_jump)),
        ("min_gap", format!("as the style has it, {}mm", style.min_gap)),
    ];
    let size = || ("size", size.clone());
    let draw = [&[size()], &drawing[..]].concat();
    let seconds = ("duration", format!("those times, else {}", flight::DURATION));
    let fly = [&[seconds, ("fov", FOV.to_string()), size()], &drawing[..]].concat();
    let pick = [&[size()], &drawing[..]].concat();
    let expected = [draw, fly, vec![size()], pick, vec![("peaks", info::PEAKS.to_owned())]]
        .concat()
        .into_iter()
        .map(|(flag, value)| (flag.to_owned(), value));
    assert_eq!(defaults(&Arguments::command()), expected.collect::<Vec<_>>());
    let arg = clap::Arg::new("x").long("x").help("Metres [default: 7]");
    assert_eq!(defaults(&clap::Command::new("c").arg(arg)), [("x".to_owned(), "7".to_owned())], "one is found");
    let mut open = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("src/cli")];
    while let Some(path) = open.pop() {
        if path.is_dir() {
            open.extend(fs::read_dir(&path).expect("a folder").map(|entry| entry.expect("an entry").path()));
            continue;
        }
        let source = fs::read_to_string(&path).expect("a source");
        for typed in source.split("[default: ").skip(1) {
            let word = typed.split(']').next().unwrap_or_default();
            assert!(!word.contains(|c: char| c.is_ascii_digit()), "{}: [default: {word}]", path.display());
        }
    }
}

#[test]
fn an_eye_set_on_the_ground_is_not_below_it() {
    let place = Place::new();
    let mut warned = 0;
    for i in 0..6 {
        let eye = format!("{},{},+0", 500_103.7 + 17.3 * f64::from(i), 4_000_211.3 - 7.9 * f64::from(i));
        let draw = |eye: &str| place.run(&[&DRAW[..], &["--eye", eye, "--azimuth", "20", "--level", "2"]].concat());
        let output = draw(&eye);
        let said = stderr(&output);
        assert!(!said.contains("below the ground"), "{eye}: {said}");
        let stdout = String::from_utf8_lossy(&output.stdout).into_owned();
        let printed = stdout.split("--eye ").nth(1).and_then(|flags| flags.split(' ').next()).expect("an eye");
        let (place_of, height) = printed.rsplit_once(',').expect("a height");
        let below = format!("{place_of},{:.3}", height.parse::<f64>().expect("metres") - 0.02);
        let said = stderr(&draw(&below));
        assert!(!said.contains("0.0 m below"), "{below}: {said}");
        warned += usize::from(said.contains("the eye is 0.0"));
    }
    assert!(warned > 3, "2 cm below is worth a word: {warned} of 6");
}

#[test]
fn left_out_tiles_are_counted_by_the_size_they_have() {
    let place = Place::new();
    let view = ["--eye", "500200,3999600,30", "--azimuth", "180", "--explain"];
    let output = place.run(&[&DRAW[..], &view].concat());
    let stdout = String::from_utf8_lossy(&output.stdout);
    // 39 x 39 cells in tiles of 16.
    assert!(stdout.contains(" of 9 tiles of samples"), "{stdout}");
}
