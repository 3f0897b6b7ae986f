//! Each promise is found broken where it is: a line too many, a number that is none, a bit that flipped, an eye that jumps.

use glam::{DVec2, DVec3};
use hachure::door::stress::accuracy::{Accuracy, worst};
use hachure::door::stress::conditioning::{Change, STEP, stepped};
use hachure::door::stress::drawing::{Drawer, plan};
use hachure::door::stress::finite::Counted;
use hachure::door::stress::flight::{self, popped};
use hachure::door::stress::folded::folded;
use hachure::door::stress::illustrated::{bits, land_of};
use hachure::door::stress::invariance::{Difference, differing, mirrored, same_bits};
use hachure::door::stress::promise::without_ink;
use hachure::door::stress::{Case, Check, Promise, named};
use hachure::door::surface::Lattice;
use hachure::ink::{self, Sheet, Style};
use hachure::line::{Chain, Lines};
use hachure::plan::{Border, Curves, Method, Plan};
use hachure::render::Renderer;
use hachure::surface::Surface;
use hachure::truth::{Inked, Mask, Terrain, Truth};
use hachure::view::Camera;
use std::sync::Arc;

use crate::scenes::{gpu, level};

const SIZE: [u32; 2] = [100, 80];

/// A mask with these pixels as ink.
fn mask(places: impl IntoIterator<Item = [u32; 2]>) -> Mask {
    let mut inked: Vec<Inked> = places.into_iter().map(|[column, row]| Inked { column, row, distance: 1.0 }).collect();
    inked.sort_by_key(|p| (p.row, p.column));
    Mask { size: SIZE, inked }
}

fn line(row: u32) -> impl Iterator<Item = [u32; 2]> {
    (0..SIZE[0]).map(move |column| [column, row])
}

fn camera() -> Camera {
    Camera { eye: DVec3::ZERO, azimuth: 30.0, altitude: -5.0, fov: 60.0, width: SIZE[0], height: SIZE[1] }
}

/// Hills from the registry, with their truth.
fn hills() -> (Case, Arc<Surface>, Truth) {
    let case = named("hills").expect("hills");
    let surface = Arc::new(Surface::new(case.dem.clone()));
    let truth = Terrain::new(&surface).truth(&case.views[0].camera, level(8));
    (case, surface, truth)
}

#[test]
fn a_line_too_many_and_a_line_too_few_are_inaccurate() {
    let (_, _, truth) = hills();
    let whole = Mask::of_truth(&truth);
    let good = Accuracy::of(&whole, &truth);
    assert!(good.f() > Some(0.999) && good.astray.is_empty() && good.missed.is_empty());
    let mut flooded = whole.clone();
    let there = whole.pixels();
    // A line in the sky.
    flooded.inked.extend((0..320).filter(|c| !there[*c as usize]).map(|column| Inked {
        column,
        row: 0,
        distance: 1.0,
    }));
    let flooded = Accuracy::of(&flooded, &truth);
    assert!(flooded.astray.len() > 200 && flooded.f() < Some(0.98), "{:?}", flooded.f());
    let (place, count) = worst(&flooded.astray, 24, 3)[0];
    assert!(place.y < 1.0 && count == 24, "{place} {count}");
    let mut lacking = whole.clone();
    lacking.inked.retain(|p| p.column > 100);
    let lacking = Accuracy::of(&lacking, &truth);
    assert!(!lacking.missed.is_empty() && lacking.f() < Some(0.98), "{:?}", lacking.f());
    let nothing = Truth { pieces: Vec::new(), ..truth };
    let ink = Accuracy::of(&whole, &nothing);
    assert!(ink.f().is_none() && ink.astray.len() == whole.inked.len(), "all ink is astray where truth has none");
}

