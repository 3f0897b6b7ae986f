//! From strokes to pages: how strokes come out, files that appear whole.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use hachure::door::files::Output;
use hachure::door::line::crowded;
use hachure::error::Error;
use hachure::ink::Surround;
use hachure::ink::plot::Journey;
use hachure::ink::style::Weight;
use hachure::ink::{Colour, Drawing, Layer, Pen, Sheet, Stroke, StrokeForm, StrokePoint, Style, draw, write_png};
use hachure::line::{Chain, ChainPoint, InkRaster, Kind, Line, Lines, Marks, Pixel, Recession};
use hachure::view::{Camera, Perspective};

use crate::ink::raster;

/// A camera towards north with the near plane at 1 m, and a raster whose rows from `crest` down show a near surface.
fn ridge(crest: u32) -> (Perspective, InkRaster) {
    let (width, height) = (100, 80);
    let camera = Camera { eye: DVec3::ZERO, azimuth: 0.0, altitude: 0.0, fov: 60.0, width, height };
    let near_rows = |row: i64| row >= i64::from(crest);
    let pixels = raster(width, height, |_, row| near_rows(row).then_some((Kind::Cover, 0.01)));
    let sky = |(i, p): (usize, &Pixel)| {
        if near_rows((i / 100) as i64) { *p } else { Pixel::new(Kind::Sky, DVec2::ZERO, 0.0) }
    };
    (
        Perspective::new(&camera, 1.0),
        InkRaster { pixels: pixels.pixels.iter().enumerate().map(sky).collect(), ..pixels },
    )
}

/// The drawing of lines, blunt, a pixel a millimetre.
fn drawn(lines: &Lines) -> Drawing {
    let weight = Weight { taper: 0.0, ..Weight::default() };
    let sheet =
        Sheet { size: DVec2::new(lines.width.into(), lines.height.into()), margin: 0.0, surround: Surround::NONE };
    draw(lines, &sheet, &Style { weight, ..Style::default() }, &[]).expect("a drawing")
}

/// The lines of a page of chains over a raster.
fn lines(chains: Vec<Chain>, raster: &InkRaster, seen: &Perspective) -> Lines {
    let marks = Marks::from(raster);
    let (width, height) = (raster.width, raster.height);
    let (eye, hidden) = (seen.eye(), Vec::new());
    Lines {
        width,
        height,
        eye,
        hidden,
        chains: crowded(&chains, &marks, seen),
        recession: Recession::of(marks.depths().map(|depth| (depth, 1.0))),
        own: Vec::new(),
    }
}

#[test]
fn every_kind_of_line_stands_in_a_layer() {
    let (seen, raster) = ridge(80);
    let point = |x: f64| {
        let (place, depth) = (DVec2::new(x, 10.0), 0.01);
        let world = seen.unproject(place, depth.into());
        ChainPoint { place, line: Line::Own(0), depth, behind: 0.0, world, crowd: 0, weight: 1.0, black: 1.0 }
    };
    let layer_of = |line: Line| {
        let points = [10.0, 20.0].map(|x| ChainPoint { line, ..point(x) }).to_vec();
        let chain = Chain { id: None, points, closed: false };
        let layers = drawn(&lines(vec![chain], &raster, &seen)).layers;
        layers.into_iter().map(|layer| layer.name).collect::<Vec<_>>()
    };
    for (kinds, layer) in [
        (&[Line::Occluding, Line::Skyline][..], "silhouette"),
        (&[Line::Border], "border"),
        (&[Line::Shore], "shore"),
        (&[Line::Drainage], "drainage"),
        (&[Line::Ridge], "ridge"),
        (&[Line::Own(0)], "own"),
    ] {
        assert!(kinds.iter().all(|line| layer_of(*line) == [format!("1 {layer}")]), "{layer}: {kinds:?}");
    }
}

/// Widths of the strokes of a chain with what lies behind its points and their weights, 10 px apart at depth 0.01.
fn strokes_of(points: &[(f32, f32)], closed: bool) -> Vec<Vec<f64>> {
    let (seen, _) = ridge(80);
    let point = |(x, &(behind, weight)): (f64, &(f32, f32))| {
        let place = DVec2::new(10.0 * x + 5.0, 10.0);
        let world = seen.unproject(place, 0.01);
        ChainPoint { place, line: Line::Occluding, depth: 0.01, behind, world, crowd: 0, weight, black: 1.0 }
    };
    let points = (0..).map(f64::from).zip(points).map(point).collect();
    let chains = vec![Chain { id: None, points, closed }];
    let (eye, recession) = (seen.eye(), Recession::of([(0.01, 1.0)].into_iter()));
    let lines = Lines { width: 100, height: 80, eye, hidden: vec![], chains, recession, own: vec![] };
    let layers = drawn(&lines).layers;
    let strokes = layers.iter().flat_map(|layer| &layer.strokes);
    strokes.map(|stroke| stroke.points.iter().map(|point| point.width).collect()).collect()
}

