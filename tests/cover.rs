//! Lines on the land over the hidden-surface cover: they lie where the form is, vanish where it hides them and come back.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::door::plan::Pieces;
use hachure::line::{Chain, Economy, Land, Line};
use hachure::plan::{Border, Curves, LandLines, Method, Plan};
use hachure::relief::{LineKind, SurfaceLine, SurfacePoint};
use hachure::render::{Page, Renderer};
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::forms::{Form, about_middle, from_middle};
use crate::scenes::{gpu, level, look};
use crate::tolerances::{COVER_PX, LAID_PX};

const PAGE: [u32; 2] = [384, 288];

/// A ridge from west to east, 160 m high in the middle and falling off to both sides.
const RIDGE: Form = Form {
    name: "ridge",
    height: |p| 160.0 * (-p.y * p.y / (2.0 * 80.0 * 80.0) - p.x * p.x / (2.0 * 120.0 * 120.0)).exp(),
    gradient: |p| {
        let height = 160.0 * (-p.y * p.y / (2.0 * 80.0 * 80.0) - p.x * p.x / (2.0 * 120.0 * 120.0)).exp();
        DVec2::new(-p.x / (120.0 * 120.0), -p.y / (80.0 * 80.0)) * height
    },
    residual: |_, _| 0.0,
    samples: 129,
    cell: 10.0,
};

/// Over the ridge from the south, on which the far plain comes out again behind it.
fn camera() -> Camera {
    look(from_middle(DVec3::new(0.0, -620.0, 420.0)), from_middle(DVec3::new(0.0, 100.0, 20.0)), 60.0, PAGE)
}

/// Where a way on the map from a to b stands on the form.
fn on_form(a: DVec2, b: DVec2, t: f64) -> DVec3 {
    let p = a.lerp(b, t);
    p.extend((RIDGE.height)(p))
}

/// Where, as shares of a way on the map, it passes from seen to hidden or back: by fine steps and bisection.
fn turns(eye: DVec3, a: DVec2, b: DVec2) -> Vec<f64> {
    let half = RIDGE.half();
    let sees = |t: f64| RIDGE.sees(eye, on_form(a, b, t) + DVec3::Z * 1e-6, &|p| p.abs().max_element() <= half);
    let steps = 400;
    let mut turns = Vec::new();
    for k in 0..steps {
        let (mut low, mut high) = (f64::from(k) / f64::from(steps), f64::from(k + 1) / f64::from(steps));
        if sees(low) != sees(high) {
            for _ in 0..40 {
                let middle = low.midpoint(high);
                if sees(middle) == sees(low) { low = middle } else { high = middle }
            }
            turns.push(low);
        }
    }
    turns
}

/// Column and row of a place about the form's middle.
fn grid(p: DVec2) -> DVec2 {
    (p * DVec2::new(1.0, -1.0) + RIDGE.half()) / RIDGE.cell
}

/// A line that the user gives through these places about the form's middle, points a cell apart.
fn own(places: &[DVec2], closed: bool) -> SurfaceLine {
    let mut points = Vec::new();
    for pair in places.windows(2) {
        let steps = (pair[0].distance(pair[1]) / RIDGE.cell).ceil().max(1.0);
        points.extend((0..steps as u32).map(|k| pair[0].lerp(pair[1], f64::from(k) / steps)));
    }
    points.extend(places.last().filter(|_| !closed));
    let point = |p| SurfacePoint { at: grid(p), across: [f32::INFINITY; 3], length: 1e3, drop: 1e3 };
    SurfaceLine {
        kind: LineKind::Own(0),
        order: 4,
        points: points.into_iter().map(point).collect(),
        closed,
        joins: None,
    }
}

fn renderer(lines: Vec<SurfaceLine>) -> Renderer {
    let surface = Arc::new(Surface::new(RIDGE.dem(|_, _| true)));
    let land = Arc::new(Land::new(surface.dem(), 1.0, lines).expect("lines"));
    let mut renderer = Renderer::new(gpu().clone(), surface).expect("a renderer");
    renderer.set_land(Some(land));
    renderer
}

