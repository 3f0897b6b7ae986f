//! Styles: the built-in ones, files of them, and what is said of mistakes in these.

use std::fs;
use std::path::Path;

use hachure::error::Error;
use hachure::ink::style::Plot;
use hachure::ink::styles::{BuiltIn, find, parse};
use hachure::ink::{Colour, Pen, Style};
use serde_json::Value;

use crate::cli::{DRAW, Place, refuses, stderr};

fn read(text: &str) -> Style {
    parse(text, Path::new("my.toml")).expect("a style")
}

/// What is said of a text that is no style.
fn mistake(text: &str) -> String {
    match parse(text, Path::new("my.toml")) {
        Err(Error::Input { what, remedy, .. }) => format!("{what}; {remedy}"),
        other => panic!("{text}: {other:?}"),
    }
}

#[test]
fn built_in_styles_differ_and_read_back_as_they_print() {
    let styles = BuiltIn::ALL.map(|style| style.style().expect("a style"));
    assert_eq!(styles[0], Style::default());
    for (i, style) in styles.iter().enumerate() {
        assert_eq!(read(&toml::to_string(style).expect("TOML")), *style);
        assert!(styles[..i].iter().all(|other| other != style));
        assert!(BuiltIn::ALL[i].description().len() > 20);
        assert_eq!(find(&BuiltIn::ALL[i].to_string()).expect("a style"), *style);
    }
    let plotter = BuiltIn::Plotter.style().expect("a style");
    assert!(plotter.plot.centre_lines && plotter.plot.registration && plotter.plot.widths.len() == 2);
}

#[test]
fn what_a_style_does_not_say_is_as_in_its_base() {
    assert_eq!(read(""), Style::default());
    let wide = read("base = \"plotter\"\n[pens.border]\nwidth = 2");
    let plotter = BuiltIn::Plotter.style().expect("a style");
    assert_eq!(wide.pens.border.width, 2.0);
    assert_eq!(wide.pens.border.colour, Colour([0; 3]), "the rest of the pen stays");
    assert_eq!((wide.pens.silhouette, &wide.plot), (plotter.pens.silhouette, &plotter.plot));
    // What a base does not say is as in the first style, key by key.
    let red = read("[pens.own]\ncolour = \"#ff0000\"").pens;
    assert_eq!((red.own.width, red.own.colour), (Style::default().pens.own.width, Colour([255, 0, 0])));
    let none = read("base = \"plotter\"\nplot.widths = []");
    assert_eq!(none.plot, Plot { widths: vec![], ..plotter.plot });
}

#[test]
fn layers_of_own_lines_have_pens_by_their_names() {
    let style =
        read("[pens.own]\nwidth = 0.4\n[pens.lines.rivers]\ncolour = \"#2b5c8a\"\n[pens.lines.\"a: b\"]\nwidth = 3");
    let pens = &style.pens;
    assert_eq!(pens.of_own("rivers"), Pen { colour: Colour([0x2b, 0x5c, 0x8a]), ..pens.own });
    assert_eq!((pens.of_own("rivers").width, pens.of_own("a: b").width), (0.4, 3.0));
    assert_eq!((pens.of_own("roads"), pens.of_own("own")), (pens.own, pens.own));
    assert_eq!((pens.all().count(), style.broadest()), (10, 3.0));
    assert!(pens.all().any(|pen| pen == pens.of_own("rivers")));
    assert_eq!(read(&toml::to_string(&style).expect("TOML")), style);
    assert!(!toml::to_string(&Style::default()).expect("TOML").contains("pens.lines"), "no empty table");
}

#[test]
fn mistakes_are_told_with_their_place_and_what_was_meant() {
    for (text, words) in [
        ("[pens.silhouette]\nwidht = 1", "line 2, column 1: unknown key `widht`; use `width`"),
        ("[pens.silhuette]\nwidth = 1", "line 1, column 7: unknown key `silhuette`; use `silhouette`"),
        ("[pens.lines.rivers]\ncolor = 1", "line 2, column 1: unknown key `color`; use `colour`"),
        ("[pens.lines]\nrivers = 1", "line 2, column 10: invalid type"),
        ("min_jump = 1", "line 1, column 1: unknown key `min_jump`; use `min-jump`"),
        ("papier = 1", "unknown key `papier`; use `paper`"),
        ("zzz = 1", "unknown key `zzz`; use one of `base`, `paper`"),
        ("base = \"atlass\"", "line 1, column 8: unknown variant `atlass`; use `atlas`"),
        ("\npaper = \"red\"", "line 2, column 9: `red` is no colour; want #rrggbb, as #26201a"),
        ("paper = \"#+1+1+1\"", "is no colour"),
        ("paper = \"#ééé\"", "is no colour"),
        ("[weight]\nfar = 0", "line 2, column 7: 0 is out of range; want a share, 0.01 to 1"),
        ("[weight]\nfar = nan", "NaN is out of range"),
        (
            "[pens.border]\nwidth = 0.001",
            "line 2, column 9: 0.001 is out of range; want millimetres of a pen, 0.02 to 10",
        ),
        ("[pens.border]\nwidth = \"wide\"", "line 2, column 9: invalid type: string \"wide\"; want a number"),
        ("[pens.border]\nopacity = 1.5", "1.5 is out of range; want a share, 0 to 1"),
        ("[dashes]\ndash = 0.0", "0 is out of range; want millimetres, 0.05 to 100"),
        ("plot.widths = [0.5, 0.3]", "widths are not in order; want at most 16, each broader than the last"),
        ("plot.widths = [0.0]", "0 is out of range"),
        ("[wobble]\nreach = 1", "`wobble.reach` of 1 mm is not below the `tolerance` of 0.075 mm; lower `reach`"),
        ("[wobble]\nseed = -1", "line 2, column 8: invalid value: integer `-1`; want a whole number"),
        ("dots = true\ndots = false", "line 2, column 1: duplicate key"),
        ("dots = ", "line 1, column 8: "),
        ("# näh é\n  dots = 1", "line 2, column 10: invalid type"),
    ] {
        let said = mistake(text);
        assert!(said.contains(words), "{text}: {said}");
        assert_eq!(said.lines().count(), 1, "{text}: {said}");
    }
}