#[test]
fn strokes_end_where_lines_have_no_weight() {
    let strokes = |weights: &[f32], closed| strokes_of(&weights.iter().map(|&w| (0.0, w)).collect::<Vec<_>>(), closed);
    assert_eq!(strokes(&[1.0, 0.5, 1.0], false), [[1.0, 0.5, 1.0]], "weights are widths");
    let cut = strokes(&[0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.5], false);
    assert_eq!(cut, [vec![0.0, 1.0, 0.0, 1.0, 0.0], vec![0.0, 0.5]]);
    assert_eq!(strokes(&[1.0, 1.0, 0.0, 0.0], true), [[0.0, 1.0, 1.0, 0.0]], "across the seam of a closed line");
    assert!(strokes(&[0.0; 3], false).is_empty() && strokes(&[0.0; 3], true).is_empty());
    assert_eq!(strokes(&[0.5, 1.0, 1.0], true), [[0.5, 1.0, 1.0]]);
}

#[test]
fn jumps_thicken_lines() {
    let width = |behind: f32| strokes_of(&[(behind, 1.0), (behind, 1.0)], false)[0][0];
    let widths = [0.01, 0.0099, 0.009, 0.005, 0.0].map(width);
    assert!(widths.windows(2).all(|pair| pair[0] < pair[1]) && widths[4] == 1.0 && widths[0] > 0.5, "{widths:?}");
}

/// The page of one layer in black on white, gray values by row and column.
fn page(width: u32, height: u32, pen: f64, strokes: Vec<Stroke>) -> image::GrayImage {
    let pen = Pen { width: pen, colour: Colour([0; 3]), opacity: 1.0 };
    let layers = vec![Layer {
        name: "1 ink".into(),
        pen,
        form: StrokeForm::Outlines,
        found: Journey::default(),
        strokes,
        areas: Vec::new(),
    }];
    let sheet = Sheet { size: DVec2::new(width.into(), height.into()), margin: 0.0, surround: Surround::NONE };
    let mut file = Vec::new();
    write_png(&Drawing { sheet, paper: Colour([255; 3]), layers, title: None, seal: None }, 1.0, &mut file).unwrap();
    image::load_from_memory(&file).unwrap().to_luma8()
}

/// A stroke of full width through these places.
fn through(places: &[(f64, f64)]) -> Stroke {
    let point = |&(x, y): &(f64, f64)| StrokePoint { place: DVec2::new(x, y), width: 1.0 };
    Stroke { chain: None, piece: 0, points: places.iter().map(point).collect(), closed: false }
}

/// Ink on a page in whole black pixels.
fn ink_of(page: &image::GrayImage) -> f64 {
    page.pixels().map(|p| 1.0 - f64::from(p.0[0]) / 255.0).sum()
}

#[test]
fn strokes_have_their_width_without_beads_gaps_or_seams() {
    // Across tile borders, with many joints, thinner than a pixel.
    for (pen, joints) in [(0.6, 2), (0.6, 300), (3.0, 300)] {
        let places: Vec<(f64, f64)> = (0..joints)
            .map(|i| 10.0 + 280.0 * f64::from(i) / f64::from(joints - 1))
            .map(|x| (x, 100.0 + x / 7.0))
            .collect();
        let page = page(300, 200, pen, vec![through(&places)]);
        let column = |x: u32| (0..200).map(|y| 1.0 - f64::from(page.get_pixel(x, y).0[0]) / 255.0).sum::<f64>();
        let expected = pen * (1.0_f64 + 1.0 / 49.0).sqrt();
        for x in 20..280 {
            assert!((column(x) - expected).abs() < 0.05, "pen {pen}, {joints} joints, column {x}: {}", column(x));
        }
    }
}

