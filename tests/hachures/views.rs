//! Hachures of views: land that wants ink has strokes about it, and none runs on over the edge of a nearer hill.

use std::sync::Arc;

use glam::DVec2;
use hachure::dem::Dem;
use hachure::geo::{ReadOptions, read};
use hachure::line::Chain;
use hachure::plan::Hachures;
use hachure::surface::Surface;
use hachure::view::{Camera, Fixed, choose};
use rstar::primitives::{GeomWithData, Line};
use rstar::{AABB, PointDistance, RTree};

use super::pops::{Flight, Frame};
use crate::common::shared_dems;
use crate::tolerances::{HACHURE_CROSSINGS, HACHURES_IN_VIEW};

/// Pixels from place to place.
const STEP: usize = 7;
/// Land on which strokes are wanted without doubt: at least so dark, and so many px from other lines.
const DARK: f64 = 0.15;
const CLEAR: f64 = 10.0;
/// At the edge of the page nothing counts, px.
const MARGIN: f64 = 8.0;
/// A hill is nearer where its depth is larger by so much, a share.
const NEARER: f64 = 1.02;
/// Weights under this are not seen.
const SEEN: f32 = 0.05;

type Piece = GeomWithData<Line<[f64; 2]>, [f64; 2]>;

/// The seen pieces of chains, each with the depths of its ends.
fn pieces(chains: &[Chain]) -> RTree<Piece> {
    let seen = chains.iter().flat_map(|chain| chain.pairs()).filter(|pair| pair.iter().all(|end| end.weight > SEEN));
    let piece = |[a, b]: [_; 2]| -> Piece {
        let [a, b]: [&hachure::line::ChainPoint; 2] = [a, b];
        GeomWithData::new(Line::new(a.place.into(), b.place.into()), [a.depth, b.depth].map(f64::from))
    };
    RTree::bulk_load(seen.map(piece).collect())
}

/// The frame that is chosen for a DEM, and its camera.
fn frame(dem: Dem) -> (Arc<Surface>, Hachures, Camera, Frame) {
    let surface = Arc::new(Surface::new(dem));
    let camera = choose(surface.dem(), Fixed::default(), 60.0, 640, 360).expect("a view");
    let mut flight = Flight::new(&surface);
    let look = flight.plan.hachures.expect("hachures");
    let frame = flight.frame(&camera);
    (surface, look, camera, frame)
}

/// Of places on the page where the land is to be dark, the share with a stroke within a spacing and a quarter.
fn hatched(surface: &Surface, look: &Hachures, camera: &Camera, frame: &Frame, strokes: &[Chain]) -> f64 {
    let (shade, strokes, lines) = (look.shade(camera.azimuth, 1.0), pieces(strokes), pieces(&frame.lines));
    let within = |tree: &RTree<Piece>, place: DVec2, reach: f64| {
        let near = tree.nearest_neighbor(place.to_array());
        near.is_some_and(|piece| piece.distance_2(&place.to_array()) <= reach * reach)
    };
    let (dem, [width, height]) = (surface.dem(), frame.perspective.size().to_array());
    let rows = (MARGIN as usize..(height - MARGIN) as usize).step_by(STEP);
    let places = rows.flat_map(|y| (MARGIN as usize..(width - MARGIN) as usize).step_by(STEP).map(move |x| [x, y]));
    let (mut dark, mut hatched) = (0, 0);
    for [x, y] in places {
        let place = DVec2::new(x as f64, y as f64) + 0.5;
        let depth = frame.raster.at(x as i64, y as i64).map_or(0.0, |pixel| pixel.depth());
        if depth == 0.0 || within(&lines, place, CLEAR) {
            continue;
        }
        let world = frame.perspective.unproject(place, depth.into()).truncate() - dem.position(0, 0).truncate();
        let at = (world * DVec2::new(1.0, -1.0) / dem.cell()).round().as_usizevec2();
        let blacks = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[right, down]| {
            let [c, r] = [(at.x + right).min(dem.columns() - 1), (at.y + down).min(dem.rows() - 1)];
            shade.black(surface.gradient(c, r))
        });
        let black = blacks.into_iter().fold(f64::INFINITY, f64::min);
        if black >= DARK {
            dark += 1;
            hatched += u32::from(within(&strokes, place, 1.25 * look.apart(black)));
        }
    }
    assert!(dark > 100, "{dark} places are dark");
    f64::from(hatched) / f64::from(dark)
}

