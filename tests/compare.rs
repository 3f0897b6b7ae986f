//! `hachure compare` as scripts and people see it: its files, that two runs agree, the cache, and one clear line where
//! there is nothing to compare.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use serde_json::Value;

use crate::cli::{Place, stderr};
use crate::common::{shader_cache, shared_dems};

/// Compares two methods at two levels on the hill, small.
const COMPARE: [&str; 8] =
    ["compare", "hill.asc", "--size", "96x64", "--levels", "1,2", "--methods", "walk,toward-away-wide"];
/// An eye that sees the hill against the sky.
const EYE: [&str; 4] = ["--eye", "500195,3999900,40", "--azimuth", "0"];
const OUT: [&str; 2] = ["-o", "report"];

/// Runs in the place, with the caches in it.
fn run(place: &Place, arguments: &[&str]) -> Output {
    let mut command = place.command(arguments);
    command.env("XDG_CACHE_HOME", place.path("cache")).env("HOME", place.path("home")).envs(shader_cache());
    command.output().expect("hachure runs")
}

fn succeeds(place: &Place, arguments: &[&str]) -> Output {
    let output = run(place, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", stderr(&output));
    output
}

fn results(place: &Place) -> Value {
    serde_json::from_str(&fs::read_to_string(place.path("report/results.json")).expect("results.json")).expect("JSON")
}

/// Files of the report by name.
fn files(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).expect("the folder").map(|e| e.expect("an entry").file_name());
    let mut names: Vec<_> = names.map(|name| name.to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Takes out what two runs may differ in: times, memory, what is set beside times, and nothing else.
fn without_times(value: &mut Value) {
    match value {
        Value::Object(fields) => {
            fields
                .retain(|key, _| !(key.ends_with("_ms") || key.ends_with("_mib") || key == "passes" || key == "floor"));
            fields.values_mut().for_each(without_times);
        }
        Value::Array(values) => values.iter_mut().for_each(without_times),
        _ => (),
    }
}

#[test]
fn a_report_is_whole() {
    let place = Place::new();
    let output = succeeds(&place, &[&COMPARE[..], &EYE, &OUT].concat());
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("hill truth at level ") && said.contains("hill walk level 2: P "), "{said}");
    let stems = ["toward-away-wide_1", "toward-away-wide_2", "walk_1", "walk_2"];
    let mut expected: Vec<String> =
        stems.iter().flat_map(|s| ["difference", "mask"].map(|kind| format!("hill_{s}_{kind}.png"))).collect();
    expected
        .extend(["error-time.svg", "hill_truth.png", "report.html", "results.csv", "results.json"].map(String::from));
    expected.sort();
    assert_eq!(files(&place.path("report")), expected);
    let found = results(&place);
    assert_eq!((&found["version"], found["runs"].as_array().map(Vec::len)), (&2.into(), Some(4)));
    assert!(found["truth"]["level"].as_u64() >= Some(8) && found["truth"]["self_f"].as_f64() > Some(0.9), "{found}");
    let promised = ["method", "level", "width", "height", "precision", "recall", "f", "gaps", "spurious", "chamfer_px"];
    for run in found["runs"].as_array().expect("runs") {
        for key in promised.iter().chain(&["frame_ms", "facets", "inked"]) {
            assert!(!run[key].is_null(), "{key} is missing: {run}");
        }
        let hashes: Vec<&str> =
            run["mask_hashes"].as_array().expect("hashes").iter().filter_map(Value::as_str).collect();
        assert_eq!(hashes.len(), 9);
        assert!(hashes.windows(2).any(|pair| pair[0] != pair[1]), "the eye does not move: {hashes:?}");
        let mask = image::open(place.path("report").join(run["mask"].as_str().expect("a name"))).expect("a picture");
        let ink = mask.to_luma8().pixels().filter(|pixel| pixel.0[0] == 0).count();
        assert_eq!(run["inked"], ink, "the mask and the figures agree");
        assert_eq!(run["place"].is_null(), run["method"] != "walk");
        assert!(run.get("floor").is_none(), "nobody asked for limits: {run}");
        for pass in run["passes"].as_array().expect("passes") {
            let [bytes, operations] = ["bytes", "operations"].map(|key| pass[key].as_u64().expect("a number"));
            // A hill this far away has no large facets, and little that walks must leave.
            let idle = ["rasterize_large", "walk_rest"].contains(&pass["name"].as_str().expect("a name"));
            assert!(idle || bytes > 0, "{pass}");
            assert!(idle || operations > 0 || pass["name"] == "clear", "{pass}");
        }
    }
}

#[test]
fn limits_stand_beside_every_time_where_they_are_asked_for() {
    let place = Place::new();
    let levels = ["--levels", "2,auto"];
    let arguments = ["compare", "hill.asc", "--size", "96x64", "--methods", "walk,toward-away,adjacency", "--floor"];
    let output = succeeds(&place, &[&arguments[..], &levels, &EYE, &OUT].concat());
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let found = results(&place);
    let runs = found["runs"].as_array().expect("runs");
    assert_eq!(runs.len(), 6);
    for run in runs {
        let floor = run["floor"].as_object().expect("limits");
        let keys = ["bytes", "copy_ms", "draw_ms", "lacking", "frame_per_copy", "frame_per_draw"];
        assert_eq!(floor.keys().map(String::as_str).collect::<Vec<_>>(), keys);
        assert!(floor["lacking"].is_null(), "{floor:?}");
        let number = |key: &str| floor[key].as_f64().unwrap_or_else(|| panic!("no {key}: {floor:?}"));
        for key in keys.into_iter().filter(|key| *key != "lacking") {
            assert!(number(key).is_finite() && number(key) > 0.0, "{key}: {floor:?}");
        }
        let of_passes = |key: &str| {
            let passes = run["passes"].as_array().expect("passes");
            passes.iter().map(|pass| pass[key].as_f64().expect("a number")).sum::<f64>()
        };
        assert_eq!(number("bytes"), of_passes("bytes"), "the copy moves what the passes move");
        let frame_ms = run["frame_ms"].as_f64().expect("a time");
        for [per, ms] in [["frame_per_copy", "copy_ms"], ["frame_per_draw", "draw_ms"]] {
            assert!((number(per) * number(ms) / frame_ms - 1.0).abs() < 1e-9, "{per}: {floor:?}");
        }
    }
    assert_eq!(said.matches(" GB/s, a bare copy ").count(), 6, "{said}");
    assert_eq!(said.matches(", depth draw ").count(), 6, "{said}");
}

#[test]
fn two_runs_differ_in_times_alone() {
    let place = Place::new();
    let arguments = [&COMPARE[..], &EYE, &OUT, &["--no-cache"]].concat();
    let [mut first, mut second] = ["1", "3"].map(|threads| {
        let mut command = place.command(&arguments);
        assert!(command.env("RAYON_NUM_THREADS", threads).output().expect("hachure runs").status.success());
        results(&place)
    });
    assert_ne!(first, second, "times to the last digit");
    for value in [&mut first, &mut second] {
        without_times(value);
    }
    assert_eq!(first, second);
    // Negative control: another eye is another result.
    succeeds(&place, &[&COMPARE[..], &["--eye", "500195,3999900,41", "--azimuth", "0"], &OUT].concat());
    let mut other = results(&place);
    without_times(&mut other);
    assert_ne!(other["runs"], first["runs"]);
}

#[test]
fn truth_is_kept_and_a_damaged_one_is_made_anew() {
    let place = Place::new();
    let arguments = [&COMPARE[..], &EYE, &OUT].concat();
    let truth_ms = |output: &Output| {
        assert!(output.status.success(), "{}", stderr(output));
        results(&place)["scenes"][0]["truth"]["truth_ms"].as_f64().expect("a time")
    };
    let made = truth_ms(&run(&place, &arguments));
    let folder = place.path("cache/hachure");
    let kept = files(&folder);
    assert!(kept.len() >= 3, "{kept:?}");
    // The time is that of the first run: nothing was made anew.
    assert_eq!(truth_ms(&run(&place, &arguments)), made);
    let mut expected = results(&place);
    without_times(&mut expected);
    let damages: [fn(&mut Vec<u8>); 4] =
        [|bytes| bytes[60] ^= 1, |bytes| bytes.truncate(bytes.len() - 56), Vec::clear, |bytes| bytes.push(0)];
    for damage in damages {
        for name in &kept {
            let mut bytes = fs::read(folder.join(name)).expect("a kept truth");
            damage(&mut bytes);
            fs::write(folder.join(name), bytes).expect("damage");
        }
        let output = run(&place, &arguments);
        assert_ne!(truth_ms(&output), made, "a damaged truth was used");
        assert!(stderr(&output).contains("damaged"), "{}", stderr(&output));
        let mut found = results(&place);
        without_times(&mut found);
        assert_eq!(found, expected);
    }
    // It is whole again.
    assert!(!stderr(&run(&place, &arguments)).contains("damaged"));
    assert_eq!(files(&folder), kept, "nothing else is kept");
    // Another view and another level find nothing of it; `--no-cache` adds nothing.
    succeeds(&place, &[&arguments[..], &["--no-cache", "--fov", "50"]].concat());
    assert_eq!(files(&folder), kept);
    succeeds(&place, &[&arguments[..], &["--fov", "50"]].concat());
    assert!(files(&folder).len() > kept.len());
}

#[test]
fn a_cache_that_cannot_be_written_costs_a_warning() {
    let place = Place::new();
    fs::write(place.path("cache"), "a file where a folder should be").expect("a file");
    let output = succeeds(&place, &[&COMPARE[..], &EYE, &OUT].concat());
    assert!(stderr(&output).contains("truth is not cached"), "{}", stderr(&output));
}

/// Fails with `code` and says `words` in one line; no report stands in its folder, which is gone if it was not there.
fn refuses(place: &Place, arguments: &[&str], code: i32, words: &str) {
    let written = || place.written().into_iter().filter(|name| name != "cache").collect::<Vec<_>>();
    let before = written();
    let output = run(place, arguments);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
    assert!(said.contains(words), "{arguments:?} should say `{words}`: {said}");
    if code == 1 {
        assert_eq!(said.lines().filter(|line| line.starts_with("error: ")).count(), 1, "one line: {said}");
    }
    assert_eq!(written(), before, "{arguments:?} left files behind");
}

/// A grid of 12 x 12 samples, 10 m.
fn grid(place: &Place, name: &str, height: &str) -> PathBuf {
    let head = "ncols 12\nnrows 12\nxllcorner 500000\nyllcorner 4000000\ncellsize 10\nNODATA_value -9999\n";
    fs::write(place.path(name), format!("{head}{}", format!("{height} ").repeat(144))).expect("a grid");
    place.path(name)
}

#[test]
fn where_nothing_can_be_compared_one_line_says_so() {
    let place = Place::new();
    grid(&place, "flat.asc", "7");
    grid(&place, "void.asc", "-9999");
    fs::write(place.path("file"), "").expect("a file");
    let hill = |more: &[&'static str]| [&COMPARE[..], &EYE, &OUT, more].concat();
    refuses(&place, &hill(&["--azimuth", "180", "--eye", "500195,3999900,40"]), 2, "--azimuth");
    let away = ["--eye", "500195,3999900,50", "--azimuth", "180"];
    refuses(&place, &[&COMPARE[..], &away, &OUT].concat(), 1, "nothing of the DEM is in view");
    let flat = ["compare", "flat.asc", "--size", "64x48", "-o", "report", "--border", "off"];
    refuses(&place, &flat, 1, "no silhouette is in view");
    refuses(&place, &["compare", "void.asc", "-o", "report"], 1, "void.asc");
    refuses(&place, &[&COMPARE[..], &["-o", "file"]].concat(), 1, "it is a file");
    refuses(&place, &[&COMPARE[..], &["-o", "file/below"]].concat(), 1, "file/below");
    refuses(&place, &["compare", "none.asc", "-o", "report"], 1, "none.asc");
    let base = ["compare", "hill.asc", "-o", "report"];
    for (flags, words) in [
        (["--levels", "3"], "want 1, 2, 4"),
        (["--levels", "best"], "want 1, 2, 4"),
        (["--levels", "auto,auto"], "auto is there twice"),
        (["--levels", "2,4,2"], "2 is there twice"),
        (["--methods", "pen"], "want some of walk, contour, toward-away"),
        (["--methods", "walk,walk"], "walk is there twice"),
        (["--sizes", "64x48,64x48"], "64x48 is there twice"),
        (["--sizes", "64"], "want WxH"),
        (["--repeat", "8"], "want 9 to 100"),
        (["--truth-level", "4"], "want 8, 16, 32 or 64"),
    ] {
        refuses(&place, &[&base[..], &flags].concat(), 2, words);
    }
    refuses(&place, &[&base[..], &["--size", "64x48", "--sizes", "32x32"]].concat(), 2, "--sizes");
    refuses(&place, &[&base[..3], &["nest/a/b"], &away[..], &["--size", "64x48"]].concat(), 1, "nothing of the DEM");
    refuses(&place, &[&base[..], &["--adapter", "no such adapter"]].concat(), 1, "no such adapter");
    refuses(&place, &[&base[..], &["--sizes", "64x48,16384x16384"]].concat(), 1, "--size");
}

#[test]
fn a_picture_that_cannot_be_written_is_noticed_before_the_work() {
    let place = Place::new();
    fs::create_dir_all(place.path("report/hill_walk_2_mask.png")).expect("a folder in the way");
    refuses(&place, &[&COMPARE[..], &EYE, &OUT].concat(), 1, "hill_walk_2_mask.png");
    assert_eq!(files(&place.path("report")), ["hill_walk_2_mask.png"], "nothing of a report stands");
}

#[test]
#[cfg(unix)]
fn names_that_are_no_text_are_taken() {
    use std::os::unix::ffi::OsStringExt;
    let place = Place::new();
    let mut command = place.command(&[&COMPARE[..], &EYE, &["--no-cache", "-o"]].concat());
    let odd = std::ffi::OsString::from_vec(b"odd\xff".to_vec());
    assert!(command.arg(&odd).output().expect("hachure runs").status.success());
    assert!(place.path("").join(odd).join("report.html").exists());
}

#[test]
fn an_older_report_stands_until_the_new_one_is_whole() {
    let place = Place::new();
    succeeds(&place, &[&COMPARE[..], &EYE, &OUT].concat());
    let before: Vec<_> = files(&place.path("report"));
    let page = fs::read(place.path("report/report.html")).expect("a page");
    let away = ["--eye", "500195,3999900,50", "--azimuth", "180"];
    refuses(&place, &[&COMPARE[..], &away, &OUT].concat(), 1, "nothing of the DEM is in view");
    assert_eq!(files(&place.path("report")), before);
    assert_eq!(fs::read(place.path("report/report.html")).expect("a page"), page);
}

#[test]
#[cfg(unix)]
fn a_signal_leaves_nothing_behind() {
    let place = Place::new();
    let arguments = ["compare", "hill.asc", "--size", "1280x720", "--repeat", "100", "--no-cache", "-o", "nest/report"];
    let mut command = place.command(&[&arguments[..], &EYE].concat());
    let mut child = command.stdout(std::process::Stdio::null()).spawn().expect("hachure runs");
    let folder = place.path("nest/report");
    while !folder.exists() || files(&folder).is_empty() {
        assert!(child.try_wait().expect("a status").is_none(), "it ended before it could be stopped");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let stopped = std::process::Command::new("kill").args(["-TERM", &child.id().to_string()]).status();
    assert!(stopped.expect("kill runs").success());
    assert_eq!(child.wait().expect("a status").code(), Some(75));
    assert_eq!(place.written(), Vec::<String>::new());
}

/// A file of views beside the hill.
fn views(place: &Place, text: &str) {
    fs::write(place.path("views.json"), text).expect("views.json");
}

const VIEWS: &str = r#"{"about": "a remark", "views": [
    {"name": "from the south", "dem": "elsewhere/hill.asc", "eye": [500195, 4000020, "+10"], "azimuth": 0, "fov": 50},
    {"name": "east", "dem": "hill.asc", "eye": [500500, 4000200, 60], "azimuth": 270, "altitude": -3},
    {"name": "other", "dem": "other.asc", "lonlat": [-117, 36.1, 60]}]}"#;

#[test]
fn a_file_of_views_is_drawn_on_pages_of_every_size() {
    let place = Place::new();
    views(&place, VIEWS);
    let arguments =
        ["compare", "hill.asc", "-o", "report", "--views", "views.json", "--sizes", "64x48,96x64", "--levels", "2"];
    let output = succeeds(&place, &[&arguments[..], &["--methods", "walk"]].concat());
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("view other passed over: other.asc"), "{said}");
    let found = results(&place);
    let names: Vec<&str> = found["runs"].as_array().expect("runs").iter().filter_map(|r| r["scene"].as_str()).collect();
    assert_eq!(
        names,
        ["from-the-south_64x48", "from-the-south_96x64", "east_64x48", "east_96x64"],
        "every view on every page"
    );
    let scenes = found["scenes"].as_array().expect("scenes");
    assert_eq!([&scenes[0]["fov"], &scenes[2]["fov"]], [50.0, 60.0]);
    assert_eq!([&scenes[1]["width"], &scenes[2]["altitude"]], [&Value::from(96), &Value::from(-3.0)]);
    let least = scenes.iter().filter_map(|s| s["truth"]["self_f"].as_f64()).fold(1.0, f64::min);
    assert_eq!(found["truth"]["self_f"], least, "the truth named first is the least sure one");
}

