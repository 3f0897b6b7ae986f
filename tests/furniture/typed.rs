//! Furniture as it is typed.

use std::fs;

use hachure::geo::{ReadOptions, read};
use serde_json::Value;

use crate::cli::{DRAW, Place, refuses, stderr};

/// No adapter of that name: an error that comes first is one before any drawing.
const NO_GPU: [&str; 2] = ["--adapter", "none of this name"];

fn text(place: &Place, name: &str) -> String {
    fs::read_to_string(place.path(name)).expect("a file")
}

/// Places of the paths of an SVG's groups with such a name, mm.
fn places(svg: &str, group: impl Fn(&str) -> bool) -> Vec<[f64; 2]> {
    let mut found = Vec::new();
    let mut inside = false;
    for line in svg.lines() {
        if line.starts_with("<g ") {
            inside = group(line);
        } else if let (true, Some(data)) = (inside, line.split(" d=\"").nth(1)) {
            let data = data.split('"').next().unwrap_or_default();
            for pair in data.split(['M', 'L', 'Z']).filter(|pair| !pair.is_empty()) {
                let (x, y) = pair.split_once(' ').expect("a pair");
                found.push([x, y].map(|number| number.parse().expect("a number")));
            }
        }
    }
    found
}

#[test]
fn without_a_page_the_sheet_grows_and_the_picture_stays() {
    let place = Place::new();
    let draw = |more: &[&str]| {
        let flags = ["draw", "hill.asc", "-o", "out.svg", "-o", "out.png", "--mask", "mask.png", "--json", "out.json"];
        let output = place.run(&[&flags[..], &["--size", "320x180"], more].concat());
        assert!(output.status.success(), "{more:?}: {}", stderr(&output));
        let report: Value = serde_json::from_str(&text(&place, "out.json")).expect("JSON");
        let picture = image::image_dimensions(place.path("out.png")).expect("a picture");
        (text(&place, "out.svg"), fs::read(place.path("mask.png")).expect("a mask"), report, picture)
    };
    let (plain, mask, report, size) = draw(&[]);
    assert_eq!(report["page"]["frame_mm"], serde_json::json!([0.0, 0.0, 240.0, 135.0]));
    assert_eq!(size, (320, 180));
    assert!(!plain.contains("furniture") && !plain.contains("<title>"));
    let furniture = ["--title", "The Hill", "--neatline", "--view-line", "--credits"];
    let (full, full_mask, report, size) = draw(&furniture);
    assert!(mask == full_mask, "the mask is the frame's");
    let frame: Vec<f64> =
        report["page"]["frame_mm"].as_array().expect("four").iter().filter_map(Value::as_f64).collect();
    assert!((frame[2] - frame[0] - 240.0).abs() < 1e-9 && (frame[3] - frame[1] - 135.0).abs() < 1e-9, "{frame:?}");
    assert!(size.0 > 345 && size.1 > 225, "{size:?}");
    assert!(full.contains("furniture\" fill=\"#") && full.contains("<title>The Hill</title>"));
    let picture = |svg: &str| places(svg, |group| !group.contains("furniture"));
    let (plain, moved) = (picture(&plain), picture(&full));
    assert!(
        plain.len() > 50 && plain.len().abs_diff(moved.len()) <= plain.len() / 50,
        "{} {}",
        plain.len(),
        moved.len()
    );
    // Corners are whole micrometres.
    let off = |a: &[f64; 2], b: &[f64; 2]| (b[0] - a[0] - frame[0]).abs().max((b[1] - a[1] - frame[1]).abs());
    let nearest = |a: &[f64; 2]| moved.iter().map(|b| off(a, b)).fold(f64::INFINITY, f64::min);
    let farthest = plain.iter().map(nearest).fold(0.0, f64::max);
    assert!(farthest < 0.003, "what is drawn is drawn, elsewhere on the sheet: {farthest} mm");
    assert!(draw(&furniture).0 == full, "the same input gives the same bytes");
}