#[test]
fn dark_land_is_hatched_wherever_it_is_seen() {
    let sample = || read("dem/golden-gate.tif", &ReadOptions::default()).expect("the sample");
    let shared = ["west_temple_50m.tif", "yosemite_utm11n_30m.tif"];
    let shared = shared_dems()
        .into_iter()
        .flat_map(|folder| shared.map(|file| (file, read(folder.join(file), &ReadOptions::default()).expect("a DEM"))));
    for (name, dem) in [("sample", sample())].into_iter().chain(shared) {
        let (surface, look, camera, frame) = frame(dem);
        let share = hatched(&surface, &look, &camera, &frame, &frame.strokes);
        println!("{name}: {share:.3} of dark places have a stroke by them, {} strokes", frame.strokes.len());
        assert!(share >= HACHURES_IN_VIEW, "{name}: {share}");
        // Negative control: every third stroke is gone.
        let fewer: Vec<Chain> =
            frame.strokes.iter().enumerate().filter(|(k, _)| k % 3 > 0).map(|(_, chain)| chain.clone()).collect();
        let share = hatched(&surface, &look, &camera, &frame, &fewer);
        assert!(share < HACHURES_IN_VIEW, "{name}: nothing was noticed: {share}");
    }
}

/// The share at which a piece meets another, of either.
fn meeting([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> Option<[f64; 2]> {
    let (way, other, off) = (b - a, d - c, c - a);
    let shares = [off.perp_dot(other), off.perp_dot(way)].map(|part| part / way.perp_dot(other));
    shares.iter().all(|share| (0.0..=1.0).contains(share)).then_some(shares)
}

/// How often strokes cross lines of nearer hills, for each pixel of stroke.
fn crossings(strokes: &[Chain], lines: &[Chain]) -> f64 {
    let ends = |piece: &Piece| [piece.geom().from, piece.geom().to].map(DVec2::from);
    let (strokes, lines) = (pieces(strokes), pieces(lines));
    let length: f64 = strokes.iter().map(|piece| ends(piece)[0].distance(ends(piece)[1])).sum();
    let depth = |piece: &Piece, share: f64| piece.data[0] + (piece.data[1] - piece.data[0]) * share;
    let crossed = |stroke: &Piece| {
        let [a, b] = ends(stroke);
        let about = AABB::from_corners(a.min(b).to_array(), a.max(b).to_array());
        let nearer = lines.locate_in_envelope_intersecting(about).filter(|line| {
            meeting([a, b], ends(line)).is_some_and(|[own, of_line]| depth(line, of_line) > NEARER * depth(stroke, own))
        });
        nearer.count()
    };
    strokes.iter().map(crossed).sum::<usize>() as f64 / length
}

#[test]
fn no_stroke_crosses_a_nearer_hill() {
    let (.., frame) = frame(read("dem/golden-gate.tif", &ReadOptions::default()).expect("the sample"));
    let shifted = |chain: &Chain| {
        let mut chain = chain.clone();
        chain.points.iter_mut().for_each(|point| point.place.y += 4.0);
        chain
    };
    let share = crossings(&frame.strokes, &frame.lines);
    // Negative control: strokes 4 px lower.
    let off = crossings(&frame.strokes.iter().map(shifted).collect::<Vec<_>>(), &frame.lines);
    println!("{:.2} crossings on 1000 px of stroke, {:.2} of strokes 4 px lower", 1e3 * share, 1e3 * off);
    assert!(share <= HACHURE_CROSSINGS && off > HACHURE_CROSSINGS, "{share}, {off}");
}
