//! The map and the ground: axes that run west or south, shear and unequal scale, other bodies.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::process::Command;

use gdal::spatial_ref::SpatialRef;
use gdal::{Dataset, DatasetOptions, GdalOpenFlags};
use glam::DVec2;
use hachure::dem::{Crs, Dem};
use hachure::geo::{ReadOptions, info, read, read_all as read_files};

use super::{Raster, cropped, folder, read_all, with_steps};
use crate::common::{shared_dems, words};
use crate::tolerances::{MAP_SHARE, WARP_METRES};

/// MODIS's sphere and Mars's, metres.
const SPHERE: f64 = 6_371_007.181;
const MARS: f64 = 3_396_190.0;
/// A sinusoidal map, in which places 110 degrees off its meridian are sheared by 54 degrees.
const SINUSOIDAL: &str = "+proj=sinu +lon_0=0 +R=6371007.181 +units=m +no_defs";

/// Heights that tell every sample of 40 columns from every other.
fn told_apart(columns: usize, rows: usize) -> Vec<f32> {
    (0..columns * rows).map(|i| (100 + 7 * (i % columns) + 3 * columns * (i / columns)) as f32).collect()
}

/// `raster` in the system that `definition` says.
fn defined(raster: Raster<f32>, definition: &str, path: &Path) -> PathBuf {
    Raster { epsg: None, ..raster }.write("GTiff", path);
    let flags = GdalOpenFlags::GDAL_OF_UPDATE;
    let mut file = Dataset::open_ex(path, DatasetOptions { open_flags: flags, ..Default::default() }).unwrap();
    file.set_spatial_ref(&SpatialRef::from_definition(definition).unwrap()).unwrap();
    file.close().unwrap();
    path.to_owned()
}

/// Where a place of the globe lies on a map.
fn on_map(epsg: u32, longitude: f64, latitude: f64) -> DVec2 {
    let [mut x, mut y] = [[longitude], [latitude]];
    let [degrees, map] = [4326, epsg].map(|code| {
        let mut reference = SpatialRef::from_epsg(code).unwrap();
        reference.set_axis_mapping_strategy(gdal::spatial_ref::AxisMappingStrategy::TraditionalGisOrder);
        reference
    });
    let way = gdal::spatial_ref::CoordTransform::new(&degrees, &map).unwrap();
    way.transform_coords(&mut x, &mut y, &mut []).unwrap();
    DVec2::new(x[0].round(), y[0].round())
}

fn converted(dem: &Dem) -> String {
    words(dem.history().converted()).join("\n")
}

#[test]
fn axes_that_run_south_and_west_are_those_of_the_map_to_east_and_north() {
    let dir = folder();
    let (columns, rows, [dx, dy]) = (40, 25, [30.0, 20.0]);
    let place = on_map(5514, 15.0, 50.0);
    let heights = told_apart(columns, rows);
    let east_north = Raster {
        transform: Some([place.x, dx, 0.0, place.y, 0.0, -dy]),
        epsg: Some(5514),
        ..Raster::new(columns, heights.clone())
    };
    let truth = read_all(&east_north.write("GTiff", &dir.path().join("east-north.tif")));
    // Southing grows along the rows, westing falls down the columns.
    let across = (0..columns * rows).map(|i| heights[(i % rows) * columns + i / rows]).collect();
    let transform = Some([-place.y, dy, 0.0, -place.x, 0.0, -dx]);
    let path = Raster { transform, epsg: Some(5513), ..Raster::new(rows, across) }
        .write("GTiff", &dir.path().join("south-west.tif"));
    let dem = read_all(&path);
    assert_eq!(dem.held().unwrap().heights(), truth.held().unwrap().heights());
    assert_eq!((dem.extent(), dem.cell()), (truth.extent(), truth.cell()));
    let said = converted(&dem);
    assert!(said.contains("S-JTSK / Krovak (EPSG:5513)") && said.contains("east is -y, north is -x"), "{said}");
    // Places lead from the file's own coordinates to the world and back.
    let georeference = dem.georeference();
    assert_eq!(georeference.file().epsg(), Some(5513));
    let [filed, world] = [DVec2::new(-place.y + 77.0, -place.x - 88.0), DVec2::new(place.x + 88.0, place.y - 77.0)];
    assert_eq!(georeference.world_place(georeference.file(), filed), Some(world));
    assert_eq!(georeference.place_in(georeference.file(), world), Some(filed));
    let [here, there] = [&dem, &truth].map(|dem| dem.georeference().lonlat(world).unwrap().unwrap());
    assert!((here - there).length() < 1e-9, "{here} {there}");
    // A crop is in the file's coordinates: two rows from the third southing on, three westings.
    let crop = cropped([-place.y + 2.0 * dy, -place.x - 7.0 * dx, -place.y + 4.0 * dy, -place.x - 4.0 * dx]);
    let part = read(&path, &crop).unwrap();
    let expected: Vec<_> =
        [2, 3].iter().flat_map(|r| (4..7).map(move |c| r * columns + c)).map(|i| heights[i]).collect();
    assert_eq!(part.held().unwrap().heights(), expected);
    // The extent is printed so that it may be typed as a crop, and no coordinate is -0.
    let said = info(std::slice::from_ref(&path), &ReadOptions::default(), &|_, _| ()).unwrap().to_string();
    let line = said.lines().find(|line| line.starts_with("extent ")).unwrap();
    let edges: Vec<f64> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let [x0, x1, y0, y1] = edges.try_into().expect(line);
    let typed = read(&path, &cropped([x0, y0, x1, y1])).unwrap();
    assert_eq!(typed.held().unwrap().heights(), truth.held().unwrap().heights(), "{line}");
    let axes = dem.georeference().world().axes().to_cols_array();
    assert!(axes.iter().all(|v| *v != 0.0 || v.is_sign_positive()), "{axes:?}");
    // Beside a file of the other system nothing is warped.
    let both = read_files(&[path, dir.path().join("east-north.tif")], &ReadOptions::default(), &|_, _| ()).unwrap();
    assert_eq!(both.held().unwrap().heights(), truth.held().unwrap().heights());
    assert!(!converted(&both).contains("warped"), "{}", converted(&both));
}

