//! What flights come from: every format of paths, keys, flags, and what is said of wrong ones.

use std::path::Path;
use std::process::Command;

use clap::Parser;
use glam::{DVec2, DVec3};
use hachure::door::cli::words::line;
use hachure::error::Error;
use hachure::surface::Level;
use hachure::view::Camera;
use tempfile::TempDir;

use crate::flights::{Typed, cameras, flight, folder, plan, sample, turn, write};

/// Three places of the sample, degrees and metres.
const PLACES: [[f64; 3]; 3] = [[-122.52, 37.80, 900.0], [-122.50, 37.83, 950.0], [-122.46, 37.86, 1000.0]];

fn geojson(kind: &str, coordinates: &str) -> String {
    format!(
        "{{\"type\":\"Feature\",\"properties\":{{\"name\":\"tour\"}},\"geometry\":{{\"type\":\"{kind}\",\"coordinates\":{coordinates}}}}}"
    )
}

fn collection(features: &[String]) -> String {
    format!("{{\"type\":\"FeatureCollection\",\"features\":[{}]}}", features.join(","))
}

fn line_of(places: &[[f64; 3]]) -> String {
    geojson("LineString", &format!("{places:?}"))
}

#[test]
fn every_format_leads_to_the_same_flight() {
    let folder = folder();
    let points = |tag: &str| {
        let point = |[lon, lat, ele]: &[f64; 3]| format!("<{tag} lat=\"{lat}\" lon=\"{lon}\"><ele>{ele}</ele></{tag}>");
        PLACES.iter().map(point).collect::<Vec<_>>()
    };
    let gpx = |inner: &str| {
        format!("<gpx version=\"1.1\" creator=\"x\" xmlns=\"http://www.topografix.com/GPX/1/1\">{inner}</gpx>")
    };
    let trk = points("trkpt");
    let kml = PLACES.map(|[lon, lat, z]| format!("{lon},{lat},{z}")).join(" ");
    let kml = format!(
        "<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document><Placemark><name>tour</name><LineString><altitudeMode>absolute</altitudeMode>\
         <coordinates>{kml}</coordinates></LineString></Placemark></Document></kml>"
    );
    let single = PLACES.map(|place| geojson("Point", &format!("{place:?}")));
    let parts = geojson("MultiLineString", &format!("[[{:?},{:?}],[{:?}]]", PLACES[0], PLACES[1], PLACES[2]));
    let truth = write(&folder, "line.geojson", &line_of(&PLACES));
    let mut files = vec![
        write(&folder, "points.geojson", &collection(&single)),
        write(&folder, "tour.kml", &kml),
        write(&folder, "parts.geojson", &parts),
        write(
            &folder,
            "track.gpx",
            &gpx(&format!(
                "<wpt lat=\"1\" lon=\"2\"/><rte><rtept lat=\"1\" lon=\"2\"/></rte><trk><trkseg>{}{}</trkseg><trkseg>{}</trkseg></trk>",
                trk[0], trk[1], trk[2]
            )),
        ),
        write(
            &folder,
            "route.gpx",
            &gpx(&format!("<wpt lat=\"1\" lon=\"2\"/><rte>{}</rte>", points("rtept").concat())),
        ),
        write(&folder, "waypoints.gpx", &gpx(&points("wpt").concat())),
        write(&folder, "keys.toml", &PLACES.map(|place| format!("[[key]]\nlonlat = {place:?}\n")).concat()),
        write(
            &folder,
            "keys-crs.toml",
            &format!("crs = \"EPSG:4326\"\n{}", PLACES.map(|place| format!("[[key]]\nplace = {place:?}\n")).concat()),
        ),
    ];
    for (name, flags) in
        [("a.gpkg", &["-nln", "tour"][..]), ("utm.gpkg", &["-t_srs", "EPSG:32611"]), ("a.shp", &[]), ("a.fgb", &[])]
    {
        let to = folder.path().join(name);
        match Command::new("ogr2ogr").args(flags).arg(&to).arg(&truth).output() {
            Ok(output) => {
                assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
                files.push(to.to_str().expect("a name").to_owned());
            }
            Err(_) => println!("SKIP {name}: install ogr2ogr"),
        }
    }
    if let Some(gpkg) = files.iter().find(|file| file.ends_with("a.gpkg")).cloned() {
        files.push(format!("{gpkg}:tour"));
    }
    let cameras_of = |file: &str| cameras(&flight(&["--path", file, "--count", "30"]));
    let wanted = cameras_of(&truth);
    assert!((wanted[0].eye.z - 900.0).abs() < 1e-6 && (wanted[29].eye.z - 1000.0).abs() < 1e-6);
    for file in &files {
        for (own, wanted) in cameras_of(file).iter().zip(&wanted) {
            assert!(
                own.eye.distance(wanted.eye) < 0.01 && turn(own.azimuth, wanted.azimuth).abs() < 1e-3,
                "{file}: {own:?} {wanted:?}"
            );
        }
    }
    // The name of a file is nothing, its points are all.
    let bytes = |file: &str| plan(&["--path", file, "--count", "30"]).expect("a plan").hashed();
    let copy = write(&folder, "copy.geojson", &line_of(&PLACES));
    assert_eq!(bytes(&truth), bytes(&copy));
    let mut moved = PLACES;
    moved[1][0] += 1e-9;
    assert_ne!(bytes(&truth), bytes(&write(&folder, "moved.geojson", &line_of(&moved))));
}