#[test]
fn on_a_page_margins_stay_blank_and_the_picture_makes_room() {
    let place = Place::new();
    let page = ["draw", "hill.asc", "-o", "out.svg", "--page", "A6", "--margin", "8", "--json", "out.json"];
    let output = place.run(&[&page[..], &["--title", "HILL", "--neatline"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let all = places(&text(&place, "out.svg"), |_| true);
    let bound = |axis: usize| all.iter().map(move |at| at[axis]);
    let low = [0, 1].map(|axis| bound(axis).fold(f64::INFINITY, f64::min));
    let high = [0, 1].map(|axis| bound(axis).fold(0.0, f64::max));
    assert_eq!(low, [8.0, 8.0], "the neatline begins at the margins");
    assert!(high[0] == 97.0 && high[1] <= 140.0 && high[1] > 138.0, "{high:?}");
    let report: Value = serde_json::from_str(&text(&place, "out.json")).expect("JSON");
    let bottom = report["page"]["frame_mm"][3].as_f64().expect("a number");
    assert!(bottom < 133.0, "{bottom}");
    // A size that went with the page no longer does, and the error says which does.
    let output = place.run(&[&page[..], &["--title", "HILL", "--size", "712x1056"]].concat());
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    let lengths =
        |text: &str| text.split([' ', ';', ',']).filter_map(|word| word.parse::<f64>().ok()).collect::<Vec<_>>();
    let said = stderr(&output);
    let said = lengths(said.lines().last().expect("an error"));
    assert!(said.len() == 2 && said.iter().all(|mm| mm.to_string().len() <= 5), "{said:?}");
}

#[test]
fn a_neatline_takes_the_place_of_registration_marks() {
    let place = Place::new();
    let plotter = String::from_utf8(place.run(&["styles", "plotter"]).stdout).expect("text");
    let unmarked = plotter.replace("registration = true", "registration = false");
    assert!(unmarked != plotter, "{plotter}");
    fs::write(place.path("marked.toml"), plotter).expect("a file");
    fs::write(place.path("unmarked.toml"), unmarked).expect("a file");
    let draw = |style: &str, more: &[&str]| {
        let flags = ["draw", "hill.asc", "-o", "out.svg", "--size", "160x90", "--style", style];
        let output = place.run(&[&flags[..], more].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        places(&text(&place, "out.svg"), |_| true)
    };
    assert!(draw("marked.toml", &[]) != draw("unmarked.toml", &[]));
    assert!(draw("marked.toml", &["--neatline"]) == draw("unmarked.toml", &["--neatline"]), "no mark beside a rule");
}

#[test]
fn what_cannot_be_set_is_refused_before_anything_is_drawn() {
    let place = Place::new();
    let long = "A title without end ".repeat(30);
    let draw = |more: &[&str], words: &str| refuses(&place, &[&DRAW[..], &NO_GPU, more].concat(), 2, words);
    draw(&["--title", &long], "error: --title: \"A title without end");
    draw(&["--title", &long], "shorten it, or use a larger --page");
    draw(&["--title", "富士山"], "--title: the font of furniture has no `富` (U+5BCC); write it otherwise");
    draw(&["--title", "a\u{7}b"], "has no U+0007");
    draw(&["--title", "\u{202e}RTL"], "has no U+202E;");
    draw(&["--title", "Όλυμπος", "--style", "plotter"], "pens write with have no `Ό`");
    draw(&["--credits=富", "--page", "A4"], "--credits: the font of furniture has no `富`");
    draw(&["--title", " "], "want some words");
    draw(&["--title", "a", "--page", "20x20", "--margin", "9"], "furniture leaves nothing of a page of 20 x 20 mm");
    refuses(
        &place,
        &["draw", "hill.asc", "-o", "p.svg", "--plan", "--scale", "1:5000", "--title", &long],
        2,
        "shorten it",
    );
    // Otherwise the adapter is what is missed.
    refuses(&place, &[&DRAW[..], &NO_GPU, &["--title", "Όλυμπος & Эльбрус"]].concat(), 1, "none of this name");
}

#[test]
fn frames_of_a_flight_have_none() {
    let place = Place::new();
    let fly = ["fly", "hill.asc", "--orbit", "500200,4000200", "--radius", "150", "--count", "3", "-o", "f/%03d.png"];
    for flag in [&["--title", "A"][..], &["--neatline"], &["--view-line"], &["--credits"]] {
        refuses(&place, &[&fly[..], flag].concat(), 2, &format!("{}: goes with drawings", flag[0]));
    }
}

/// A VRT of the hill that says who made it.
fn thanked(place: &Place, items: &str) {
    let vrt = format!(
        "<VRTDataset rasterXSize=\"40\" rasterYSize=\"40\"><GeoTransform>500000, 10, 0, 4000400, 0, -10</GeoTransform>\
         <Metadata>{items}</Metadata><VRTRasterBand dataType=\"Float32\" band=\"1\"><NoDataValue>-9999</NoDataValue>\
         <SimpleSource><SourceFilename relativeToVRT=\"1\">hill.asc</SourceFilename><SourceBand>1</SourceBand></SimpleSource>\
         </VRTRasterBand></VRTDataset>"
    );
    fs::write(place.path("hill.vrt"), vrt).expect("a file");
}

#[test]
fn credits_are_what_the_files_say() {
    let place = Place::new();
    let credits = || read(place.path("hill.vrt"), &ReadOptions::default()).expect("a DEM").history().credits().to_vec();
    let item = |key: &str, value: &str| format!("<MDI key=\"{key}\">{value}</MDI>");
    let items = [
        item("TIFFTAG_COPYRIGHT", "© Nobody\n  2020"),
        item("TIFFTAG_IMAGEDESCRIPTION", "A hill"),
        item("ATTRIBUTION", "A hill"),
        item("AREA_OR_POINT", "Area"),
    ];
    thanked(&place, &items.concat());
    assert_eq!(credits(), ["A hill", "© Nobody 2020"]);
    let draw = |credits: &str| {
        let plan = ["draw", "hill.vrt", "-o", "p.svg", "--plan", "--scale", "1:5000", credits];
        let output = place.run(&plan);
        assert!(output.status.success(), "{}", stderr(&output));
        text(&place, "p.svg")
    };
    let draw = |credits: &str| places(&draw(credits), |group| group.contains("furniture"));
    let said = draw("--credits");
    assert!(said.len() > 100 && said == draw("--credits=A hill · © Nobody 2020"), "they are what is written");
    assert!(said != draw("--credits=A hill · © Nobody 2021"), "and another letter is seen");
    thanked(&place, "");
    assert!(credits().is_empty());
    let plain = draw("--credits");
    assert!(
        plain == draw("--credits=Terrain: hill.vrt · 40\u{a0}×\u{a0}40\u{a0}samples\u{a0}10\u{a0}m\u{a0}apart"),
        "else of samples"
    );
    assert!(
        plain != draw("--credits=Terrain: hill.vrt · 40\u{a0}×\u{a0}40\u{a0}samples\u{a0}11\u{a0}m\u{a0}apart"),
        "which are told"
    );
    thanked(&place, &item("TIFFTAG_COPYRIGHT", "富士"));
    let plan = ["draw", "hill.vrt", "-o", "q.svg", "--plan", "--scale", "1:5000", "--credits"];
    let output = place.run(&plan);
    let said = stderr(&output);
    assert!(output.status.code() == Some(2) && said.contains("own words, --credits=TEXT"), "{said}");
}

/// Whether letters stand in one place, to a rounding of the sheet's size.
fn are_alike(a: &[[f64; 2]], b: &[[f64; 2]]) -> bool {
    let off = |(a, b): (&[f64; 2], &[f64; 2])| (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
    a.len() == b.len() && a.iter().zip(b).map(off).fold(0.0, f64::max) < 0.002
}

#[test]
fn credits_count_the_samples_of_the_files() {
    let place = Place::new();
    thanked(&place, "");
    let metres = text(&place, "hill.vrt");
    let east = metres.replace("500000, 10, 0, 4000400, 0, -10", "500400, 10, 0, 4000400, 0, -10");
    let degrees = metres.replace("500000, 10, 0, 4000400, 0, -10", "-113, .0001, 0, 37, 0, -.0001");
    let degrees = degrees.replace("<GeoTransform>", "<SRS>EPSG:4326</SRS><GeoTransform>");
    for (name, vrt) in [("east.vrt", east), ("degrees.vrt", degrees)] {
        fs::write(place.path(name), vrt).expect("a file");
    }
    let draw = |dems: &[&str], credits: &str| {
        let plan = ["-o", "p.svg", "--plan", "--scale", "1:5000", credits];
        let output = place.run(&[&["draw"], dems, &plan].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        places(&text(&place, "p.svg"), |group| group.contains("furniture"))
    };
    for (dems, wanted) in [
        // Warped and cut, it is drawn with others.
        (&["degrees.vrt"][..], "Terrain: degrees.vrt · 40 × 40 samples 0.36″ apart · WGS 84 (EPSG:4326)"),
        (&["hill.vrt", "--crop", "500100,4000100,500300,4000300"], "Terrain: hill.vrt · 40 × 40 samples 10 m apart"),
        (
            &["hill.vrt", "east.vrt", "--crop", "500100,4000100,500600,4000300"],
            "Terrain: hill.vrt and 1 more · 40 × 40 samples each, 10 m apart",
        ),
    ] {
        let own = |text: &str| {
            // Lines break between parts alone.
            let parts: Vec<String> = text
                .split(" · ")
                .map(|part| match part.contains("samples") {
                    true => part.replace(' ', "\u{a0}"),
                    false => part.to_owned(),
                })
                .collect();
            draw(dems, &format!("--credits={}", parts.join(" · ")))
        };
        let told = draw(dems, "--credits");
        assert!(are_alike(&told, &own(wanted)), "{wanted}");
        assert!(!are_alike(&told, &own(&wanted.replace("40 × 40", "40 × 41"))), "and another number is seen");
    }
}

/// Drawings with furniture, a plan with other words, and one without.
const DRAWINGS: &str = r#"
[defaults]
dem = "hill.asc"
size = "120x60"
title = "The hill"
neatline = true
credits = true

[[drawing]]
output = "out/a.svg"
view-line = true

[[drawing]]
output = "out/b.svg"
plan = true
scale = "1:5000"
size = false
credits = "By hand"
style = "plotter"

[[drawing]]
output = "out/c.svg"
title = false
neatline = false
credits = false
"#;

#[test]
fn a_batch_has_it_too() {
    let place = Place::new();
    let batch = |text: &str| {
        fs::write(place.path("drawings.toml"), text).expect("a file");
        let output = place.run(&["batch", "drawings.toml"]);
        assert!(output.status.success(), "{}", stderr(&output));
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    assert!(batch(DRAWINGS).contains("3 drawings drawn"));
    let [a, b, c] = ["a", "b", "c"].map(|name| text(&place, &format!("out/{name}.svg")));
    assert!(a.contains("<title>The hill</title>") && a.contains(" furniture\" fill=\"#"), "{a}");
    assert!(b.contains(" furniture 0.3 mm\" fill=\"none\""), "{b}");
    assert!(!c.contains("furniture") && !c.contains("<title>"));
    // Another title is another drawing, of those that have it.
    assert!(batch(&DRAWINGS.replace("The hill", "A hill")).contains("2 drawings drawn, 1 were there"));
    let wrong = DRAWINGS.replace("The hill", "富士");
    fs::write(place.path("drawings.toml"), wrong).expect("a file");
    let output = place.run(&["batch", "drawings.toml"]);
    assert!(!output.status.success() && stderr(&output).contains("`富`"), "{}", stderr(&output));
}