#[test]
fn axes_that_run_west_and_south_or_west_alone_are_flipped() {
    let dir = folder();
    let heights = told_apart(40, 25);
    // The picture of the map as its user sees it is upside down, or a mirror image.
    let [south, nowhere] = [on_map(2048, 19.5, -30.0), DVec2::splat(5e5)];
    for (epsg, place, [x, y]) in [(2048, south, [-1.0, -1.0]), (3052, nowhere, [-1.0, 1.0])] {
        let transform = Some([place.x, 30.0, 0.0, place.y, 0.0, -20.0]);
        let raster = Raster { transform, epsg: Some(epsg), ..Raster::new(40, heights.clone()) };
        let dem = read_all(&raster.write("GTiff", &dir.path().join("flipped.tif")));
        for (c, r) in [(0, 0), (39, 0), (3, 20)] {
            let [own_c, own_r] = [if x < 0.0 { 39 - c } else { c }, if y < 0.0 { 24 - r } else { r }];
            assert_eq!(dem.height(c, r), Some(heights[own_r * 40 + own_c]), "EPSG:{epsg}, sample {c}, {r}");
        }
        // PROJ knows no way from Reykjavik's datum to the globe.
        let lonlat = |c: usize, r: usize| dem.georeference().lonlat(dem.position(c, r).truncate()).unwrap();
        if let [Some(corner), Some(east), Some(south)] = [lonlat(0, 0), lonlat(39, 0), lonlat(0, 24)] {
            assert!(east.x > corner.x && south.y < corner.y, "EPSG:{epsg}: {corner} {east} {south}");
        }
        assert!(converted(&dem).contains("axes of"), "{}", converted(&dem));
    }
}

#[test]
fn degrees_that_are_printed_for_an_eye_on_krovaks_map_lead_to_that_eye() {
    let dir = folder();
    let place = on_map(5514, 15.0, 50.0);
    let transform = Some([place.x, 30.0, 0.0, place.y, 0.0, -20.0]);
    let raster = Raster { transform, epsg: Some(5514), ..Raster::new(40, told_apart(40, 25)) };
    let file = raster.write("GTiff", &dir.path().join("krovak.tif"));
    let [page, json] = ["page.png", "view.json"].map(|name| dir.path().join(name));
    let draw = |flags: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hachure"));
        command.arg("draw").arg(&file).arg("-o").arg(&page).arg("--json").arg(&json).args(flags);
        // Soon compiled: what its lines are is nothing to places.
        command.args(["--method", "toward-away", "--hachures", "none"]);
        let ran = command.output().unwrap();
        let said = [ran.stdout, ran.stderr].map(|said| String::from_utf8_lossy(&said).into_owned()).concat();
        assert!(ran.status.success(), "{said}");
        let report: serde_json::Value = serde_json::from_slice(&std::fs::read(&json).unwrap()).unwrap();
        (said, report["view"]["eye"].clone(), std::fs::read(&page).unwrap())
    };
    for step in 0..4 {
        let eye = format!("{:.3},{:.3},2000", place.x + 321.123 + 37.031 * f64::from(step), place.y - 211.077);
        let (said, at, drawn) = draw(&["--size", "64x36", "--azimuth", "30", "--altitude", "-20", "--eye", &eye]);
        let flags = said.lines().find_map(|line| line.split_once("or with: ")).expect(&said).1;
        let (_, again, repeated) = draw(&flags.split_whitespace().collect::<Vec<_>>());
        assert_eq!(again, at, "{flags}");
        assert!(repeated == drawn, "{flags}");
    }
}

