//! The command line as scripts see it: exit codes, one clear line, nothing written on failure, promised JSON keys.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

use crate::common::gpu;

/// A folder with `hill.asc`: 40 x 40 samples, 10 m, a hill of 60 m and a hole.
pub struct Place {
    folder: TempDir,
}

impl Place {
    pub fn new() -> Self {
        let folder = TempDir::new().expect("a temporary folder");
        let mut text =
            String::from("ncols 40\nnrows 40\nxllcorner 500000\nyllcorner 4000000\ncellsize 10\nNODATA_value -9999\n");
        for r in 0..40 {
            for c in 0..40 {
                let (x, y) = (f64::from(c) - 19.5, f64::from(r) - 19.5);
                let hole = (4..7).contains(&c) && (30..33).contains(&r);
                let height = if hole { -9999.0 } else { 60.0 * (-(x * x + y * y) / 80.0).exp() };
                text += &format!("{height:.3} ");
            }
            text += "\n";
        }
        fs::write(folder.path().join("hill.asc"), text).expect("hill.asc");
        Self { folder }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().expect("hachure runs")
    }

    /// The program; drawings of which no word is said on hachures have none: these are the business of their own tests.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hachure"));
        command.current_dir(self.folder.path());
        match arguments {
            [draws @ ("draw" | "fly"), rest @ ..] if !arguments.contains(&"--hachures") => {
                command.args([*draws, "--hachures", "none"]).args(rest)
            }
            all => command.args(all),
        };
        command
    }

    /// What stands in the folder beside the DEM.
    pub fn written(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).expect("the folder");
        let names = entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned());
        let mut names: Vec<_> = names.filter(|n| n != "hill.asc").collect();
        names.sort();
        names
    }
}

/// Draws the hill, small.
pub const DRAW: [&str; 6] = ["draw", "hill.asc", "-o", "out.png", "--size", "64x48"];

/// The same by a method that is compiled in a third of the time, where it is nothing to a test what lines there are.
pub const QUICK: [&str; 8] = ["draw", "hill.asc", "-o", "out.png", "--size", "64x48", "--method", "toward-away"];

/// What the program said on standard error.
pub fn stderr(output: &Output) -> String {
    // The Vulkan loader has its own words on machines without a desktop.
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    text.lines().filter(|l| !l.contains("XDG_RUNTIME_DIR")).collect::<Vec<_>>().join("\n")
}

/// Fails with `code`, says `words` in one line, and leaves nothing behind.
pub fn refuses(place: &Place, arguments: &[&str], code: i32, words: &str) {
    let output = place.run(arguments);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
    assert!(said.contains(words), "{arguments:?} should say `{words}`: {said}");
    if code == 1 {
        // What was assumed of the file is said before.
        let errors = said.lines().filter(|line| !line.starts_with("warning: assumed"));
        assert_eq!(errors.count(), 1, "one line: {said}");
    }
    assert_eq!(place.written(), Vec::<String>::new(), "{arguments:?} left files behind");
}

