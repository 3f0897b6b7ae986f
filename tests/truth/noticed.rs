//! What is wrong shows in the figures: a mask moved or with a hole, another eye, one method in place of another.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::plan::{Border, Method};
use hachure::surface::Surface;
use hachure::truth::metrics::{Judge, Scores};
use hachure::truth::{Mask, Terrain, Truth};
use hachure::view::Camera;

use crate::frames::draw_mask;
use crate::judged::moved;
use crate::scenes::{level, look, rough};
use crate::tolerances::{RECALL, STUDY};

const PAGE: [u32; 2] = [384, 288];

fn scores(truth: &Truth, mask: &Mask) -> Scores {
    Judge::new(truth).expect("a line on the page").measure(mask).scores()
}

#[test]
fn what_is_wrong_shows_in_the_figures() {
    let surface = Arc::new(Surface::new(rough(60, 50, 2.0, 3.0, false)));
    let terrain = Terrain::new(&surface);
    let [west, south, east, north] = surface.dem().extent();
    let middle = DVec3::new((west + east) / 2.0, (south + north) / 2.0, 0.0);
    let camera = look(middle + DVec3::new(-500.0, -900.0, 300.0), middle, 60.0, PAGE);
    let find = |camera: &Camera| terrain.truth(camera, level(16)).without_border();
    let draw = |method| draw_mask(&surface, &camera, level(8), method, Border::Off);
    let (truth, ink) = (find(&camera), draw(Method::Walk));
    let right = scores(&truth, &ink);
    println!("{right:?}, {} px of ink, {:.0} px of line", ink.inked.len(), truth.length());
    assert!(right.agreement().f() >= RECALL, "F {:.4}", right.agreement().f());

    let by_three = scores(&truth, &moved(&ink, [0, 3])).agreement();
    assert!(by_three.precision < 0.8 && by_three.recall < 0.8, "3 px down: {by_three:?}");

    // A round hole about a piece of the line.
    let centre = truth.on_page().nth(truth.pieces.len() / 2).expect("a piece").middle();
    let kept = |at: DVec2| at.distance(centre) > 8.0;
    let hole = Mask { inked: ink.inked.iter().copied().filter(|p| kept(p.centre())).collect(), ..ink.clone() };
    let holed = scores(&truth, &hole);
    assert!(holed.gaps > right.gaps, "a hole: {} gaps, {} without", holed.gaps, right.gaps);
    assert!(holed.agreement().recall < right.agreement().recall - 0.001, "a hole: {:?}", holed.agreement());

    let other = find(&Camera { eye: camera.eye + DVec3::new(20.0, -15.0, 10.0), ..camera });
    let other = scores(&other, &ink);
    assert!(other.agreement().f() < 0.9 && other.gaps > right.gaps, "another eye: {other:?}");

    let swapped = scores(&truth, &draw(Method::TowardAway { wide: false })).agreement();
    println!("toward-away: {swapped:?}");
    let walk = right.agreement().recall;
    assert!(walk >= RECALL, "walk: recall {walk:.4}");
    assert!(swapped.recall < walk - STUDY, "toward-away in place of walk: {swapped:?}, walk {walk:.4}");
}