#[test]
fn a_quarter_turned_grid_is_read_with_rows_for_columns() {
    let dir = folder();
    let heights = told_apart(40, 25);
    let across = (0..1000).map(|i| heights[(i % 25) * 40 + i / 25]).collect();
    let transform = Some([5e5, 0.0, 30.0, 42e5, -20.0, 0.0]);
    let dem = read_all(&Raster { transform, ..Raster::new(25, across) }.write("GTiff", &dir.path().join("turned.tif")));
    assert_eq!(dem.held().unwrap().heights(), heights);
    assert_eq!(dem.extent(), [500_015.0, 4_199_510.0, 501_185.0, 4_199_990.0]);
    assert_eq!(converted(&dem), "rows are read for columns, north up");
}

/// Hills of a sphere of `radius`, waves of 600 m along the ground, at a place in degrees.
fn hills(place: DVec2, middle: DVec2, radius: f64) -> f64 {
    let metres = (place - middle) * (TAU / 360.0) * radius * DVec2::new(middle.y.to_radians().cos(), 1.0);
    500.0 + 40.0 * (metres.x / 600.0 * TAU).sin() * (metres.y / 600.0 * TAU).cos()
}

#[test]
fn a_sheared_map_is_warped_and_kept_whole() {
    let dir = folder();
    let (n, middle) = (120, DVec2::new(-110.0, 45.0));
    let centre = DVec2::new(middle.x * middle.y.to_radians().cos(), middle.y) * SPHERE * TAU / 360.0;
    let place = |i: usize| {
        let map = centre + DVec2::new((i % n) as f64 - 59.5, 59.5 - (i / n) as f64) * 30.0;
        let latitude = map.y / SPHERE;
        DVec2::new(map.x / SPHERE / latitude.cos(), latitude) * 360.0 / TAU
    };
    let heights: Vec<_> = (0..n * n).map(|i| hills(place(i), middle, SPHERE) as f32).collect();
    let transform = Some([centre.x - 1800.0, 30.0, 0.0, centre.y + 1800.0, 0.0, -30.0]);
    let sheared = || Raster { transform, ..Raster::new(n, heights.clone()) };
    let path = defined(sheared(), SINUSOIDAL, &dir.path().join("sheared.tif"));
    let dem = read_all(&path);
    assert_eq!((dem.georeference().world().epsg(), dem.cell()), (Some(32612), DVec2::splat(30.0)));
    let said = converted(&dem);
    for part in ["scale 0.53", " to 1.8", "shear 53.", "voids beside"] {
        assert!(said.contains(part), "{said}");
    }
    let (mut worst, mut seen) = (0.0_f64, 0);
    for (c, r) in (2..dem.rows() - 2).flat_map(|r| (2..dem.columns() - 2).map(move |c| (c, r))) {
        let inside = (c - 2..=c + 2).all(|c| (r - 2..=r + 2).all(|r| dem.height(c, r).is_some()));
        let Some(height) = dem.height(c, r).filter(|_| inside) else { continue };
        let place = dem.georeference().lonlat(dem.position(c, r).truncate()).unwrap().unwrap();
        (worst, seen) = (worst.max((f64::from(height) - hills(place, middle, SPHERE)).abs()), seen + 1);
    }
    // Of the parallelogram, not of the rectangle inside it, which holds a quarter. The shear makes cubic waves coarser.
    assert!(worst < 10.0 * WARP_METRES && seen > n * n * 3 / 4, "{worst} m, {seen} samples");
    // A crop is obeyed though it is a parallelogram there.
    let crop = [centre.x - 900.0, centre.y - 300.0, centre.x + 900.0, centre.y + 300.0];
    let part = read(&path, &cropped(crop)).unwrap();
    assert!(converted(&part).contains("all inside the crop, voids beside it"), "{}", converted(&part));
    let (file, mut seen) = (part.georeference().file(), 0);
    for (c, r) in (0..part.rows()).flat_map(|r| (0..part.columns()).map(move |c| (c, r))) {
        let place = part.georeference().place_in(file, part.position(c, r).truncate()).unwrap();
        let off = (place - centre).abs() - DVec2::new(900.0, 300.0);
        if part.height(c, r).is_some() {
            seen += 1;
            assert!(off.max_element() < 1e-3, "{c}, {r} is {off} m outside the crop");
        }
    }
    assert!((1150..1260).contains(&seen), "{seen} samples of 60 x 20 cells");
    // Left as it is where that is asked, or where the warp has no room; then it is said.
    let asked = read(&path, &ReadOptions { warp: false, ..Default::default() }).unwrap();
    let short = read(&path, &ReadOptions { memory: 1 << 17, ..Default::default() }).unwrap();
    assert_eq!(asked.held().unwrap().heights(), heights);
    assert!(short.is_filed() && short.georeference().file() == short.georeference().world());
    let said_of_short = words(short.history().assumed()).join("\n");
    for (dem, remedy) in [(asked, "leave out --no-warp, or warp it first"), (short, "cannot be warped here")] {
        let said = words(dem.history().assumed()).join("\n");
        let named = ["scale 0.53", "shear 53.", remedy, "`gdalwarp -t_srs EPSG:32612 -r cubic"];
        assert!(named.iter().all(|part| said.contains(part)), "{said}");
        assert_eq!(converted(&dem), "");
    }
    // With the memory that is named it is warped.
    let more = said_of_short.split("give --memory ").nth(1).and_then(|rest| rest.split("MiB").next()).unwrap();
    let memory = more.parse::<u64>().unwrap() << 20;
    let dem = read(&path, &ReadOptions { memory, ..Default::default() }).unwrap();
    assert!(converted(&dem).contains("warped"), "{said_of_short}");
    // Resampled, too, and then in its own system only where that is asked.
    for (warp, epsg) in [(true, Some(32612)), (false, None)] {
        let dem = read(&path, &ReadOptions { resample: Some(60.0), warp, ..Default::default() }).unwrap();
        assert_eq!((dem.georeference().world().epsg(), dem.cell()), (epsg, DVec2::splat(60.0)));
    }
}