#[test]
fn numbers_that_are_none_are_counted_wherever_they_are() {
    let (case, surface, _) = hills();
    let camera = case.views[0].camera;
    let mut renderer = Renderer::new(gpu().clone(), surface).expect("a renderer");
    let plan = Plan { curves: Curves::On, ..Plan::new(level(4), Method::Walk, Border::On) };
    let page = renderer.page(&plan, &camera, |_| ()).expect("a page");
    let mut counted = Counted::default();
    counted.buffers(&renderer).expect("buffers");
    counted.chains(&page.chains);
    assert!(counted.bad == 0 && counted.numbers > 100_000, "{}", counted.words());
    for name in ["places", "heights", "gradients_east", "pixels", "sides", "segments"] {
        let buffer = renderer.on_device().buffer(name).expect(name).clone();
        let old: Vec<u32> = gpu().read(&buffer, 2).expect(name);
        gpu().queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&[f32::NAN, f32::INFINITY]));
        let mut counted = Counted::default();
        counted.buffers(&renderer).expect("buffers");
        let expected = if name == "pixels" { 1 } else { 2 };
        assert!(counted.bad == expected && counted.words().contains(name), "{name}: {}", counted.words());
        gpu().queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&old));
    }
    let mut chains: Vec<Chain> = page.chains.clone();
    chains[0].points[0].place.x = f64::NAN;
    chains[0].points[0].depth = f32::INFINITY;
    let mut counted = Counted::default();
    counted.chains(&chains);
    assert!(counted.bad == 2 && counted.words().contains("chains 2"), "{}", counted.words());
    let (style, sheet) = (Style::default(), Sheet::for_frame([camera.width, camera.height]));
    let px_per_mm = sheet.placement([camera.width, camera.height]).px_per_mm;
    let lines: Lines = page.lines(&style.economy(px_per_mm), style.tolerance * px_per_mm);
    let mut drawing = ink::draw(&lines, &sheet, &style, &[]).expect("a drawing");
    let mut counted = Counted::default();
    counted.strokes(&drawing);
    assert!(counted.bad == 0 && counted.numbers > 100, "{}", counted.words());
    let layer = drawing.layers.iter_mut().find(|layer| !layer.strokes.is_empty()).expect("a layer");
    layer.strokes[0].points[0].width = f64::NEG_INFINITY;
    counted.strokes(&drawing);
    assert_eq!(counted.bad, 1);
}

#[test]
fn a_bit_that_flips_is_found() {
    assert_eq!(differing(&[1, 2, 3], &[1, 2, 3]), 0);
    assert_eq!(differing(&[1, 2, 3], &[1, 2, 7]), 1);
    assert_eq!(differing(&[1, 2, 3], &[1, 2]), 3, "pages of other sizes have no bit in common");
}

#[test]
fn land_that_is_rounded_where_it_goes_has_other_bits() {
    let (case, surface, _) = hills();
    let (camera, plan) = (case.views[0].camera, plan(case.detail, Method::Walk));
    let here = Drawer::new(gpu(), &surface).and_then(|mut drawer| drawer.draw(&plan, &camera)).expect("a drawing");
    for moved in same_bits(&case.dem) {
        let surface = Arc::new(Surface::new(moved.dem.clone()));
        let mut there = Drawer::new(gpu(), &surface).expect("a renderer");
        let eye = (moved.camera)(&case.dem, &camera);
        assert_eq!(differing(&here.words, &there.draw(&plan, &eye).expect("a drawing").words), 0, "{}", moved.how);
        // The eye a little beside where it should be.
        let beside = Camera { eye: eye.eye + DVec3::new(0.3, 0.0, 0.0), ..eye };
        assert!(differing(&here.words, &there.draw(&plan, &beside).expect("a drawing").words) > 1000, "{}", moved.how);
    }
}

#[test]
fn ink_that_moves_is_found_and_ink_that_jumps_is_far() {
    let here = mask(line(20).chain(line(60)));
    assert_eq!(Difference::of(&here, &here), Difference { pixels: 0, far: Vec::new(), ink: 200.0 });
    let near = Difference::of(&here, &mask(line(21).chain(line(60))));
    assert!(near.pixels == 200 && near.far.is_empty() && near.share() == 1.0, "{near:?}");
    let far = Difference::of(&here, &mask(line(20).chain(line(60)).chain([[50, 40]])));
    assert_eq!((far.pixels, far.far), (1, vec![[50, 40]]));
    let [left, right] = [mask([[0, 3], [7, 9]]), mask([[99, 3], [92, 9]])];
    assert!(mirrored(&left) == right && mirrored(&mirrored(&left)) == left);
    assert!(Difference::of(&left, &mirrored(&left)).far.len() == 4, "a mirror is no copy");
}

#[test]
fn an_eye_that_hardly_moves_and_ink_that_jumps_are_ill_conditioned() {
    let (here, camera) = (mask(line(20)), camera());
    let still = Change::of(&here, &here, &camera);
    assert_eq!(still, Change { popped: 0.0, places: Vec::new(), amplification: 0.0 });
    let jumps = Change::of(&here, &mask(line(20).chain([[50, 40], [51, 40]])), &camera);
    assert!((jumps.popped - 2.0 / 102.0).abs() < 1e-12 && jumps.places == [[50, 40], [51, 40]], "{jumps:?}");
    // A line that moves down by 0.1 px changes a tenth of its pixels, twice.
    let moved = (0..SIZE[0]).map(|column| [column, if column < 10 { 21 } else { 20 }]);
    let moves = Change::of(&here, &mask(moved), &camera);
    let expected = 0.1 / (camera.focal() * STEP);
    assert!(moves.popped == 0.0 && (moves.amplification / expected - 1.0).abs() < 1e-9, "{moves:?}");
    let target = camera.eye + camera.axes()[2] * 5000.0;
    let step = stepped(&camera, 5000.0);
    assert!((step.eye.distance(camera.eye) - 5000.0 * STEP).abs() < 1e-9);
    let on_page = step.project(target).0.distance(DVec2::new(50.0, 40.0));
    assert!((on_page / (0.8 * camera.focal() * STEP) - 1.0).abs() < 0.01, "across the page: {on_page}");
}