#[test]
fn a_wrong_file_of_views_is_refused() {
    let place = Place::new();
    let base = ["compare", "hill.asc", "-o", "report", "--views", "views.json"];
    refuses(&place, &base, 1, "views.json");
    let one = |view: &str| format!(r#"{{"views": [{view}]}}"#);
    for (text, words) in [
        ("no JSON".to_owned(), "views.json"),
        ("{}".to_owned(), "views"),
        (one(r#"{"name": "a", "dem": "hill.asc"}"#), "either `eye` or `lonlat`"),
        (one(r#"{"name": "a", "dem": "hill.asc", "eye": [0, 0, 0], "lonlat": [0, 0, 0]}"#), "either `eye`"),
        (one(r#"{"name": "a", "dem": "hill.asc", "eye": [0, 0]}"#), "views.json"),
        (one(r#"{"name": "a", "dem": "hill.asc", "eye": [0, 0, "high"]}"#), "`high` is no number"),
        (one(r#"{"name": "a", "dem": "hill.asc", "lonlat": [900, 0, 0]}"#), "longitude"),
        (one(r#"{"name": "a", "dem": "hill.asc", "eye": [0, 0, 0], "altitude": 91}"#), "-90 to 90"),
        (one(r#"{"name": "a", "dem": "hill.asc", "eye": [0, 0, 0], "azimut": 91}"#), "azimut"),
        (one(r#"{"name": "a", "dem": "other.asc", "eye": [0, 0, 0]}"#), "none of its views"),
        (
            one(r#"{"name": "a", "dem": "hill.asc", "eye": [0, 0, 0]}, {"name": "a", "dem": "b", "eye": [0, 0, 0]}"#),
            "two views",
        ),
    ] {
        views(&place, &text);
        refuses(&place, &base, 1, words);
    }
    views(&place, VIEWS);
    refuses(&place, &[&base[..], &EYE].concat(), 2, "leave out one of the two");
    refuses(&place, &[&base[..], &["--north", "true"]].concat(), 2, "so does --north; leave out one of the two");
}

#[test]
fn the_shared_views_are_understood() {
    let Some(folder) = shared_dems() else { return };
    let place = Place::new();
    let (dem, views) = (folder.join("west_temple_50m.tif"), folder.join("../views.json"));
    let [dem, views] = [dem, views].map(|path| path.to_string_lossy().into_owned());
    let arguments = ["compare", &dem, "-o", "report", "--views", &views, "--size", "160x120", "--levels", "4"];
    succeeds(&place, &[&arguments[..], &["--methods", "walk", "--border", "off"]].concat());
    let found = results(&place);
    assert_eq!(found["runs"][0]["scene"], "west-temple");
    assert!(found["runs"][0]["f"].as_f64() > Some(0.98), "{}", found["runs"][0]);
}