#[test]
fn heights_of_files_are_the_lands_own_and_are_exaggerated_with_it() {
    let folder = folder();
    let path = write(&folder, "line.geojson", &line_of(&PLACES));
    let doubled = plan(&["--path", &path, "--count", "3"])
        .expect("a plan")
        .flight(sample(), Level::EIGHT, 2.0)
        .expect("a flight");
    assert!((doubled.camera(0).eye.z - 1800.0).abs() < 1e-6);
    // A height that is typed is in the place of the path's own.
    let typed = plan(&["--path", &path, "--count", "3", "--height", "1500"]).expect("a plan");
    assert_eq!(typed.flight(sample(), Level::EIGHT, 2.0).expect("a flight").camera(1).eye.z, 1500.0);
}

#[test]
fn keys_say_where_to_look_and_how_wide() {
    let folder = folder();
    let look = "[[key]]\nplace = [538000, 4186000, 900]\nlook = [545000, 4190000, 100]\nfov = 30\ntime = 0\n\
                [[key]]\nplace = [549000, 4186000, 900]\nlook = [545000, 4190000, 100]\nfov = 60\ntime = 8\n";
    let path = write(&folder, "look.toml", look);
    let looking = plan(&["--path", &path]).expect("a plan");
    assert_eq!((looking.count(), looking.fps()), (200, 25.0), "seconds of the last key, 25 frames each");
    let looking = looking.flight(sample(), Level::EIGHT, 1.0).expect("a flight");
    for camera in cameras(&looking) {
        let (place, _) =
            Camera { width: 100, height: 100, ..camera }.project(DVec3::new(545_000.0, 4_190_000.0, 100.0));
        assert!(place.distance(DVec2::splat(50.0)) < 1e-5, "{place}");
    }
    assert_eq!((looking.camera(0).fov, looking.camera(199).fov), (30.0, 60.0));
    // Over north the short way, to the bit at keys.
    let turned = "key = [{place = [540000, 4186000, 900], azimuth = 350, altitude = -5}, {place = [542000, 4186000, 900], azimuth = 20, altitude = 5}]";
    let flight = flight(&["--path", &write(&folder, "turned.toml", turned), "--count", "11"]);
    let azimuths: Vec<f64> = cameras(&flight).iter().map(|camera| camera.azimuth).collect();
    assert_eq!((azimuths[0], azimuths[5], azimuths[10], flight.camera(10).altitude), (350.0, 5.0, 20.0, 5.0));
}