fn plan() -> Plan {
    Plan { curves: Curves::On, land: LandLines::On, ..Plan::new(level(4), Method::Walk, Border::Off) }
}

fn page(lines: Vec<SurfaceLine>, camera: &Camera) -> Page {
    renderer(lines).page(&plan(), camera, |_| ()).expect("a page")
}

fn ends(chain: &Chain) -> [DVec2; 2] {
    [chain.points[0].place, chain.points[chain.points.len() - 1].place]
}

#[test]
fn a_line_over_a_ridge_lies_on_it_and_vanishes_where_the_ridge_hides_it() {
    let camera = camera();
    // Up the near side and down the far one, into the plain behind; and aslant along the far foot.
    let ways = [
        (DVec2::new(30.0, -400.0), DVec2::new(-40.0, 560.0), 2),
        (DVec2::new(-420.0, 200.0), DVec2::new(430.0, 260.0), 2),
    ];
    for (a, b, count) in ways {
        let turns = turns(about_middle(camera.eye), a, b);
        assert_eq!(turns.len(), count, "the ridge hides one stretch");
        let place = |t: f64| camera.project(from_middle(on_form(a, b, t))).0;
        let shown = page(vec![own(&[a, b], false)], &camera).land;
        assert_eq!(shown.len(), 2, "a chain on either side of what is hidden");
        let truth: Vec<DVec2> = (0..=20_000).map(|k| place(f64::from(k) / 20_000.0)).collect();
        let off = |p: DVec2| truth.iter().map(|t| p.distance(*t)).fold(f64::INFINITY, f64::min);
        let farthest = shown.iter().flat_map(|chain| &chain.points).map(|point| off(point.place)).fold(0.0, f64::max);
        println!("cover: points within {farthest:.3} px of the form");
        assert!(farthest <= LAID_PX, "a point lies {farthest} px beside its line");
        for t in turns {
            let off = shown.iter().flat_map(ends).map(|p| p.distance(place(t))).fold(f64::INFINITY, f64::min);
            println!("cover: hidden from or to {}, chain ends {off:.2} px from there", place(t));
            assert!(off <= COVER_PX, "a chain ends {off:.2} px from where the ridge hides the line");
        }
        assert!(
            shown.iter().flat_map(|chain| &chain.points).all(|point| point.line == Line::Own(0) && point.weight == 1.0)
        );
        // Negative control: a line 15 m beside it is noticed.
        let beside = page(vec![own(&[a + 15.0, b + 15.0], false)], &camera).land;
        let farthest = beside.iter().flat_map(|chain| &chain.points).map(|point| off(point.place)).fold(0.0, f64::max);
        assert!(farthest > LAID_PX, "a moved line is not noticed");
    }
}

#[test]
fn lines_change_nothing_of_the_surface() {
    let camera = camera();
    let lines = vec![own(&[DVec2::new(-400.0, -200.0), DVec2::new(400.0, 230.0)], false)];
    let with = page(lines.clone(), &camera);
    let without = Plan { land: LandLines::Off, ..plan() };
    let without = renderer(lines).page(&without, &camera, |_| ()).expect("a page");
    assert!(!with.land.is_empty() && without.land.is_empty() && !without.chains.is_empty());
    assert_eq!((&with.marks, &with.chains), (&without.marks, &without.chains));
    // Nor does it change the strokes of silhouettes: where both would lie side by side they win.
    let economy = Economy { min_jump: 0.01, min_gap: 3.0 };
    let [with, without] = [with, without].map(|page| page.lines(&economy, 0.5));
    assert_eq!(with.recession, without.recession);
    let of_surface: Vec<&Chain> = with.chains.iter().filter(|chain| !chain.line().is_of_land()).collect();
    assert_eq!(of_surface, without.chains.iter().collect::<Vec<_>>());
}

