//! SIGTERM and SIGKILL at moments spread over the whole of a run: what has its final name is what an undisturbed run makes, and
//! the same command makes the rest.

#![cfg(unix)]

use std::fs;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::{DRAW, files, undisturbed};
use crate::cli::{Place, stderr};

/// Moments of a run at which it is ended.
const MOMENTS: u32 = 2;

/// Files by their paths.
type Files = Vec<(String, Vec<u8>)>;

/// Ends a run by a signal after some time.
fn interrupted(run: &[&str], whole: &Files, signal: &str, wait: Duration) {
    let place = Place::new();
    list(&place);
    fs::create_dir_all(place.path("out")).expect("a folder");
    let child = place.command(run).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it starts");
    sleep(wait);
    Command::new("kill").args([signal, &child.id().to_string()]).output().expect("kill runs");
    let output = child.wait_with_output().expect("it ends");
    let about = format!("{} {signal} after {wait:?}: {}", run.join(" "), stderr(&output));
    // Before its first line, and by a signal that nobody catches, the system ends it.
    assert!([None, Some(0), Some(75)].contains(&output.status.code()), "{about}");
    let [made, half] = files(&place.path("out"));
    assert!(half.len() <= if signal == "-KILL" { whole.len() } else { 0 }, "{about} left {}", half.len());
    is_part(&made, whole, &about);
    let again = place.run(run);
    assert_eq!(again.status.code(), Some(0), "{about}, then again: {}", stderr(&again));
    let [made, _] = files(&place.path("out"));
    is_part(whole, &made, &about);
    is_part(&made, whole, &about);
}

/// Fails where a picture is not among the others. Reports and manifests tell times.
fn is_part(made: &[(String, Vec<u8>)], whole: &[(String, Vec<u8>)], about: &str) {
    let tells_times = |name: &str| {
        [".json", ".html", ".csv"].iter().any(|ending| name.ends_with(ending)) || name.ends_with("time.svg")
    };
    for (name, bytes) in made.iter() {
        let known = whole.iter().find(|(other, _)| other == name);
        assert!(known.is_some_and(|(_, whole)| tells_times(name) || whole == bytes), "{about}: {name} is not whole");
    }
}

fn list(place: &Place) {
    let drawing = |name: &str, look: &str| {
        format!("[[drawing]]\ndem = \"hill.asc\"\noutput = [\"out/{name}.png\", \"out/{name}.pdf\"]\n{look}\n\n")
    };
    let small = "size = \"160x90\"\nhachures = \"none\"";
    let list = [drawing("a", small), drawing("b", "plan = true\nscale = \"1:5000\"")].concat();
    fs::write(place.path("list.toml"), list).expect("a list");
}

fn at_every_moment(run: &[&str]) {
    let place = Place::new();
    list(&place);
    fs::create_dir_all(place.path("out")).expect("a folder");
    let began = Instant::now();
    let whole = undisturbed(&place, run);
    let lasts = began.elapsed();
    let runs: Vec<_> = (0..MOMENTS).flat_map(|i| ["-TERM", "-KILL"].map(|signal| (i, signal))).collect();
    runs.into_par_iter().for_each(|(i, signal)| {
        // One after the other, not all at the same places.
        let within = if signal == "-TERM" { 0.25 } else { 0.75 };
        interrupted(run, &whole, signal, lasts.mul_f64((f64::from(i) + within) / f64::from(MOMENTS)));
    });
}

#[test]
fn a_drawing_ended_at_any_moment_is_whole_or_not_there() {
    at_every_moment(&DRAW);
}

#[test]
fn a_batch_ended_at_any_moment_goes_on() {
    at_every_moment(&["batch", "list.toml"]);
}

#[test]
fn a_report_ended_at_any_moment_is_whole_or_not_there() {
    at_every_moment(&[
        "compare",
        "hill.asc",
        "-o",
        "out",
        "--size",
        "64x48",
        "--levels",
        "1",
        "--methods",
        "adjacency",
    ]);
}

#[test]
#[should_panic(expected = "a.png is not whole")]
fn half_a_file_is_noticed() {
    let whole = [("a.png".to_owned(), vec![1, 2, 3])];
    is_part(&[("a.png".to_owned(), vec![1, 2])], &whole, "cut short");
}
