//! Lines of the user's own: from every format and system to the land, and what is said of wrong files.

use std::path::Path;
use std::process::Command;

use clap::Parser;
use glam::DVec2;
use hachure::cli::lines::LinesArguments;
use hachure::cli::talk::{Lines, Talk, TalkArguments};
use hachure::cli::words::line;
use hachure::dem::{Crs, Dem};
use hachure::geo::{OwnLayer, OwnLine, OwnLines, own_lines};
use hachure::relief::{self, LineKind, SurfaceLine};
use tempfile::TempDir;

use crate::flights::{folder, sample, write};

#[derive(Parser)]
struct Typed {
    #[command(flatten)]
    lines: LinesArguments,
    #[command(flatten)]
    talk: TalkArguments,
}

/// A winding way over the sample, degrees.
fn way() -> Vec<[f64; 2]> {
    (0..100).map(|i| f64::from(i) / 100.0).map(|t| [-122.56 + 0.1 * t, 37.80 + 0.03 * (t * 9.0).sin().abs()]).collect()
}

fn feature(kind: &str, coordinates: &str, properties: &str) -> String {
    format!(
        "{{\"type\":\"Feature\",\"properties\":{{{properties}}},\"geometry\":{{\"type\":\"{kind}\",\"coordinates\":{coordinates}}}}}"
    )
}

fn collection(features: &[String]) -> String {
    format!("{{\"type\":\"FeatureCollection\",\"features\":[{}]}}", features.join(","))
}

/// Makes another file of one; `false`, with a line that says so, without GDAL's tools.
fn ogr2ogr(flags: &[&str], to: &Path, from: &str) -> bool {
    match Command::new("ogr2ogr").args(flags).arg(to).arg(from).output() {
        Ok(output) => {
            assert!(output.status.success(), "{}: {}", to.display(), String::from_utf8_lossy(&output.stderr));
            true
        }
        Err(_) => {
            println!("SKIP {}: install ogr2ogr", to.display());
            false
        }
    }
}

fn placed(path: &str) -> Vec<SurfaceLine> {
    on(path, sample().dem())
}

fn on(path: &str, dem: &Dem) -> Vec<SurfaceLine> {
    let lines = own_lines(Path::new(path), false).and_then(|given| relief::own_lines(Path::new(path), &given, dem));
    lines.unwrap_or_else(|e| panic!("{}", line(&e)))
}

fn places(line: &SurfaceLine) -> Vec<DVec2> {
    line.points.iter().map(|point| point.at).collect()
}

/// Cells from a place to a line.
fn away(place: DVec2, line: &[DVec2]) -> f64 {
    let of_edge = |edge: &[DVec2]| {
        let run = edge[1] - edge[0];
        let along = ((place - edge[0]).dot(run) / run.length_squared()).clamp(0.0, 1.0);
        place.distance(edge[0] + run * along)
    };
    line.windows(2).map(of_edge).fold(f64::INFINITY, f64::min)
}

/// What holds of every line on the land.
fn check(line: &SurfaceLine, dem: &Dem) {
    let far = DVec2::new((dem.columns() - 1) as f64, (dem.rows() - 1) as f64);
    let at = places(line);
    assert!(at.len() > 1 && line.kind == LineKind::Own && line.joins.is_none());
    assert!(at.iter().all(|place| place.cmpge(DVec2::ZERO).all() && place.cmple(far).all()));
    assert!(at.windows(2).all(|pair| pair[0] != pair[1] && pair[0].distance(pair[1]) <= 1.0 + 1e-9));
    assert!(line.points.iter().all(|point| point.across == [f32::INFINITY; 3] && point.drop == f32::INFINITY));
    let length = at.windows(2).map(|pair| ((pair[1] - pair[0]) * dem.cell()).length()).sum::<f64>();
    assert!(
        (f64::from(line.points[at.len() - 1].length) - length).abs() <= 1e-6 * length && line.points[0].length == 0.0
    );
}

