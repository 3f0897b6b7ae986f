//! Several files as one DEM.

use std::path::PathBuf;

use glam::DVec2;
use hachure::cli::words::line;
use hachure::dem::Dem;
use hachure::geo::{ReadOptions, read_all};

use super::{Raster, TRANSFORM, folder, hill};
use crate::common::words;
use crate::tolerances::PLANE_METRES;

fn together(paths: &[PathBuf]) -> Dem {
    read_all(paths, &ReadOptions::default(), &|_, _| ()).unwrap()
}

/// `TRANSFORM` moved by columns and rows.
fn moved(columns: f64, rows: f64) -> Option<[f64; 6]> {
    let [x, dx, _, y, _, dy] = TRANSFORM;
    Some([x + columns * dx, dx, 0.0, y + rows * dy, 0.0, dy])
}

#[test]
fn the_last_file_wins_and_its_voids_cover_nothing() {
    let dir = folder();
    let first = hill().write("GTiff", &dir.path().join("first.tif"));
    // Three columns farther west and one row farther south, over the first by one column.
    let values = vec![1.0f32, 2.0, 3.0, -9999.0, 5.0, 6.0, 7.0, 8.0];
    let west = Raster { transform: moved(-3.0, 1.0), nodata: Some(-9999.0), ..Raster::new(4, values) };
    let west = west.write("GTiff", &dir.path().join("west.tif"));
    let dem = together(&[first.clone(), west.clone()]);
    assert_eq!((dem.columns(), dem.rows()), (7, 3));
    assert_eq!(dem.extent(), [499_925.0, 4_199_950.0, 500_105.0, 4_199_990.0]);
    let row = |r: usize| (0..7).map(|c| dem.height(c, r)).collect::<Vec<_>>();
    let some = |values: &[f32]| values.iter().map(|v| Some(*v)).collect::<Vec<_>>();
    assert_eq!(row(0), [vec![None; 3], some(&[100.0, 101.0, 102.0, 103.0])].concat());
    assert_eq!(row(1), some(&[1.0, 2.0, 3.0, 104.0, 105.0, 106.0, 107.0]), "a void covers nothing");
    assert_eq!(row(2), some(&[5.0, 6.0, 7.0, 8.0, 109.0, 110.0, 111.0]), "the last wins");
    assert_eq!(together(&[west, first]).height(3, 2), Some(108.0), "and the other way round");
    assert_eq!(words(dem.history().converted()), ["2 files laid together: 7 x 3 samples"]);
}

#[test]
fn each_file_keeps_its_own_unit_band_and_marks() {
    let dir = folder();
    let first = hill().write("GTiff", &dir.path().join("metres.tif"));
    let source = "<SimpleSource><SourceFilename relativeToVRT=\"1\">numbers.tif</SourceFilename></SimpleSource>";
    let values = vec![1000.0f32, -32768.0, 2000.0, 3000.0];
    Raster { transform: moved(4.0, 0.0), ..Raster::new(2, values) }.write("GTiff", &dir.path().join("numbers.tif"));
    let [x, dx, _, y, _, dy] = moved(4.0, 0.0).unwrap();
    let head = format!("<SRS>EPSG:32610</SRS><GeoTransform>{x}, {dx}, 0, {y}, 0, {dy}</GeoTransform>");
    let band = format!("<UnitType>ft</UnitType>{source}");
    let feet = super::sized_vrt(&dir.path().join("feet.vrt"), 2, 2, &head, &band);
    let dem = together(&[first, feet.clone()]);
    assert_eq!((dem.height(3, 0), dem.height(4, 0), dem.height(5, 0)), (Some(103.0), Some(304.8), None));
    let feet = format!("{}: elevations x 0.3048 to metres (\"ft\")", feet.display());
    assert!(words(dem.history().converted()).contains(&feet), "{:?}", dem.history());
}

