//! Flights that are cut off, shared out and taken up again: the frames are those of an undisturbed one, to the last byte.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::thread::sleep;
use std::time::{Duration, Instant, SystemTime};

use serde_json::Value;

use crate::cli::{Place, stderr};

/// Frames of the flight.
const COUNT: u32 = 16;
/// The flight: around a hill, small.
pub const FLY: [&str; 12] = [
    "fly",
    "hill.asc",
    "--orbit",
    "500195,4000195",
    "--radius",
    "150",
    "--height",
    "+60",
    "--count",
    "16",
    "--size",
    "160x90",
];

/// A frame's file with its bytes and the time at which it was made.
pub type Files = BTreeMap<String, (Vec<u8>, SystemTime)>;

pub fn fly<'a>(folder: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&FLY[..], &["-o", folder], more].concat()
}

/// The frames in a folder.
pub fn frames(folder: &Path) -> Files {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let named = entries.map(|entry| (entry.file_name().to_string_lossy().into_owned(), entry.path()));
    let frames = named.filter(|(name, path)| name.ends_with(".png") && !name.starts_with('.') && path.is_file());
    frames
        .filter_map(|(name, path)| Some((name, (fs::read(&path).ok()?, fs::metadata(&path).ok()?.modified().ok()?))))
        .collect()
}

pub fn bytes(files: &Files) -> BTreeMap<&String, &Vec<u8>> {
    files.iter().map(|(name, (bytes, _))| (name, bytes)).collect()
}

/// What is left in a folder that has no final name.
pub fn half_made(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).filter(|name| name.starts_with('.')).collect()
}

/// The frames of an undisturbed flight, made once for all tests.
pub fn undisturbed() -> &'static Files {
    static WHOLE: OnceLock<Files> = OnceLock::new();
    WHOLE.get_or_init(|| {
        let place = Place::new();
        let output = place.run(&fly("whole/%05d.png", &[]));
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let frames = frames(&place.path("whole"));
        assert_eq!(frames.len() as u32, COUNT);
        frames
    })
}

fn start(place: &Place, arguments: &[&str]) -> Child {
    place.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts")
}

/// Waits until so many frames are there, or the child has ended.
pub fn wait_for(folder: &Path, count: usize, child: &mut Child) {
    let began = Instant::now();
    while frames(folder).len() < count && child.try_wait().expect("a child").is_none() {
        assert!(began.elapsed() < Duration::from_secs(60), "no frame for a minute");
        sleep(Duration::from_millis(2));
    }
}

/// Numbers without a pattern, always the same.
fn random(seed: u64) -> u64 {
    xxhash_rust::xxh3::xxh3_64(&seed.to_le_bytes())
}

#[test]
fn a_flight_that_is_killed_goes_on_where_it_ended() {
    let place = Place::new();
    let whole = undisturbed();
    let mut kills = 0;
    for i in 0..8 {
        let (name, k) = (format!("killed-{i}"), 1 + random(i) as usize % (COUNT as usize - 1));
        let (folder, pattern) = (place.path(&name), format!("{name}/%05d.png"));
        let mut child = start(&place, &fly(&pattern, &["-q"]));
        wait_for(&folder, k, &mut child);
        kills += usize::from(child.try_wait().expect("a child").is_none());
        child.kill().expect("it can be killed");
        child.wait().expect("it ends");
        let finished = frames(&folder);
        assert!(finished.len() >= k, "{} of {k}", finished.len());
        let output = place.run(&fly(&pattern, &[]));
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let all = frames(&folder);
        assert_eq!(bytes(&all), bytes(whole), "killed at {k}");
        assert!(half_made(&folder).len() <= 1, "at most one half-made file of a kill");
        for (name, (_, made)) in &finished {
            assert_eq!(all[name].1, *made, "{name} was finished, and made again");
        }
    }
    assert!(kills >= 6, "only {kills} were killed at work");
}

