//! Lines on the map: read back, they lie on the surface, in the right system, with what is known of them; the same bytes again; and
//! what is refused.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use gdal::raster::Buffer;
use gdal::spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef};
use gdal::vector::LayerAccess;
use gdal::{Dataset, DriverManager};
use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::door::surface::LatticePoint;
use hachure::geo::{ReadOptions, read};
use hachure::surface::{Level, Surface};

use crate::cli::{Place, refuses, stderr};
use crate::tolerances::{MAPPED_CELLS, MAPPED_DEGREES};

/// What is as close to the surface lies on it, metres.
const CLOSE: f64 = 0.05;
/// Samples along a side of made land.
const SIDE: usize = 70;

/// A line as it was read back.
struct Read {
    kind: String,
    id: Option<String>,
    order: Option<i32>,
    depth: f64,
    length: f64,
    points: Vec<DVec3>,
}

/// Hills and a valley, in a file of a system with this transform.
fn land(path: &Path, epsg: u32, transform: [f64; 6]) {
    // The first call takes drivers from GDAL; no other thread may be using it meanwhile.
    let _ = read(Path::new(""), &ReadOptions::default());
    let height = |i: usize| {
        let (x, y) = ((i % SIDE) as f64, (i / SIDE) as f64);
        (260.0 + 60.0 * (x / 4.0).sin() * (y / 5.0).cos() + 3.0 * y + 6.0 * (x * 1.7).sin()) as f32
    };
    let driver = DriverManager::get_driver_by_name("GTiff").expect("a driver");
    let mut file = driver.create_with_band_type::<f32, _>(path, SIDE, SIDE, 1).expect("a file");
    file.set_geo_transform(&transform).expect("a place");
    file.set_spatial_ref(&SpatialRef::from_epsg(epsg).expect("a CRS")).expect("a CRS");
    let mut samples = Buffer::new((SIDE, SIDE), (0..SIDE * SIDE).map(height).collect());
    file.rasterband(1).expect("a band").write((0, 0), (SIDE, SIDE), &mut samples).expect("samples");
    file.close().expect("a file");
}

/// The lines of a file. Words that its format does not read back are empty.
fn lines(path: &Path) -> Vec<Read> {
    let file = Dataset::open(path).expect("a file");
    let mut layer = file.layer(0).expect("a layer");
    assert_eq!(layer.name(), "lines");
    let index = |name: &str| layer.defn().field_index(name).ok();
    let fields = ["kind", "id", "order", "depth", "length"].map(index);
    let of = |feature: gdal::vector::Feature| {
        let geometry = feature.geometry().expect("a line");
        let point = |i: usize| DVec3::from(geometry.get_point(i as i32));
        let text = |field: usize| fields[field].and_then(|i| feature.field_as_string(i).ok().flatten());
        let number = |field: usize| fields[field].and_then(|i| feature.field_as_double(i).ok().flatten());
        Read {
            kind: text(0).unwrap_or_default(),
            id: text(1),
            order: fields[2].and_then(|i| feature.field_as_integer(i).ok().flatten()),
            depth: number(3).unwrap_or(f64::NAN),
            length: number(4).unwrap_or(f64::NAN),
            points: (0..geometry.point_count()).map(point).collect(),
        }
    };
    layer.features().map(of).collect()
}

fn draw(place: &Place, flags: &[&str]) {
    let output =
        place.run(&[&["draw", "land.tif", "--keep-steps", "-o", "out.svg", "--size", "480x320"], flags].concat());
    assert!(output.status.success(), "{flags:?}: {}", stderr(&output));
}

fn surface(place: &Place) -> Surface {
    let options = ReadOptions { keep_steps: true, ..ReadOptions::default() };
    Surface::new(read(place.path("land.tif"), &options).expect("the land"))
}