#[test]
fn other_grids_and_systems_are_warped_to_the_first() {
    let dir = folder();
    let plane = |p: DVec2| 500.0 + 0.05 * (p.x - 5e5) - 0.03 * (p.y - 42e5);
    let raster = |columns: usize, rows: usize, transform: [f64; 6]| {
        let [x, dx, _, y, _, dy] = transform;
        let place = |i: usize| DVec2::new(x + ((i % columns) as f64 + 0.5) * dx, y + ((i / columns) as f64 + 0.5) * dy);
        let values = (0..columns * rows).map(|i| plane(place(i)) as f32).collect();
        Raster { transform: Some(transform), ..Raster::new(columns, values) }
    };
    let first = raster(50, 40, TRANSFORM).write("GTiff", &dir.path().join("first.tif"));
    // Half a cell off, and of another size.
    let beside = raster(80, 60, [501_007.0, 17.0, 0.0, 4_200_003.0, 0.0, -17.0]);
    let beside = beside.write("GTiff", &dir.path().join("beside.tif"));
    let dem = together(&[first.clone(), beside.clone()]);
    assert_eq!((dem.cell(), dem.position(0, 0).x), (DVec2::new(30.0, 20.0), 500_015.0), "the grid is the first's");
    // The second ends at 502 358.5 m east and 4 198 991.5 m north, in the middle of its outermost samples.
    assert_eq!((dem.columns(), dem.rows()), (79, 50), "no row or column beyond the data");
    let mut seen = 0;
    for (c, r) in (0..dem.rows()).flat_map(|r| (0..dem.columns()).map(move |c| (c, r))).filter(|(c, _)| *c < 76) {
        let Some(_) = dem.height(c, r) else { continue };
        let p = dem.position(c, r);
        // At its border cubic convolution leans on fewer samples.
        let inside = p.x < 501_000.0 || (p.x > 501_040.0 && p.x < 502_300.0 && p.y < 4_199_960.0 && p.y > 4_199_030.0);
        assert!(!inside || (p.z - plane(p.truncate())).abs() < PLANE_METRES, "{c}, {r}: {p}, {}", plane(p.truncate()));
        seen += usize::from(p.x > 501_040.0);
    }
    assert!(seen > 800, "{seen} samples of the second file");
    let warped =
        |dem: &Dem| words(dem.history().converted()).iter().any(|c| c.contains("warped to the grid of the first"));
    assert!(warped(&dem), "{:?}", dem.history());
    // The same system under its old name falls on the same samples: no warp.
    let dem = together(&[
        first.clone(),
        Raster { transform: moved(50.0, 0.0), ..raster(50, 40, TRANSFORM) }
            .write("GTiff", &dir.path().join("next.tif")),
    ]);
    assert!(!warped(&dem) && dem.columns() == 100);
    // The neighbouring zone, over the first: heights of the first's plane seen from there are not known, places are.
    let flat = Raster {
        epsg: Some(32611),
        transform: Some([-30_000.0, 30.0, 0.0, 4_221_000.0, 0.0, -30.0]),
        ..Raster::new(60, vec![7.0f32; 3600])
    };
    let flat = flat.write("GTiff", &dir.path().join("zone.tif"));
    let dem = together(&[first, flat]);
    let sevens: Vec<_> = (0..dem.rows())
        .flat_map(|r| (0..dem.columns()).map(move |c| (c, r)))
        .filter(|(c, r)| dem.height(*c, *r).is_some_and(|h| (h - 7.0).abs() < 1e-3))
        .collect();
    let &(c, r) = sevens.iter().max_by_key(|(c, r)| c + r).unwrap();
    let there = hachure::dem::Crs::from_epsg(32611).unwrap();
    let place = dem.georeference().place_in(&there, dem.position(c, r).truncate()).unwrap();
    assert!((-30_030.0..-28_170.0).contains(&place.x) && (4_219_170.0..4_221_030.0).contains(&place.y), "{place}");
}