#[test]
fn wrong_flags_are_refused_in_one_line() {
    let cases: [(&str, &str); 9] = [
        ("", "--path: nothing says where the flight leads; add --path FILE, or --orbit E,N --radius M"),
        ("--orbit 1,2", "--orbit: nothing says how far from the place; add --radius M"),
        ("--radius 2", "--radius: goes with a place that is circled; add --orbit E,N, or leave it out"),
        (
            "--orbit 1,2 --radius 3 --path a",
            "--orbit: a flight takes a path or circles a place; leave out --path or --orbit",
        ),
        (
            "--path a --duration 3 --count 3",
            "--duration: both say how many frames there are; leave out --count or --duration",
        ),
        (
            "--path a --duration .001",
            "--duration: 0.001 s of 25 frames each are 0 frames; want 1 to 1000000; give another --duration, or --count N",
        ),
        (
            "--path a --crs EPSG:4326",
            "--crs: says in which CRS a place is given, and none is; add --look-at E,N[,Z] or leave it out; files name their own",
        ),
        ("--orbit 1,2 --radius 3 --crs EPSG:1", "EPSG:1 is unknown"),
        ("--path nowhere.kml --count 3", "nowhere.kml: there is no such file; check the spelling and the folder"),
    ];
    for (flags, words) in cases {
        let flags: Vec<&str> = flags.split(' ').filter(|flag| !flag.is_empty()).collect();
        let said = plan(&flags).map(drop).map_err(|e| line(&e)).expect_err("an error");
        assert!(said.contains(words) && !said.contains('\n'), "{flags:?}: {said}");
    }
    for (flags, words) in [
        ("--count 0", "want frames in all, 1 to 1000000"),
        ("--fps 0", "want frames a second"),
        ("--clearance -1", "want metres, 0 or more"),
    ] {
        let flags: Vec<&str> = ["fly", "--path", "a"].into_iter().chain(flags.split(' ')).collect();
        let Err(error) = Typed::try_parse_from(flags) else { panic!("{words}") };
        assert!(error.to_string().contains(words), "{error}");
    }
}

/// The line of an error about a path; `flags` beside it.
fn refused(folder: &TempDir, name: &str, text: &str, flags: &[&str]) -> String {
    let path = write(folder, name, text);
    let flight = plan(&[&["--path", &path, "--count", "5"], flags].concat())
        .and_then(|plan| plan.flight(sample(), Level::EIGHT, 1.0));
    let Err(error) = flight else { panic!("{name} is taken: {text}") };
    assert!(matches!(error, Error::Input { .. } | Error::Setting { .. }), "{error:?}");
    let said = line(&error).replace(&format!("{}/", folder.path().display()), "");
    assert!(!said.contains('\n'), "{said}");
    said
}

#[test]
fn wrong_files_are_refused_in_one_line() {
    let folder = folder();
    let two = [line_of(&PLACES), line_of(&PLACES[..2])];
    let far = PLACES.map(|[lon, lat, z]| [lon + 1.0, lat, z]);
    let flat = "{\"type\":\"LineString\",\"coordinates\":[[-122.5,37.8],[-122.4,37.9]]}";
    let area = geojson("Polygon", "[[[-122.5,37.8],[-122.4,37.9],[-122.4,37.8],[-122.5,37.8]]]");
    let cases: [(&str, &str, &[&str]); 10] = [
        ("empty.geojson", "", &["is empty (0 bytes)"]),
        (
            "nothing.geojson",
            "{\"type\":\"FeatureCollection\",\"features\":[]}",
            &["holds no line and no points; give a file with a line, or points in order"],
        ),
        (
            "one.geojson",
            &geojson("Point", "[-122.5,37.8,900]"),
            &["holds one point; give a path of two points at least, or --orbit"],
        ),
        (
            "still.geojson",
            &geojson("LineString", "[[-122.5,37.8,900],[-122.5,37.8,900]]"),
            &["all its points are one place"],
        ),
        ("flat.geojson", flat, &["its points have no heights; add --height +300 for 300 m above the ground"]),
        (
            "two.geojson",
            &collection(&two),
            &["holds 2 lines in layer two (\"tour\", \"tour\"); keep one: `ogr2ogr -fid 0 OUT.gpkg IN \"two\"`"],
        ),
        (
            "area.geojson",
            &area,
            &[
                "holds areas or curves, no line and no points; make lines of them: `ogr2ogr -nlt LINESTRING OUT.gpkg IN`",
            ],
        ),
        (
            "far.geojson",
            &line_of(&far),
            &[
                "lies outside the DEM: between -121.52,37.8 and -121.46,37.86 of WGS 84 (EPSG:",
                "and the DEM between ",
                "give a path over the DEM",
            ],
        ),
        (
            "words.gpx",
            "no path at all",
            &["is in no format of lines that hachure reads; give a line as GeoJSON, KML, GPX or GeoPackage"],
        ),
        ("cut.geojson", "{\"type\":\"FeatureCollection\",\"features\":[{\"type\"", &["cannot be opened as a path ("]),
    ];
    for (name, text, words) in cases {
        let said = refused(&folder, name, text, &[]);
        assert!(words.iter().all(|words| said.contains(words)), "{name}: {said}");
    }
    // What the remedies say works.
    assert!(
        plan(&["--path", folder.path().join("flat.geojson").to_str().expect("a name"), "--height", "+200"]).is_ok()
    );
    for (name, flags, layer) in [("two", &["-fid", "0"][..], Some("two")), ("area", &["-nlt", "LINESTRING"], None)] {
        let to = folder.path().join(format!("{name}.gpkg"));
        let from = folder.path().join(format!("{name}.geojson"));
        let Ok(output) = Command::new("ogr2ogr").args(flags).args([&to, &from]).args(layer).output() else { continue };
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(plan(&["--path", to.to_str().expect("a name"), "--height", "+200"]).is_ok(), "{name}");
    }
    let dem = concat!(env!("CARGO_MANIFEST_DIR"), "/dem/golden-gate.tif");
    for (path, words) in [
        (dem, "holds a raster, not a path"),
        ("http://a.b/c.kml", "lies on a network"),
        ("/vsicurl/http://a.b/c.kml", "lies on a network"),
        ("PG:dbname=a", "is no file, but a connection"),
    ] {
        let said = line(&plan(&["--path", path]).map(drop).expect_err("an error"));
        assert!(said.contains(words), "{said}");
    }
    let layer = format!("{}:roads", folder.path().join("two.geojson").display());
    assert!(
        line(&plan(&["--path", &layer]).map(drop).expect_err("an error"))
            .contains("has no layer roads; name one of its layers: two")
    );
    assert!(Path::new(dem).exists());
}

