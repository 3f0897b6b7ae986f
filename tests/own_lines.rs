//! Lines of the user's own: from every format and system to the land, and what is said of wrong files.

mod layers;
mod refused;
mod sheets;
mod voids;

use std::path::Path;
use std::process::Command;

use gdal::DriverManager;
use gdal::raster::Buffer;
use gdal::spatial_ref::SpatialRef;
use glam::DVec2;
use hachure::dem::{Crs, Dem};
use hachure::door::cli::words::line;
use hachure::geo::{OwnLayer, OwnLine, OwnLines, ReadOptions, own_lines, read};
use hachure::relief::{self, LineKind, SurfaceLine};

use crate::flights::{folder, sample, write};

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
    let lines = own_lines(Path::new(path), false).and_then(|given| relief::own_lines(Path::new(path), &given, dem, 0));
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
    assert!(at.len() > 1 && matches!(line.kind, LineKind::Own(_)) && line.joins.is_none());
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

#[test]
fn dems_that_stay_in_their_files_have_the_same() {
    let folder = folder();
    let path = write(&folder, "way.geojson", &feature("LineString", &format!("{:?}", way()), ""));
    let dem = concat!(env!("CARGO_MANIFEST_DIR"), "/dem/golden-gate.tif");
    let filed = read(dem, &ReadOptions { memory: 1 << 16, ..Default::default() }).expect("the sample");
    assert!(filed.is_filed());
    assert_eq!(on(&path, &filed), placed(&path));
}

/// A file of lines by hand.
fn given(crs: Option<Crs>, lines: Vec<OwnLine>) -> OwnLines {
    OwnLines { layers: vec![OwnLayer { name: "a".into(), crs, lines, points_left_out: 0 }] }
}

#[test]
fn dems_in_feet_and_degrees_have_them_where_they_are() {
    let folder = folder();
    for (epsg, transform) in
        [(2227, [5_950_000.0, 100.0, 0.0, 2_130_000.0, 0.0, -100.0]), (4326, [-122.6, 0.0003, 0.0, 37.9, 0.0, -0.0003])]
    {
        let path = folder.path().join(format!("{epsg}.tif"));
        let driver = DriverManager::get_driver_by_name("GTiff").expect("a driver");
        let mut file = driver.create_with_band_type::<f32, _>(&path, 90, 80, 1).expect("a file");
        file.set_geo_transform(&transform).expect("a place");
        file.set_spatial_ref(&SpatialRef::from_epsg(epsg).expect("a system")).expect("a system");
        let mut buffer = Buffer::new((90, 80), (0..90 * 80_u16).map(|i| f32::from(i).sin() * 9.0 + 50.0).collect());
        file.rasterband(1).expect("a band").write((0, 0), (90, 80), &mut buffer).expect("samples");
        file.close().expect("a file");
        let dem = read(&path, &ReadOptions::default()).unwrap_or_else(|e| panic!("{}", line(&e)));
        // Of a file that names no system, and of one in degrees: the same line.
        let place = |[c, r]: [f64; 2]| DVec2::new(transform[0] + c * transform[1], transform[3] + r * transform[5]);
        let places = [[30.5, 40.5], [45.5, 33.5], [52.5, 42.5]].map(place);
        let (globe, georeference) = (Crs::lonlat().expect("a register"), dem.georeference());
        let world = places.map(|place| georeference.world_place(georeference.file(), place).expect("a place"));
        let degrees = world.map(|world| georeference.place_in(&globe, world).expect("a place"));
        for (crs, places) in [(None, places), (Some(globe), degrees)] {
            let own = OwnLine { places: places.to_vec(), closed: false, order: 3 };
            let found = relief::own_lines(Path::new("a"), &given(crs, vec![own]), &dem, 0)
                .unwrap_or_else(|e| panic!("{}", line(&e)));
            assert_eq!((found.len(), found[0].order), (1, 3));
            check(&found[0], &dem);
            let wanted = world.map(|world| dem.grid_place(world));
            let worst = wanted.iter().map(|place| away(*place, &self::places(&found[0]))).fold(0.0, f64::max);
            assert!(worst < 1e-3, "{epsg}: {worst} cells");
            if epsg == 2227 {
                assert!(wanted[0].distance(DVec2::new(30.0, 40.0)) < 1e-6, "{}", wanted[0]);
            }
        }
    }
}