#[test]
fn truth_agrees_with_finer_truth_but_where_the_eye_is_on_a_sample() {
    let agrees = |name| {
        let case = named(name).expect(name);
        let surface = Surface::new(case.dem.clone());
        let terrain = Terrain::new(&surface);
        let [coarse, fine] = [32, 64].map(|n| terrain.truth(&case.views[0].camera, level(n)));
        (coarse.length(), Accuracy::of(&Mask::of_truth(&coarse), &fine).f().unwrap_or(0.0))
    };
    assert!(agrees("level-64").1 > 0.999, "land as it is");
    assert!(agrees("doubled-rows").1 > 0.98, "slivers are there");
    // So that case promises no accuracy.
    let (px, f) = agrees("on-a-sample");
    assert!(px > 1000.0 && f == 0.0, "{px} px, F {f}");
    assert!(!named("on-a-sample").expect("it").promises.contains(&Promise::Accurate));
}

#[test]
fn what_folds_is_found_and_gone_with_limited_tangents() {
    let case = named("folds").expect("folds");
    let surface = Surface::new(case.dem.clone());
    let lattice = Lattice::uniform(surface.dem(), level(8)).expect("a lattice");
    let [patches, facets] = folded(&surface, &lattice).expect("folds");
    assert!(patches > 10 && facets > 10, "{patches} patches, {facets} facets");
    let limited = surface.limited().expect("a limited surface");
    assert_eq!(folded(&limited, &lattice).expect("folds"), [0, 0]);
}

#[test]
fn a_frame_of_a_flight_that_is_another_and_ink_that_pops_are_found() {
    let (case, surface, _) = hills();
    let camera = case.views[0].camera;
    let next = flight::cameras(&camera, 3000.0);
    assert!(next.len() == 2 && (next[1].eye.distance(camera.eye) - 1.5).abs() < 1e-9);
    let land = Arc::new(land_of(&surface).expect("lines of the land"));
    let mut renderer = Renderer::new(gpu().clone(), surface).expect("a renderer");
    let mut drawn = |camera: &Camera| bits(&mut renderer, &land, case.detail, camera).expect("a page");
    let (first, second) = (drawn(&camera), drawn(&next[0]));
    assert_eq!(differing(&first, &drawn(&camera)), 0, "whatever came between");
    assert!(differing(&first, &second) > 1000, "frames a step apart are not the same");
    let (still, jumps) = (mask(line(20)), mask(line(60)));
    assert_eq!(popped(&[&still, &still, &still]), 0.0);
    assert_eq!(popped(&[&still, &still, &jumps]), 0.5);
}

#[test]
fn a_figure_that_is_none_keeps_nothing() {
    for at_least in [false, true] {
        assert!(!Check::holds(f64::NAN, 0.5, at_least));
        assert!(Check::holds(0.5, 0.5, at_least));
    }
    assert!(Check::holds(0.6, 0.5, true) && !Check::holds(0.4, 0.5, true));
    assert!(Check::holds(0.4, 0.5, false) && !Check::holds(0.6, 0.5, false));
}

#[test]
fn a_method_without_ink_keeps_no_promise_unless_truth_has_none() {
    let check = Check {
        case: "needle",
        view: "foot",
        method: "walk",
        promise: Promise::SameBits,
        measured: 0.0,
        limit: 0.0,
        at_least: false,
        kept: true,
        of: "words".into(),
        exception: "",
    };
    let kept = |inked, truth_px| {
        let mut checks = [check.clone(), check.clone()];
        without_ink(&mut checks, inked, truth_px);
        checks.map(|check| check.kept)
    };
    assert_eq!(kept(0, 300.0), [false; 2]);
    assert_eq!(kept(0, 0.0), [true; 2]);
    assert_eq!(kept(1, 300.0), [true; 2]);
    assert_eq!(check.line(), "needle, view foot, walk: same-bits is 0, promised at most 0 (words)");
}
