//! Hidden lines: where nearer land stands before a line, and nowhere else.

use std::sync::Arc;

use glam::DVec2;
use hachure::door::line::visible::{chains, seen_and_hidden};
use hachure::geo::{ReadOptions, read};
use hachure::line::{Chain, Sight};
use hachure::plan::{Border, Curves, Detail, Method, Plan};
use hachure::render::{Page, Renderer};
use hachure::surface::{Level, Surface};
use hachure::view::{Camera, Fixed, choose};

use crate::common::gpu;
use crate::page_curves::{PAGE, disc, through, with};
use crate::scenes::surface;
use crate::tolerances::{HIDDEN_PX, ON_LINE_PX};

/// A slanting ridge before a level line behind it, both walked to the left; the line is hidden beyond x = 140.
fn ridge_and_line() -> Vec<hachure::line::Curve> {
    let ridge = through(&[[200.0, 100.0, 1.0], [20.0, 136.0, 1.0]]);
    let line = through(&[[190.0, 112.0, 0.5], [10.0, 112.0, 0.5]]);
    let doubt = |beyond: f64| match beyond {
        x if x > 6.0 => Sight::Hidden,
        x if x < -6.0 => Sight::Free,
        _ => Sight::Doubt { free: true },
    };
    vec![ridge, with(line, |place, stretch| stretch.sight = doubt(place.x - 140.0))]
}

#[test]
fn what_is_hidden_begins_where_what_is_seen_ends() {
    let (visible, hidden) = seen_and_hidden(ridge_and_line(), PAGE);
    assert_eq!(visible, chains(ridge_and_line(), PAGE), "what is seen is the same");
    assert_eq!(hidden.len(), 1);
    let [first, last] = [&hidden[0].points[0], &hidden[0].points[hidden[0].points.len() - 1]].map(|point| point.place);
    assert_eq!(first, DVec2::new(190.0, 112.0));
    assert!(last.distance(DVec2::new(140.0, 112.0)) < ON_LINE_PX, "ends at {last}");
    let ids: Vec<_> = visible.iter().chain(&hidden).map(|chain| chain.id.expect("a name")).collect();
    assert!(ids.iter().enumerate().all(|(i, id)| !ids[..i].contains(id)), "{ids:?}");
    // What hides itself is drawn neither way.
    let concave = |curve| with(curve, |_, stretch| stretch.fall = -1.0);
    let (visible, hidden) = seen_and_hidden(ridge_and_line().into_iter().map(concave).collect(), PAGE);
    assert!(visible.is_empty() && hidden.is_empty());
}

#[test]
fn a_closed_curve_is_seen_or_hidden_everywhere_once() {
    let ring = || {
        with(disc(DVec2::new(120.0, 90.0), 50.0, 0.5), |place, stretch| {
            stretch.sight = if place.x > 120.0 { Sight::Hidden } else { Sight::Free };
        })
    };
    let (visible, hidden) = seen_and_hidden(vec![ring()], PAGE);
    let length = |chains: &[Chain]| chains.iter().map(Chain::length).sum::<f64>();
    let around = std::f64::consts::TAU * 50.0;
    assert!((length(&visible) + length(&hidden) - around).abs() < 1.0);
    assert!((length(&hidden) - around / 2.0).abs() < 5.0, "{} of {around}", length(&hidden));
    assert!(hidden.iter().flat_map(|chain| &chain.points).all(|point| point.place.x > 117.0));
}

const SIDE: usize = 161;
const CELL: f64 = 10.0;

/// A round hill in the north, and before it, if asked for, a ridge that hides its western half.
fn land(has_ridge: bool) -> Arc<Surface> {
    let height = |i: usize| {
        let (x, y) = ((i % SIDE) as f64 * CELL, (i / SIDE) as f64 * CELL);
        let bump = |dx: f64, dy: f64, wide: f64, deep: f64| (-(dx / wide).powi(2) - (dy / deep).powi(2)).exp();
        let hill = 120.0 * bump(x - 800.0, y - 400.0, 150.0, 150.0);
        let ridge = 110.0 * bump(x - 450.0, y - 1000.0, 300.0, 80.0);
        (hill + if has_ridge { ridge } else { 0.0 }) as f32
    };
    surface(SIDE, CELL, (0..SIDE * SIDE).map(height).collect())
}

