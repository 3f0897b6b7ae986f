//! Reports of comparisons: the plot, the CSV, and the page with its words.

mod browser;
mod page;
mod sample;

use hachure::door::measure::compare::Finding;
use hachure::door::report::lines::lines;
use hachure::door::report::results::Results;
use hachure::door::report::{error_time_svg, write_csv};
use hachure::error::Error;
use sample::AWKWARD;

/// A page of the sample, px.
const SIZE: [u32; 2] = [300, 200];

fn sample() -> Results {
    sample::results(SIZE[0], SIZE[1])
}

fn sample_with_floors() -> Results {
    sample::with_floors(SIZE[0], SIZE[1])
}

#[test]
fn the_plot_is_the_same_file_every_time_and_shows_every_run() {
    let results = sample();
    let svg = error_time_svg(&results).expect("a plot");
    assert_eq!(svg, error_time_svg(&results).expect("a plot"));
    assert!(svg.starts_with("<svg role=\"img\"") && svg.ends_with("</svg>\n"), "{svg}");
    for words in ["<title id=", "<desc id=", ">\n≤ 0.0001\n<", "time of a frame, camera to mask, ms", "1 − F"] {
        assert!(svg.contains(words), "{words}");
    }
    // Each method is named once in each of two panels, and described run by run.
    for method in ["walk", "contour", "toward-away", "toward-away-wide", "adjacency", "adjacency-corner"] {
        assert_eq!(svg.matches(&format!("\n{method}, level ")).count(), 2, "{method}");
    }
    assert!(svg.contains("walk, level 8: F 1.0000 in 114.0 ms, on the Pareto front."));
    assert!(svg.contains("a&lt;b &amp; c") && !svg.contains("a<b"), "names are escaped");
    // 1 - F of 0 and of 1 have places.
    assert!(!svg.contains("NaN") && !svg.contains("inf") && !svg.contains("2147483647"));
}

#[test]
fn the_plot_follows_the_results() {
    let (mut results, first) = (sample(), error_time_svg(&sample()).expect("a plot"));
    results.runs[0].frame_ms *= 1.5;
    assert_ne!(error_time_svg(&results).expect("a plot"), first);
    // As fast as a clock can tell, as slow as patience allows, and nothing at all.
    (results.runs[0].frame_ms, results.runs[1].frame_ms) = (0.0, 3.6e6);
    assert!(error_time_svg(&results).expect("a plot").contains("1000000"));
    results.runs.clear();
    assert!(error_time_svg(&results).expect("a plot").contains("west-temple"));
    results.scenes.clear();
    assert!(error_time_svg(&results).expect("a plot").contains("</svg>"));
}

#[test]
fn a_method_that_nobody_knows_is_not_drawn_as_another() {
    let mut results = sample();
    results.runs[0].method = "stranger";
    let error = error_time_svg(&results).expect_err("no look of its own");
    assert!(matches!(&error, Error::Mistake { what } if what == "no method is called stranger"), "{error:?}");
}

/// Names of the columns, and rows by name.
fn table(results: &Results) -> (Vec<String>, Vec<Vec<String>>) {
    let mut bytes = Vec::new();
    write_csv(results, &mut bytes).expect("CSV");
    let mut reader = csv::Reader::from_reader(&bytes[..]);
    let names = reader.headers().expect("names").iter().map(str::to_owned).collect();
    let row = |row: csv::Result<csv::StringRecord>| row.expect("a row").iter().map(str::to_owned).collect();
    (names, reader.records().map(row).collect())
}

#[test]
fn the_csv_holds_what_the_json_holds() {
    let results = sample();
    let (names, rows) = table(&results);
    assert_eq!(rows.len(), results.runs.len());
    let mut once = names.clone();
    once.sort();
    once.dedup();
    assert_eq!(once.len(), names.len(), "no name twice: {names:?}");
    let json = serde_json::to_value(&results).expect("JSON");
    for (row, run) in rows.iter().zip(json["runs"].as_array().expect("runs")) {
        let cell = |name: &str| &row[names.iter().position(|n| n == name).unwrap_or_else(|| panic!("no {name}"))];
        for (key, value) in run.as_object().expect("a run") {
            match value {
                serde_json::Value::Number(number) => assert_eq!(cell(key), &number.to_string(), "{key}"),
                serde_json::Value::String(text) => assert_eq!(cell(key), text, "{key}"),
                serde_json::Value::Null if key != "place" => assert_eq!(cell(key), "", "{key}"),
                _ => {}
            }
        }
        assert_eq!(cell("precision_0.5px"), &run["at"][0]["precision"].to_string());
        assert_eq!(cell("f_3px"), &run["at"][3]["f"].to_string());
        assert_eq!(cell("far_recall"), &run["bands"][2]["recall"].to_string());
        assert_eq!(cell("far_to_m"), "");
        assert_eq!(cell("min_frame_range_ms"), &run["frame_range_ms"][0].to_string());
        assert_eq!(cell("mask_hashes"), "9f86d081 60303ae2");
        let walk = run["method"] == "walk";
        for key in ["ids_kept", "economy_removed"] {
            assert_eq!(cell(key).is_empty(), run["method"] != "contour", "{key}");
        }
        for key in ["pixel_recall", "chains", "chains_px", "short_chains", "chain_precision", "chain_recall"] {
            assert_eq!(cell(key), &run[key].to_string(), "{key}");
        }
        assert_eq!(cell("place_mean_px").is_empty(), !walk);
        assert_eq!(cell("walk_ms").is_empty(), !walk);
        assert_eq!(cell("silhouette_ms").is_empty(), walk || run["method"] == "contour");
    }
    assert!(rows.iter().any(|row| row[0] == AWKWARD));
}

