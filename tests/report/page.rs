//! The page: what it says, and that it works in a browser.

use std::io::Cursor;

use hachure::door::measure::figures::DrawnLevel;
use hachure::door::report::results::Results;
use hachure::door::report::{Picture, error_time_svg, report_html};
use hachure::error::Error;
use image::{GrayImage, ImageFormat, Luma};
use serde_json::Value;

use super::browser::{Browser, Visit};
use super::{SIZE, sample, sample_with_floors};
use hachure::door::measure::compare::Finding;
use hachure::door::report::lines::lines;

/// What is looked for in the browser.
const PROBE: &str = include_str!("probe.js");
/// Widths of a desk's window and a telephone's, px.
const WIDTHS: [u32; 2] = [1400, 420];

/// A picture for every name, no two alike.
fn pictures(results: &Results) -> Vec<Picture> {
    let of_runs = results.runs.iter().flat_map(|run| [&run.mask, &run.difference]);
    let names = results.scenes.iter().map(|scene| &scene.picture).chain(of_runs);
    let picture = |(i, name): (usize, &String)| {
        let bar = |x: u32, y: u32| Luma([if x / 2 == i as u32 || y == 9 { 26 } else { 255 }]);
        let mut png = Cursor::new(Vec::new());
        GrayImage::from_fn(SIZE[0], SIZE[1], bar).write_to(&mut png, ImageFormat::Png).expect("a picture");
        Picture { name: name.clone(), png: png.into_inner() }
    };
    names.enumerate().map(picture).collect()
}

fn page_of(results: &Results) -> String {
    report_html(results, &error_time_svg(results).expect("a plot"), &pictures(results)).expect("a page")
}

/// The text of an element's children, tags and all, between two words.
fn between<'a>(page: &'a str, from: &str, to: &str) -> &'a str {
    let rest = page.split_once(from).unwrap_or_else(|| panic!("no {from}")).1;
    rest.split_once(to).unwrap_or_else(|| panic!("no {to}")).0
}

/// The results of the first scene alone.
fn one_scene() -> Results {
    let mut results = sample();
    results.scenes.truncate(1);
    results.runs.retain(|run| run.scene == results.scenes[0].name);
    results
}

#[test]
fn sequences_have_a_table_where_there_are_any() {
    let results = crate::report::sample::with_sequences(SIZE[0], SIZE[1]);
    let (page, without) = (page_of(&results), page_of(&sample()));
    let rows = between(&page, "<section id=\"sequences\"", "</section>");
    assert_eq!(rows.matches("<tr><td>").count(), 2);
    for cell in [">0.034<", ">1.234<", ">0.9967<", ">0.078<", ">2.130<", ">0.972<", ">10.0<"] {
        assert!(rows.contains(cell), "{cell}");
    }
    assert!(page.contains("href=\"#sequences\"") && !without.contains("sequences"));
    let line = lines(&Finding::Sequence(&results.sequences[0])).concat().join("\n");
    let wanted = "walk level auto, 20 frames 10 m apart: excess pop 0.034 % (ink 1.234 %, truth 1.200 %), R 0.9967 (least \
                  0.9951); of strokes 0.078 % (of 2.130 % lost); 97.2 % of ids kept; 105 ms a frame, 5465 px of ink";
    assert!(line.ends_with(wanted), "{line}");
    let json: Value = serde_json::to_value(&results).expect("JSON");
    assert_eq!((&json["sequences"][0]["level"], &json["sequences"][1]["ids_kept"]), (&"auto".into(), &Value::Null));
}

#[test]
fn each_picture_is_in_the_page_once_and_a_missing_one_is_an_error() {
    let results = sample();
    let page = page_of(&results);
    let pictures = pictures(&results);
    assert_eq!(page.matches("data:image/png;base64,").count(), pictures.len());
    assert_eq!(page, page_of(&results), "the same results give the same page");
    let lacking = report_html(&results, "<svg></svg>", &pictures[1..]);
    assert!(
        matches!(lacking, Err(Error::Mistake { what }) if what == "the report cannot be made: there is no picture west-temple_truth.png")
    );
}

#[test]
fn texts_of_the_results_are_escaped_and_nothing_is_fetched() {
    let page = page_of(&sample());
    assert!(page.contains("a&lt;b &amp; c") && !page.contains("a<b"));
    // The command as it is, quotes and all.
    assert!(page.contains("hachure draw &#x27;a&lt;b &amp; c, &quot;d&#x27;\\&#x27;&#x27;s&quot;.tif&#x27;"));
    let links = page.matches("http").count();
    assert_eq!(links, page.matches("http://www.w3.org/2000/svg").count() + page.matches("http-equiv").count());
}

