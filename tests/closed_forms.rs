//! Hemisphere, cone, Gaussian hill and saddle: ink where mathematics puts the silhouette, and nowhere else.
//!
//! The sampling is fine enough when the facets lie within a quarter pixel of the form on the page; each test asserts
//! that. A hemisphere's rim is vertical, which no grid holds: it is cut at a slope of 60 degrees and goes on as the
//! cone that touches it there. The cone's apex stands on a sample and is rounded by a fraction of a cell.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::line::Kind;
use hachure::plan::{Border, Method, SharedVertices};
use hachure::surface::Surface;
use hachure::truth::Truth;
use hachure::truth::metrics::Judge;
use hachure::view::Camera;

use crate::forms::{Form, from_middle};
use crate::frames::{METHODS, draw, draw_mask};
use crate::judged::{Score, inked, moved, score};
use crate::scenes::{level, look};
use crate::tolerances::{
    ADJACENCY_CORNER, CLOSED_FORM, GRID_ERROR_PX, PLACE_GAIN, PLACE_MEAN_PX, REACH_PX, RECALL, RECALL_TOWARD_AWAY,
    WIDE_PRECISION, WIDE_REACH_PX,
};

const PAGE: [u32; 2] = [384, 288];
const RADIUS: f64 = 400.0;
const APEX: f64 = 400.0;
const HILL: [f64; 2] = [300.0, 180.0];
const BEND: f64 = 1.0 / 1500.0;

/// A sphere about (0, 0, 0), below 60 degrees its tangent cone with apex 800 m high.
pub const HEMISPHERE: Form = Form {
    name: "hemisphere",
    height: |p| {
        let r = p.length();
        let cut = RADIUS * 0.75_f64.sqrt();
        if r < cut { (RADIUS * RADIUS - r * r).sqrt() } else { 2.0 * RADIUS - 3.0_f64.sqrt() * r }
    },
    gradient: |p| {
        let r = p.length();
        let cut = RADIUS * 0.75_f64.sqrt();
        if r < cut { -p / (RADIUS * RADIUS - r * r).sqrt() } else { -p * (3.0_f64.sqrt() / r) }
    },
    residual: |p, eye| {
        if p.truncate().length() < RADIUS * 0.75_f64.sqrt() {
            // The polar plane of the eye.
            (p.dot(eye) - RADIUS * RADIUS) / eye.length()
        } else {
            cone_residual(p, eye, 2.0 * RADIUS, 3.0_f64.sqrt())
        }
    },
    samples: 129,
    cell: 10.0,
};

/// A cone of 45 degrees.
pub const CONE: Form = Form {
    name: "cone",
    height: |p| APEX - p.length(),
    gradient: |p| -p / p.length(),
    residual: |p, eye| cone_residual(p, eye, APEX, 1.0),
    samples: 257,
    cell: 4.0,
};

/// A Gaussian hill; its contour has no closed form beyond F = 0, which stands for it.
pub const GAUSSIAN: Form = Form {
    name: "Gaussian hill",
    height: |p| HILL[0] * (-p.length_squared() / (2.0 * HILL[1] * HILL[1])).exp(),
    gradient: |p| p * (-HILL[0] / (HILL[1] * HILL[1]) * (-p.length_squared() / (2.0 * HILL[1] * HILL[1])).exp()),
    residual: |p, eye| (p.z - eye.z) - (GAUSSIAN.gradient)(p.truncate()).dot(p.truncate() - eye.truncate()),
    samples: 257,
    cell: 5.0,
};

/// A saddle, z = a (x x - y y): its contour is a hyperbola about the eye on the map.
pub const SADDLE: Form = Form {
    name: "saddle",
    height: |p| BEND * (p.x * p.x - p.y * p.y),
    gradient: |p| DVec2::new(2.0 * BEND * p.x, -2.0 * BEND * p.y),
    residual: |p, eye| {
        let d = (p - eye).truncate();
        let above = eye.z - (SADDLE.height)(eye.truncate());
        (d.y * d.y - d.x * d.x - above / BEND) / (2.0 * d.length())
    },
    samples: 129,
    cell: 10.0,
};