#[test]
fn lines_on_a_page_in_pieces_are_those_of_one_piece() {
    let camera = camera();
    let ring: Vec<DVec2> = (0..=40).map(|k| DVec2::from_angle(f64::from(k) / 40.0 * std::f64::consts::TAU)).collect();
    let ring = own(&ring.iter().map(|p| DVec2::new(0.0, -190.0) + *p * 50.0).collect::<Vec<_>>(), true);
    let lines = vec![ring, own(&[DVec2::new(-500.0, -600.0), DVec2::new(500.0, 600.0)], false)];
    let whole = page(lines.clone(), &camera).land;
    assert_eq!(whole.iter().filter(|chain| chain.closed).count(), 1, "the ring before the ridge is seen whole");
    let mut renderer = renderer(lines);
    let frame =
        renderer.plan(&plan(), &camera).and_then(|frame| frame.cut(Pieces::new(PAGE, [100, 100]))).expect("a frame");
    assert!(frame.pieces.iter().len() > 4);
    assert_eq!(renderer.page_of(frame, |_| ()).expect("a page").land, whole);
}

#[test]
fn a_line_over_the_edge_of_the_page_and_behind_the_eye_is_cut_there() {
    let eye = from_middle(DVec3::new(0.0, -200.0, 150.0));
    let camera = look(eye, from_middle(DVec3::new(0.0, 300.0, 0.0)), 60.0, PAGE);
    let line = own(&[DVec2::new(-620.0, -610.0), DVec2::new(40.0, -100.0), DVec2::new(600.0, 10.0)], false);
    let land = page(vec![line], &camera).land;
    let inside = |p: DVec2| p.cmpge(DVec2::ZERO).all() && p.cmple(DVec2::new(384.0, 288.0)).all();
    assert!(!land.is_empty() && land.iter().flat_map(|chain| &chain.points).all(|point| inside(point.place)));
    let reaches = |x: f64| land.iter().flat_map(ends).any(|p| (p.x - x).abs() < 1.5 || (p.y - 288.0).abs() < 1.5);
    assert!(reaches(384.0), "it goes on to the page's edge");
    // Beyond the DEM's edge and behind the eye there is nothing.
    let behind = own(&[DVec2::new(-100.0, -600.0), DVec2::new(100.0, -600.0)], false);
    assert!(page(vec![behind], &camera).land.is_empty());
    assert!(page(Vec::new(), &camera).land.is_empty());
}

#[test]
fn lines_run_on_beneath_the_eye_and_along_the_edge_of_the_land() {
    // A road that passes the eye, points far apart: it reaches the foot of the page.
    let eye = from_middle(DVec3::new(0.0, -500.0, 4.0));
    let camera = look(eye, from_middle(DVec3::new(0.0, -300.0, 0.0)), 60.0, PAGE);
    let mut road = own(&[DVec2::new(2.0, -620.0), DVec2::new(2.0, -200.0)], false);
    road.points = [0, road.points.len() - 1].map(|end| road.points[end]).to_vec();
    let land = page(vec![road], &camera).land;
    let lowest = land.iter().flat_map(|chain| &chain.points).map(|point| point.place.y).fold(0.0, f64::max);
    assert!(lowest > 286.0, "it ends {lowest} px down");
    // Along all four sides of the DEM.
    let camera = look(from_middle(DVec3::new(0.0, 0.0, 3000.0)), from_middle(DVec3::new(0.0, 1.0, 0.0)), 60.0, PAGE);
    let half = RIDGE.half();
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]].map(DVec2::from);
    for (a, b) in corners.into_iter().zip(corners.into_iter().cycle().skip(1)) {
        let land = page(vec![own(&[a, b], false)], &camera).land;
        let ends = [a, b].map(|p| camera.project(from_middle(p.extend(0.0))).0);
        let length: f64 = land.iter().map(Chain::length).sum();
        assert!((length - ends[0].distance(ends[1])).abs() < 2.0, "{a} to {b}: {length} px");
    }
}