/// The rim of a DEM without voids, lattice step by lattice step.
fn rim(surface: &Surface) -> Vec<DVec3> {
    let [right, bottom] = [surface.dem().columns(), surface.dem().rows()].map(|samples| (samples as u32 - 1) * 64);
    let sides = [[0, 0], [right, 0], [right, bottom], [0, bottom], [0, 0]];
    let side = |pair: &[[u32; 2]]| {
        let ([x0, y0], [x1, y1]) = (pair[0], pair[1]);
        let steps = x0.abs_diff(x1).max(y0.abs_diff(y1));
        let at = |a: u32, b: u32, i: u32| a + (b.max(a) - a) / steps * i - (a.max(b) - b) / steps * i;
        (0..steps).map(move |i| LatticePoint { x: at(x0, x1, i), y: at(y0, y1, i) }).collect::<Vec<_>>()
    };
    let places = sides.windows(2).flat_map(side);
    places.map(|at| surface.position(at).expect("no void")).collect()
}

/// How far a line leaves the surface, its points and the places between them, in cells: up and down, or at the rim any way.
fn leaves(surface: &Surface, rim: &[DVec3], points: &[DVec3]) -> f64 {
    let level = Level::new(16).expect("a level");
    let off_rim = |place: DVec3| {
        let pairs = rim.iter().zip(rim.iter().cycle().skip(1));
        let off = |(a, b): (&DVec3, &DVec3)| {
            let share = ((place - *a).dot(*b - *a) / a.distance_squared(*b)).clamp(0.0, 1.0);
            a.lerp(*b, share).distance(place)
        };
        pairs.map(off).fold(f64::INFINITY, f64::min)
    };
    let off = |place: DVec3| match surface.height_below(place.truncate(), level) {
        // At the rim patches bend inwards and outwards.
        None => off_rim(place),
        Some(height) if (height - place.z).abs() < CLOSE => (height - place.z).abs(),
        Some(height) => (height - place.z).abs().min(off_rim(place)),
    };
    let between = points.windows(2).flat_map(|pair| [pair[0], pair[0].lerp(pair[1], 0.31), pair[0].lerp(pair[1], 0.5)]);
    between.map(off).fold(0.0, f64::max) / surface.dem().cell().min_element()
}

/// Of many lines some, of each kind.
fn some(lines: &[Read]) -> Vec<&Read> {
    let mut taken: Vec<&Read> = Vec::new();
    for line in lines {
        let count = taken.iter().filter(|other| other.kind == line.kind).count();
        if count < 4 {
            taken.push(line);
        }
    }
    taken
}

/// Checks lines on the world of a DEM; tells the kinds.
fn check(surface: &Surface, lines: &[Read], to_world: impl Fn(DVec2) -> DVec2) -> BTreeSet<String> {
    let rim = rim(surface);
    for line in some(lines) {
        let world: Vec<DVec3> = line.points.iter().map(|at| to_world(at.truncate()).extend(at.z)).collect();
        let stride = (world.len() / 12).max(1);
        let parts: Vec<&[DVec3]> = world.windows(3).step_by(stride).collect();
        let worst = parts.iter().map(|part| leaves(surface, &rim, part)).fold(0.0, f64::max);
        assert!(worst < MAPPED_CELLS, "{} {:?} leaves the surface by {worst} cells", line.kind, line.id);
        let length: f64 = world.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        assert!((length - line.length).abs() < 1e-3 * length + 0.01, "{length}: {}", line.length);
    }
    // The check sees a line that is .02 cells too high.
    let first = &lines.iter().find(|line| line.kind == "silhouette").expect("a silhouette").points;
    let raised: Vec<DVec3> = first[..3]
        .iter()
        .map(|at| to_world(at.truncate()).extend(at.z + 2.0 * MAPPED_CELLS * surface.dem().cell().min_element()))
        .collect();
    assert!(leaves(surface, &rim, &raised) > MAPPED_CELLS);
    lines.iter().map(|line| line.kind.clone()).collect()
}

const UTM: (u32, [f64; 6]) = (32632, [560_000.0, 25.0, 0.0, 5_540_000.0, 0.0, -25.0]);
const DEGREES: (u32, [f64; 6]) = (4326, [9.3, 0.0004, 0.0, 50.2, 0.0, -0.0003]);
const VIEW: [&str; 6] = ["--azimuth", "10", "--altitude", "-12", "--creases", "drainage,ridges"];

