//! Several files as one DEM.

use std::path::PathBuf;

use glam::DVec2;
use hachure::dem::Dem;
use hachure::door::cli::words::line;
use hachure::geo::{ReadOptions, read_all};

use super::{Raster, TRANSFORM, folder, hill};
use crate::common::words;

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
fn like_grids_and_systems_lie_as_given() {
    let dir = folder();
    let raster = |transform: [f64; 6], height: f32, name: &str| {
        Raster { transform: Some(transform), ..Raster::new(50, vec![height; 2000]) }
            .write("GTiff", &dir.path().join(name))
    };
    let first = raster(TRANSFORM, 500.0, "first.tif");
    // Half a cell off, of like cells: one on the other, in the grid of the first.
    let [x, dx, _, y, _, dy] = TRANSFORM;
    let shifted = raster([x + 615.0, dx, 0.0, y - 310.0, 0.0, dy], 7.0, "shifted.tif");
    for (paths, above) in [([&first, &shifted], 7.0), ([&shifted, &first], 500.0)] {
        let dem = together(&paths.map(PathBuf::clone));
        assert_eq!(dem.cell(), DVec2::new(30.0, 20.0));
        let [lower, upper] = paths.map(|path| path.file_name().unwrap().display().to_string());
        let said = words(dem.history().converted());
        assert!(said[0].starts_with(&format!("{upper} on {lower}, cells of 30 m, seams blended over ")), "{said:?}");
        // In the middle of what they share, over four cells from the border of either.
        let place = DVec2::new(x + 1060.0, y - 550.0);
        let cell = |i: usize| (place[i] - dem.position(0, 0)[i]).abs() / dem.cell()[i];
        let height = dem.height(cell(0).round() as usize, cell(1).round() as usize);
        assert_eq!(height, Some(above), "{said:?}");
    }
    // The same system under its old name falls on the same samples: no warp.
    let next = Raster { transform: moved(50.0, 0.0), ..Raster::new(50, vec![500.0f32; 2000]) };
    let dem = together(&[first.clone(), next.write("GTiff", &dir.path().join("next.tif"))]);
    assert!(dem.columns() == 100 && words(dem.history().converted()) == ["2 files laid together: 100 x 40 samples"]);
    // The neighbouring zone, over the first: places are known.
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