#[test]
fn limits_have_columns_where_they_were_asked_for() {
    let of_floor =
        |names: &[String]| names.iter().filter(|name| name.starts_with("floor")).cloned().collect::<Vec<_>>();
    assert_eq!(of_floor(&table(&sample()).0), Vec::<String>::new());
    let (names, rows) = table(&sample_with_floors());
    let keys = ["bytes", "copy_ms", "draw_ms", "lacking", "frame_per_copy", "frame_per_draw"];
    assert_eq!(of_floor(&names), keys.map(|key| format!("floor_{key}")));
    let cell = |row: usize, name: &str| rows[row][names.iter().position(|n| n == name).expect(name)].as_str();
    assert_eq!([cell(0, "floor_draw_ms"), cell(0, "floor_lacking")], ["", "several vertex batches"]);
    assert_eq!([cell(1, "floor_frame_per_draw"), cell(1, "floor_lacking")], ["1.6", ""]);
    assert_eq!([cell(0, "tessellate_bytes"), cell(0, "tessellate_operations")], ["16000000", "48000000"]);
}

#[test]
fn the_columns_of_the_csv_stand_in_the_order_of_the_fields() {
    let (names, _) = table(&sample());
    let place = |name: &str| names.iter().position(|n| n == name).unwrap_or_else(|| panic!("no {name}"));
    assert_eq!(names[..3], ["scene", "method", "level"]);
    let order = [
        "f",
        "gaps",
        "pixel_recall",
        "chains",
        "chain_mean_px",
        "ids_kept",
        "precision_0.5px",
        "near_to_m",
        "place_mean_px",
        "facets",
        "tessellate_ms",
        "rasterize_ms",
    ];
    assert!(order.windows(2).all(|two| place(two[0]) < place(two[1])), "{names:?}");
    // A walk's passes came first; another method's stand among them, not at the end.
    assert!(place("silhouette_ms") < place("peak_mib"));
    assert!(!names.iter().any(|name| name == "place" || name == "pareto"), "{names:?}");
    // Columns do not depend on what a machine can tell.
    let mut poorer = sample();
    poorer.runs.iter_mut().for_each(|run| (run.peak_mib, run.chamfer_px, run.place) = (None, None, None));
    assert_eq!(table(&poorer).0, names);
    let mut nothing = Vec::new();
    write_csv(&Results { runs: Vec::new(), ..sample() }, &mut nothing).expect("CSV");
    assert!(nothing.is_empty());
}

#[test]
fn a_run_is_told_with_its_chains() {
    let results = sample();
    let said = |method: &str| {
        let run = results.runs.iter().find(|run| run.method == method).expect("a run");
        lines(&Finding::Run(run))[0].clone()
    };
    let chains =
        "  214 chains, 3721 px: 0.057 px from truth, 95 % within 0.110; P 0.8317 R 0.9044 (economy removes 6.4 %)";
    assert_eq!(said("contour")[1], format!("{chains}; 11.2 % under 6 px; 93.8 % of ids kept"));
    let traced = "P 0.8391 R 0.8649; 11.2 % under 6 px";
    assert!(said("toward-away")[1].ends_with(traced), "{:?}", said("toward-away"));
    assert_eq!(said("adjacency")[1], "  0 chains, 0 px: P 0.0339 R 0.9722; 11.2 % under 6 px");
    let truth = &results.scenes[0].truth;
    let said = lines(&Finding::Truth("here", truth, None))[0].clone();
    assert!(
        said[0].starts_with("here truth at level 32: 3785 px of line (0 of border), 8.8 % of its chains under 6 px, F")
    );
}
