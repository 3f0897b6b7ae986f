//! `hachure stress` as scripts see it.

use std::fs;
use std::time::Instant;

use hachure::door::stress::{Promise, all, named, short};
use serde_json::Value;

use crate::cli::{Place, refuses, stderr};

/// Seconds that the short list may take on two cores, twice those that it may take alone: another test runs beside it.
const SHORT: f64 = 2.0 * 90.0;

fn json(place: &Place, folder: &str) -> Value {
    let text = fs::read_to_string(place.path(folder).join("results.json")).expect("results.json");
    serde_json::from_str(&text).expect("JSON")
}

fn count(list: &Value) -> usize {
    list.as_array().expect("a list").len()
}

#[test]
fn the_short_list_keeps_every_promise_in_time() {
    let place = Place::new();
    let start = Instant::now();
    let output = place.run(&["stress", "-o", "report", "--short"]);
    let seconds = start.elapsed().as_secs_f64();
    assert!(output.status.success(), "{}{}", String::from_utf8_lossy(&output.stdout), stderr(&output));
    println!("{}", String::from_utf8_lossy(&output.stdout));
    assert!(seconds <= SHORT, "{seconds:.0} s");
    let results = json(&place, "report");
    assert_eq!(count(&results["cases"]), short().len());
    let views: usize = short().iter().map(|case| case.views.len()).sum();
    assert_eq!(count(&results["runs"]), 6 * views, "methods times views");
    assert_eq!(
        (&results["broken"], count(&results["checks"])),
        (&0.into(), results["kept"].as_u64().expect("kept") as usize)
    );
    // Each promise of each case was looked at in each view, those of flights in the first.
    for case in short() {
        for (view, promise) in case.views.iter().flat_map(|view| case.promises.iter().map(move |p| (view, p))) {
            let of_flights = matches!(promise, Promise::Alone | Promise::Steady);
            if of_flights && view.name != case.views[0].name {
                continue;
            }
            let is_it = |check: &&Value| {
                (&check["case"], &check["view"], &check["promise"])
                    == (&case.name.into(), &view.name.into(), &promise.name().into())
            };
            let checked = results["checks"].as_array().expect("checks").iter().filter(is_it).count();
            let truth = results["runs"].as_array().expect("runs").iter();
            let truth = truth.filter(|run| run["case"] == case.name && run["view"] == view.name);
            let has_f = truth.map(|run| run["truth_px"].as_f64().expect("px")).fold(0.0, f64::max) >= 200.0;
            assert!(
                checked > 0 || promise.name() == "accurate" && !has_f,
                "{}, {}: {}",
                case.name,
                view.name,
                promise.name()
            );
        }
    }
    let page = fs::read_to_string(place.path("report/report.html")).expect("report.html");
    let csv = fs::read_to_string(place.path("report/results.csv")).expect("results.csv");
    assert_eq!(csv.lines().count(), 1 + count(&results["checks"]));
    let plot = fs::read_to_string(place.path("report/error-time.svg")).expect("error-time.svg");
    for case in short() {
        assert!(page.contains(&format!("<h3 id=\"{}\">", case.name)) && csv.contains(case.name), "{}", case.name);
        for view in &case.views {
            let name = format!("{}_{}.png", case.name, view.name);
            let picture = image::open(place.path("report").join(&name)).expect(&name);
            assert!(picture.width() >= view.camera.width && picture.height() >= view.camera.height, "{name}");
        }
    }
    assert!(
        plot.contains("hills, across, walk: F ") && plot.contains("needle, foot, walk: F "),
        "points beside ordinary land"
    );
}

#[test]
fn a_broken_promise_exits_1_and_is_named() {
    let place = Place::new();
    let output = place.run(&["stress", "-o", "report", "--only", "control"]);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    let error = said.lines().find(|line| line.starts_with("error: ")).expect("an error");
    assert!(error.contains("a promise is broken: control, view across, walk: accurate is 0."), "{error}");
    assert!(error.contains("promised at least 0.98") && error.contains("; see report/report.html"), "{error}");
    assert_eq!(said.lines().filter(|line| line.starts_with("error: ")).count(), 1);
    let results = json(&place, "report");
    let broken = results["broken"].as_u64().expect("broken");
    assert!(broken > 0 && results["checks"].as_array().expect("checks").iter().any(|check| check["kept"] == false));
    let page = fs::read_to_string(place.path("report/report.html")).expect("the report is whole all the same");
    assert!(page.contains("Broken promises") && page.contains("are broken."));
}

#[test]
fn lists_name_every_case_with_its_promises() {
    let place = Place::new();
    let lines = |arguments: &[&str]| {
        let output = place.run(arguments);
        assert!(output.status.success(), "{}", stderr(&output));
        String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect::<Vec<_>>()
    };
    let listed = lines(&["stress", "--list"]);
    assert_eq!(listed, all().iter().map(|case| case.line()).collect::<Vec<_>>());
    assert_eq!(lines(&["stress", "--list", "--short"]).len(), short().len());
    assert_eq!(lines(&["stress", "--list", "--only", "needle"]), [named("needle").expect("needle").line()]);
    assert_eq!(place.written(), Vec::<String>::new());
}

#[test]
fn wrong_usage_is_refused_before_the_work() {
    let place = Place::new();
    refuses(
        &place,
        &["stress", "-o", "report", "--only", "needel"],
        2,
        "--only: no case is called needel; use `needle`",
    );
    refuses(&place, &["stress", "--only", "needle"], 2, "--output");
    refuses(&place, &["stress", "-o", "report", "--only", "needle", "--short"], 2, "cannot be used with");
    refuses(&place, &["stress", "-o", "hill.asc", "--only", "needle"], 1, "it is a file, and a report is a folder");
}