#[test]
fn a_flight_that_is_asked_to_end_finishes_its_frame() {
    let place = Place::new();
    let whole = undisturbed();
    let folder = place.path("asked");
    let mut child = start(&place, &fly("asked/%05d.png", &[]));
    wait_for(&folder, 3, &mut child);
    let asked = Command::new("kill").args(["-TERM", &child.id().to_string()]).status().expect("kill runs");
    assert!(asked.success());
    let output = child.wait_with_output().expect("it ends");
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(75), "{said}");
    assert!(said.contains("left; the same command goes on from there"), "{said}");
    assert_eq!(half_made(&folder), Vec::<String>::new());
    let finished = frames(&folder);
    assert!(finished.len() < whole.len(), "it ended before its end");
    finished.iter().for_each(|(name, (bytes, _))| assert_eq!(*bytes, whole[name].0, "{name}"));
    assert_eq!(place.run(&fly("asked/%05d.png", &[])).status.code(), Some(0));
    assert_eq!(bytes(&frames(&folder)), bytes(whole));
}

#[test]
fn two_processes_at_one_flight_share_it() {
    let place = Place::new();
    let whole = undisturbed();
    let both = [0, 1].map(|_| start(&place, &fly("both/%05d.png", &[])));
    for child in both {
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    assert_eq!(bytes(&frames(&place.path("both"))), bytes(whole));
    assert_eq!(half_made(&place.path("both")), Vec::<String>::new());
}

#[test]
fn a_folder_that_is_removed_is_made_again() {
    let place = Place::new();
    let whole = undisturbed();
    let folder = place.path("gone");
    let mut child = start(&place, &fly("gone/%05d.png", &[]));
    wait_for(&folder, 2, &mut child);
    // Between two files of a folder that is being removed another may be made.
    while fs::remove_dir_all(&folder).is_err() && folder.exists() {}
    child.wait().expect("it ends");
    let output = place.run(&fly("gone/%05d.png", &[]));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(bytes(&frames(&folder)), bytes(whole));
}

#[test]
fn shards_in_any_order_make_the_same_frames() {
    let place = Place::new();
    let whole = undisturbed();
    let merge = || place.run(&["merge", "shards"]);
    for (done, index) in ["2", "0", "1"].into_iter().enumerate() {
        let shard = format!("{index}/3");
        let output = place.run(&fly("shards/%05d.png", &["--shard", &shard]));
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let merged = merge();
        let said = String::from_utf8_lossy(&merged.stdout).into_owned();
        assert_eq!(merged.status.code(), Some(i32::from(done < 2)), "{said}");
        let absent = ["never ran: shard 0-1 of 3", "never ran: shard 1 of 3", "are whole, by 3 manifests"][done];
        assert!(said.contains(absent), "{said}");
    }
    assert_eq!(bytes(&frames(&place.path("shards"))), bytes(whole));
    let film = |name: &str| place.run(&["merge", "shards", "--video", name]);
    assert_eq!(film("film.gif").status.code(), Some(0));
    let mut decoder =
        gif::DecodeOptions::new().read_info(fs::File::open(place.path("film.gif")).expect("a film")).expect("a GIF");
    let mut shown = 0;
    while decoder.read_next_frame().expect("a frame").is_some() {
        shown += 1;
    }
    assert_eq!(shown, COUNT, "all shards' frames");
    let output = film("shards/00003.png");
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("--video: shards/00003.png is a frame"), "{}", stderr(&output));
    fs::remove_file(place.path("shards/00007.png")).expect("it is there");
    assert_eq!(film("half.gif").status.code(), Some(1), "no film of what is not whole");
    assert!(!place.path("half.gif").exists());
    let merged = merge();
    assert_eq!(merged.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&merged.stdout).contains("missing or not whole: 7"));
    let output = place.run(&fly("shards/%05d.png", &["--frames", "5-8"]));
    assert!(String::from_utf8_lossy(&output.stdout).contains("1 frames drawn, 3 were there"));
    assert_eq!(merge().status.code(), Some(0));
}

