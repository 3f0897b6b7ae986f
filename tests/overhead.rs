//! Plans: the rims of a DEM from straight above, true to scale, whatever the heights.

use std::fs;

use glam::DVec2;
use hachure::dem::Dem;
use hachure::door::line::Overhead;
use hachure::geo::{ReadOptions, read};
use hachure::ink::styles::BuiltIn;
use hachure::line::{Chain, Land, Lines};
use hachure::relief::{LineKind, SurfaceLine, SurfacePoint};
use serde_json::Value;

use crate::cli::{Place, refuses, stderr};

/// The plan of a grid of rows of `#` with data and `.` without, samples 10 m and 10 px apart.
fn plan(rows: &[&str]) -> Lines {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.asc");
    let mut text = format!(
        "ncols {}\nnrows {}\nxllcorner 500000\nyllcorner 4000000\ncellsize 10\nNODATA_value -9999\n",
        rows[0].len(),
        rows.len()
    );
    for (r, row) in rows.iter().enumerate() {
        let height =
            |(c, sample): (usize, char)| if sample == '#' { format!("{}.25 ", c * 7 + r * 3) } else { "-9999 ".into() };
        text += &row.chars().enumerate().map(height).collect::<String>();
        text += "\n";
    }
    fs::write(&path, text).expect("a file");
    let size = [rows[0].len(), rows.len()].map(|samples| 10 * (samples as u32 - 1));
    let dem = read(&path, &ReadOptions::default()).expect("a DEM");
    Overhead { area: dem.extent(), size, px_per_metre: 1.0 }.lines(&dem).expect("a plan")
}

#[test]
fn lines_on_the_land_that_no_page_holds_are_refused() {
    let dem = Dem::from_heights(21, DVec2::splat(10.0), DVec2::ZERO, vec![5.0; 21 * 21]);
    let point = |x: f64| SurfacePoint { at: DVec2::new(x, 10.0), across: [f32::INFINITY; 3], length: 0.0, drop: 0.0 };
    let points = vec![point(0.0), point(10.0), point(20.0)];
    let line = SurfaceLine { kind: LineKind::Own(0), order: 1, points, closed: false, joins: None };
    let land = Land::new(&dem, 1.0, vec![line]).expect("lines");
    // 200 m.
    let at = |px_per_metre: f64| Overhead { area: dem.extent(), size: [100; 2], px_per_metre }.land(&land, 0.0, None);
    let most = f64::from(1 << 24) / 200.0;
    assert_eq!(at(1.0).expect("a line").len(), 1);
    let refused = at(most * 1.01).expect_err("too long");
    let words = "lines of the land are 16944988 px long on the page, 16777216 can be laid; use --scale 1:N with a larger N, or fewer --creases, --hachures or --lines";
    assert_eq!(hachure::door::cli::words::line(&refused), words);
}

/// Twice the area to the left of a ring as seen from above; rows run down.
fn area(chain: &Chain) -> f64 {
    chain.pairs().map(|[a, b]| b.place.perp_dot(a.place)).sum()
}

/// The corners of each ring in samples.
fn corners(lines: &Lines) -> Vec<Vec<[i32; 2]>> {
    let corner = |place: DVec2| (place / 10.0).round().to_array().map(|v| v as i32);
    lines.chains.iter().map(|chain| chain.points.iter().map(|point| corner(point.place)).collect()).collect()
}

#[test]
fn a_whole_grid_has_one_rim_of_four_corners() {
    let lines = plan(&["####", "####", "####"]);
    assert_eq!(corners(&lines), [[[0, 0], [0, 2], [3, 2], [3, 0]]]);
    assert_eq!([lines.width, lines.height], [30, 20]);
    assert!(lines.chains[0].closed && area(&lines.chains[0]) == 2.0 * 600.0, "land lies to the left");
    assert_eq!(lines.chains[0].points[2].world.truncate(), DVec2::new(500_035.0, 4_000_005.0));
}

#[test]
fn voids_have_rims_with_the_land_outside() {
    let lines = plan(&["######", "######", "##.###", "######", "######"]);
    assert_eq!(lines.chains.len(), 2);
    let hole = &lines.chains[1];
    // The six patches around a sample, three cells by three less the two that the diagonal leaves.
    assert_eq!(corners(&lines)[1].len(), 6);
    assert_eq!(area(hole), -2.0 * 300.0, "six halves of cells");
}

#[test]
fn land_that_touches_by_a_corner_stays_apart() {
    let lines = plan(&["###....", "###....", "#######", "..#####", "..#####"]);
    // Both blocks are whole, and meet in one sample or along the patches that fill in.
    let total: f64 = lines.chains.iter().map(area).sum();
    let by_patches = |rows: &[&str]| {
        let has = |r: usize, c: usize| rows[r].as_bytes()[c] == b'#';
        let cells = (0..rows.len() - 1).flat_map(|r| (0..rows[0].len() - 1).map(move |c| (r, c)));
        cells
            .map(|(r, c)| {
                let across = has(r, c) && has(r + 1, c + 1);
                f64::from(u8::from(across && has(r + 1, c)) + u8::from(across && has(r, c + 1))) * 100.0
            })
            .sum::<f64>()
    };
    assert_eq!(total, by_patches(&["###....", "###....", "#######", "..#####", "..#####"]));
    // Two blocks that share a sample are two rings.
    let pinch = plan(&["..###", "..###", "#####", "###..", "###.."]);
    assert_eq!(pinch.chains.len(), 2);
    assert!(
        pinch.chains.iter().all(|chain| {
            let mut places: Vec<_> =
                chain.points.iter().map(|point| point.place.to_array().map(f64::to_bits)).collect();
            places.sort_unstable();
            places.windows(2).all(|pair| pair[0] != pair[1])
        }),
        "no ring passes a sample twice: {:?}",
        corners(&pinch)
    );
}

