//! What the eye sees of the device's contours, against mathematics: chains lie on the visible contours of forms, cover them,
//! and end once at each cusp that is seen.

use glam::DVec2;
use hachure::door::line::visible::chains;
use hachure::line::{Bound, Chain, Curve, Line};
use hachure::plan::{Culling, Detail};
use hachure::truth::Truth;
use hachure::view::Camera;

use super::closed::{CASES, Case, PAGE, means};
use super::cusps::cusps_on_page;
use super::device::{Scene, plan};
use crate::forms::Form;
use crate::judged::{piece, truth};
use crate::scenes::{gpu, level};
use crate::tolerances::{CHAIN_END_PX, CONTOUR_MEAN_PX};

fn scene(case: &Case) -> Scene {
    Scene::draw(gpu(), &case.surface(), plan(Detail::from(level(8)), Culling::On), &case.camera())
}

/// What chains draw but for the border, as a judge takes it.
fn drawn(chains: &[Chain]) -> Truth {
    let of_chain = |chain: &Chain| {
        let after = chain.points.iter().skip(1).chain(chain.closed.then(|| &chain.points[0]));
        let pairs = chain.points.iter().zip(after).filter(|(a, _)| a.line != Line::Border);
        pairs.map(|(a, b)| piece([a.place, b.place], 1.0 / f64::from(a.depth))).collect::<Vec<_>>()
    };
    truth(PAGE, chains.iter().flat_map(of_chain).collect())
}

/// All contours of curves, seen or not.
fn all(curves: &[Curve]) -> Truth {
    let of_curve = |curve: &Curve| {
        let after = curve.points.iter().skip(1).chain(curve.closed.then(|| &curve.points[0]));
        let pairs = curve.points.iter().zip(after).zip(&curve.stretches).filter(|(_, s)| s.bound == Bound::Contour);
        pairs.map(|((a, b), _)| piece([a.place, b.place], 1.0 / a.depth)).collect::<Vec<_>>()
    };
    truth(PAGE, curves.iter().flat_map(of_curve).collect())
}

/// Cusps of a form that the eye sees, px.
fn seen_cusps(form: &Form, camera: &Camera) -> Vec<DVec2> {
    let (lines, _) = form.contours(camera);
    let near = |at: &DVec2| lines.pieces.iter().any(|piece| piece.middle().distance(*at) < 0.5);
    cusps_on_page(form, camera).into_iter().filter(near).collect()
}

#[test]
fn chains_are_the_visible_contours_of_forms() {
    let mut noticed = 0;
    for case in &CASES {
        let (scene, name) = (scene(case), case.form.name);
        let lines = case.form.contours(&scene.camera).0;
        let chains = chains(scene.curves.clone(), PAGE);
        let found = drawn(&chains);
        let off = means(&found, &lines);
        println!(
            "{name}: {} chains, {off:.5?} px off, {:.0} of {:.0} px",
            chains.len(),
            found.length(),
            lines.length()
        );
        assert!(off[0].max(off[1]) <= CONTOUR_MEAN_PX, "{name}: {off:?} px off");
        // Negative control: everything is seen.
        let off = means(&all(&scene.curves), &lines);
        noticed += usize::from(off[0].max(off[1]) > CONTOUR_MEAN_PX);
    }
    assert!(noticed >= 2, "what is hidden is not noticed");
}

#[test]
fn chains_end_once_at_each_cusp() {
    let mut met = 0;
    for case in &CASES {
        let (scene, name) = (scene(case), case.form.name);
        let chains = chains(scene.curves.clone(), PAGE);
        let open = chains.iter().filter(|chain| !chain.closed);
        let ends: Vec<DVec2> =
            open.flat_map(|chain| [chain.points[0].place, chain.points[chain.points.len() - 1].place]).collect();
        for cusp in seen_cusps(&case.form, &scene.camera) {
            let near: Vec<f64> = ends.iter().map(|end| end.distance(cusp)).filter(|d| *d <= CHAIN_END_PX).collect();
            println!("{name}: ends {near:.3?} px from the cusp at {cusp}");
            assert_eq!(near.len(), 1, "{name}: {near:?} ends at the cusp at {cusp}, all {ends:?}");
            met += 1;
        }
    }
    assert!(met >= 4, "only {met} cusps are seen");
}