#[test]
fn draw_writes_picture_mask_and_report() {
    let place = Place::new();
    let level: [&str; 2] = ["--level", "4"];
    let output = place.run(&[&DRAW[..], &level[..], &["--mask", "mask.png", "--json", "report.json"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(place.written(), ["mask.png", "out.png", "report.json"]);
    let report: Value =
        serde_json::from_str(&fs::read_to_string(place.path("report.json")).expect("report")).expect("JSON");
    for key in ["facets", "inked", "frame_ms", "passes", "adapter", "view", "left_out"] {
        assert!(!report[key].is_null(), "{key} is missing: {report}");
    }
    for key in ["eye", "azimuth", "altitude", "fov", "projection", "crs"] {
        assert!(!report["view"][key].is_null(), "view.{key} is missing: {report}");
    }
    assert_eq!(report["timing"], gpu().clock.describe());
    assert!(report["passes"][0]["name"].is_string() && report["passes"][0]["ms"].is_number());
    // Patches of 39 x 39 cells less those around 3 x 3 voids, times 4 x 4.
    assert_eq!(report["facets"], (2 * 39 * 39 - (2 * 16 - 2)) * 16);
    let (size, ink) = mask(&place.path("mask.png"));
    assert_eq!(size, (64, 48));
    assert_eq!(report["inked"], ink, "the mask and the report agree");
    assert!(ink > 20);
}

/// Size of a mask and its ink; asserts that it has 1 bit a pixel.
fn mask(path: &Path) -> ((u32, u32), u64) {
    let decoder = png::Decoder::new(std::io::BufReader::new(fs::File::open(path).expect("mask")));
    let mut reader = decoder.read_info().expect("a PNG");
    assert_eq!((reader.info().bit_depth, reader.info().color_type), (png::BitDepth::One, png::ColorType::Grayscale));
    let (width, height) = (reader.info().width, reader.info().height);
    let mut ink = 0;
    while let Some(row) = reader.next_row().expect("a row") {
        ink += (0..width).filter(|x| row.data()[*x as usize / 8] >> (7 - x % 8) & 1 == 0).count() as u64;
    }
    ((width, height), ink)
}

#[test]
fn printed_flags_repeat_the_chosen_view() {
    let place = Place::new();
    let chosen = place.run(&DRAW);
    assert!(chosen.status.success(), "{}", stderr(&chosen));
    let stdout = String::from_utf8_lossy(&chosen.stdout);
    let flags = stdout.lines().find_map(|l| l.strip_prefix("view: ")).expect("a view line").to_owned();
    let first = fs::read(place.path("out.png")).expect("out.png");
    let repeat = [&["draw", "hill.asc", "-o", "out.png"][..], &flags.split(' ').collect::<Vec<_>>()].concat();
    assert!(place.run(&repeat).status.success());
    assert_eq!(fs::read(place.path("out.png")).expect("out.png"), first);
    // Another eye gives another picture.
    assert!(place.run(&[&DRAW[..], &["--eye", "500100,4000050,+80", "--azimuth", "20"]].concat()).status.success());
    assert_ne!(fs::read(place.path("out.png")).expect("out.png"), first);
}

#[test]
fn a_page_wider_than_any_piece_is_drawn() {
    let place = Place::new();
    // The two flanks of the hill cross the rows, one of them far right.
    let view = ["--eye", "499900,3999900,25", "--azimuth", "35", "--fov", "50", "--size", "40000x64", "--level", "2"];
    // A pen 8 px wide: the usual one is wider than half of the page is high.
    fs::write(place.path("fine.toml"), "weight.far = 1\nweight.flat = 1\npens.silhouette.width = 0.05")
        .expect("a style");
    let files =
        ["draw", "hill.asc", "-o", "out.png", "--mask", "mask.png", "--json", "out.json", "--style", "fine.toml"];
    let output = place.run(&[&files[..], &view].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let report: Value = serde_json::from_slice(&fs::read(place.path("out.json")).expect("out.json")).expect("JSON");
    assert_eq!((&report["pieces"], &report["warm_frames"]), (&Value::from(20), &Value::from(1)));
    assert!(report["frame_ms"].as_f64() > Some(0.0));
    let [mask, page] = ["mask.png", "out.png"].map(|name| image::open(place.path(name)).expect(name).to_luma8());
    assert_eq!((mask.dimensions(), page.dimensions()), ((40_000, 64), (40_000, 64)));
    let inked: Vec<[u32; 2]> = mask.enumerate_pixels().filter(|(.., p)| p.0[0] == 0).map(|(x, y, _)| [x, y]).collect();
    assert_eq!(report["inked"], inked.len());
    let beyond = inked.iter().filter(|at| at[0] > 32_767).count();
    assert!(beyond >= 8 && beyond < inked.len());
    // Where the pen reaches ink is dark, and paper is far from it.
    for at in inked.iter().filter(|at| (12..52).contains(&at[1])) {
        assert!(page.get_pixel(at[0], at[1]).0[0] < 100, "paper at {at:?}");
    }
    for (x, y, _) in page.enumerate_pixels().filter(|(.., pixel)| pixel.0[0] < 200) {
        let nearest = inked.iter().map(|at| at[0].abs_diff(x).max(at[1].abs_diff(y))).min().expect("ink");
        assert!(nearest < 8, "ink at {x}, {y}, {nearest} px from the mask's");
    }
    refuses(&Place::new(), &[&DRAW[..4], &["--size", "65537x8"]].concat(), 2, "each from 1 to 65536");
}

#[test]
fn every_method_and_switch_draws() {
    let place = Place::new();
    let cases: [&[&str]; 9] = [
        &["--method", "walk", "--level", "2"],
        &["--method", "toward-away"],
        &["--method", "toward-away", "--wide"],
        &["--method", "adjacency", "--share", "corner", "--level", "1"],
        &["--border", "off", "--exaggeration", "2.5"],
        &["--crop", "500050,4000050,500350,4000350"],
        &["--adapter", "cpu", "--no-int64"],
        &["--altitude", "-90", "--eye", "500200,4000200,900"],
        &["--min-jump", "0.05", "--min-gap", "2.5"],
    ];
    for case in cases {
        let output = place.run(&[&DRAW[..], case].concat());
        assert!(output.status.success(), "{case:?}: {}", stderr(&output));
    }
}

#[test]
fn an_eye_below_ground_draws_with_a_warning() {
    let place = Place::new();
    let output = place.run(&[&DRAW[..], &["--eye", "500200,4000200,20", "--azimuth", "0"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stderr(&output).contains("warning: the eye is") && stderr(&output).contains("below the ground"));
    assert_eq!(place.written(), ["out.png"]);
}

#[test]
fn wrong_usage_exits_with_2() {
    let place = Place::new();
    let cases: [(&[&str], &str); 29] = [
        (&["--paper", "A4"], "--paper"),
        (&["--style", "x"], "--style"),
        (&["--level", "3"], "want 1, 2, 4"),
        (&["--level", "automatic"], "want 1, 2, 4, 8, 16, 32 or 64, or auto"),
        (&["--error-px", "0"], "want pixels, from 0.01 to 100"),
        (&["--level", "4", "--error-px", "1"], "--error-px: goes with --level auto only"),
        (&["--size", "0x48"], "want WxH"),
        (&["--size", "99999x1"], "want WxH"),
        (&["--fov", "nan"], "out of range"),
        (&["--fov", "180"], "want 0.1 to 170"),
        (&["--altitude", "91"], "want -90 to 90"),
        (&["--azimuth", "inf"], "out of range"),
        (&["--eye", "1,2"], "want E,N,Z"),
        (&["--eye", "NaN,2,3"], "out of range"),
        (&["--eye", "1e300,2,3"], "out of range"),
        (&["--exaggeration", "0"], "above 0"),
        (&["--exaggeration", "-1"], "above 0"),
        (&["--crop", "10,10,5,20"], "west beyond its east"),
        (&["--wide"], "--method toward-away"),
        (&["--share", "edge"], "--method adjacency"),
        (&["--min-jump", "-0.1"], "want a share of the distance, 0 or more"),
        (&["--min-jump", "2%"], "want a share of the distance, 0 or more"),
        (&["--min-gap", "-3px"], "or pixels, from 0 to 1000, as 3px"),
        (&["--min-gap", "nan"], "or pixels, from 0 to 1000, as 3px"),
        (&["--min-gap", "101mm"], "want millimetres, from 0 to 100, as .4mm"),
        (&["--min-gap", "3px", "--method", "toward-away"], "--min-gap: goes with contours only"),
        (&["--min-jump", "0", "--method", "adjacency"], "--min-jump: goes with contours only"),
        (&["--eye", "0,0,+10"], "no ground"),
        (&["--eye", "99999999,0,10"], "cells from the DEM"),
    ];
    for (flags, words) in cases {
        refuses(&place, &[&DRAW[..4], flags].concat(), 2, words);
    }
    refuses(&place, &["draw", "hill.asc", "-o", "out.bmp"], 2, ".png");
    refuses(&place, &[&DRAW[..], &["--mask", "out.png"]].concat(), 2, "name of its own");
    refuses(&place, &[&DRAW[..], &["--json", "hill.asc"]].concat(), 2, "name of its own");
    refuses(&place, &["draw", "hill.asc"], 2, "--output");
    refuses(&place, &["paint"], 2, "paint");
}

#[test]
fn failures_exit_with_1_and_say_why() {
    let place = Place::new();
    refuses(&place, &["draw", "none.tif", "-o", "out.png"], 1, "none.tif");
    refuses(&place, &["draw", ".", "-o", "out.png"], 1, "directory");
    refuses(&place, &["info", "none.tif"], 1, "none.tif");
    refuses(&place, &["draw", "hill.asc", "-o", "no/where.png"], 1, "no/where.png");
    refuses(&place, &[&DRAW[..], &["--mask", "no/where.png"]].concat(), 1, "no/where.png");
    refuses(&place, &[&DRAW[..], &["--crop", "0,0,10,10"]].concat(), 1, "hill.asc");
    refuses(&place, &[&DRAW[..], &["--adapter", "no such adapter"]].concat(), 1, "no such adapter");
}

#[test]
fn no_adapter_says_how_to_get_one() {
    let place = Place::new();
    let mut command = place.command(&DRAW);
    // A loader that finds no driver is a machine without one.
    let output = command.env("VK_DRIVER_FILES", "/nonexistent").env("VK_ICD_FILENAMES", "/nonexistent").output();
    let output = output.expect("hachure runs");
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stderr(&output).contains("mesa-vulkan-drivers"), "{}", stderr(&output));
    assert_eq!(place.written(), Vec::<String>::new());
}

#[test]
fn info_prints_what_the_dem_holds() {
    let place = Place::new();
    let output = place.run(&["info", "hill.asc"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let stdout = String::from_utf8_lossy(&output.stdout);
    for words in ["40 columns x 40 rows", "10 m x 10 m", "voids      9"] {
        assert!(stdout.contains(words), "{words}: {stdout}");
    }
}

#[test]
#[cfg(unix)]
fn a_signal_leaves_nothing_behind() {
    let place = Place::new();
    let mut child = place.command(&[&DRAW[..4], &["--level", "64", "--size", "2000x2000"]].concat());
    let mut child = child.stdout(std::process::Stdio::null()).spawn().expect("hachure runs");
    while place.written().is_empty() {
        assert!(child.try_wait().expect("a status").is_none(), "it ended before it could be stopped");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let stopped = Command::new("kill").args(["-TERM", &child.id().to_string()]).status().expect("kill runs");
    assert!(stopped.success());
    assert_eq!(child.wait().expect("a status").code(), Some(75));
    assert_eq!(place.written(), Vec::<String>::new());
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_standard_output_is_an_error_in_words() {
    let place = Place::new();
    let full = fs::OpenOptions::new().write(true).open("/dev/full").expect("/dev/full");
    let output = place.command(&["info", "hill.asc"]).stdout(full).output().expect("hachure runs");
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("standard output"), "{}", stderr(&output));
}
