//! Shores of flat water: circles that are known, coasts, plains that are no lakes, and what files do to level water.

use std::collections::HashMap;
use std::f64::consts::TAU;

use gdal::DriverManager;
use gdal::raster::Buffer;
use gdal::spatial_ref::SpatialRef;
use glam::DVec2;
use hachure::cache::{Cache, CacheObserver};
use hachure::dem::{Crs, Dem};
use hachure::geo::{ReadOptions, read};
use hachure::relief::{LineKind, Shores, SurfaceLine};

use crate::common::shared_dems;
use crate::flights::{folder, sample};

const SIDE: usize = 200;
/// Cells that a shore may lie from where land and water meet.
const OFF: f64 = 0.3;

/// Cells of 10 m.
fn dem(height: impl Fn(DVec2) -> f64) -> Dem {
    let at = |i: usize| DVec2::new((i % SIDE) as f64, (i / SIDE) as f64);
    let heights = (0..SIDE * SIDE).map(|i| height(at(i)) as f32).collect();
    Dem::from_heights(SIDE, DVec2::splat(10.0), DVec2::ZERO, heights)
}

fn shores(dem: &Dem) -> Shores {
    let shores = Shores::of(dem, 1.0).expect("a held DEM");
    check(&shores, dem);
    shores
}

fn places(line: &SurfaceLine) -> Vec<DVec2> {
    line.points.iter().map(|point| point.at).collect()
}

/// What holds of all shores: each point lies on the side of a cell, between water and land; two pieces of line in one cell do
/// not cross, and each is in one cell.
fn check(shores: &Shores, dem: &Dem) {
    let mut in_cells: HashMap<[u64; 2], Vec<[DVec2; 2]>> = HashMap::new();
    for line in &shores.lines {
        let at = places(line);
        for place in &at {
            let [low, high] = [place.floor(), place.ceil()];
            assert_eq!((high - low).element_sum(), 1.0, "{place} lies on no side of a cell");
            let [a, b] = [low, high].map(|end| shores.water.is_water(end.x as usize, end.y as usize));
            assert!(a != b, "{place} is not between water and land");
        }
        let count = if line.closed { at.len() } else { at.len() - 1 };
        let mut length = 0.0;
        for i in 0..count {
            let edge = [at[i], at[(i + 1) % at.len()]];
            assert!(edge[0] != edge[1]);
            let cell = ((edge[0] + edge[1]) / 2.0).floor();
            assert!(
                edge.iter().all(|end| (*end - cell).cmpge(DVec2::ZERO).all() && (*end - cell).cmple(DVec2::ONE).all())
            );
            in_cells.entry([cell.x as u64, cell.y as u64]).or_default().push(edge);
            length += ((edge[1] - edge[0]) * dem.cell()).length();
        }
        assert!(line.kind == LineKind::Shore && line.order == 1 && line.joins.is_none());
        let same = |point: &hachure::relief::SurfacePoint| {
            point.across == [f32::INFINITY; 3]
                && point.drop == f32::INFINITY
                && (f64::from(point.length) / length - 1.0).abs() < 1e-6
        };
        assert!(line.points.iter().all(same), "{length} m");
    }
    for edges in in_cells.values() {
        for (i, one) in edges.iter().enumerate() {
            assert!(edges[..i].iter().all(|other| !cross(*one, *other)), "{edges:?}");
        }
    }
}