#[test]
fn maps_of_unequal_or_other_scale_are_warped_and_true_ones_are_not() {
    let dir = folder();
    let read_at = |epsg: u32, longitude: f64, latitude: f64| {
        let place = on_map(epsg, longitude, latitude);
        let transform = Some([place.x, 30.0, 0.0, place.y, 0.0, -30.0]);
        let raster = Raster { transform, epsg: Some(epsg), ..Raster::new(40, told_apart(40, 40)) };
        read(raster.write("GTiff", &dir.path().join("map.tif")), &with_steps()).unwrap()
    };
    for (epsg, longitude, latitude, scale, zone) in [
        (32662, 10.0, 60.0, ["scale 0.999", "to 1.99"], 32632),
        (3857, 10.0, 45.0, ["scale 1.41", "shear 0.0 degrees"], 32632),
        (5070, -81.0, 25.0, ["scale 0.98", "to 1.01"], 32617),
    ] {
        let dem = read_at(epsg, longitude, latitude);
        let said = converted(&dem);
        assert_eq!(dem.georeference().world().epsg(), Some(zone), "EPSG:{epsg}: {said}");
        assert!(scale.iter().all(|part| said.contains(part)), "EPSG:{epsg}: {said}");
    }
    // Lambert, Albers near its parallels, transverse Mercator with north first, oblique Mercator, polar stereographic.
    for (epsg, longitude, latitude) in
        [(2154, 3.0, 46.0), (5070, -96.0, 40.0), (2193, 173.0, -41.0), (2056, 8.0, 47.0), (3413, 100.0, 72.0)]
    {
        let dem = read_at(epsg, longitude, latitude);
        assert_eq!(dem.held().unwrap().heights(), told_apart(40, 40), "EPSG:{epsg}");
        assert_eq!((converted(&dem), dem.history().assumed()), (String::new(), &[][..]), "EPSG:{epsg}");
    }
}

#[test]
fn degrees_too_wide_for_a_zone_are_drawn_with_a_warning() {
    let dir = folder();
    for (step, named) in [(0.3, true), (0.1, false)] {
        let transform = Some([0.0, step, 0.0, 2.0, 0.0, -step]);
        let raster = Raster { transform, epsg: Some(4326), ..Raster::new(60, told_apart(60, 20)) };
        let said = words(read_all(&raster.write("GTiff", &dir.path().join("wide.tif"))).history().assumed()).join("\n");
        assert_eq!(
            said.contains("scale 1.000 to 1.01") && said.contains("take a smaller part with --crop"),
            named,
            "{said}"
        );
    }
}

