//! Ink: from pixels to strokes, on rasters made here.

use glam::{DVec2, DVec3, UVec2};
use hachure::door::line::{smooth, trace};
use hachure::ink::{self, Drawing, Sheet, Style, Surround, write_mask};
use hachure::line::{Chain, InkRaster, Kind, Line, Lines, Marks, Pixel};
use hachure::view::{Camera, Perspective};

const TOLERANCE: f64 = 0.6;

/// How a page of so many pixels is seen: towards the north, the near plane at 1 m.
fn perspective([width, height]: [u32; 2]) -> Perspective {
    let camera = Camera { eye: DVec3::ZERO, azimuth: 0.0, altitude: 0.0, fov: 60.0, width, height };
    Perspective::new(&camera, 1.0)
}

/// The chains of a raster's ink.
fn trace(raster: &InkRaster) -> Vec<Chain> {
    trace::trace(&Marks::from(raster), &perspective([raster.width, raster.height]))
}

/// The chains smoothed.
fn smooth(chains: &[Chain], tolerance: f64) -> Vec<Chain> {
    smooth::smooth(chains, &perspective([64, 64]), tolerance)
}

/// The drawing of a raster's ink, a pixel a millimetre.
fn draw(raster: &InkRaster, style: &Style) -> Drawing {
    let (marks, frame) = (Marks::from(raster), [raster.width, raster.height]);
    let sheet = Sheet { size: UVec2::from(frame).as_dvec2(), margin: 0.0, surround: Surround::NONE };
    ink::draw(&Lines::of(&marks, &perspective(frame), TOLERANCE), &sheet, style, &[]).expect("a drawing")
}

/// A raster of cover at depth 0.01 with ink wherever `ink` gives a kind and a depth for column and row.
pub fn raster(width: u32, height: u32, ink: impl Fn(i64, i64) -> Option<(Kind, f32)>) -> InkRaster {
    let places = (0..i64::from(height)).flat_map(|y| (0..i64::from(width)).map(move |x| (x, y)));
    let pixel = |(x, y)| {
        let (kind, depth) = ink(x, y).unwrap_or((Kind::Cover, 0.01));
        Pixel::new(kind, DVec2::ZERO, depth)
    };
    InkRaster { width, height, pixels: places.map(pixel).collect() }
}

/// A raster from rows of text: `#` and digits are silhouette (a digit d at depth 1 / 2^d), `b` is border.
fn picture(rows: &[&str]) -> InkRaster {
    let at = |x: i64, y: i64| match rows[y as usize].as_bytes()[x as usize] {
        b'#' => Some((Kind::Silhouette, 1.0)),
        b'b' => Some((Kind::Border, 1.0)),
        d @ b'0'..=b'9' => Some((Kind::Silhouette, 0.5_f32.powi(i32::from(d - b'0')))),
        _ => None,
    };
    raster(rows[0].len() as u32, rows.len() as u32, at)
}

/// A raster of silhouette pixels nearest to a line y(x).
fn graph_of(width: u32, height: u32, y: impl Fn(f64) -> f64) -> InkRaster {
    raster(width, height, |column, row| {
        (y(column as f64 + 0.5).floor() as i64 == row).then_some((Kind::Silhouette, 1.0))
    })
}

/// Largest distance of an ink pixel's centre from the nearest chain point, px.
fn farthest_ink(raster: &InkRaster, chains: &[Chain]) -> f64 {
    let centre = |i: usize| DVec2::new((i as u32 % raster.width) as f64, (i as u32 / raster.width) as f64) + 0.5;
    let points: Vec<DVec2> = chains.iter().flat_map(|c| &c.points).map(|p| p.place).collect();
    let ink = raster.pixels.iter().enumerate().filter(|(_, p)| p.is_ink()).map(|(i, _)| centre(i));
    ink.map(|c| points.iter().map(|p| p.distance(c)).fold(f64::INFINITY, f64::min)).fold(0.0, f64::max)
}

/// Distance of a place from a chain's polyline, px.
fn distance_to(chain: &Chain, place: DVec2) -> f64 {
    let closing = chain.closed.then(|| chain.points[0]);
    let points: Vec<DVec2> = chain.points.iter().chain(&closing).map(|p| p.place).collect();
    let to = |a: DVec2, b: DVec2| {
        let t = ((place - a).dot(b - a) / (b - a).length_squared().max(1e-12)).clamp(0.0, 1.0);
        place.distance(a.lerp(b, t))
    };
    points.windows(2).map(|w| to(w[0], w[1])).fold(points[0].distance(place), f64::min)
}

