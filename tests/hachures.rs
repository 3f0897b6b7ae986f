//! Hachures on maps: tone, and how strokes lie on the land.

mod bare;
mod map;
mod pops;
mod scales;
mod views;

use std::fs;

use glam::DVec2;
use hachure::dem::Dem;
use hachure::door::line::LandWay;
use hachure::door::line::hachures::{Viewer, hatched};
use hachure::geo::{ReadOptions, read};
use hachure::ink::HachureStyle;
use hachure::line::Chain;
use hachure::plan::{Hachures, Tone};
use rstar::RTree;
use rstar::primitives::{GeomWithData, Line};
use rustc_hash::FxHashMap;
use serde_json::Value;

use crate::cli::{Place, refuses, stderr};
use crate::common::shared_dems;
use crate::tolerances::{
    HACHURE_INK, HACHURE_INK_DARK, HACHURE_INK_LAND, HACHURES_APART, HACHURES_APART_SHARE, HACHURES_APART_SHARE_LAND,
};

use map::{Map, classes, lehmann};

const SIDE: usize = 161;
const CELL: f64 = 30.0;

/// Land by its height at metres east and south of its middle.
fn land(height: impl Fn(DVec2) -> f64) -> Dem {
    let at = |i: usize| (DVec2::new((i % SIDE) as f64, (i / SIDE) as f64) - 80.0) * CELL;
    let heights = (0..SIDE * SIDE).map(|i| height(at(i)) as f32).collect();
    Dem::from_heights(SIDE, DVec2::splat(CELL), DVec2::new(500_000.0, 4_000_000.0), heights)
}

/// A cone of one slope, degrees.
fn cone(slope: f64) -> Dem {
    land(|at| 5000.0 - at.length() * slope.to_radians().tan())
}

/// Whether classes of slopes, degrees, have the ink that they want.
fn are_as_wanted(name: &str, found: impl IntoIterator<Item = (f64, [f64; 3])>, most: f64) {
    let off = |(slope, [share, wanted, ink]): (f64, [f64; 3])| {
        println!("{name}, {slope} degrees: {share:.3} of the map, {wanted:.3} of it to be ink, {ink:.3} is");
        (ink - wanted).abs()
    };
    let worst = found.into_iter().map(off).fold(0.0, f64::max);
    assert!(worst <= most, "{name}: {worst} off");
}

#[test]
fn ink_is_as_the_slope_on_cones() {
    let slopes = [7.5, 12.5, 17.5, 22.5, 27.5, 32.5, 37.5, 42.5];
    let found =
        slopes.map(|slope| (slope, classes(&Map::new(cone(slope), 50_000.0, lehmann()))[(slope / 5.0) as usize]));
    are_as_wanted("cone", found.into_iter().filter(|(slope, _)| *slope < 40.0), HACHURE_INK);
    are_as_wanted("cone", found.into_iter().filter(|(slope, _)| *slope > 40.0), HACHURE_INK_DARK);
}

#[test]
fn strokes_of_a_cone_point_to_its_tip() {
    let map = Map::new(cone(25.0), 50_000.0, lehmann());
    let middle = DVec2::new(map.overhead.size[0].into(), map.overhead.size[1].into()) / 2.0;
    assert!(map.strokes.len() > 100);
    for pair in map.strokes.iter().flat_map(|chain| chain.points.windows(2)) {
        let (way, from) = (pair[1].place - pair[0].place, pair[0].place - middle);
        let off = way.angle_to(from).abs().to_degrees();
        assert!(way.length() < 1e-6 || from.length() < 30.0 || off < 5.0, "{off} degrees at {:?}", pair[0].place);
    }
}

#[test]
fn a_plain_has_no_hachures() {
    assert!(Map::new(land(|at| at.x * 0.02), 50_000.0, lehmann()).strokes.is_empty());
}

