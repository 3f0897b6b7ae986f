//! Colours are no elevations, unless elevations were packed into them.

use std::path::{Path, PathBuf};

use gdal::raster::ColorInterpretation::{AlphaBand, BlueBand, GrayIndex, GreenBand, PaletteIndex, RedBand};
use hachure::door::cli::words::line;
use hachure::geo::{Encoding, ReadOptions, read};

use super::{Bands, FILED, SIDE, assumed, cured, doubt, folder, land, marked, one, same, with_steps};

/// The line that a picture is refused with, held and filed.
fn refused(path: &Path, options: &ReadOptions, words: &[&str]) -> String {
    let [line, filed] = [options.memory, FILED]
        .map(|memory| line(&read(path, &ReadOptions { memory, ..options.clone() }).expect_err("a picture was read")));
    assert_eq!(line, filed);
    words.iter().for_each(|word| assert!(line.contains(word), "no {word:?}: {line}"));
    line
}

/// The land as a picture, and its heights packed into colours.
fn shade() -> Vec<u8> {
    land().iter().map(|n| (n / 6.0) as u8).collect()
}

fn packed(encoding: Encoding) -> Vec<Vec<u8>> {
    let number = |metres: f64| match encoding {
        Encoding::TerrainRgb => ((metres + 10_000.0) * 10.0).round() as u32,
        _ => ((metres + 32_768.0) * 256.0).round() as u32,
    };
    [16, 8, 0].map(|shift| land().iter().map(|metres| (number(*metres) >> shift) as u8).collect()).to_vec()
}

fn coloured(bands: Vec<Vec<u8>>, path: &Path) -> PathBuf {
    Bands { colours: vec![RedBand, GreenBand, BlueBand, AlphaBand], ..Bands::new(bands) }.write(path)
}

#[test]
fn pictures_are_refused_unless_a_band_is_named() {
    let dir = folder();
    let rgb = coloured(vec![shade(); 3], &dir.path().join("rgb.tif"));
    let remedy = ["band 1 holds the red of a picture", "--band 1"];
    refused(&rgb, &with_steps(), &remedy);
    let rgba = coloured(vec![shade(); 4], &dir.path().join("rgba.tif"));
    refused(&rgba, &with_steps(), &remedy);
    let palette = Bands { colours: vec![PaletteIndex], ..Bands::new(vec![shade()]) };
    let palette = palette.write(&dir.path().join("palette.tif"));
    refused(&palette, &with_steps(), &["band 1 holds numbers of colours in a palette", "--band 1"]);
    for path in [rgb, rgba, palette] {
        let dem = read(&path, &ReadOptions { band: Some(1), ..with_steps() }).unwrap();
        same(&dem, &shade().into_iter().map(f64::from).collect::<Vec<_>>(), 0.0);
    }
    // For a picture is no picture of elevations.
    let rgb = dir.path().join("rgb.tif");
    for encoding in [Encoding::TerrainRgb, Encoding::Terrarium] {
        let asked = ReadOptions { encoding: Some(encoding), ..with_steps() };
        refused(&rgb, &asked, &["is no picture of elevations", encoding.name(), "leave --encoding out"]);
    }
    let land = one(&land(), |n| n as f32).write(&dir.path().join("land.tif"));
    let asked = ReadOptions { encoding: Some(Encoding::Terrarium), ..with_steps() };
    refused(&land, &asked, &["is no picture of elevations"]);
}

#[test]
fn elevations_in_colours_are_named_and_decoded() {
    let dir = folder();
    let path = dir.path().join("packed.tif");
    let (steep, holes): (Vec<_>, Vec<_>) = (land(), marked(f64::NAN, &land()));
    let opaque: Vec<u8> = marked(0.0, &vec![255.0; SIDE * SIDE]).iter().map(|n| *n as u8).collect();
    for encoding in [Encoding::TerrainRgb, Encoding::Terrarium] {
        let name = encoding.name();
        coloured(packed(encoding), &path);
        let line = refused(&path, &with_steps(), &["packed into its colours", &format!("--encoding {name} ")]);
        same(&cured(&path, &line, "--encoding"), &steep, 1e-4);
        coloured([packed(encoding), vec![opaque.clone()]].concat(), &path);
        let line = refused(&path, &with_steps(), &[&format!("--encoding {name} ")]);
        same(&cured(&path, &line, "--encoding"), &holes, 1e-4);
        // The other one is not it, and says so.
        let other = if encoding == Encoding::Terrarium { Encoding::TerrainRgb } else { Encoding::Terrarium };
        let asked = ReadOptions { encoding: Some(other), ..with_steps() };
        refused(&path, &asked, &[&format!("give --encoding {name}")]);
        // Colours that nobody calls so.
        Bands { colours: vec![GrayIndex], ..Bands::new(packed(encoding)) }.write(&path);
        let line = refused(&path, &with_steps(), &[&format!("--encoding {name} ")]);
        same(&cured(&path, &line, "--encoding"), &steep, 1e-4);
    }
}

#[test]
fn eight_bits_are_warned_of() {
    let dir = folder();
    let path = Bands::new(vec![shade()]).write(&dir.path().join("shade.tif"));
    let line = doubt(&path, &["8-bit numbers, 0 to 255", "hillshade"]);
    same(&cured(&path, &line, "--elevation-unit"), &shade().into_iter().map(f64::from).collect::<Vec<_>>(), 0.0);
}

#[test]
fn the_band_that_is_called_elevation_is_taken() {
    let dir = folder();
    let path = dir.path().join("bands.tif");
    let heights: Vec<f32> = land().iter().map(|n| *n as f32).collect();
    let other: Vec<f32> = heights.iter().map(|n| n / 7.0).collect();
    for (names, taken) in [
        (["count", "Elevation (m)", "mean"], 2),
        (["mean", "idw", "max"], 2),
        (["min", "demand", "z_MEAN"], 3),
        (["height", "x", "DEM"], 3),
    ] {
        let mut bands = vec![other.clone(); 3];
        bands[taken - 1].clone_from(&heights);
        Bands { names: names.to_vec(), ..Bands::new(bands) }.write(&path);
        let told = format!("elevations are in band {taken} of 3, called {}", names[taken - 1]);
        let all = format!("the bands are 1 {}, 2 {}, 3 {}", names[0], names[1], names[2]);
        doubt(&path, &[&told, &all, "--band N"]);
        same(&read(&path, &with_steps()).unwrap(), &land(), 0.0);
        let first = read(&path, &ReadOptions { band: Some(1), ..with_steps() }).unwrap();
        assert_eq!(first.height(40, 40) == Some(heights[40 * SIDE + 40]), taken == 1);
    }
    Bands { names: vec!["count", "stdev"], ..Bands::new(vec![heights.clone(), other]) }.write(&path);
    doubt(&path, &["elevations are in band 1 of 2 (the bands are 1 count, 2 stdev;"]);
    // A mask is no second band to choose from.
    let opaque: Vec<f32> = marked(0.0, &vec![255.0; SIDE * SIDE]).iter().map(|n| *n as f32).collect();
    Bands { colours: vec![GrayIndex, AlphaBand], ..Bands::new(vec![heights, opaque]) }.write(&path);
    assert_eq!(assumed(std::slice::from_ref(&path), &with_steps()), Vec::<String>::new());
    same(&read(&path, &with_steps()).unwrap(), &marked(f64::NAN, &land()), 0.0);
}