#[test]
fn another_look_redraws_all_and_the_same_none() {
    let place = Place::new();
    let drawn = |more: &[&str]| {
        let output = place.run(&fly("looks/%05d.png", more));
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        String::from_utf8_lossy(&output.stdout).lines().last().unwrap_or_default().to_owned()
    };
    assert!(drawn(&[]).contains("16 frames drawn, 0 were there"));
    assert!(drawn(&[]).contains("0 frames drawn, 16 were there"));
    assert!(drawn(&["--style", "woodcut"]).contains("16 frames drawn, 0 were there"));
    assert!(drawn(&["--style", "woodcut", "--min-gap", "2px"]).contains("16 frames drawn, 0 were there"));
    fs::rename(place.path("hill.asc"), place.path("mound.asc")).expect("it is there");
    fs::copy(place.path("mound.asc"), place.path("hill.asc")).expect("room");
    assert!(drawn(&["--style", "woodcut", "--min-gap", "2px"]).contains("0 frames drawn"), "the same bytes, copied");
    let text = fs::read_to_string(place.path("hill.asc")).expect("a DEM").replace("59.", "58.");
    fs::write(place.path("hill.asc"), text).expect("room");
    let woodcut = ["--style", "woodcut", "--min-gap", "2px"];
    assert!(drawn(&woodcut).contains("16 frames drawn"), "other heights");
    fs::write(place.path("hill.prj"), "").expect("room");
    fs::remove_file(place.path("hill.prj")).expect("it is there");
    assert!(drawn(&woodcut).contains("0 frames drawn"), "nothing has changed");
    assert!(drawn(&[&woodcut[..], &["--exaggeration", "2"]].concat()).contains("16 frames drawn"));
    let output = place.run(&fly("looks/%05d.png", &["--clearance", "7"]));
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "another flight: {said}");
    assert!(said.contains("hachure-0-of-1.json: it is the manifest of a flight of 16 frames around"), "{said}");
    assert!(said.contains("that takes another way; give another folder"), "{said}");
}

#[test]
fn the_last_of_two_dems_on_one_grid_counts() {
    let place = Place::new();
    let text = fs::read_to_string(place.path("hill.asc")).expect("a DEM");
    fs::write(place.path("mound.asc"), text.replace(" 5", " 4")).expect("room");
    let drawn = |dems: [&str; 2]| {
        let flags = [&["fly"], &dems[..], &FLY[2..12], &["-o", "two/%05d.png", "--frames", "0-1"]].concat();
        let output = place.run(&flags);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        String::from_utf8_lossy(&output.stdout).lines().last().unwrap_or_default().to_owned()
    };
    assert!(drawn(["hill.asc", "mound.asc"]).contains("2 frames drawn"));
    assert!(drawn(["hill.asc", "mound.asc"]).contains("2 were there"));
    assert!(drawn(["mound.asc", "hill.asc"]).contains("2 frames drawn"), "the other one is on top now");
}

#[test]
fn what_is_there_stays_as_it_is() {
    let place = Place::new();
    let run = |more: &[&str]| {
        let output = place.run(&fly("kept/%05d.png", &[&["--frames", "0-2"], more].concat()));
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    };
    run(&["--mask", "kept/mask-%05d.png"]);
    let first = frames(&place.path("kept"));
    assert_eq!(first.len(), 6);
    run(&["--mask", "kept/mask-%05d.png", "-o", "kept/%05d.svg"]);
    assert_eq!(frames(&place.path("kept")), first, "an SVG more leaves the pictures alone");
    run(&["--mask", "kept/mask-%05d.png", "--style", "plotter"]);
    let restyled = frames(&place.path("kept"));
    let same = |name: &str| restyled[name] == first[name];
    assert!(same("mask-00001.png") && !same("00001.png"), "a mask does not know of styles");
}

#[test]
fn a_frame_that_fails_costs_itself_alone() {
    let place = Place::new();
    let whole = undisturbed();
    fs::create_dir_all(place.path("bad/00005.png")).expect("a folder in the way");
    let output = place.run(&fly("bad/%05d.png", &["--progress", "json"]));
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("1 of 16 frames failed") && said.contains("00005.png"), "{said}");
    let lines: Vec<Value> = String::from_utf8_lossy(&output.stdout)
        .lines()
        .map(|line| serde_json::from_str(line).unwrap_or_else(|_| panic!("{line} is no JSON")))
        .collect();
    let of = |event: &str| lines.iter().filter(|line| line["event"] == event).collect::<Vec<_>>();
    assert_eq!((of("start").len(), of("frame").len(), of("fail").len(), of("done").len()), (1, 15, 1, 1));
    assert_eq!((&of("fail")[0]["n"], &of("done")[0]["failed"]), (&Value::from(5), &Value::from(1)));
    assert!(of("frame").iter().all(|line| line["ms"].as_f64() > Some(0.0) && line["adapter"].is_string()));
    let frames = frames(&place.path("bad"));
    assert_eq!(frames.len(), 15);
    frames.iter().for_each(|(name, (bytes, _))| assert_eq!(*bytes, whole[name].0, "{name}"));
}