#[test]
fn the_page_has_all_that_was_measured() {
    let page = page_of(&sample());
    for words in [
        "llvmpipe Mesa 22.3.6",
        "wall clock from submitting to done, median of 9 warm frames",
        "--eye 325249,4117889,2000 --azimuth 310",
        "Slope fitted to the medians: −1.95: twice the level divides the distance by 3.9.",
        "near to 2410 m,\nmiddle to 5120 m,\nfar beyond",
        "2\u{202f}117\u{202f}248",
        "black: agreed",
        "blue: missed",
        "red-orange: spurious",
        "<td data-v=\"\">–</td>",
        "F 0.9991 (precision 0.9995,\nrecall 0.9987)",
    ] {
        assert!(page.contains(words), "{words}");
    }
    let mut unfitted = sample();
    unfitted.scenes[0].convergence.as_mut().expect("convergence").slope = None;
    assert!(page_of(&unfitted).contains("no slope can be fitted"));
    // Nothing was drawn: still a page.
    unfitted.runs.clear();
    assert!(page_of(&unfitted).contains("No method was drawn in every scene."));
}

#[test]
fn the_page_shows_what_passes_cost_and_limits_where_they_were_asked_for() {
    let (plain, page) = (page_of(&sample()), page_of(&sample_with_floors()));
    let cost = "<td data-v=\"16\">16.00</td><td data-v=\"48\">48.00</td>";
    assert!(plain.contains(cost) && page.contains(cost));
    assert!(!plain.contains("How far from the limit"));
    let limits = between(&page, "<h3 id=\"limits\">", "</section>");
    let rows = between(limits, "<tbody>", "</tbody>");
    let first = between(rows, "<tr>", "</tr>");
    for words in ["<td data-v=\"40\">40.00</td>", "<td data-v=\"3.2\">3.20</td>", "<td>several vertex batches</td>"] {
        assert!(first.contains(words), "{words}: {first}");
    }
    assert_eq!(rows.matches("several vertex batches").count(), 1);
    let words =
        "A frame of walk at level 2 takes at most 3.2 times as long as a bare copy of as many bytes and 1.6 times as";
    assert!(page.contains(words) && !plain.contains("A frame of walk"));
    assert_eq!(rows.matches("<td data-v=\"1.6\">1.60</td>").count(), sample().runs.len() - 1);
}

#[test]
fn the_page_tells_how_chains_lie_beside_truths_own() {
    let results = sample();
    let page = page_of(&results);
    let table = between(&page, "<h3 id=\"chains\">", "</table>");
    let rows: Vec<&str> = between(table, "<tbody>", "</tbody>").split("<tr>").skip(1).collect();
    assert_eq!(rows.len(), results.runs.len());
    let of = |method: &str| results.runs.iter().position(|run| run.method == method).expect("a run");
    let contour = rows[of("contour")];
    let figures = "<td data-v=\"214\">214</td><td data-v=\"3721.4\">3\u{202f}721</td>\n<td data-v=\"0.0572\">0.057</td>\
        <td data-v=\"0.1104\">0.110</td>";
    let short = "<td data-v=\"0.1125\">0.113</td><td data-v=\"0.0875\">0.087</td>";
    assert!(contour.contains(figures) && contour.contains(short), "{contour}");
    assert!(contour.contains("<td data-v=\"0.9375\">0.938</td>"), "{contour}");
    assert!(contour.contains("<td data-v=\"0.064\">0.064</td>"), "{contour}");
    // What is traced has no names and no economy, and where nothing is drawn there are no distances.
    let none = "<td data-v=\"\">–</td>";
    assert_eq!(rows[of("toward-away")].matches(none).count(), 2);
    assert_eq!(rows[of("adjacency")].matches(none).count(), 4);
    assert!(rows[of("adjacency")].contains("<td data-v=\"0\">0</td>"));
    // Recall by pixels stands in the table of all runs.
    let run = &results.runs[0];
    assert!(
        between(&page, "<section id=\"runs\"", "</table>").contains(&format!("<td data-v=\"{}\">", run.pixel_recall))
    );
}