#[test]
fn shadow_begins_where_light_is_less_than_on_level_land() {
    let dome = || land(|at| (9e6 - at.length_squared()).max(1e6).sqrt());
    let map = Map::new(dome(), 50_000.0, HachureStyle { tone: Tone::Shadow, ..HachureStyle::default() });
    // Light from the north-west, 45 degrees up.
    let light = glam::DVec3::new(-0.5, 0.5, 0.5_f64.sqrt());
    let lit = |place: DVec2| {
        let gradient = map.gradient(place)?;
        Some((-gradient).extend(1.0).normalize().dot(light) / light.z)
    };
    let drawn = map.strokes.iter().flat_map(|chain| &chain.points).filter(|point| point.weight > 0.0);
    let drawn: Vec<DVec2> = drawn.map(|point| point.place).collect();
    assert!(drawn.len() > 100);
    let wrong = drawn.iter().filter(|place| lit(**place).is_some_and(|lit| lit > 1.02)).count();
    assert_eq!(wrong, 0, "of {} places are in the light", drawn.len());
    let tree = RTree::bulk_load(drawn.iter().map(|place| place.to_array()).collect());
    let middle = DVec2::new(map.overhead.size[0].into(), map.overhead.size[1].into()) / 2.0;
    // Half way down the side that is turned away, and of that to the light.
    for (turn, is_dark) in [(DVec2::new(1.0, 1.0), true), (DVec2::new(-1.0, -1.0), false)] {
        let place = middle + turn.normalize() * 1600.0 * map.overhead.px_per_metre;
        let nearest = tree.nearest_neighbor(place.to_array()).map(|near| DVec2::from(*near).distance(place));
        assert_eq!(nearest.is_some_and(|far| far < 1.5 * map.look.spacing), is_dark, "{turn}: {nearest:?}");
    }
}

/// The places of a map's lines and how strongly each is shown, lines never cut.
fn shown(map: &Map, black_at: f64) -> FxHashMap<[u64; 2], f32> {
    let look = Hachures { black_at, length: 1e9, ..map.look };
    let ways = hatched(map.slopes(), &look, Viewer::Above(&map.overhead)).expect("lines").ways;
    let places = |way: &LandWay| {
        way.points.iter().map(|point| (point.at.to_array().map(f64::to_bits), point.weight)).collect::<Vec<_>>()
    };
    ways.iter().flat_map(places).collect()
}

#[test]
fn strokes_of_a_tone_are_among_those_of_a_darker_one() {
    let map = Map::new(read("dem/golden-gate.tif", &ReadOptions::default()).expect("the sample"), 150_000.0, lehmann());
    let [dark, light] = [30.0, 80.0].map(|black_at| shown(&map, black_at));
    let drawn = light.iter().filter(|(_, weight)| **weight > 0.0);
    let lost = drawn.clone().filter(|(place, _)| dark.get(*place).is_none_or(|weight| *weight == 0.0)).count();
    assert_eq!(lost, 0, "of {} places", drawn.count());
    assert!(dark.len() > light.len() * 5 / 4, "{} and {}", dark.len(), light.len());
}

/// Strokes under this share of their pen are hardly seen.
const SEEN: f32 = 0.1;

type Piece = GeomWithData<Line<[f64; 2]>, usize>;

/// Distances on the page from the middles of strokes to the nearest other stroke, in spacings that the tone wants.
fn apart(map: &Map) -> Vec<f64> {
    let pieces = |(i, chain): (usize, &Chain)| {
        let steps = chain.points.windows(2).filter(|pair| pair[0].weight > SEEN || pair[1].weight > SEEN);
        steps.map(|pair| Piece::new(Line::new(pair[0].place.into(), pair[1].place.into()), i)).collect::<Vec<_>>()
    };
    let tree = RTree::bulk_load(map.strokes.iter().enumerate().flat_map(pieces).collect());
    let nearest = |(i, chain): (usize, &Chain)| {
        let middle = chain.points[chain.points.len() / 2];
        let wanted = map.look.apart(middle.black.into());
        let near = tree.nearest_neighbor_iter(middle.place.to_array()).find(|piece| piece.data != i)?;
        let far = rstar::PointDistance::distance_2(near, &middle.place.to_array()).sqrt();
        (middle.weight > SEEN && chain.length() > 2.0 * wanted).then_some(far / wanted)
    };
    map.strokes.iter().enumerate().filter_map(nearest).collect()
}