#[test]
fn junctions_are_not_darker_and_dots_are_round() {
    let cross = page(64, 64, 0.8, vec![through(&[(5.0, 32.5), (59.0, 32.5)]), through(&[(32.5, 5.0), (32.5, 59.0)])]);
    let (arm, heart) = (cross.get_pixel(20, 32).0[0], cross.get_pixel(32, 32).0[0]);
    assert!(arm > 40 && heart < arm, "the pixel of the crossing is fuller, {heart} against {arm}");
    let twice = page(64, 64, 0.8, vec![through(&[(5.0, 32.5), (59.0, 32.5)]), through(&[(5.0, 32.5), (40.0, 32.5)])]);
    assert_eq!(twice.get_pixel(20, 32), twice.get_pixel(50, 32), "a line drawn twice is not darker");
    let dot = ink_of(&page(20, 20, 6.0, vec![through(&[(10.3, 9.6)])]));
    assert!((dot - TAU / 2.0 * 9.0).abs() < 0.5, "{dot}");
    assert_eq!(ink_of(&page(20, 20, 6.0, vec![])), 0.0);
}

#[test]
fn closed_strokes_and_huge_pages_are_drawn_whole() {
    let corners = (0..40).map(|i| DVec2::from_angle(TAU * f64::from(i) / 40.0) * 20.0 + 32.0);
    let points = corners.map(|place| StrokePoint { place, width: 1.0 }).collect();
    let ring = ink_of(&page(64, 64, 2.0, vec![Stroke { chain: None, piece: 0, points, closed: true }]));
    assert!((ring - TAU * 20.0 * 2.0).abs() < 3.0, "{ring}");
    let wide = page(40_000, 4, 1.0, vec![through(&[(-10.0, 2.5), (40_010.0, 2.5)])]);
    assert!(wide.enumerate_pixels().all(|(_, y, p)| (p.0[0] < 5) == (y == 2)));
    let sheet = Sheet { size: DVec2::new(0.0, 5.0), margin: 0.0, surround: Surround::NONE };
    assert!(
        write_png(
            &Drawing { sheet, paper: Colour([255; 3]), layers: vec![], title: None, seal: None },
            1.0,
            Vec::new()
        )
        .is_err()
    );
}

#[test]
fn bands_do_not_show() {
    // From corner to corner over three bands, and a page that ends in the second.
    let strokes = || vec![through(&[(3.3, 2.2), (150.1, 180.7), (290.4, 380.0)]), through(&[(250.0, 127.9)])];
    let tall = page(300, 384, 2.3, strokes());
    let short = page(300, 200, 2.3, strokes());
    assert!(ink_of(&short) > 400.0 && short.rows().zip(tall.rows()).all(|(a, b)| a.eq(b)));
    // However many bands are filled at a time.
    let by = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| page(300, 384, 2.3, strokes()))
    };
    assert!(by(1) == tall && by(2) == tall && by(5) == tall);
}

#[test]
fn outputs_appear_whole_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.png");
    let files = || std::fs::read_dir(folder.path()).unwrap().count();
    let mut output = Output::create(&path).unwrap();
    assert!(!path.exists());
    output.write(|file| file.write_all(b"whole")).unwrap();
    output.publish().unwrap();
    assert_eq!((std::fs::read(&path).unwrap(), files()), (b"whole".to_vec(), 1));
    let broken = Output::create(&path).unwrap().write(|file| {
        file.write_all(b"half")?;
        Err(std::io::Error::other("the disk is full"))
    });
    assert!(matches!(broken, Err(Error::Output { path: p, what, .. }) if p == path && what == "the disk is full"));
    drop(Output::create(&path).unwrap());
    assert_eq!((std::fs::read(&path).unwrap(), files()), (b"whole".to_vec(), 1));
    for wrong in [folder.path().to_owned(), folder.path().join("missing/out.png"), "".into(), path.join("out.png")] {
        assert!(matches!(Output::create(&wrong), Err(Error::Output { .. })), "{}", wrong.display());
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let plain = folder.path().join("plain");
        std::fs::write(&plain, "").unwrap();
        let mode = |path: &std::path::Path| std::fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&path), mode(&plain), "permissions of any new file");
        let link = folder.path().join("link");
        std::os::unix::fs::symlink(&plain, &link).unwrap();
        let mut output = Output::create(&link).unwrap();
        output.write(|file| file.write_all(b"linked")).unwrap();
        output.publish().unwrap();
        assert_eq!(std::fs::read(&plain).unwrap(), b"linked", "a link stays a link");
        assert!(Output::create(std::path::Path::new("/dev/null")).is_err(), "a device stays a device");
    }
}