/// The least and the greatest of each number of a schema, by the keys that lead to it.
fn bounds(schema: &Value, of: &Value, path: &[String], found: &mut Vec<(Vec<String>, f64, f64)>) {
    let of = match of["$ref"].as_str() {
        Some(name) => &schema["$defs"][name.trim_start_matches("#/$defs/")],
        None => of,
    };
    if let (Some(least), Some(most)) = (of["minimum"].as_f64(), of["maximum"].as_f64()) {
        found.push((path.to_vec(), least, most));
    }
    for (key, inner) in of["properties"].as_object().into_iter().flatten() {
        bounds(schema, inner, &[path, std::slice::from_ref(key)].concat(), found);
    }
    if of["additionalProperties"].is_object() {
        bounds(schema, &of["additionalProperties"], &[path, &["any".to_owned()]].concat(), found);
    }
}

#[test]
fn the_schema_has_every_key_and_the_bounds_that_are_kept() {
    let schema = serde_json::to_value(schemars::schema_for!(Style)).expect("JSON");
    let mut found = Vec::new();
    bounds(&schema, &schema, &[], &mut found);
    assert!(found.len() > 20, "{found:?}");
    assert!(found.iter().any(|(path, ..)| path.join(".") == "pens.lines.any.width"), "{found:?}");
    for (path, least, most) in found.iter().filter(|(path, ..)| path[path.len() - 1] != "seed") {
        let takes = |value: f64| {
            // The only number that another bounds.
            let value = if path[0] == "wobble" && value == 100.0 { 99.9 } else { value };
            let text = format!("tolerance = 100.0\n{} = {value:?}", path.join("."));
            let text = if path[0] == "tolerance" { format!("tolerance = {value:?}") } else { text };
            parse(&text, Path::new("my.toml")).is_ok()
        };
        assert!(takes(*least) && takes(*most), "{path:?}: {least} to {most}");
        assert!(!takes(most * 1.001) && !takes(least - 0.001), "{path:?}: {least} to {most}");
    }
    // Every key that a style prints is in the schema.
    let printed: toml::Table = toml::from_str(&toml::to_string(&Style::default()).expect("TOML")).expect("TOML");
    for key in printed.keys() {
        assert!(
            !schema["properties"][key].is_null() && schema["properties"][key]["description"].is_string()
                || key == "base",
            "{key}"
        );
    }
}

#[test]
fn styles_are_listed_shown_and_used() {
    let place = Place::new();
    let answer = |arguments: &[&str]| {
        let output = place.run(arguments);
        assert!(output.status.success(), "{}", stderr(&output));
        String::from_utf8(output.stdout).expect("text")
    };
    let list = answer(&["styles"]);
    assert!(BuiltIn::ALL.iter().all(|style| list.contains(&style.to_string()) && list.contains(style.description())));
    let schema: Value = serde_json::from_str(&answer(&["styles", "--schema"])).expect("JSON");
    assert!(schema["properties"]["pens"].is_object());
    // A style that is printed to a file draws what it drew by its name.
    fs::write(place.path("mine.toml"), answer(&["styles", "woodcut"])).expect("a file");
    let drawn = |style: &str| {
        answer(&[&DRAW[..], &["--style", style]].concat());
        fs::read(place.path("out.png")).expect("a picture")
    };
    let woodcut = drawn("woodcut");
    assert_eq!(drawn("mine.toml"), woodcut);
    assert_ne!(drawn("atlas"), woodcut);
}

#[test]
fn styles_that_are_none_are_refused_before_the_work() {
    let place = Place::new();
    let with = |style| [&DRAW[..], &["--style", style]].concat();
    refuses(&place, &with("atlsa"), 2, "--style: there is no style `atlsa`; use `atlas`, or a file that ends in .toml");
    refuses(&place, &with("zzz"), 2, "use one of `field-sketch`, `atlas`, `plotter`, `woodcut`");
    refuses(&place, &with("none.toml"), 1, "none.toml: No such file");
    refuses(&place, &["styles", "atlsa"], 2, "use `atlas`");
    #[cfg(unix)]
    {
        let endless = place.path("endless.toml");
        std::os::unix::fs::symlink("/dev/zero", &endless).expect("a link");
        let output = place.run(&with("endless.toml"));
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        assert!(stderr(&output).contains("endless.toml: it is no regular file; name a file of TOML"));
        fs::remove_file(endless).expect("a link");
    }
    refuses(&place, &with("."), 2, "there is no style `.`; use one of");
}