#[test]
fn words_follow_from_the_figures() {
    let mut results = one_scene();
    let page = page_of(&results);
    assert_eq!(
        between(&page, "<p class=\"lead\">", "</p>"),
        "Walk at level 8 comes closest to truth: F 1.0000 in 114 ms a frame."
    );
    let when = |page: &str| between(page, "<section id=\"when\">", "</section>").to_owned();
    for words in [
        "walk at level 2: F 0.9920 in 44.1 ms a frame. It is the fastest that reaches F 0.99.",
        "toward-away at level 1: F 0.9229 in 29.8 ms a frame.",
        "adjacency at every level (as little as 1.7 % of its ink lies on a line) and adjacency-corner at levels 4",
        "toward-away and toward-away-wide, at every level.",
        "Gaps: 11 at level 1, 2 at level 2, 0 at level 4, 0 at level 8.",
    ] {
        assert!(when(&page).contains(words), "{words}: {}", when(&page));
    }
    assert!(!when(&page).contains("as far as truth can tell"));
    // A truth that is sure of itself to 0.002 only cannot tell level 4 from level 8.
    results.truth.self_f = 0.998;
    assert!(
        when(&page_of(&results)).contains("walk at level 4: F 0.9985 in 56.2 ms a frame. Truth may be off by 0.0020")
    );
    // Another method wins when its figures do.
    let leading = results.runs.iter_mut().filter(|run| ["walk", "contour"].contains(&run.method));
    leading.for_each(|run| (run.f, run.gaps) = (0.5, 7));
    let page = page_of(&results);
    assert!(between(&page, "<p class=\"lead\">", "</p>").starts_with("Toward-away-wide at level 8 comes closest"));
    assert!(when(&page).contains("walk, contour, toward-away and toward-away-wide, at every level."));
}

#[test]
fn two_scenes_are_judged_by_the_worse_one() {
    let page = page_of(&sample());
    // Levels 4 and 8 were drawn in one scene only.
    assert_eq!(
        between(&page, "<p class=\"lead\">", "</p>"),
        "Walk at level 2 comes closest to truth: at least F 0.9920 in at most 75.0 ms a frame, in each of 2 scenes."
    );
}

/// A column of numbers in the order of the page; those without one are `None`.
fn numbers(column: &Value) -> Vec<Option<f64>> {
    column.as_array().expect("a column").iter().map(|cell| cell.as_str().expect("a cell").parse().ok()).collect()
}

/// Whether numbers rise, or fall, and those that are none stand at the end.
fn is_sorted(column: &[Option<f64>], falling: bool) -> bool {
    column.windows(2).all(|two| match (two[0], two[1]) {
        (Some(a), Some(b)) => {
            if falling {
                a >= b
            } else {
                a <= b
            }
        }
        (first, second) => first.is_some() || second.is_none(),
    })
}

/// Whether the headings sort: none, one and two clicks on each.
fn sorts(visit: &Visit) -> bool {
    ["F", "facets", "chamfer"].iter().all(|name| {
        let states = &visit.found["sorted"][name];
        is_sorted(&numbers(&states[1]), false)
            && is_sorted(&numbers(&states[3]), true)
            && (states[2] == "ascending" && states[4] == "descending")
    })
}