#[test]
fn tiles_across_the_date_line_stand_side_by_side() {
    let dir = folder();
    let tile = |west: f64, height: f32, name: &str| {
        let transform = Some([west, 0.01, 0.0, -16.0, 0.0, -0.01]);
        Raster { transform, epsg: Some(4326), ..Raster::new(20, vec![height; 400]) }
            .write("GTiff", &dir.path().join(name))
    };
    let dem = together(&[tile(179.8, 10.0, "west.tif"), tile(-180.0, 20.0, "east.tif")]);
    assert_eq!(dem.voids(), 0);
    assert!(dem.extent()[2] - dem.extent()[0] > 35_000.0, "{:?}", dem.extent());
    for order in [["west.tif", "east.tif"], ["east.tif", "west.tif"]] {
        let paths = order.map(|name| dir.path().join(name));
        let part = read_all(&paths, &super::cropped([179.9, -16.15, 180.1, -16.05]), &|_, _| ()).unwrap();
        assert_eq!(part.voids(), 0, "{order:?}");
    }
    let r = dem.rows() / 2;
    assert_eq!((dem.height(3, r), dem.height(dem.columns() - 3, r)), (Some(10.0), Some(20.0)));
}

#[test]
fn a_far_finer_file_is_refused_before_it_is_read() {
    let dir = folder();
    let first = hill().write("GTiff", &dir.path().join("first.tif"));
    let fine = "<SRS>EPSG:32610</SRS><GeoTransform>500000, 0.001, 0, 4200000, 0, -0.001</GeoTransform>";
    let fine = super::sized_vrt(&dir.path().join("fine.vrt"), 40_000, 40_000, fine, "<Scale>1</Scale>");
    let error = read_all(&[first, fine.clone()], &ReadOptions::default(), &|_, _| ()).unwrap_err().to_string();
    assert!(error.starts_with(&format!("{}: 1600000000 samples would be read", fine.display())), "{error}");
}

#[test]
fn files_that_lie_nowhere_are_not_laid_together() {
    let dir = folder();
    let image = |name: &str| Raster { transform: None, epsg: None, ..hill() }.write("GTiff", &dir.path().join(name));
    let paths = [image("a.tif"), image("b.tif")];
    let error = read_all(&paths, &ReadOptions { cell: Some(5.0), ..Default::default() }, &|_, _| ()).unwrap_err();
    assert!(line(&error).contains("cannot be laid beside others; draw it alone with --cell"), "{error}");
}

#[test]
fn files_that_no_way_connects_are_refused() {
    let dir = folder();
    let first = hill().write("GTiff", &dir.path().join("hill.tif"));
    let bare = Raster { epsg: None, ..hill() }.write("GTiff", &dir.path().join("bare.tif"));
    let error = read_all(&[first, bare.clone()], &ReadOptions::default(), &|_, _| ()).unwrap_err().to_string();
    assert!(error.starts_with(&format!("{}: lies in no named coordinate system", bare.display())), "{error}");
    assert!(error.contains("EPSG:32610") && error.contains("-a_srs"), "{error}");
    let none = read_all(&[], &ReadOptions::default(), &|_, _| ()).unwrap_err().to_string();
    assert!(none.contains("no file is named"), "{none}");
}

#[test]
fn a_system_without_a_name_is_called_so() {
    let dir = folder();
    hill().write("GTiff", &dir.path().join("hill.tif"));
    let source = "<SimpleSource><SourceFilename relativeToVRT=\"1\">hill.tif</SourceFilename></SimpleSource>";
    let local = "<SRS>LOCAL_CS[\"unknown\",UNIT[\"metre\",1]]</SRS>\
                 <GeoTransform>500000, 30, 0, 4200000, 0, -20</GeoTransform>";
    let own = super::vrt(&dir.path().join("own.vrt"), local, source);
    let error = read_all(&[own, dir.path().join("hill.tif")], &Default::default(), &|_, _| ());
    let said = error.unwrap_err().to_string();
    assert!(said.contains(" to an unnamed system, that of ") && !said.contains("unknown"), "{said}");
}
