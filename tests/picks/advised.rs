//! What a pick tells to type is taken, and does what is told of it; where nothing would, nothing is.

use serde_json::Value;

use super::{answer, at, land, number};
use crate::cli::{Place, refuses};

/// Hills of some hundred metres with valleys between them, and the sea in the north.
fn hills(east: f64, south: f64) -> f64 {
    let waves = (east / 140.0).sin() * (south / 190.0).cos() + 0.6 * (east / 61.0 + south / 83.0).sin();
    if south < 300.0 { 0.0 } else { 60.0 + 0.05 * south + 45.0 * waves }
}

/// The lines of an answer that are of a rule.
fn of_rule<'a>(told: &'a Value, rule: &'a str) -> impl Iterator<Item = &'a Value> {
    told["lines"].as_array().expect("lines").iter().filter(move |line| line["rule"] == rule)
}

/// A page, small and without hachures.
const PAGE: [&str; 4] = ["--size", "320x200", "--hachures", "none"];

/// Asks for a pixel of the hills.
fn of_hills(place: &Place, pixel: &str, more: &[&str]) -> Value {
    let eye = at(1000.0, 1950.0);
    let eye = format!("{},{},+160", eye.x, eye.y);
    let view = ["--eye", &eye, "--azimuth", "0", "--altitude", "-14", "--at", pixel];
    answer(place, &[&view[..], &PAGE, more].concat())
}

/// The flags that are told of the lines of a rule.
fn flags_of(told: &Value, rule: &str) -> Vec<String> {
    of_rule(told, rule).filter_map(|line| line["flags"].as_str().map(str::to_owned)).collect()
}

#[test]
fn flags_that_are_told_to_draw_a_line_draw_it() {
    let place = Place::new();
    land(&place.path("land.tif"), hills);
    let mut count = 0;
    for pixel in (0..12).map(|i| format!("{},{}", 54 + 53 * (i % 4), 48 + 31 * (i / 4))) {
        let told = of_hills(&place, &pixel, &["--creases", "drainage"]);
        let lines = of_rule(&told, "creases").chain(of_rule(&told, "channel-area"));
        for line in lines {
            let Some(flags) = line["flags"].as_str() else {
                assert!(!line["words"].as_str().expect("words").contains(" draws "), "{line}");
                continue;
            };
            count += 1;
            let kept: &[&str] = if flags.contains("--creases") { &[] } else { &["--creases", "drainage"] };
            let typed: Vec<&str> = flags.split(' ').chain(kept.iter().copied()).collect();
            let then = of_hills(&place, &pixel, &typed);
            let is_drawn = of_rule(&then, "drawn").any(|drawn| drawn["kind"] == line["kind"]);
            assert!(is_drawn, "{pixel}: {flags} was told to draw a {}: {then}", line["kind"]);
        }
    }
    assert!(count > 2, "{count}");
}

#[test]
fn where_no_stream_runs_its_reason_is_told() {
    let place = Place::new();
    // A valley to the south; and a slope that falls to the sea.
    let valley = |east: f64, south: f64| 0.35 * (east - 1000.0).abs() + 0.08 * (2000.0 - south);
    land(&place.path("land.tif"), valley);
    let eye = at(1000.0, 1700.0);
    let eye = format!("{},{},700", eye.x, eye.y);
    let view = ["--eye", &eye, "--azimuth", "0", "--altitude", "-40", "--at", "160,100", "--creases", "drainage"];
    let asked = |area: &str| answer(&place, &[&view[..], &PAGE, &["--channel-area", area]].concat());
    let flags = flags_of(&asked("300ha"), "channel-area");
    let [flags] = &flags[..] else { panic!("one: {flags:?}") };
    let then = asked(flags.strip_prefix("--channel-area ").expect("one flag"));
    assert!(of_rule(&then, "drawn").any(|line| line["kind"] == "drainage"), "{flags}: {then}");
    land(&place.path("land.tif"), |_, south| (0.2 * (1000.0 - south)).max(0.0));
    let eye = at(1000.0, 1900.0);
    let eye = format!("{},{},100", eye.x, eye.y);
    let view = ["--eye", &eye, "--azimuth", "0", "--altitude", "-20", "--at", "160,100", "--creases", "drainage"];
    let sea = answer(&place, &[&view[..], &PAGE].concat());
    let told: Vec<&Value> = of_rule(&sea, "flat-water").collect();
    assert!(told.len() == 1 && told[0]["flags"].is_null() && of_rule(&sea, "channel-area").count() == 0, "{sea}");
}

#[test]
fn only_methods_that_draw_lines_of_the_land_tell_of_flags_for_them() {
    let place = Place::new();
    land(&place.path("land.tif"), hills);
    for (method, draws) in [("contour", true), ("walk", true), ("toward-away", false), ("adjacency", false)] {
        let asked = |more: &[&str]| of_hills(&place, "160,79", &[&["--method", method], more].concat());
        let flags = flags_of(&asked(&["--creases", "none"]), "creases");
        assert_eq!(!flags.is_empty(), draws, "{method}: {flags:?}");
        flags.iter().for_each(|flags| drop(asked(&flags.split(' ').collect::<Vec<_>>())));
    }
}

#[test]
fn what_is_faded_until_nobody_sees_it_is_left_out() {
    let place = Place::new();
    land(&place.path("land.tif"), super::ridges);
    let eye = at(1000.0, 1900.0);
    let eye = format!("{},{},150", eye.x, eye.y);
    let (view, pixel) = (["--eye", &eye, "--azimuth", "0", "--altitude", "0", "--min-jump", "0"], "320,295");
    let page = ["--size", "640x480", "--border", "off", "--hachures", "none", "--at", pixel, "--min-gap"];
    // The width of the first ridge; 0 where it is left out.
    let wide = |gap: f64| {
        let told = answer(&place, &[&view[..], &page, &[&format!("{gap}px")]].concat());
        let lines = told["lines"].as_array().expect("lines");
        let first = lines.iter().min_by(|a, b| number(&a["off_px"]).total_cmp(&number(&b["off_px"])));
        let first = first.expect("the ridge").clone();
        if first["drawn"] == true { number(&first["numbers"]["width_mm"]) } else { 0.0 }
    };
    let [mut drawn, mut left_out] = [4.5, 24.0];
    assert!(wide(drawn) > 0.1 && wide(left_out) == 0.0);
    for _ in 0..10 {
        let middle = f64::midpoint(drawn, left_out);
        let width = wide(middle);
        assert!(width == 0.0 || width >= 0.005, "{width} mm of ink at --min-gap {middle}px");
        if width > 0.0 { drawn = middle } else { left_out = middle }
    }
}

#[test]
fn a_pick_asks_for_a_pixel_or_a_place() {
    let place = Place::new();
    refuses(&place, &["pick", "hill.asc"], 2, "<--at <X,Y>|--of <E,N|LON,LAT>>");
    let help = String::from_utf8(place.run(&["pick", "--help"]).stdout).expect("text");
    assert!(help.contains("no pick\nfor plans") || help.contains("no pick for plans"), "{help}");
}