/// Distance from the two lines in which planes through the eye touch a cone of this slope.
fn cone_residual(p: DVec3, eye: DVec3, apex: f64, slope: f64) -> f64 {
    if p.truncate().length() < 2.0 {
        return 0.0;
    }
    let e = eye - DVec3::Z * apex;
    let half_angle = (-e.z / (slope * e.truncate().length())).acos();
    let middle = e.y.atan2(e.x);
    let off = |side: f64| DVec2::from_angle(middle + side * half_angle).perp_dot(p.truncate()).abs();
    off(1.0).min(off(-1.0))
}

/// A form with the eyes it is seen from, metres about its middle, and the level it is drawn at.
pub struct Case {
    pub form: &'static Form,
    eyes: &'static [DVec3],
    target: DVec3,
    level: u32,
}

const CASES: [Case; 4] = [
    Case {
        form: &HEMISPHERE,
        eyes: &[DVec3::new(-1300.0, -500.0, 250.0), DVec3::new(100.0, -1250.0, 500.0)],
        target: DVec3::new(0.0, 0.0, 100.0),
        level: 4,
    },
    Case {
        form: &CONE,
        eyes: &[DVec3::new(-800.0, -450.0, 100.0), DVec3::new(60.0, -900.0, 250.0)],
        target: DVec3::new(0.0, 0.0, 150.0),
        level: 2,
    },
    Case {
        form: &GAUSSIAN,
        eyes: &[DVec3::new(-1000.0, -550.0, 60.0), DVec3::new(30.0, -1000.0, 140.0)],
        target: DVec3::new(0.0, 0.0, 150.0),
        level: 2,
    },
    Case {
        form: &SADDLE,
        eyes: &[DVec3::new(80.0, -900.0, -100.0), DVec3::new(-400.0, -1000.0, 0.0)],
        target: DVec3::new(0.0, 0.0, 0.0),
        level: 4,
    },
];

/// Calls `check` with each form from each eye: surface, camera, truth.
pub fn each_view(check: impl Fn(&Case, &Arc<Surface>, &Camera, &Truth)) {
    for case in &CASES {
        let surface = Arc::new(Surface::new(case.form.dem(|_, _| true)));
        for &eye in case.eyes {
            let camera = look(from_middle(eye), from_middle(case.target), 60.0, PAGE);
            let (truth, _) = case.form.contours(&camera);
            check(case, &surface, &camera, &truth);
        }
    }
}

fn report(case: &Case, method: &str, s: &Score) {
    println!(
        "{} {method}: P {:.4} R {:.4}, {} px of ink, {:.0} px of line, farthest {:.2} px, mean {:.3} px",
        case.form.name, s.precision, s.recall, s.ink, s.length, s.farthest, s.mean
    );
}

#[test]
fn true_contours_obey_their_closed_forms() {
    for case in &CASES {
        for &eye in case.eyes {
            let camera = look(from_middle(eye), from_middle(case.target), 60.0, PAGE);
            let (truth, points) = case.form.contours(&camera);
            let off = |eye: DVec3| points.iter().map(|p| (case.form.residual)(*p, eye).abs()).fold(0.0, f64::max);
            let scene = case.form.half();
            println!("{}: {} pieces, off by {:.1e} m", case.form.name, truth.pieces.len(), off(eye));
            assert!(points.len() > 400, "{}: only {} pieces", case.form.name, points.len());
            assert!(off(eye) < CLOSED_FORM * scene, "{}: off by {} m", case.form.name, off(eye));
            // Negative control: from an eye 1 m higher the line is another.
            assert!(off(eye + DVec3::Z) > CLOSED_FORM * scene, "{}: the check is blind", case.form.name);
        }
    }
}

#[test]
fn facets_lie_within_a_quarter_pixel_of_the_form() {
    each_view(|case, surface, camera, _| {
        let off = case.form.deviation(surface, level(case.level), camera);
        println!("{} at level {}: facets within {off:.3} px", case.form.name, case.level);
        assert!(off < GRID_ERROR_PX, "{}: {off} px", case.form.name);
    });
    // Negative control: every fourth sample is too few for the sphere.
    let coarse = Form { samples: 33, cell: 40.0, ..HEMISPHERE };
    let camera = look(from_middle(CASES[0].eyes[0]), from_middle(CASES[0].target), 60.0, PAGE);
    assert!(coarse.deviation(&Arc::new(Surface::new(coarse.dem(|_, _| true))), level(4), &camera) > GRID_ERROR_PX);
}