fn cross([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let side = |from: DVec2, to: DVec2, place: DVec2| (to - from).perp_dot(place - from);
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

#[test]
fn lines_that_cross_are_noticed() {
    let line = |x0, y0, x1, y1| [DVec2::new(x0, y0), DVec2::new(x1, y1)];
    assert!(cross(line(0.0, 0.5, 1.0, 0.5), line(0.5, 0.0, 0.5, 1.0)));
    assert!(!cross(line(0.0, 0.5, 0.5, 0.0), line(0.5, 1.0, 1.0, 0.5)));
}

/// The greatest distance from a circle, cells, and the greatest turn away from it, degrees, over at least a cell and a half.
fn off_circle(line: &SurfaceLine, centre: DVec2, radius: f64) -> [f64; 2] {
    let at = places(line);
    let away = at.iter().map(|place| (place.distance(centre) - radius).abs()).fold(0.0, f64::max);
    let turn = |i: usize| {
        let next =
            (1..at.len()).map(|k| at[(i + k) % at.len()]).find(|next| next.distance(at[i]) > 1.5).expect("a circle");
        let (run, out) = (next - at[i], (at[i] + next) / 2.0 - centre);
        (run.dot(out) / (run.length() * out.length())).asin().to_degrees().abs()
    };
    [away, (0..at.len()).map(turn).fold(0.0, f64::max)]
}

#[test]
fn lakes_and_islands_have_their_circles() {
    let (lake, island) = (DVec2::new(100.3, 97.6), DVec2::new(112.4, 105.1));
    for (radius, slope) in [(40.37, 0.02), (41.5, 0.2), (55.0, 1.0)] {
        let dem = dem(|place| {
            let inland = (place.distance(lake) - radius).max(12.2 - place.distance(island)).max(0.0);
            480.0 + inland * 10.0 * slope
        });
        let found = shores(&dem);
        assert_eq!(found.lines.len(), 2, "{radius}, {slope}");
        for (centre, radius) in [(lake, radius), (island, 12.2)] {
            let line = found.lines.iter().find(|line| off_circle(line, centre, radius)[0] < 3.0).expect("a circle");
            let [away, turn] = off_circle(line, centre, radius);
            println!("radius {radius}, slope {slope}: {away:.3} cells, {turn:.1} degrees off");
            assert!(line.closed && away < OFF && turn < 8.0, "{away} cells, {turn} degrees");
            assert!(off_circle(line, centre + DVec2::X, radius)[0] > OFF, "a shore a cell away is noticed");
            let length = f64::from(line.points[0].length);
            assert!((length / (TAU * radius * 10.0) - 1.0).abs() < 0.01, "{length} m");
        }
        // Where the land hardly rises above a sample, its height says nothing.
        let inland = |i: usize| {
            let place = DVec2::new((i % SIDE) as f64, (i / SIDE) as f64);
            (place.distance(lake) - radius).max(12.2 - place.distance(island))
        };
        let is_right =
            |i: &usize| inland(*i).abs() < 0.1 || found.water.is_water(i % SIDE, i / SIDE) == (inland(*i) < 0.0);
        let wrong = (0..SIDE * SIDE).filter(|i| !is_right(i)).count();
        assert_eq!(wrong, 0, "samples of water");
    }
}

#[test]
fn exaggeration_changes_no_shore() {
    let height = |place: DVec2| {
        480.0 + ((place.distance(DVec2::splat(99.7)) - 50.0) * 3.0).max(0.0) - if place.x > 100.0 { 0.25 } else { 0.0 }
    };
    let (plain, tripled) = (shores(&dem(height)), Shores::of(&dem(|place| 3.0 * height(place)), 3.0).expect("shores"));
    assert_eq!(plain.water, tripled.water);
    let far = plain.lines.iter().zip(&tripled.lines).flat_map(|(a, b)| places(a).into_iter().zip(places(b)));
    assert!(far.map(|(a, b)| a.distance(b)).fold(0.0, f64::max) < 1e-3 && plain.lines.len() == tripled.lines.len());
}

#[test]
fn water_of_several_decimetres_is_one() {
    // Two sheets of a map that differ by half a metre, with a seam of two samples between.
    let centre = DVec2::new(100.2, 99.9);
    let level = |x: f64| 480.0 - 0.5 * ((x - 110.0) / 3.0).clamp(0.0, 1.0);
    let steps = |height: f64| (height * 16.0).round() / 16.0;
    let dem = dem(|place| steps(level(place.x) + ((place.distance(centre) - 60.5) * 2.5).max(0.0)));
    let found = shores(&dem);
    assert!(found.lines.len() == 1 && found.lines[0].closed);
    assert!(off_circle(&found.lines[0], centre, 60.5)[0] < OFF + 0.1);
}

#[test]
fn plains_and_slopes_are_no_lakes() {
    let none = |height: &dyn Fn(DVec2) -> f64| {
        let found = shores(&dem(height));
        assert!(found.lines.is_empty() && found.water.count() == 0, "{} lines", found.lines.len());
    };
    none(&|_| 12.0);
    none(&|place| 12.0 + (place.x - 90.0).max(0.0) - (60.0 - place.x).max(0.0));
    none(&|place| ((place.x * 0.011 + place.y * 0.007) * 16.0).floor() / 16.0);
    none(&|place| 300.0 + (place.x / 31.0).sin() + (place.y / 23.0).cos() + 0.02 * place.x);
    // A bench of three samples.
    none(&|place| {
        if (place.x - 100.0).abs() < 2.0 && (place.y - 100.0).abs() < 30.0 { 50.0 } else { 50.0 + 0.001 * place.y }
    });
}

#[test]
fn coasts_end_where_the_dem_does() {
    let coast = |x: f64| 110.3 + 6.0 * (x / 17.0).sin();
    let height = |place: DVec2| ((coast(place.x) - place.y) * 4.0).max(0.0);
    let found = shores(&dem(height));
    assert_eq!(found.lines.len(), 1);
    let at = places(&found.lines[0]);
    let mut ends = [at[0].x, at[at.len() - 1].x];
    ends.sort_by(f64::total_cmp);
    assert_eq!((ends, found.lines[0].closed), ([0.0, (SIDE - 1) as f64], false));
    assert!(at.iter().all(|place| (place.y - coast(place.x)).abs() < OFF + 0.05));
    // Of a sea that is no data there is a rim, no shore.
    let none = shores(&dem(|place| if height(place) > 0.0 { height(place) } else { f64::NAN }));
    assert!(none.lines.is_empty() && none.water.count() == 0);
    assert!(found.water.is_water(3, 199) && !found.water.is_water(3, 3) && !found.water.is_water(200, 199));
    assert!(!found.water.is_water(3, 200));
}

#[test]
fn shores_end_at_voids() {
    let centre = DVec2::splat(99.6);
    let height =
        |place: DVec2| if place.x > 120.5 { f64::NAN } else { 480.0 + (place.distance(centre) - 50.2).max(0.0) };
    let found = shores(&dem(height));
    assert_eq!(found.lines.len(), 1);
    let at = places(&found.lines[0]);
    let ends = [at[0], at[at.len() - 1]];
    assert!(!found.lines[0].closed && ends.iter().all(|end| end.x > 119.0 && end.x <= 120.0), "{ends:?}");
    assert!(at.iter().all(|place| (place.distance(centre) - 50.2).abs() < OFF));
}

#[test]
fn what_is_smaller_than_a_few_cells_is_left_out() {
    let lake = DVec2::splat(100.0);
    let rock = |place: DVec2| place.distance(DVec2::splat(105.0)) < 1.2;
    let found = shores(&dem(|place| if rock(place) { 495.0 } else { 480.0 + (place.distance(lake) - 40.0).max(0.0) }));
    assert!(found.lines.len() == 1 && !found.water.is_water(105, 105));
    let pond = shores(&dem(|place| 480.0 + (place.distance(lake) - 4.0).max(0.0)));
    assert!(pond.lines.is_empty() && pond.water.count() == 0);
}

#[test]
fn lakes_of_warped_dems_have_their_circles() {
    let folder = folder();
    let path = folder.path().join("lake.tif");
    // Seconds of arc; a lake at 431 m amid banks of 15 and 60 %.
    let (side, second) = (300_usize, 1.0 / 3600.0);
    let transform = [8.0, second, 0.0, 46.5, 0.0, -second];
    let (centre, radius) = (DVec2::new(150.3, 147.8), 81.4);
    let height = |i: usize| {
        let place = DVec2::new((i % side) as f64, (i / side) as f64);
        let out = place - centre;
        let slope = 10.0 - 6.0 * out.x / out.length();
        (431.0 + (out.length() - radius).max(0.0) * slope) as f32
    };
    let driver = DriverManager::get_driver_by_name("GTiff").expect("a driver");
    let mut file = driver.create_with_band_type::<f32, _>(&path, side, side, 1).expect("a file");
    file.set_geo_transform(&transform).expect("a place");
    file.set_spatial_ref(&SpatialRef::from_epsg(4326).expect("a system")).expect("a system");
    let mut buffer = Buffer::new((side, side), (0..side * side).map(height).collect());
    file.rasterband(1).expect("a band").write((0, 0), (side, side), &mut buffer).expect("samples");
    file.close().expect("a file");
    let dem = read(&path, &ReadOptions::default()).expect("a DEM");
    let found = shores(&dem);
    assert_eq!(found.lines.len(), 1);
    let globe = Crs::lonlat().expect("a register");
    let [west, .., north] = dem.extent();
    let in_file = |place: DVec2| {
        let world = DVec2::new(west, north) + place * dem.cell() * DVec2::new(1.0, -1.0);
        let degrees = dem.georeference().place_in(&globe, world).expect("a place");
        DVec2::new(degrees.x - transform[0], transform[3] - degrees.y) / second - 0.5
    };
    let away = places(&found.lines[0]).into_iter().map(|place| (in_file(place).distance(centre) - radius).abs());
    let mut away: Vec<f64> = away.collect();
    away.sort_by(f64::total_cmp);
    let (most, all) = (away[away.len() * 19 / 20], away[away.len() - 1]);
    println!("{most:.3} cells of the file, {all:.3} at most");
    // A cell of one grid is up to 1.2 of the other's, and waves may take a sample of the shore.
    assert!(found.lines[0].closed && most < 0.4 && all < 0.9, "{most} cells of the file, {all} at most");
}

#[test]
fn dems_that_stay_in_their_files_have_the_shores_of_held_ones() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/dem/golden-gate.tif");
    let filed = read(path, &ReadOptions { memory: 1 << 16, ..Default::default() }).expect("the sample");
    assert!(filed.is_filed());
    let held = shores(sample().dem());
    let folder = folder();
    let cache = Cache::in_folder(folder.path().to_owned());
    let hearing = CacheObserver { warn: &|_| panic!("nothing to say"), progress: &|_| () };
    for cache in [Cache::none(), cache.clone(), cache] {
        assert_eq!(cache.shores(&filed, 1.0, hearing).expect("shores"), held);
    }
    let kept = std::fs::read_dir(folder.path()).expect("a folder").map(|entry| entry.expect("an entry").file_name());
    assert_eq!(kept.filter(|name| name.to_string_lossy().starts_with("creases-")).count(), 1);
}

/// How far the most of some places, 95 %, are from the nearest of others, samples.
fn off(places: &[DVec2], others: &[DVec2]) -> f64 {
    let nearest = |place: &DVec2| others.iter().map(|other| other.distance(*place)).fold(f64::INFINITY, f64::min);
    let mut off: Vec<f64> = places.iter().map(nearest).collect();
    off.sort_by(f64::total_cmp);
    off[off.len() * 19 / 20]
}

fn all_places(shores: &Shores) -> Vec<DVec2> {
    shores.lines.iter().flat_map(places).collect()
}

#[test]
fn on_blocks_shores_run_where_half_of_the_ground_is_water() {
    let (centre, radius) = (DVec2::new(97.3, 104.6), 61.4);
    let depth = |place: DVec2| place.distance(centre) - radius;
    // A lake at 20 m in land that rises from it; with a seam of two decimetres through it and samples here and there a decimetre low;
    // with a void beside it; above a plain that is level and lower.
    let lake = |place: DVec2| 20.0 + (0.4 * depth(place)).max(0.0);
    let patched = |place: DVec2| {
        let is_low = (7919.0 * place.x + 104_729.0 * place.y) % 97.0 < 1.0;
        let seam = if place.x > 90.0 { 0.2 } else { 0.0 };
        lake(place) + if depth(place) < 0.0 { seam - if is_low { 0.1 } else { 0.0 } } else { 0.0 }
    };
    let above = |place: DVec2| if place.y > 180.0 { 12.0 } else { lake(place) };
    for (name, dem) in [("lake", dem(lake)), ("patched", dem(patched)), ("above a plain", dem(above))] {
        for side in [2, 4, 8] {
            let found = Shores::on_blocks(&dem, 1.0, side, &|_| ()).expect("shores");
            let of_lake: Vec<_> = found.lines.iter().filter(|line| line.closed).collect();
            assert!(of_lake.len() == 1, "{name}, blocks of {side}: {} rims", of_lake.len());
            let mut off: Vec<f64> = places(of_lake[0]).into_iter().map(|place| depth(place).abs()).collect();
            off.sort_by(f64::total_cmp);
            let (most, all) = (off[off.len() * 19 / 20], off[off.len() - 1]);
            println!("{name}, blocks of {side}: {most:.2} samples off, {all:.2} at most");
            let limits = if name == "patched" { [0.6, 1.0] } else { [0.3, 0.5] }.map(|blocks| blocks * side as f64);
            assert!(most <= limits[0] && all <= limits[1], "{name}, blocks of {side}: {most}, {all}");
            assert!(found.water.is_water(97, 104) && !found.water.is_water(97, 104 + 61 + 2 * side), "{name}");
        }
    }
    let one = Shores::on_blocks(&dem(lake), 1.0, 1, &|_| ()).expect("shores");
    assert_eq!(one, shores(&dem(lake)));
}

#[test]
fn on_blocks_of_a_file_the_bay_has_its_shores() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/dem/golden-gate.tif");
    let filed = read(path, &ReadOptions { memory: 1 << 16, exaggeration: 2.0, ..Default::default() }).expect("it");
    let held = all_places(&shores(sample().dem()));
    // 500 samples are 62 blocks of 8 and a half.
    for side in [4, 8] {
        let found = Shores::on_blocks(&filed, 2.0, side, &|_| ()).expect("shores");
        let at = all_places(&found);
        let (right, whole) = (off(&at, &held) / side as f64, off(&held, &at) / side as f64);
        println!("blocks of {side}: lines {right:.2} blocks off, held ones {whole:.2}");
        assert!(right < 1.0 && whole < 2.5, "blocks of {side}: {right}, {whole}");
        assert!(at.iter().all(|place| place.cmpge(DVec2::ZERO).all() && place.cmple(DVec2::splat(499.0)).all()));
        let share = (0..250_000).filter(|i| found.water.is_water(i % 500, i / 500)).count() as f64 / 250_000.0;
        assert!((0.49..0.54).contains(&share), "{share} of it is sea");
    }
}