#[test]
fn lines_of_a_projected_dem_lie_on_its_surface_with_what_is_known_of_them() {
    let place = Place::new();
    land(&place.path("land.tif"), UTM.0, UTM.1);
    let eye = ["--eye", "560900,5538300,700"];
    draw(&place, &[&eye[..], &VIEW, &["--georeferenced", "out.gpkg"]].concat());
    assert_eq!(place.written(), ["land.tif", "out.gpkg", "out.svg"]);
    let lines = lines(&place.path("out.gpkg"));
    let kinds = check(&surface(&place), &lines, |at| at);
    for kind in ["silhouette", "border", "drainage", "ridge"] {
        assert!(kinds.contains(kind), "{kind}: {kinds:?}");
    }
    let file = Dataset::open(place.path("out.gpkg")).expect("a file");
    let crs = file.layer(0).expect("a layer").spatial_ref().expect("a CRS");
    assert_eq!(crs.auth_code().expect("a code"), 32632);
    let svg = fs::read_to_string(place.path("out.svg")).expect("a drawing");
    let eye = DVec3::new(560_900.0, 5_538_300.0, 700.0);
    for line in &lines {
        let nearest = line.points.iter().map(|at| at.distance(eye)).fold(f64::INFINITY, f64::min);
        assert!((nearest - line.depth).abs() < 1e-6, "{nearest}: {}", line.depth);
        assert_eq!(line.order.is_some(), line.kind == "drainage", "{}: {:?}", line.kind, line.order);
        let Some(id) = line.id.as_deref() else { continue };
        let is_whole = line.kind == "silhouette" && !id.contains('-');
        assert!(!is_whole || svg.contains(&format!("id=\"{id}\"")), "{id} is in the drawing");
    }
    let ids: Vec<_> = lines.iter().filter_map(|line| line.id.clone()).collect();
    assert!(ids.len() > 9 && ids.iter().collect::<BTreeSet<_>>().len() == ids.len(), "each has a name of its own");
    assert!(lines.iter().filter(|line| line.kind == "drainage").all(|line| line.order >= Some(1)));
}

#[test]
fn of_a_warped_dem_they_stand_in_its_own_degrees() {
    let place = Place::new();
    land(&place.path("land.tif"), DEGREES.0, DEGREES.1);
    draw(&place, &[&VIEW[..], &["--lonlat", "9.314,50.176,800", "--georeferenced", "out.gpkg"]].concat());
    let lines = lines(&place.path("out.gpkg"));
    let surface = surface(&place);
    let dem: &Dem = surface.dem();
    let georeference = dem.georeference();
    assert!(georeference.file() != georeference.world(), "it is warped");
    let inside = |at: &DVec3| (9.29..9.33).contains(&at.x) && (50.17..50.21).contains(&at.y);
    assert!(lines.iter().flat_map(|line| &line.points).all(inside), "degrees, longitude first");
    check(&surface, &lines, |at| georeference.world_place(georeference.file(), at).expect("a place"));
}