#[test]
fn every_format_and_system_gives_the_same_lines() {
    let (folder, dem) = (folder(), sample().dem());
    let truth = write(&folder, "way.geojson", &feature("LineString", &format!("{:?}", way()), ""));
    let globe = Crs::lonlat().expect("a register");
    let on_grid = |[lon, lat]: [f64; 2]| {
        dem.grid_place(dem.georeference().world_place(&globe, DVec2::new(lon, lat)).expect("a place"))
    };
    let wanted: Vec<DVec2> = way().into_iter().map(on_grid).collect();
    let points =
        |tag: &str| way().iter().map(|[lon, lat]| format!("<{tag} lat=\"{lat}\" lon=\"{lon}\"/>")).collect::<String>();
    let gpx = format!(
        "<gpx version=\"1.1\" creator=\"x\" xmlns=\"http://www.topografix.com/GPX/1/1\"><wpt lat=\"1\" lon=\"2\"/><trk><trkseg>{}</trkseg></trk></gpx>",
        points("trkpt")
    );
    let kml: String = way().iter().map(|[lon, lat]| format!("{lon},{lat} ")).collect();
    let kml = format!(
        "<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document><Placemark><LineString><coordinates>{kml}</coordinates></LineString></Placemark></Document></kml>"
    );
    let mut files = vec![truth.clone(), write(&folder, "way.gpx", &gpx), write(&folder, "way.kml", &kml)];
    for (name, flags) in [
        ("utm.gpkg", &["-t_srs", "EPSG:32611"][..]),
        ("feet.gpkg", &["-t_srs", "EPSG:2227"]),
        ("same.gpkg", &["-t_srs", "EPSG:32610"]),
        ("way.shp", &["-t_srs", "EPSG:3857"]),
        ("way.fgb", &[]),
        ("way.kmz", &["-f", "LIBKML"]),
        ("way.geojsonl", &["-f", "GeoJSONSeq"]),
        ("way.tab", &["-f", "MapInfo File"]),
    ] {
        let to = folder.path().join(name);
        if ogr2ogr(flags, &to, &truth) {
            files.push(to.to_str().expect("a name").to_owned());
        }
    }
    // Of MapInfo files places are whole numbers of 4 cm.
    for file in &files {
        let lines = placed(file);
        assert_eq!(lines.len(), 1, "{file}");
        check(&lines[0], dem);
        let own = places(&lines[0]);
        let worst = wanted.iter().map(|place| away(*place, &own)).fold(0.0, f64::max);
        assert!(worst < 0.002 && own[0].distance(wanted[0]) < 0.002, "{file}: {worst} cells");
        let back = own.iter().map(|place| away(*place, &wanted)).fold(0.0, f64::max);
        assert!(back < 0.002, "{file}: {back} cells");
    }
}

#[test]
fn edges_are_straight_in_their_file() {
    let (folder, dem) = (folder(), sample().dem());
    // A parallel and a meridian, the ends of which lie far beyond what the map of the DEM shows.
    let lines = [
        feature("LineString", "[[-170,37.85],[10,37.85]]", ""),
        feature("LineString", "[[-122.5,-80],[-122.5,88]]", ""),
        feature("LineString", "[[-170,1],[10,1]]", ""),
    ];
    let lines = placed(&write(&folder, "graticule.geojson", &collection(&lines)));
    assert_eq!(lines.len(), 2);
    let lonlat = |place: DVec2| {
        let [west, .., north] = dem.extent();
        dem.georeference()
            .lonlat(DVec2::new(west, north) + place * dem.cell() * DVec2::new(1.0, -1.0))
            .ok()
            .flatten()
            .expect("a place")
    };
    for (line, axis, degrees) in [(&lines[0], 1, 37.85), (&lines[1], 0, -122.5)] {
        check(line, dem);
        let off = places(line).into_iter().map(|place| (lonlat(place)[axis] - degrees).abs()).fold(0.0, f64::max);
        assert!(off < 3e-8, "{off} degrees, 3 mm");
    }
    let [across, down] = [0, 1].map(|i| places(&lines[i]));
    let ends = |line: &[DVec2], axis: usize| [line[0][axis], line[line.len() - 1][axis]];
    assert_eq!(ends(&across, 0), [0.0, 499.0], "from edge to edge");
    assert_eq!(ends(&down, 1), [499.0, 0.0]);
}

/// A grid of 21 x 21 samples of cells of 10 m, with voids.
fn grid(voids: &[[usize; 2]]) -> Dem {
    let height = |i: usize| if voids.contains(&[i % 21, i / 21]) { f32::NAN } else { 5.0 };
    Dem::from_heights(21, DVec2::splat(10.0), DVec2::new(1000.0, 2000.0), (0..21 * 21).map(height).collect())
}