#[test]
fn shared_maps_are_true() {
    let Some(shared) = shared_dems() else { return };
    for name in ["inl_idaho_feet.tif", "west_temple_50m.tif", "yosemite_calif3_feet.tif", "SainteHelens.dem"] {
        let dem = read_all(&shared.join(name));
        assert_eq!(dem.georeference().world(), dem.georeference().file(), "{name}");
        assert!(!converted(&dem).contains("warped"), "{name}: {}", converted(&dem));
    }
}

/// By which share, at most, distances between samples of a DEM differ from those of its sphere.
fn off_sphere(dem: &Dem, radius: f64) -> f64 {
    let (c, r) = (dem.columns() - 1, dem.rows() - 1);
    let on_sphere = |c: usize, r: usize| {
        let place = dem.georeference().lonlat(dem.position(c, r).truncate()).unwrap().unwrap();
        let [longitude, latitude] = [place.x, place.y].map(f64::to_radians);
        glam::DVec3::new(latitude.cos() * longitude.cos(), latitude.cos() * longitude.sin(), latitude.sin())
    };
    let share = |a: [usize; 2], b: [usize; 2]| {
        let ground = on_sphere(a[0], a[1]).angle_between(on_sphere(b[0], b[1])) * radius;
        let map = (dem.position(a[0], a[1]) - dem.position(b[0], b[1])).truncate().length();
        (map / ground - 1.0).abs()
    };
    let pairs = [([0, 0], [c, 0]), ([0, 0], [0, r]), ([0, 0], [c, r]), ([c, 0], [0, r])];
    pairs.into_iter().map(|(a, b)| share(a, b)).fold(0.0, f64::max)
}

/// 60 x 60 samples of Mars in degrees.
pub(super) fn mars(path: &Path) -> PathBuf {
    let raster =
        Raster { transform: Some([-134.0, 0.008, 0.0, 18.5, 0.0, -0.008]), ..Raster::new(60, told_apart(60, 60)) };
    defined(raster, &format!("+proj=longlat +R={MARS} +no_defs"), path)
}

#[test]
fn other_bodies_have_a_map_on_their_own_ellipsoid() {
    let dir = folder();
    let degree = MARS * TAU / 360.0;
    let (longlat, equal) =
        (format!("+proj=longlat +R={MARS} +no_defs"), format!("+proj=eqc +R={MARS} +units=m +no_defs"));
    let step = 463.0 / degree;
    let cases = [
        ("degrees.tif", &longlat, [-134.0, step, 0.0, 18.5, 0.0, -step], [-134.0, 18.5]),
        ("south.tif", &longlat, [10.0, step, 0.0, -45.0, 0.0, -step], [10.0, -45.0]),
        ("pole.tif", &longlat, [10.0, 5.0 * step, 0.0, 88.0, 0.0, -step], [10.0, 88.0]),
        ("equal.tif", &equal, [-134.0 * degree, 463.0, 0.0, 60.0 * degree, 0.0, -463.0], [-134.0, 60.0]),
    ];
    for (name, definition, transform, [longitude, latitude]) in cases {
        let raster = Raster { transform: Some(transform), ..Raster::new(60, told_apart(60, 60)) };
        let dem = read_all(&defined(raster, definition, &dir.path().join(name)));
        let off = off_sphere(&dem, MARS);
        assert!(off < MAP_SHARE, "{name}: {off}");
        assert!(converted(&dem).starts_with("warped from"), "{name}: {}", converted(&dem));
        assert!(words(dem.history().assumed()).iter().all(|said| !said.contains("on the ground")), "{name}");
        let corner = dem.georeference().lonlat(dem.position(0, 0).truncate()).unwrap().unwrap();
        assert!((corner - DVec2::new(longitude, latitude)).abs().max_element() < 2.0, "{name}: {corner}");
        // There are no longitude and latitude of the Earth there, and those of the body lead back.
        let georeference = dem.georeference();
        let globe = georeference.globe().unwrap().unwrap();
        let back = georeference.world_place(&globe, corner).unwrap();
        assert!((back - dem.position(0, 0).truncate()).length() < 1e-3, "{name}: {back}");
        assert_eq!(georeference.world_place(&Crs::lonlat().unwrap(), corner), None, "{name}");
    }
}