#[test]
fn wrong_keys_are_refused_with_their_line() {
    let folder = folder();
    let key = |more: &str| {
        format!("[[key]]\nplace = [540000, 4186000, 900]\n{more}\n[[key]]\nplace = [541000, 4186000, 900]\n")
    };
    let cases: [(&str, &str); 12] = [
        ("", "holds no key; write a table [[key]] for each of two places at least"),
        ("[[key]]\nplace = [540000, 4186000, 900]\n", "holds one key"),
        (&key("plase = 3"), "line 3, column 1: unknown key `plase`; use `place`"),
        ("[[keys]]\nplace = [1, 2, 3]\n", "line 1, column 3: unknown key `keys`; use `key`"),
        (
            &key("fov = 50"),
            "line 4, column 1: this key lacks `fov`, unlike the first; give `fov` to all keys or to none",
        ),
        (&key("time = 1\n[[key]]\nplace = [1, 2, 3]\ntime = 1"), "line 7"),
        (
            "key = [{place = [540000, 4186000, 900], time = 1}, {place = [541000, 4186000, 900], time = 1}]",
            "time 1 does not come after 1, that of the key before; let times rise from key to key",
        ),
        (
            "key = [{place = [540000, 4186000, 900]}, {place = [540000, 4186000, 950]}]",
            "stands where the key before does; leave one of them out, or give all keys a time",
        ),
        (&key("look = [1, 2]\nazimuth = 3"), "`look` and `azimuth` both say where to look"),
        (&key("place2 = [1]").replace("place2 = [1]", "lonlat = [1, 2, 3]"), "want either `place` or `lonlat`"),
        ("key = [{place = [540000, 4186000]}, {place = [1, 2, 3]}]", "`place`: want E,N,Z or E,N,+H"),
        ("key = [{place = [540000, true, 4]}, {place = [1, 2, 3]}]", "want numbers, of which a height may be text"),
    ];
    for (text, words) in cases {
        let said = refused(&folder, "keys.toml", text, &[]);
        assert!(said.starts_with("keys.toml: ") && said.contains(words), "{text}: {said}");
    }
    let looked = "key = [{place = [540000, 4186000, 900], fov = 40}, {place = [541000, 4186000, 900], fov = 50}]";
    assert!(
        refused(&folder, "keys.toml", looked, &["--fov", "30"])
            .contains("--fov: the keys of the path have fields of view of their own")
    );
    assert!(
        refused(&folder, "keys.toml", looked, &["--height", "+30"])
            .contains("--height: the keys of the path have heights of their own")
    );
}