/// Lines through columns and rows of [`grid`].
fn given(lines: &[(&[[f64; 2]], bool)]) -> OwnLines {
    let world = |place: &[f64; 2]| DVec2::new(1000.0 + 10.0 * place[0], 2000.0 - 10.0 * place[1]);
    let of = |(line, closed): &(&[[f64; 2]], bool)| OwnLine {
        places: line.iter().map(world).collect(),
        closed: *closed,
        order: 1,
    };
    let lines = lines.iter().map(of).collect();
    OwnLines { layers: vec![OwnLayer { name: "a".into(), crs: None, lines, points_left_out: 0 }] }
}

fn on_grid(lines: &[(&[[f64; 2]], bool)], voids: &[[usize; 2]]) -> Vec<SurfaceLine> {
    let dem = grid(voids);
    let lines = relief::own_lines(Path::new("a"), &given(lines), &dem).unwrap_or_else(|e| panic!("{}", line(&e)));
    lines.iter().for_each(|line| check(line, &dem));
    lines
}

/// First and last place.
fn ends(line: &SurfaceLine) -> [[f64; 2]; 2] {
    [0, line.points.len() - 1].map(|i| (line.points[i].at * 1e9).round().to_array().map(|x| x / 1e9))
}

#[test]
fn lines_end_where_the_land_does() {
    let void = [[10, 10]];
    let across = on_grid(&[(&[[-5.0, 3.5], [25.0, 3.5]], false)], &void);
    assert_eq!((across.len(), ends(&across[0])), (1, [[0.0, 3.5], [20.0, 3.5]]), "the edge");
    // Patches have three corners: of cell (9, 10) the one in the south-west is there.
    let through = on_grid(&[(&[[2.0, 10.25], [18.0, 10.25]], false)], &void);
    assert_eq!(
        through.iter().map(ends).collect::<Vec<_>>(),
        [[[2.0, 10.25], [9.25, 10.25]], [[11.0, 10.25], [18.0, 10.25]]]
    );
    let along = on_grid(&[(&[[2.0, 10.0], [18.0, 10.0]], false)], &void);
    assert_eq!(along.iter().map(ends).collect::<Vec<_>>(), [[[2.0, 10.0], [9.0, 10.0]], [[11.0, 10.0], [18.0, 10.0]]]);
    // Along the rim of a void, and of the DEM, there is land on one side.
    let rim =
        on_grid(&[(&[[9.0, 9.0], [9.0, 10.0], [10.0, 11.0]], false), (&[[20.0, 1.0], [20.0, 5.0]], false)], &void);
    assert_eq!(rim.iter().map(ends).collect::<Vec<_>>(), [[[9.0, 9.0], [10.0, 11.0]], [[20.0, 1.0], [20.0, 5.0]]]);
}

#[test]
fn closed_lines_stay_closed_or_are_cut_once_less() {
    let square: &[[f64; 2]] = &[[5.0, 5.0], [15.0, 5.0], [15.0, 15.0], [5.0, 15.0]];
    let whole = on_grid(&[(square, true)], &[]);
    assert!(whole.len() == 1 && whole[0].closed && whole[0].points.len() == 40);
    // Its first place lies amid what is left.
    let cut = on_grid(&[(square, true)], &[[10, 15]]);
    assert_eq!((cut.len(), ends(&cut[0]), cut[0].closed), (1, [[9.0, 15.0], [11.0, 15.0]], false));
    let beyond = on_grid(&[(&[[5.0, 5.0], [25.0, 5.0], [25.0, 15.0], [5.0, 15.0]], true)], &[]);
    assert_eq!((beyond.len(), ends(&beyond[0])), (1, [[20.0, 15.0], [20.0, 5.0]]));
}