#[test]
fn the_page_works_in_a_browser() {
    let Some(browser) = Browser::find() else { return };
    let results = sample();
    let page = page_of(&results);
    for width in WIDTHS {
        let visit = browser.visit(&page, PROBE, width);
        let found = &visit.found;
        assert_eq!(visit.trouble, Vec::<String>::new());
        assert_eq!(found["width"], width);
        assert!(
            found["wide"].as_i64() <= Some(0),
            "the page is wider than its window of {width} px: {}",
            found["wide"]
        );

        // Headings sort: numbers as numbers, names as names.
        assert!(sorts(&visit), "{}", found["sorted"]);
        assert!(!is_sorted(&numbers(&found["sorted"]["F"][0]), false), "the table was sorted before the click");
        let names = |i: usize| found["sorted"]["method"][i].as_array().expect("names").clone();
        assert!(names(1).is_sorted_by_key(Value::to_string) && !names(0).is_sorted_by_key(Value::to_string));
        assert_eq!(found["marked"], 1, "one heading tells the order");

        // The boundary moves: the mask on its left, the difference on its right.
        let run = &results.runs[0];
        for sides in found["sides"].as_array().expect("sides") {
            assert_eq!([&sides[0], &sides[1]], [run.mask.as_str(), run.difference.as_str()]);
        }
        // A mouse drags it to 90 px and lets go; a finger beside the line does not.
        assert_eq!(found["dragged"], serde_json::json!(["90", "150"]));

        // Selects change the picture, to the one that stands below.
        let best = results.runs.iter().find(|run| run.level == DrawnLevel::Of(8)).expect("a run");
        assert_eq!(found["choices"][0][0][0], results.scenes[0].picture.as_str());
        assert_eq!(found["choices"][0][1][0], best.mask.as_str());
        assert_eq!(found["choices"][1][0][0], results.runs[2].mask.as_str());
        assert_eq!(found["chooserSources"], found["runSources"]);

        // Every picture is there, a pixel for a pixel, and no text of the plot lies on another.
        let shown = found["pictures"].as_array().expect("pictures");
        assert_eq!(shown.len(), pictures(&results).len() + results.scenes.len());
        assert!(
            shown.iter().all(|p| p[0] == SIZE[0] && p[1].as_f64() == Some(SIZE[0].into()) && p[2] == true),
            "{shown:?}"
        );
        assert_eq!(found["overlaps"], Value::Array(Vec::new()));
        assert!(found["texts"].as_u64() > Some(50));
        assert_eq!(found["controls"].as_u64(), Some((results.scenes.len() + results.runs.len()) as u64));
    }
}

#[test]
fn the_page_can_be_read_without_its_script() {
    let Some(browser) = Browser::find() else { return };
    let page = page_of(&sample());
    let script = between(&page, "</main>", "</body>").to_owned();
    let probe = "return [...document.querySelectorAll('img, table')].map(e => e.getBoundingClientRect().height)
        .concat([...document.querySelectorAll('.controls')].map(e => 1 - e.offsetHeight))";
    let visit = browser.visit(&page.replace(&script, ""), probe, WIDTHS[0]);
    assert_eq!(visit.trouble, Vec::<String>::new());
    let heights = visit.found.as_array().expect("heights");
    assert!(heights.len() > 90 && heights.iter().all(|height| height.as_f64() > Some(0.0)), "{heights:?}");
}

#[test]
fn the_checks_of_the_page_can_fail() {
    let Some(browser) = Browser::find() else { return };
    let page = page_of(&one_scene());
    let with = |more: &str| page.replace("</main>", &format!("{more}</main>"));
    let policy = between(&page, "<meta http-equiv", ">").to_owned();
    let nothing = "return null";
    let elsewhere = "<img src=\"http://127.0.0.1:9/picture.png\" alt=\"\">";
    for (what, broken) in [
        ("an exception", with("<script>missing()</script>")),
        ("a rejection", with("<script>Promise.reject('no')</script>")),
        ("a message", with("<script>console.error('no')</script>")),
        ("a picture from elsewhere", with(elsewhere)),
        ("the same, were it allowed", with(elsewhere).replace(&format!("<meta http-equiv{policy}>"), "")),
        ("a number SVG cannot read", with("<svg><rect width=\"wide\"/></svg>")),
    ] {
        assert!(!browser.visit(&broken, nothing, WIDTHS[0]).trouble.is_empty(), "{what} was not noticed");
    }
    assert!(browser.visit(&page, nothing, WIDTHS[0]).trouble.is_empty());

    // Headings that do nothing, a label on another, a picture that is too small, a page that is too wide.
    let broken = page
        .replace("body.append(...[...body.rows]", "void ([...body.rows]")
        .replace("</svg>", "<text x=\"300\" y=\"300\">one</text><text x=\"302\" y=\"303\">two</text></svg>")
        .replace("</style>", ".run img { width: 200px } h1 { width: 2000px }</style>");
    let visit = browser.visit(&broken, PROBE, WIDTHS[0]);
    assert!(!sorts(&visit));
    assert!(visit.found["overlaps"].as_array().is_some_and(|overlaps| !overlaps.is_empty()));
    assert!(visit.found["pictures"].as_array().is_some_and(|p| p.iter().any(|p| p[1].as_f64() == Some(200.0))));
    assert!(visit.found["wide"].as_i64() > Some(0));
    // A boundary that stays where it is.
    let stuck = page.replace("range.addEventListener(\"input\", show);", "");
    let sides = &browser.visit(&stuck, PROBE, WIDTHS[0]).found["sides"];
    assert_ne!(sides[0], sides[1], "{sides}");
}