#[test]
fn geojson_and_kml_hold_the_same_lines_in_degrees() {
    let place = Place::new();
    land(&place.path("land.tif"), UTM.0, UTM.1);
    let eye = ["--eye", "560900,5538300,700"];
    let written = ["gpkg", "geojson", "kml"].map(|ending| {
        let name = format!("out.{ending}");
        draw(&place, &[&eye[..], &VIEW, &["--georeferenced", &name]].concat());
        let bytes = fs::read(place.path(&name)).expect("a file");
        draw(&place, &[&eye[..], &VIEW, &["--georeferenced", &name]].concat());
        assert!(bytes == fs::read(place.path(&name)).expect("a file"), "{name} is the same again");
        (lines(&place.path(&name)), bytes)
    });
    let mut from = SpatialRef::from_epsg(32632).expect("a CRS");
    let mut to = SpatialRef::from_epsg(4326).expect("a CRS");
    from.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
    to.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
    let to_degrees = CoordTransform::new(&from, &to).expect("a way");
    let [(on_map, _), (geojson, text), (kml, kml_text)] = &written;
    for (lines, name) in [(geojson, "geojson"), (kml, "kml")] {
        assert_eq!(lines.len(), on_map.len(), "{name}");
        for (line, other) in lines.iter().zip(on_map) {
            assert_eq!(line.points.len(), other.points.len(), "{name}");
            for (at, other) in line.points.iter().zip(&other.points) {
                let (mut lon, mut lat) = ([other.x], [other.y]);
                to_degrees.transform_coords(&mut lon, &mut lat, &mut []).expect("degrees");
                let off = (at.truncate() - DVec2::new(lon[0], lat[0])).abs().max_element();
                assert!(off < MAPPED_DEGREES && (at.z - other.z).abs() < 1e-6, "{name}: {at} and {other}");
            }
        }
    }
    let json: serde_json::Value = serde_json::from_slice(text).expect("JSON");
    assert!(json["crs"].is_null(), "RFC 7946 has one system");
    let first = &json["features"][0]["properties"];
    assert!(first["kind"].is_string() && first["depth"].is_f64() && first["length"].is_f64(), "{first}");
    assert!(String::from_utf8_lossy(kml_text).contains("<altitudeMode>absolute</altitudeMode>"));
}

#[test]
fn exaggeration_changes_no_height() {
    let place = Place::new();
    land(&place.path("land.tif"), UTM.0, UTM.1);
    // Thrice as high, over land thrice as high.
    let view = ["--eye", "560900,5538300,2100", "--exaggeration", "3", "--azimuth", "10", "--altitude", "-35"];
    draw(&place, &[&view[..], &["--georeferenced", "out.gpkg"]].concat());
    let lines = lines(&place.path("out.gpkg"));
    check(&surface(&place), &lines, |at| at);
    let highest = lines.iter().flat_map(|line| &line.points).map(|at| at.z).fold(0.0, f64::max);
    assert!((300.0..600.0).contains(&highest), "{highest} m");
    let eye = DVec3::new(560_900.0, 5_538_300.0, 700.0);
    let nearest = lines[0].points.iter().map(|at| at.distance(eye)).fold(f64::INFINITY, f64::min);
    assert!((nearest - lines[0].depth).abs() < 1e-6, "depth is the land's own: {nearest}, {}", lines[0].depth);
}