/// Largest turning angle between two segments of a chain, degrees.
fn sharpest_turn(chain: &Chain) -> f64 {
    let points: Vec<DVec2> = chain.points.iter().map(|p| p.place).collect();
    points.windows(3).map(|w| (w[1] - w[0]).angle_to(w[2] - w[1]).abs().to_degrees()).fold(0.0, f64::max)
}

/// A wild but repeatable picture: blobs, speckles and lines.
fn speckled(share: u64) -> InkRaster {
    raster(90, 70, |x, y| {
        let mut h = (x as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ (y as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F);
        h = (h ^ (h >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        ((h >> 33) % 100 < share).then_some((Kind::Silhouette, 1.0))
    })
}

#[test]
fn pixel_packs_kind_place_and_depth() {
    for kind in [Kind::Sky, Kind::Cover, Kind::Silhouette, Kind::Border] {
        let pixel = Pixel::new(kind, DVec2::new(-1.5, 0.734375), 0.25);
        assert_eq!((pixel.kind(), pixel.place(), pixel.depth()), (kind, DVec2::new(-1.5, 0.734375), 0.25));
        assert_eq!(pixel.is_ink(), matches!(kind, Kind::Silhouette | Kind::Border));
        assert_eq!(pixel.distance(2.0), 8.0);
    }
    let words = [2 | 0xA0 << 8 | 47 << 16, 0.25_f32.to_bits()];
    assert_eq!(
        bytemuck::cast_slice::<u32, Pixel>(&words),
        [Pixel::new(Kind::Silhouette, DVec2::new(-1.5, 0.734375), 0.25)]
    );
}

#[test]
fn mask_has_one_bit_a_pixel_and_ink_is_0() {
    let raster = picture(&["#..b.....#.", "...........", "..........#"]);
    let mut file = Vec::new();
    write_mask([11, 3], Marks::from(&raster).places(), None, &mut file).unwrap();
    assert_eq!((file[24], file[25]), (1, 0), "bit depth and colour type of the PNG header");
    let read = image::load_from_memory(&file).unwrap().to_luma8();
    assert_eq!(read.dimensions(), (11, 3));
    let expected: Vec<u8> = raster.pixels.iter().map(|p| if p.is_ink() { 0 } else { 255 }).collect();
    assert_eq!(read.into_raw(), expected);
    assert!(write_mask([0, 0], [], None, Vec::new()).is_err());
}

#[test]
fn a_line_is_one_chain_and_a_gap_cuts_it() {
    let line = graph_of(80, 40, |x| 5.0 + 0.3 * x);
    assert_eq!(trace(&line).len(), 1);
    // One missing pixel is bridged, five are not.
    let without = |gap: std::ops::Range<i64>| {
        let mut cut = line.clone();
        let width = i64::from(cut.width);
        for (i, pixel) in cut.pixels.iter_mut().enumerate() {
            if gap.contains(&(i as i64 % width)) {
                *pixel = Pixel::new(Kind::Cover, DVec2::ZERO, 0.01);
            }
        }
        cut
    };
    assert_eq!(trace(&without(40..41)).len(), 1);
    assert_eq!(trace(&without(40..45)).len(), 2);
    // The coverage check notices a chain that lacks a run.
    assert!(farthest_ink(&line, &trace(&line)) <= 1.5);
    assert!(farthest_ink(&line, &trace(&without(40..45))) > 1.5);
}

#[test]
fn nothing_inked_is_lost() {
    for share in [0, 1, 10, 30, 50, 70, 90, 97, 100] {
        let raster = speckled(share);
        let chains = trace(&raster);
        assert!(farthest_ink(&raster, &chains) <= 1.5, "{share} % ink");
        assert_eq!(chains, trace(&raster), "{share} % ink: another run, another result");
        assert!(chains.iter().all(|c| !c.points.is_empty()));
    }
}

#[test]
fn rings_close_and_lone_pixels_are_dots() {
    let ring = raster(60, 60, |x, y| {
        let r = ((x as f64 - 30.0).powi(2) + (y as f64 - 30.0).powi(2)).sqrt();
        ((r - 20.0).abs() < 0.7).then_some((Kind::Silhouette, 1.0))
    });
    let chains = trace(&ring);
    assert_eq!(chains.iter().map(|c| c.closed).collect::<Vec<_>>(), [true]);
    let dot = trace(&picture(&["...", ".#.", "..."]));
    assert_eq!((dot.len(), dot[0].points.len(), dot[0].points[0].place), (1, 1, DVec2::new(1.5, 1.5)));
    let style = Style::default();
    assert!(draw(&picture(&["...", ".#.", "..."]), &style).layers.is_empty());
    assert_eq!(draw(&picture(&["...", ".#.", "..."]), &Style { dots: true, ..style }).layers[0].strokes.len(), 1);
}

#[test]
fn chains_run_through_the_places_of_their_pixels() {
    let y = |x: f64| 5.0 + 0.3 * x;
    let mut line = graph_of(80, 40, y);
    for (i, pixel) in line.pixels.iter_mut().enumerate().filter(|(_, p)| p.is_ink()) {
        let centre = DVec2::new((i % 80) as f64 + 0.5, (i / 80) as f64 + 0.5);
        *pixel = Pixel::new(Kind::Silhouette, DVec2::new(0.0, y(centre.x) - centre.y), 1.0);
    }
    let off = |c: &Chain| c.points.iter().map(|p| (p.place.y - y(p.place.x)).abs()).fold(0.0, f64::max);
    let raw = trace(&line);
    assert!(off(&raw[0]) <= 0.5 / 64.0 && off(&smooth(&raw, TOLERANCE)[0]) < 0.01);
    assert!(off(&trace(&graph_of(80, 40, y))[0]) > 0.3, "without places the line is pixel stairs");
}

#[test]
fn lines_two_pixels_apart_stay_apart() {
    let chains = trace(&picture(&["............", ".##########.", "............", "##########..", "............"]));
    assert_eq!(chains.len(), 2);
    for chain in chains {
        assert!(chain.points.iter().all(|p| p.place.y == chain.points[0].place.y));
    }
}

#[test]
fn slanting_lines_that_touch_by_corners_have_no_rungs() {
    let ladder = |gap: i64| {
        let on = move |x: i64, y: i64| x == y + 1 + gap || (x == y + 1 && (6..24).contains(&y));
        raster(40, 30, move |x, y| on(x, y).then_some((Kind::Silhouette, 1.0)))
    };
    for gap in [2, 4] {
        let chains = trace(&ladder(gap));
        assert_eq!(chains.len(), 2, "{gap} px apart");
        assert!(chains.iter().all(|c| c.points.len() >= 18), "{gap} px apart");
        assert!(farthest_ink(&ladder(gap), &chains) <= 1.5);
    }
}

#[test]
fn a_hole_of_one_pixel_is_no_loop() {
    let pierced = picture(&["....###....", "#####.#####", "....###...."]);
    assert_eq!(trace(&pierced).len(), 1);
    assert!(farthest_ink(&pierced, &trace(&pierced)) <= 1.5);
    let loops = picture(&["....#####....", "#####...#####", "....#####...."]);
    assert!(trace(&loops).len() > 1);
}

#[test]
fn the_near_line_runs_through_where_a_far_one_ends() {
    // Straight on from the left lies the far branch; the near line bends by 45 degrees and yet runs through.
    let junction = picture(&[
        ".......................",
        "00000000000333333333333",
        "...........0...........",
        "............0..........",
        ".............0.........",
        "..............0........",
        "...............0.......",
        "................0......",
    ]);
    let chains = trace(&junction);
    assert_eq!(chains.len(), 2);
    let is_near = |c: &&Chain| c.points.iter().filter(|p| p.depth == 1.0).count() > 10;
    let near = chains.iter().find(is_near).unwrap();
    assert!(near.points.iter().any(|p| p.place.x < 1.0) && near.points.iter().any(|p| p.place.y > 7.0));
    let far = chains.iter().find(|c| !is_near(c)).unwrap();
    let meets = |chains: &[Chain]| {
        let ends = |c: &Chain| [c.points[0].place, c.points[c.points.len() - 1].place];
        let (long, short) = (&chains[0], &chains[1]);
        ends(short).into_iter().map(|end| distance_to(long, end)).fold(f64::INFINITY, f64::min)
    };
    assert_eq!(meets(&[near.clone(), far.clone()]), 0.0);
    let smoothed = smooth(&[near.clone(), far.clone()], TOLERANCE);
    assert!(meets(&smoothed) < 0.05, "strokes connect after smoothing: {} px", meets(&smoothed));
    // The same picture at one depth: straight on is the better way.
    let mut level = junction.clone();
    level.pixels.iter_mut().filter(|p| p.is_ink()).for_each(|p| *p = Pixel::new(p.kind(), p.place(), 1.0));
    let straight = |c: &Chain| c.points.iter().all(|p| p.place.y < 3.0) && c.points.len() > 20;
    assert!(trace(&level).iter().any(straight) && !chains.iter().any(straight));
}

#[test]
fn a_jump_in_depth_ends_a_line() {
    assert_eq!(trace(&picture(&["0000000000000000000000"])).len(), 1);
    let chains = trace(&picture(&["0000000000033333333333"]));
    assert_eq!(chains.len(), 2);
    assert_eq!(chains[0].points.last(), chains[1].points.first());
}

#[test]
fn border_and_silhouette_go_to_layers_of_their_own() {
    let raster = picture(&["####################bbbbbbbbbbbbbbbbbbbb", "........................................"]);
    let drawing = draw(&raster, &Style::default());
    let names: Vec<&str> = drawing.layers.iter().map(|l| l.name.as_str()).collect();
    assert_eq!(names, ["1 border", "2 silhouette"]);
    assert!(drawing.layers[0].pen.width < drawing.layers[1].pen.width);
    assert!(drawing.layers.iter().all(|l| l.strokes.len() == 1));
}

#[test]
fn what_mostly_lies_beside_the_sky_is_skyline() {
    let mut raster = picture(&["....................", "####################", "...................."]);
    let line = |raster: &InkRaster| trace(raster)[0].line();
    assert_eq!(line(&raster), Line::Occluding);
    let sky = Pixel::new(Kind::Sky, DVec2::ZERO, 0.0);
    raster.pixels[..8].fill(sky);
    assert_eq!(line(&raster), Line::Occluding, "9 of 20 pixels");
    raster.pixels[8..12].fill(sky);
    assert_eq!(line(&raster), Line::Skyline, "13 of 20 pixels");
    assert_eq!(trace(&raster).len(), 1, "a line is not cut where the sky begins");
}

#[test]
fn stairs_come_out_straight() {
    let raw = trace(&graph_of(200, 80, |x| 5.0 + 0.3 * x));
    let chain = &smooth(&raw, TOLERANCE)[0];
    assert!(raw[0].points.iter().all(|p| distance_to(chain, p.place) <= TOLERANCE));
    let off = chain.points.iter().map(|p| (p.place.y - 5.0 - 0.3 * p.place.x).abs()).fold(0.0, f64::max);
    assert!(off < 0.35, "{off} px off the true line");
    assert!(sharpest_turn(chain) < 3.0, "turns by {}", sharpest_turn(chain));
    assert!(sharpest_turn(&raw[0]) > 40.0, "the stairs themselves are not smooth");
}

#[test]
fn circles_come_out_round() {
    let centre = DVec2::new(60.3, 60.1);
    for radius in [15.0, 50.0] {
        let raster = raster(120, 120, |x, y| {
            let r = DVec2::new(x as f64 + 0.5, y as f64 + 0.5).distance(centre);
            ((r - radius).abs() < 0.6).then_some((Kind::Silhouette, 1.0))
        });
        let raw = trace(&raster);
        let smoothed = smooth(&raw, TOLERANCE);
        assert_eq!((smoothed.len(), smoothed[0].closed), (1, true));
        let chain = &smoothed[0];
        assert!(raw[0].points.iter().all(|p| distance_to(chain, p.place) <= TOLERANCE));
        let off = chain.points.iter().map(|p| (p.place.distance(centre) - radius).abs()).fold(0.0, f64::max);
        assert!(off < TOLERANCE + 0.3, "radius {radius}: {off} px off the circle");
        assert!(sharpest_turn(chain) < 16.0, "radius {radius}: turns by {}", sharpest_turn(chain));
        assert!(sharpest_turn(&raw[0]) > 40.0);
    }
}

#[test]
fn smoothing_keeps_its_tolerance_on_anything() {
    for (share, tolerance) in [(20, 0.6), (50, 0.3), (80, 1.0), (50, 0.001)] {
        let raw = trace(&speckled(share));
        for (chain, smoothed) in raw.iter().zip(smooth(&raw, tolerance)) {
            let off = chain.points.iter().map(|p| distance_to(&smoothed, p.place)).fold(0.0, f64::max);
            assert!(off <= tolerance + 1e-9, "{share} % ink: {off} px");
        }
    }
}

#[test]
fn lines_thin_with_distance_and_in_crowds() {
    let rows: Vec<i64> = vec![5, 25, 45];
    let depths = [1.0, 0.1, 0.01];
    let single = raster(200, 60, |_, y| rows.iter().position(|&r| r == y).map(|i| (Kind::Silhouette, depths[i])));
    let layer = &draw(&single, &Style::default()).layers[0];
    let widths: Vec<f64> = layer.strokes.iter().map(|s| s.points[s.points.len() / 2].width).collect();
    let far = Style::default().weight.far;
    for (width, wanted) in widths.into_iter().zip([1.0, f64::midpoint(1.0, far), far]) {
        assert!((width - wanted).abs() < 0.01, "{width}, {wanted}");
    }
    let crowd = raster(200, 60, |_, y| (y % 2 == 0).then_some((Kind::Silhouette, 1.0)));
    let crowded = &draw(&crowd, &Style::default()).layers[0].strokes[10].points[3];
    assert!(crowded.width < 0.8, "{}", crowded.width);
}