fn page(surface: &Arc<Surface>, detail: Detail, curves: Curves) -> Page {
    let middle = surface.dem().position(SIDE / 2, SIDE - 1);
    let eye = middle + glam::DVec3::new(0.0, -300.0, 90.0);
    let camera = Camera { eye, azimuth: 0.0, altitude: -2.0, fov: 50.0, width: 400, height: 240 };
    let mut renderer = Renderer::new(gpu().clone(), surface.clone()).expect("a renderer");
    let plan = Plan { curves, ..Plan::new(detail, Method::Walk, Border::Off) };
    renderer.page(&plan, &camera, |_| ()).expect("a page")
}

/// Distance of a place from chains, px.
fn off(chains: &[Chain], place: DVec2) -> f64 {
    let to = |[a, b]: [DVec2; 2]| {
        let t = ((place - a).dot(b - a) / (b - a).length_squared().max(1e-12)).clamp(0.0, 1.0);
        place.distance(a.lerp(b, t))
    };
    let pieces = chains.iter().flat_map(Chain::pairs).map(|pair| pair.map(|point| point.place));
    pieces.map(to).fold(f64::INFINITY, f64::min)
}

#[test]
fn hidden_lines_lie_where_they_are_seen_without_what_hides_them() {
    for detail in [Detail::Uniform(Level::EIGHT), Detail::default()] {
        let (with, without) = (page(&land(true), detail, Curves::All), page(&land(false), detail, Curves::All));
        let far = |chains: &[Chain]| {
            let is_far = |chain: &&Chain| chain.points[0].world.y > land(true).dem().position(0, 80).y;
            chains.iter().filter(is_far).cloned().collect::<Vec<_>>()
        };
        let (hidden, seen, whole) = (far(&with.hidden), far(&with.chains), far(&without.chains));
        let length = |chains: &[Chain]| chains.iter().map(Chain::length).sum::<f64>();
        println!(
            "{detail:?}: hidden {:.1}, seen {:.1}, whole {:.1} px",
            length(&hidden),
            length(&seen),
            length(&whole)
        );
        assert!(length(&hidden) > 20.0 && length(&seen) > 20.0);
        assert!((length(&hidden) + length(&seen) - length(&whole)).abs() < 3.0);
        let points = hidden.iter().flat_map(|chain| &chain.points);
        let farthest = points.map(|point| off(&whole, point.place)).fold(0.0, f64::max);
        assert!(farthest < HIDDEN_PX, "{farthest} px off");
    }
}

#[test]
fn asking_for_hidden_lines_changes_nothing_that_is_seen() {
    // On real land the lattice is finer behind the horizon where all curves are asked for, and so beside it.
    let dem = concat!(env!("CARGO_MANIFEST_DIR"), "/dem/golden-gate.tif");
    let surface = Arc::new(Surface::new(read(dem, &ReadOptions::default()).expect("a DEM")));
    let fixed = Fixed { azimuth: Some(45.0), ..Fixed::default() };
    let camera = choose(surface.dem(), fixed, 60.0, 1920, 1080).expect("a view");
    let mut renderer = Renderer::new(gpu().clone(), surface).expect("a renderer");
    let mut page = |curves| {
        let plan = Plan { curves, ..Plan::new(Detail::default(), Method::Walk, Border::On) };
        renderer.page(&plan, &camera, |_| ()).expect("a page")
    };
    let (all, seen) = (page(Curves::All), page(Curves::On));
    assert!(all.chains == seen.chains && all.marks == seen.marks);
    assert!(seen.hidden.is_empty() && !all.hidden.is_empty());
}