#[test]
fn own_lines_keep_their_order_and_their_layer_and_plans_have_lines_too() {
    let place = Place::new();
    land(&place.path("land.tif"), UTM.0, UTM.1);
    let road = "{\"type\":\"FeatureCollection\",\"crs\":{\"type\":\"name\",\"properties\":{\"name\":\"EPSG:32632\"}},\"features\":[{\"type\":\
                \"Feature\",\"properties\":{\"order\":4},\"geometry\":{\"type\":\"LineString\",\"coordinates\":\
                [[560300,5539000],[560800,5539300],[561400,5539100]]}}]}";
    fs::write(place.path("road.geojson"), road).expect("a road");
    let flags = ["draw", "land.tif", "--keep-steps", "-o", "out.svg", "--plan", "--scale", "1:20000"];
    let output = place.run(&[&flags[..], &["--lines", "road.geojson", "--georeferenced", "out.gpkg"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let lines = lines(&place.path("out.gpkg"));
    let own: Vec<_> = lines.iter().filter(|line| line.kind == "own").collect();
    assert_eq!(own.iter().map(|line| line.order).collect::<Vec<_>>(), [Some(4)]);
    assert!(own[0].depth.is_nan() && lines.iter().any(|line| line.kind == "border"), "a plan has no eye");
    check_own(&surface(&place), own[0]);
    let file = Dataset::open(place.path("out.gpkg")).expect("a file");
    let mut layer = file.layer(0).expect("a layer");
    let field = layer.defn().field_index("layer").expect("a field");
    let layers: Vec<_> = layer.features().filter_map(|feature| feature.field_as_string(field).ok().flatten()).collect();
    assert_eq!(layers, ["road"]);
}

#[test]
fn lines_of_a_dem_without_a_system_are_read_again() {
    let place = Place::new();
    let drawn = |flags: &[&str]| {
        let output =
            place.run(&[&["draw", "hill.asc", "-o", "out.svg", "--plan", "--scale", "1:20000"], flags].concat());
        assert!(output.status.success(), "{flags:?}: {}", stderr(&output));
        fs::read_to_string(place.path("out.svg")).expect("a drawing")
    };
    let without = drawn(&["--georeferenced", "lines.gpkg"]);
    assert!(!lines(&place.path("lines.gpkg")).is_empty());
    assert_ne!(drawn(&["--lines", "lines.gpkg"]), without, "its own lines are drawn on it");
}

fn check_own(surface: &Surface, own: &Read) {
    let worst = own.points.windows(3).step_by(7).map(|part| leaves(surface, &[], part)).fold(0.0, f64::max);
    assert!(worst < MAPPED_CELLS, "{worst} cells");
}

#[test]
fn what_cannot_be_meant_is_refused_and_leaves_nothing() {
    let place = Place::new();
    let draw = ["draw", "hill.asc", "-o", "out.png", "--size", "64x48", "--georeferenced"];
    let refused = |name: &str, words: &str| refuses(&place, &[&draw[..], &[name]].concat(), 2, words);
    refused("out.shp", "error: --georeferenced: out.shp does not end in .gpkg, .geojson or .kml; name it so");
    refused("-", "error: --georeferenced: - does not end in .gpkg, .geojson or .kml; name it so");
    for name in ["out.geojson", "out.kml"] {
        refused(
            name,
            "error: --georeferenced: the DEM names no coordinate system, and this format holds places on Earth alone; name it .gpkg, or \
             name the system of the DEM, `gdal_translate -a_srs EPSG:CODE IN OUT.tif`",
        );
    }
    refuses(&place, &[&draw[..], &["no/out.gpkg"]].concat(), 1, "error: no/out.gpkg: cannot be written");
    refuses(
        &place,
        &[&draw[..], &["out.gpkg", "--json", "out.gpkg"]].concat(),
        2,
        "out.gpkg is another output already",
    );
    // In the DEM's own coordinates, whatever they are.
    let output = place.run(&[&draw[..], &["out.gpkg"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(place.written(), ["out.gpkg", "out.png"]);
    let file = Dataset::open(place.path("out.gpkg")).expect("a file");
    let crs = file.layer(0).expect("a layer").spatial_ref().expect("a system");
    assert!(!crs.is_geographic() && crs.name().is_some_and(|name| name == "Undefined Cartesian SRS"));
    let points = lines(&place.path("out.gpkg"));
    let inside = |at: &DVec3| (500_000.0..500_400.0).contains(&at.x) && (4_000_000.0..4_000_400.0).contains(&at.y);
    assert!(points.iter().flat_map(|line| &line.points).all(inside));
    // An input stays as it is.
    let road = fs::read(place.path("out.gpkg")).expect("lines");
    let output = place.run(&[&draw[..], &["out.gpkg", "--lines", "out.gpkg"]].concat());
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("error: --georeferenced: out.gpkg is read as input"), "{}", stderr(&output));
    assert!(fs::read(place.path("out.gpkg")).expect("lines") == road);
}

#[test]
#[cfg(target_os = "linux")]
fn a_disk_that_is_full_leaves_no_half_of_a_file() {
    let place = Place::new();
    let hachure = env!("CARGO_BIN_EXE_hachure");
    // 16 KiB a file: the picture fits, a GeoPackage does not.
    let line = format!(
        "ulimit -f 32; {hachure} draw hill.asc -o out.png --size 64x48 --hachures none --georeferenced out.gpkg"
    );
    let output = std::process::Command::new("sh").args(["-c", &line]).current_dir(place.path("")).output();
    let output = output.expect("a shell");
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("error: out.gpkg: cannot be written (File too large"), "{said}");
    assert_eq!(place.written(), Vec::<String>::new());
}