#[test]
fn areas_parts_layers_and_orders_are_taken() {
    let folder = folder();
    let ring = "[[-122.5,37.8],[-122.49,37.8],[-122.49,37.81],[-122.5,37.81],[-122.5,37.8]]";
    let hole = "[[-122.497,37.803],[-122.493,37.803],[-122.493,37.807],[-122.497,37.803]]";
    let two = "[[[-122.53,37.83],[-122.52,37.83]],[[-122.51,37.83],[-122.5,37.84]]]";
    let point = feature("MultiPoint", "[[-122.5,37.8],[-122.4,37.8]]", "");
    let rivers = write(
        &folder,
        "rivers.geojson",
        &collection(&[
            feature("Polygon", &format!("[{ring},{hole}]"), "\"Class\":\"lake\",\"STRAHLER\":4"),
            feature("MultiLineString", two, "\"Class\":\"7\",\"STRAHLER\":null"),
            feature("LineString", "[[-122.53,37.85],[-122.5,37.85]]", "\"Class\":\"brook\""),
            feature("LineString", "[[-122.53,37.86],[-122.5,37.86]]", "\"STRAHLER\":1000"),
            point.clone(),
        ]),
    );
    let lines = placed(&rivers);
    assert_eq!(
        lines.iter().map(|line| (line.order, line.closed)).collect::<Vec<_>>(),
        [(4, true), (4, true), (7, false), (7, false), (1, false), (255, false)]
    );
    let taken = |path: &str| {
        own_lines(Path::new(path), false).map(|lines| lines.taken()).unwrap_or_else(|e| panic!("{}", line(&e)))
    };
    assert_eq!(taken(&rivers), "6 lines of layer rivers; 2 points left out");
    let gpkg = folder.path().join("both.gpkg");
    let roads = write(&folder, "roads.geojson", &feature("LineString", "[[-122.5,37.8],[-122.49,37.81]]", ""));
    if ogr2ogr(&["-nln", "rivers"], &gpkg, &rivers)
        && ogr2ogr(&["-update", "-nln", "roads", "-t_srs", "EPSG:3857"], &gpkg, &roads)
    {
        let gpkg = gpkg.to_str().expect("a name");
        assert_eq!(taken(gpkg), "6 lines of layer rivers, 1 line of layer roads; 2 points left out");
        assert_eq!(taken(&format!("{gpkg}:roads")), "1 line of layer roads");
        assert_eq!((placed(gpkg).len(), placed(&format!("{gpkg}:roads")).len()), (7, 1));
    }
    // Half a circle, of the radius of .01 degrees.
    let arc = write(&folder, "arc.csv", "id,WKT\n1,\"CIRCULARSTRING (-122.51 37.83,-122.5 37.84,-122.49 37.83)\"\n");
    let to = folder.path().join("arc.gpkg");
    if ogr2ogr(&["-a_srs", "EPSG:4326", "-oo", "GEOM_POSSIBLE_NAMES=WKT"], &to, &arc) {
        let given = own_lines(&to, false).unwrap_or_else(|e| panic!("{}", line(&e)));
        let places = &given.layers[0].lines[0].places;
        assert!(
            places.len() > 40
                && places.iter().all(|place| (place.distance(DVec2::new(-122.5, 37.83)) - 0.01).abs() < 1e-9)
        );
    }
}