#[test]
fn a_full_disk_ends_the_flight_and_leaves_whole_frames() {
    let place = Place::new();
    let whole = undisturbed();
    let folder = place.path("full");
    fs::create_dir(&folder).expect("a folder");
    let room = 4096 * (4 + whole.values().take(5).map(|(bytes, _)| bytes.len().div_ceil(4096)).sum::<usize>());
    let mount =
        Command::new("mount").args(["-t", "tmpfs", "-o", &format!("size={room}"), "none"]).arg(&folder).status();
    if !mount.is_ok_and(|status| status.success()) {
        println!("SKIP small disks can be made by root alone");
        return;
    }
    let output = place.run(&fly("full/%05d.png", &[]));
    let said = stderr(&output);
    let kept = frames(&folder);
    let half = half_made(&folder);
    let unmount = Command::new("umount").arg(&folder).status().expect("umount runs");
    assert!(unmount.success());
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("make room there or choose another output path"), "{said}");
    assert_eq!(half, Vec::<String>::new(), "nothing half made");
    assert!((1..16).contains(&kept.len()), "{} frames", kept.len());
    kept.iter().for_each(|(name, (bytes, _))| assert_eq!(*bytes, whole[name].0, "{name}"));
}

#[test]
fn what_cannot_be_flown_is_told_in_one_line() {
    let place = Place::new();
    let wrong = |arguments: &[&str], code: i32, words: &str| {
        let output = place.run(arguments);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
        assert!(said.contains(words), "{arguments:?} should say `{words}`: {said}");
        assert!(!said.contains("panicked"), "{said}");
    };
    wrong(&fly("frame.png", &[]), 2, "frame.png: it has no number, so that each frame would replace the last");
    wrong(&fly("%05d.png", &["--frames", "14-16"]), 2, "there is no 16; the 16 frames count from 0 to 15");
    wrong(&fly("%05d.png", &["--frames", "a"]), 2, "want numbers and ranges from 0 on");
    wrong(&fly("%05d.png", &["--shard", "3/3"]), 2, "there is no shard 3 of 3; i of i/n counts from 0 to 2");
    wrong(&fly("%05d.png", &["--shard-from-env"]), 2, "no shard is named");
    wrong(&fly("%05d.tif", &[]), 2, "%05d.tif does not end in .png, .svg or .pdf");
    wrong(&fly("%05d.png", &["--mask", "%05d.png"]), 2, "is another output already");
    wrong(&fly("%05d.svg", &["--video", "a.gif"]), 2, "add --output with a .png");
    wrong(&fly("%05d.png", &["--video", "a.avi"]), 2, "a.avi does not end in .gif, .png or .mp4");
    wrong(&fly("%05d.png", &["--video", "x/../00003.png"]), 2, "x/../00003.png is a frame");
    wrong(&fly("%05d.png", &["--video", "none/a.gif"]), 1, "none/a.gif: cannot be written (there is no folder none)");
    wrong(&fly("none/%d.png", &["--mask", "none/%02d.png"]), 2, "is another output already");
    fs::copy(place.path("hill.asc"), place.path("hill.gif")).expect("room");
    let mut as_gif = fly("%05d.png", &["--video", "hill.gif"]);
    as_gif[1] = "hill.gif";
    wrong(&as_gif, 2, "hill.gif is read as input");
    fs::remove_file(place.path("hill.gif")).expect("it is there");
    assert_eq!(place.written(), Vec::<String>::new(), "nothing was written");
    fs::write(place.path("plain"), "").expect("a file");
    wrong(&fly("a/%05d.png", &["--mask", "plain/%05d.png"]), 1, "plain: cannot be written");
    assert!(frames(&place.path("a")).is_empty(), "before a frame is drawn");
    fs::write(place.path("hachure-0-of-1.json"), "{}").expect("a file");
    wrong(&fly("%05d.png", &[]), 1, "hachure-0-of-1.json: it is no manifest");
    wrong(&["merge", "."], 1, "hachure-0-of-1.json: it is no manifest");
}

