//! Sheets of a map join: creases and hachures run on from one to the next.

use std::fs;

use glam::DVec2;

use crate::cli::{Place, stderr};
use crate::tolerances::PEN_MM;

/// Millimetres of a sheet's side, and of its margin.
const SIDE: f64 = 40.0;
const MARGIN: f64 = 10.0;
/// South-western corners, km.
const SHEETS: [[u32; 2]; 4] = [[540, 4184], [544, 4184], [540, 4188], [544, 4188]];

/// Strokes of a layer of a drawing in the plotter's style, mm from the upper left corner of the map.
fn strokes(svg: &str, layer: &str) -> Vec<Vec<DVec2>> {
    let of_layer = svg.split("<g ").find(|group| group.contains(&format!(" {layer} "))).unwrap_or_default();
    let paths = of_layer.split(" d=\"").skip(1).filter_map(|path| path.split('"').next());
    let stroke = |path: &str| -> Vec<DVec2> {
        let numbers = path.split(|c: char| c.is_ascii_alphabetic() || c == ' ').filter_map(|text| text.parse().ok());
        numbers.collect::<Vec<f64>>().chunks_exact(2).map(|place| DVec2::from_slice(place) - MARGIN).collect()
    };
    paths.flat_map(|path| path.split('M')).map(stroke).collect()
}

/// Where strokes cross the line on which a coordinate, 0 or 1, has a value: the other.
fn crossings(strokes: &[Vec<DVec2>], coordinate: usize, at: f64) -> Vec<f64> {
    let crosses = |pair: &[DVec2]| {
        let [a, b] = [pair[0], pair[1]].map(|end| end[coordinate] - at);
        (a * b < 0.0).then(|| pair[0].lerp(pair[1], a / (a - b))[1 - coordinate])
    };
    strokes.iter().flat_map(|stroke| stroke.windows(2).filter_map(crosses)).collect()
}

#[test]
fn lines_run_on_from_sheet_to_sheet() {
    let place = Place::new();
    let dem = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("dem/golden-gate.tif");
    let text = format!(
        "[[drawing]]\ndem = {:?}\noutput = \"{{sheet}}.svg\"\nplan = true\nscale = \"1:100000\"\nstyle = \"plotter\"\n\
         creases = \"drainage,ridges\"\nhachures = \"lehmann\"\ncrop = \"540000,4184000,548000,4192000\"\n",
        dem.display()
    );
    fs::write(place.path("sheets.toml"), text).expect("a file");
    let output = place.run(&["batch", "sheets.toml", "--grid", "EPSG:32610", "--sheet", "4km"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let sheet =
        |[east, north]: [u32; 2]| fs::read_to_string(place.path(&format!("E{east}_N{north}.svg"))).expect("a sheet");
    for layer in ["drainage", "ridge", "hachure"] {
        let (mut all, mut joined, mut beside) = (0, 0, 0);
        for (from, to) in SHEETS.iter().flat_map(|from| SHEETS.iter().map(move |to| (*from, *to))) {
            // From the upper left corner of one to that of the other, mm.
            let way = DVec2::new(f64::from(to[0]) - f64::from(from[0]), f64::from(from[1]) - f64::from(to[1])) * 10.0;
            if way.length() != SIDE {
                continue;
            }
            let edge = usize::from(way.x == 0.0);
            let at = way[edge].max(0.0);
            let [here, there] =
                [(from, at), (to, SIDE - at)].map(|(corner, at)| crossings(&strokes(&sheet(corner), layer), edge, at));
            let goes_on = |own: f64| there.iter().any(|other| (own - other).abs() < PEN_MM / 2.0);
            all += here.len();
            joined += here.iter().filter(|own| goes_on(**own)).count();
            // Negative control: the neighbour lies beside its place.
            beside += here.iter().filter(|own| goes_on(**own + 3.0 * PEN_MM)).count();
        }
        println!("{layer}: {joined} of {all} go on at the edges, {beside} of a sheet beside its place");
        assert!(all >= 10 && joined == all, "{layer}: {joined} of {all}");
        assert!(beside < all / 2, "{layer}: {beside} of {all} were taken for joined");
    }
}