fn typed(paths: &[&str]) -> Typed {
    let flags = paths.iter().map(|path| format!("--lines={path}"));
    Typed::try_parse_from(["draw".to_owned(), "-q".to_owned()].into_iter().chain(flags))
        .unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn the_flag_is_repeatable_and_names_what_was_asked() {
    let folder = folder();
    let road = |end: f64| feature("LineString", &format!("[[-122.5,37.8],[-122.49,{end}]]"), "");
    let [one, other] = [37.81, 37.82].map(|end| write(&folder, &format!("{end}.geojson"), &road(end)));
    let typed_two = typed(&[&one, &other]);
    let talk = Talk::new(&typed_two.talk, Lines::Stdout);
    assert_eq!(typed_two.lines.files(), [Path::new(&one), Path::new(&other)]);
    assert!(!typed_two.lines.is_empty() && typed(&[]).lines.is_empty());
    let lines = typed_two.lines.read(sample().dem(), false, &talk).unwrap_or_else(|e| panic!("{}", line(&e)));
    assert_eq!(lines.len(), 2);
    let asked = |paths: &[&str]| typed(paths).lines.open(false).unwrap_or_else(|e| panic!("{}", line(&e))).asked();
    assert_eq!(asked(&[]), "");
    assert_eq!(asked(&[&one, &other]), asked(&[&one, &other]));
    assert_ne!(asked(&[&one, &other]), asked(&[&other, &one]), "the last lies on top");
    let elsewhere = TempDir::new().expect("a folder");
    let copy = |end| write(&elsewhere, "37.81.geojson", &road(end));
    let layer = copy(37.81) + ":37.81";
    assert_eq!((asked(&[&copy(37.81)]), typed(&[&layer]).lines.files()), (asked(&[&one]), vec![copy(37.81).into()]));
    assert_ne!(asked(&[&copy(37.810001)]), asked(&[&one]), "other places");
}

/// The line of an error about a file of lines.
fn refused(path: &str, dem: &Dem) -> String {
    let lines = own_lines(Path::new(path), false).and_then(|given| relief::own_lines(Path::new(path), &given, dem));
    let said = line(&lines.expect_err(path));
    assert!(!said.contains('\n'), "{said}");
    said
}

#[test]
fn wrong_files_are_refused_in_one_line() {
    let (folder, dem) = (folder(), sample().dem());
    let road = feature("LineString", "[[-122.5,37.8],[-122.49,37.81]]", "");
    let far = feature("LineString", "[[10.5,47.8],[10.6,47.9]]", "");
    for (name, text, words) in [
        ("empty.geojson", "", &["is empty (0 bytes)"][..]),
        ("nothing.geojson", &collection(&[]), &["holds no line and no area; give a file with lines"]),
        ("points.geojson", &feature("Point", "[-122.5,37.8]", ""), &["holds points, no line and no area; "]),
        (
            "far.geojson",
            &far,
            &[
                "lies outside the DEM: between 10.500000,47.800000 and 10.600000,47.900000 of WGS 84 (EPSG:4326), and the DEM between 536715.00,4180515.00 and 551685.00,4195485.00 metres of \"WGS 84 / UTM zone 10N (EPSG:32610)\"",
                "; give lines over the DEM, x first, in the system that the file names",
            ],
        ),
        (
            "words.gpx",
            "no lines at all",
            &["is in no format of lines that hachure reads; give lines as GeoPackage, GeoJSON"],
        ),
        ("cut.geojson", "{\"type\":\"FeatureCollection\",\"features\":[{\"type\"", &["cannot be opened as lines ("]),
    ] {
        let said = refused(&write(&folder, name, text), dem);
        assert!(words.iter().all(|words| said.contains(words)), "{name}: {said}");
    }
    let good = write(&folder, "road.geojson", &road);
    let raster = concat!(env!("CARGO_MANIFEST_DIR"), "/dem/golden-gate.tif");
    for (path, words) in [
        (format!("{good}:rails").as_str(), "has no layer rails; name one of its layers: road"),
        (raster, "holds a raster, not lines"),
        ("nowhere.gpkg", "nowhere.gpkg: there is no such file; "),
        ("http://a.b/c.gpkg", "lies on a network; download it first, or add `--allow-remote`"),
        ("PG:dbname=a", "is no file, but a connection"),
    ] {
        let said = refused(path, dem);
        assert!(said.contains(words), "{said}");
    }
    // A GeoPackage that ends amid its pages.
    let gpkg = folder.path().join("road.gpkg");
    let many =
        write(&folder, "many.geojson", &collection(&vec![feature("LineString", &format!("{:?}", way()), ""); 200]));
    if ogr2ogr(&[], &gpkg, &many) {
        let whole = std::fs::read(&gpkg).expect("a file");
        std::fs::write(&gpkg, &whole[..whole.len() / 3]).expect("a file");
        let said = refused(gpkg.to_str().expect("a name"), dem);
        assert!(said.contains("is damaged or cut short (") || said.contains("cannot be opened as lines ("), "{said}");
    }
    let nowhere = grid(&[]);
    assert!(
        refused(&good, &nowhere)
            .contains("lies in WGS 84 (EPSG:4326), and the DEM in no named system, of which nobody knows")
    );
    let all: Vec<[usize; 2]> = (0..21 * 21).map(|i| [i % 21, i / 21]).filter(|place| place[1] > 5).collect();
    let in_void = relief::own_lines(Path::new("a"), &given(&[(&[[5.0, 9.0], [9.0, 9.0]], false)]), &grid(&all));
    assert_eq!(
        line(&in_void.expect_err("no land")),
        "a: its lines lie in voids of the DEM alone; give lines over its land, or fill its voids"
    );
}