#[test]
fn a_list_tells_what_each_frame_may_take() {
    let place = Place::new();
    assert_eq!(place.run(&fly("listed/%05d.png", &["--frames", "0-3"])).status.code(), Some(0));
    let output = place.run(&fly("listed/%05d.png", &["--list", "--frames", "2-5"]));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let lines: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let done: Vec<_> = lines.iter().map(|line| (line["n"].as_u64(), line["done"].as_bool())).collect();
    assert_eq!(done, [(2, true), (3, true), (4, false), (5, false)].map(|(n, done)| (Some(n), Some(done))));
    for line in &lines[2..] {
        assert!(line["seconds"].as_f64() > Some(0.0), "{line}");
        assert!(line["start_seconds"].as_f64() > Some(0.0), "{line}");
        assert_eq!(line["samples"], 40 * 40, "{line}");
        assert!(line["memory_bytes"].as_u64() > line["device_bytes"].as_u64(), "{line}");
        assert!(line["files"][0].as_str().is_some_and(|file| file.ends_with(".png")), "{line}");
    }
    assert_eq!(frames(&place.path("listed")).len(), 4, "nothing was made");
}

#[test]
fn a_mask_alone_is_the_mask_of_the_drawing() {
    let place = Place::new();
    let output = place.run(&fly("a/%05d.png", &["--mask", "a/mask-%05d.png", "--frames", "3"]));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let fly_alone: Vec<&str> = FLY.iter().copied().chain(["--mask", "b/%05d.png", "--frames", "3"]).collect();
    let output = place.run(&fly_alone);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let pixels = |name: &str| image::open(place.path(name)).expect("a mask").to_luma8().into_raw();
    assert_eq!(pixels("a/mask-00003.png"), pixels("b/00003.png"));
    assert!(pixels("b/00003.png").contains(&0), "some of it is ink");
}

#[test]
fn frames_without_a_line_are_told() {
    let place = Place::new();
    let output = place.run(&fly("up/%05d.png", &["--frames", "0-2", "--altitude", "80"]));
    assert_eq!(output.status.code(), Some(0));
    let said = stderr(&output);
    assert!(said.contains("3 of the frames drawn hold no line; see where they look with --preview"), "{said}");
    assert!(!stderr(&place.run(&fly("on/%05d.png", &["--frames", "0"]))).contains("hold no line"));
}

#[test]
fn a_path_is_followed_frame_by_frame_by_compare() {
    let place = Place::new();
    let keys = |east: f64| format!("[[key]]\nplace = [{east}, 4000080, \"+40\"]\nazimuth = 20\naltitude = -10\n");
    fs::write(place.path("path.toml"), keys(500090.0) + &keys(500300.0)).expect("a file");
    let flags =
        ["compare", "hill.asc", "-o", "report", "--path", "path.toml", "--size", "160x90", "--methods", "walk,contour"];
    let output = place.run(&[&flags[..], &["--levels", "4", "--truth-level", "8", "--no-cache"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = fs::read_to_string(place.path("report/results.json")).expect("results");
    let results: Value = serde_json::from_str(&text).expect("JSON");
    let sequences = results["sequences"].as_array().expect("sequences");
    let told: Vec<_> = sequences.iter().map(|run| (run["method"].as_str(), run["step_m"].as_f64())).collect();
    let both = [1.0, 10.0].map(|step| [(Some("walk"), Some(step)), (Some("contour"), Some(step))]).concat();
    assert_eq!(told, both);
    assert!(sequences.iter().all(|run| run["frames"] == 20 && run["recall"].as_f64() > Some(0.9)), "{sequences:?}");
    assert!(fs::read_to_string(place.path("report/report.html")).expect("a page").contains("From frame to frame"));
    fs::write(place.path("short.toml"), keys(500190.0) + &keys(500200.0)).expect("a file");
    let output = place.run(&["compare", "hill.asc", "-o", "other", "--path", "short.toml", "--levels", "4"]);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("--path: 10.0 m long, 19 m of it are followed; give a longer one"), "{said}");
}