#[test]
fn a_plan_is_true_to_scale_and_knows_no_heights() {
    let place = Place::new();
    let plan = |more: &[&str]| {
        let always = ["draw", "hill.asc", "-o", "a.svg", "-o", "a.png", "--json", "a.json", "--plan", "--dpi", "254"];
        let output = place.run(&[&always[..], more].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        (fs::read(place.path("a.svg")).expect("a file"), image::open(place.path("a.png")).expect("a PNG").to_luma8())
    };
    let (_, picture) = plan(&["--scale", "1:2000", "--margin", "5"]);
    // 390 m between the outermost samples: 195 mm, ten pixels each.
    assert_eq!(picture.dimensions(), (2050, 2050));
    let dark: Vec<(u32, u32)> =
        picture.enumerate_pixels().filter(|(.., p)| p.0[0] < 100).map(|(x, y, _)| (x, y)).collect();
    let (left, right) = (dark.iter().map(|at| at.0).min(), dark.iter().map(|at| at.0).max());
    assert!(
        left.is_some_and(|x| x.abs_diff(50) <= 2) && right.is_some_and(|x| x.abs_diff(1999) <= 2),
        "{left:?} {right:?}"
    );
    let report: Value = serde_json::from_slice(&fs::read(place.path("a.json")).expect("a file")).expect("JSON");
    assert_eq!((&report["scale"], &report["lines"]), (&serde_json::json!(2000.0), &serde_json::json!(2)));
    // Lower heights, the same plan.
    let first = fs::read(place.path("a.svg")).expect("a file");
    let text = fs::read_to_string(place.path("hill.asc")).expect("the DEM");
    let lower =
        |word: &str| word.parse::<f64>().ok().filter(|h| (0.001..100.0).contains(h)).map(|h| (h / 3.0).to_string());
    let (head, body) = text.split_at(text.find("-9999\n").expect("a header") + 6);
    let body: Vec<String> = body.split(' ').map(|word| lower(word).unwrap_or(word.to_owned())).collect();
    fs::write(place.path("hill.asc"), head.to_owned() + &body.join(" ")).expect("the DEM");
    assert_eq!(plan(&["--scale", "1:2000", "--margin", "5"]).0, first);
}

#[test]
fn every_style_draws_whole_rims() {
    let place = Place::new();
    fs::write(place.path("pens.toml"), "base = \"plotter\"\nplot.widths = [2.0]").expect("a style");
    let built_in = BuiltIn::ALL.map(|style| style.to_string());
    for style in built_in.iter().map(String::as_str).chain(["pens.toml"]) {
        let output = place.run(&[
            "draw",
            "hill.asc",
            "-o",
            "a.svg",
            "--plan",
            "--scale",
            "1:2000",
            "--margin",
            "0",
            "--creases",
            "none",
            "--style",
            style,
        ]);
        assert!(output.status.success(), "{}", stderr(&output));
        let svg = fs::read_to_string(place.path("a.svg")).expect("a file");
        assert_eq!(svg.matches("<path").count(), 2, "{style}: the border and a hole");
        assert_eq!(svg.matches("id=\"c").count(), 2, "{style}");
        assert_eq!(svg.matches("Z").count(), if svg.contains("fill=\"none\"") { 2 } else { 4 }, "{style}");
    }
}

#[test]
fn what_a_plan_cannot_have_is_refused_with_a_reason() {
    let place = Place::new();
    let with = |more: &[&'static str]| [&["draw", "hill.asc", "-o", "out.png"], more].concat();
    for (more, words) in [
        (
            &["--plan", "--scale", "1:2000", "--mask", "m.png"][..],
            "--mask: a mask is of what an eye sees, and a plan has none; leave out --mask or --plan",
        ),
        (&["--plan"], "--scale"),
        (&["--scale", "1:2000"], "--plan"),
        (&["--plan", "--scale", "2000"], "want 1:N"),
        (&["--plan", "--scale", "1:0"], "want 1:N"),
        (&["--plan", "--scale", "1:2000", "--azimuth", "4"], "--azimuth"),
        (&["--plan", "--scale", "1:2000", "--exaggeration", "2"], "--exaggeration"),
        (&["--plan", "--scale", "1:2000", "--page", "A4"], "--page"),
        (
            &["--plan", "--scale", "1:10"],
            "--scale: the DEM is 39000 x 39000 mm at 1:10, over 4980; use --scale 1:79 or a --crop",
        ),
        (
            &["--plan", "--scale", "1:900000"],
            "--scale: the DEM is 0.43 x 0.43 mm at 1:900000, under 10; use --scale 1:39000",
        ),
    ] {
        refuses(&place, &with(more), 2, words);
    }
    let margins = ["--plan", "--scale", "1:2000", "--margin", "2497"];
    refuses(&place, &with(&margins), 2, "--margin: margins of 2497 mm leave nothing of a page of 5000 mm");
}