#[test]
fn the_sample_has_its_bay_and_its_islands() {
    let dem = sample().dem();
    let found = shores(dem);
    let share = found.water.count() as f64 / 250_000.0;
    assert!((0.5..0.53).contains(&share), "{share} of it is sea");
    // Angel Island and Alcatraz.
    let closed: Vec<f32> = found.lines.iter().filter(|line| line.closed).map(|line| line.points[0].length).collect();
    assert!(closed.iter().any(|length| (8000.0..12_000.0).contains(length)), "{closed:?}");
    assert!(closed.iter().any(|length| (1000.0..2000.0).contains(length)), "{closed:?}");
    assert!(found.lines.len() < 12, "{}", found.lines.len());
}

#[test]
fn a_plain_of_lava_has_few_lakes() {
    let Some(folder) = shared_dems() else { return };
    let dem = read(folder.join("inl_idaho_feet.tif"), &ReadOptions::default()).expect("a DEM");
    let found = shores(&dem);
    println!("{} lines, {} samples of water", found.lines.len(), found.water.count());
    assert!((5..20).contains(&found.lines.len()), "{} lines", found.lines.len());
}

#[test]
fn spirit_lake_is_one() {
    let Some(folder) = shared_dems() else { return };
    let dem = read(folder.join("sthelens_utm10n_10m.tif"), &ReadOptions::default()).expect("a DEM");
    let found = shores(&dem);
    let longest = found.lines.iter().max_by(|a, b| a.points[0].length.total_cmp(&b.points[0].length)).expect("shores");
    let at = places(longest);
    let area = (0..at.len()).map(|i| at[i].perp_dot(at[(i + 1) % at.len()])).sum::<f64>().abs() / 2.0 * 1e-4;
    println!("{} lines; the longest is {} m about {area} km2", found.lines.len(), longest.points[0].length);
    assert!(longest.closed && (10.0..11.5).contains(&area) && found.lines.len() < 25);
}