fn are_apart(name: &str, map: &Map, least: f64) {
    let mut apart = apart(map);
    apart.sort_by(f64::total_cmp);
    let [low, half, high] = [0.05, 0.5, 0.95].map(|share| apart[(share * apart.len() as f64) as usize]);
    let within = apart.iter().filter(|apart| (HACHURES_APART[0]..=HACHURES_APART[1]).contains(*apart)).count();
    let share = within as f64 / apart.len() as f64;
    println!(
        "{name}: {} strokes, 5 % {low:.2} spacings apart, half {half:.2}, 95 % {high:.2}; {share:.3} within",
        apart.len()
    );
    assert!(share >= least, "{name}: {share}");
}

#[test]
fn strokes_are_as_far_apart_as_wanted() {
    are_apart("plane", &Map::new(land(|at| at.x * 0.4 + at.y * 0.1), 50_000.0, lehmann()), HACHURES_APART_SHARE);
    let sample = read("dem/golden-gate.tif", &ReadOptions::default()).expect("the sample");
    are_apart("sample", &Map::new(sample, 100_000.0, lehmann()), HACHURES_APART_SHARE_LAND);
}

#[test]
fn ink_is_as_the_slope_on_real_land() {
    let mut maps = vec![(
        "sample",
        Map::new(read("dem/golden-gate.tif", &ReadOptions::default()).expect("the sample"), 100_000.0, lehmann()),
    )];
    let shared = [("west-temple", "west_temple_50m.tif", 50_000.0), ("yosemite", "yosemite_utm11n_30m.tif", 100_000.0)];
    if let Some(folder) = shared_dems() {
        maps.extend(shared.map(|(name, file, scale)| {
            let dem = read(folder.join(file), &ReadOptions::default()).expect("a DEM");
            (name, Map::new(dem, scale, lehmann()))
        }));
    }
    for (name, map) in maps {
        let classes = classes(&map).into_iter().enumerate().skip(1).filter(|(_, found)| found[0] > 0.01);
        are_as_wanted(name, classes.map(|(class, found)| (class as f64 * 5.0 + 2.5, found)), HACHURE_INK_LAND);
    }
}

/// The layers of a drawing of the hill.
fn layers(arguments: &[&str]) -> Vec<String> {
    let place = Place::new();
    let output = place.run(&[&["draw", "hill.asc", "-o", "a.svg", "--json", "a.json"], arguments].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let report: Value = serde_json::from_slice(&fs::read(place.path("a.json")).expect("a report")).expect("JSON");
    let layers = report["layers"].as_array().expect("layers");
    layers.iter().map(|layer| layer["name"].as_str().expect("a name").to_owned()).collect()
}

#[test]
fn hachures_are_a_layer_of_views_and_plans() {
    let has = |arguments: &[&str]| layers(arguments).iter().any(|name| name == "1 hachure");
    for view in [&["--size", "160x120"][..], &["--plan", "--scale", "1:2000"]] {
        for (tone, is_drawn) in [("lehmann", true), ("shadow", true), ("both", true), ("none", false)] {
            assert_eq!(has(&[view, &["--hachures", tone]].concat()), is_drawn, "{view:?} {tone}");
        }
    }
}

#[test]
fn hachures_of_a_style_that_a_method_does_not_draw_are_told() {
    let told = |arguments: &[&str]| {
        let place = Place::new();
        // The style's own, not the tests'.
        let mut command = place.command(&[]);
        let view = ["draw", "hill.asc", "-o", "a.png", "--size", "64x48", "--method", "adjacency"];
        let output = command.args([&view[..], arguments].concat()).output().expect("the program");
        assert!(output.status.success(), "{}", stderr(&output));
        stderr(&output).lines().filter(|line| line.contains("left out: ")).map(str::to_owned).collect::<Vec<_>>()
    };
    let words = "they go with contours only; leave out --method, or add";
    assert_eq!(told(&[]), [format!("warning: the style's hachures are left out: {words} --hachures none")]);
    let both = format!(
        "warning: the style's drainage, ridges and hachures are left out: {words} --creases none --hachures none"
    );
    assert_eq!(told(&["--style", "woodcut"]), [both]);
    assert_eq!(told(&["--hachures", "none"]), Vec::<String>::new());
}

#[test]
fn hachures_want_contours() {
    let traced = ["draw", "hill.asc", "-o", "a.png", "--method", "adjacency", "--hachures", "both"];
    refuses(&Place::new(), &traced, 2, "--hachures: goes with contours only");
}