#[test]
fn all_ink_is_silhouette_and_the_silhouette_is_ink() {
    each_view(|case, surface, camera, truth| {
        for (name, method) in METHODS {
            let Some(recall) = recall_of(method) else { continue };
            let s = score(&draw_mask(surface, camera, level(case.level), method, Border::Off), truth);
            report(case, name, &s);
            let reach = if method == (Method::TowardAway { wide: true }) { WIDE_REACH_PX } else { REACH_PX };
            assert!(s.farthest <= reach, "{} {name}: ink {:.2} px from the line", case.form.name, s.farthest);
            assert!(s.precision >= WIDE_PRECISION, "{} {name}: precision {:.4}", case.form.name, s.precision);
            assert!(s.recall >= recall, "{} {name}: recall {:.4}", case.form.name, s.recall);
        }
    });
}

/// What a method promises; adjacency draws the sides of thin facets too and is judged apart.
fn recall_of(method: Method) -> Option<f64> {
    match method {
        Method::Walk | Method::TowardAway { wide: true } => Some(RECALL),
        Method::Contour => None,
        Method::TowardAway { wide: false } => Some(RECALL_TOWARD_AWAY),
        Method::Adjacency { .. } => None,
    }
}

#[test]
fn a_moved_mask_and_a_moved_eye_are_noticed() {
    each_view(|case, surface, camera, truth| {
        let ink = draw_mask(surface, camera, level(case.level), Method::Walk, Border::Off);
        let s = score(&moved(&ink, [0, 3]), truth);
        assert!(s.precision < 0.9 && s.recall < 0.9, "{}: 3 px down is not noticed", case.form.name);
        let other = Camera { eye: camera.eye + DVec3::new(80.0, -60.0, 40.0), ..*camera };
        let s = score(&ink, &case.form.contours(&other).0);
        assert!(s.precision < 1.0 && s.recall < RECALL, "{}: a moved eye is not noticed", case.form.name);
    });
}

#[test]
fn places_of_the_walk_are_truer_than_pixel_centres() {
    each_view(|case, surface, camera, truth| {
        let frame = draw(surface, camera, level(case.level), Method::Walk, Border::Off);
        let (centres, places): (Vec<DVec2>, Vec<DVec2>) = inked(&frame.raster, Kind::Silhouette).into_iter().unzip();
        let judge = Judge::new(truth).expect("a line on the page");
        let farthest = places.iter().map(|p| judge.distance(*p)).fold(0.0, f64::max);
        let [centres, places] = [centres, places].map(|places| judge.offsets(&places).expect("ink"));
        println!(
            "{}: centres {:.3} px, places {:.3} px off on average, {farthest:.2} px at most",
            case.form.name, centres.mean, places.mean
        );
        assert!(places.mean <= PLACE_MEAN_PX, "{}: {} px", case.form.name, places.mean);
        assert!(centres.mean >= PLACE_GAIN * places.mean, "{}: no gain", case.form.name);
    });
}

#[test]
fn adjacency_finds_the_line_and_floods_beside_it() {
    // Facets of 40 m, some ten pixels wide but where they are seen edge-on: there neighbouring pixels show facets that
    // share nothing, so that adjacency draws more than the line whatever the level.
    let coarse = Form { samples: 33, cell: 40.0, ..HEMISPHERE };
    let surface = Arc::new(Surface::new(coarse.dem(|_, _| true)));
    let camera = look(from_middle(CASES[0].eyes[0]), from_middle(CASES[0].target), 60.0, PAGE);
    let (truth, _) = coarse.contours(&camera);
    let [edge, corner] = [SharedVertices::Edge, SharedVertices::Corner].map(|share| {
        let s = score(&draw_mask(&surface, &camera, level(1), Method::Adjacency { share }, Border::Off), &truth);
        report(&CASES[0], &format!("adjacency {share:?}"), &s);
        s
    });
    assert!(edge.recall >= RECALL, "edge: recall {:.4}", edge.recall);
    assert!(corner.recall >= ADJACENCY_CORNER[1], "corner: recall {:.4}", corner.recall);
    assert!(corner.precision >= ADJACENCY_CORNER[0], "corner: precision {:.4}", corner.precision);
    assert!(edge.precision < corner.precision, "sharing an edge is asking more than sharing a corner");
}
