//! Contours turn from convex to concave at the cusps of mathematics, once at each.
//!
//! A cusp is where the contour runs along the ray: there it turns from convex, where land folds out of sight behind it, to
//! concave, where it hides itself. F changes along the view direction v by v' H v |eye - p|, H the second derivatives of
//! the height: a cusp is a zero of that on the contour. Of a saddle alone that sign is the same all along.

use glam::{DVec2, DVec3};
use hachure::line::Bound;
use hachure::view::Camera;

use super::closed::{CASES, LEVELS, PAGE, twin};
use super::twin::{Node, Piece, Strung, Twin, string_pieces};
use crate::forms::{Form, about_middle, from_middle};
use crate::tolerances::{CUSP_PX, CUSP_RUN_PX};

/// How F changes along the view direction at a place of the map, but for a factor above 0.
fn along_view(form: &Form, p: DVec2, eye: DVec3) -> f64 {
    let v = (p - eye.truncate()).normalize();
    v.dot((form.gradient)(p + v * 1e-3) - (form.gradient)(p - v * 1e-3))
}

/// Cusps of a form's contours on the map.
fn cusps(form: &Form, camera: &Camera) -> Vec<DVec2> {
    let eye = about_middle(camera.eye);
    let mut found = Vec::new();
    for piece in form.all_contours(camera) {
        let [mut a, mut b] = piece.map;
        let convex = |p| along_view(form, p, eye) < 0.0;
        let first = convex(a);
        if first == convex(b) {
            continue;
        }
        for _ in 0..50 {
            let middle = form.onto_contour(a.midpoint(b), (b - a).perp(), eye);
            if convex(middle) == first { a = middle } else { b = middle }
        }
        found.push(a.midpoint(b));
    }
    found
}

/// A stretch of contour that is convex or concave throughout.
#[derive(Debug, Clone, Copy)]
struct Run {
    convex: bool,
    /// On the page, px.
    length: f64,
    /// Where on the page it starts, px.
    start: DVec2,
}

/// The runs of a curve: in its order if it is open or meets the rim, else from the longest on. Its rim is passed over.
fn runs(twin: &Twin, pieces: &[Piece], curve: &Strung<Node>, camera: &Camera) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for piece in contours(pieces, curve) {
        let [start, end] = piece.ends.map(|node| camera.project(twin.place(node)).0);
        let convex = piece.ends.iter().map(|node| twin.along_view(*node)).sum::<f64>() < 0.0;
        match runs.last_mut().filter(|run| run.convex == convex) {
            Some(run) => run.length += start.distance(end),
            None => runs.push(Run { convex, length: start.distance(end), start }),
        }
    }
    if is_ring(pieces, curve) && runs.len() > 1 {
        if runs.len() % 2 == 1 {
            let first = runs.remove(0);
            let last = runs.len() - 1;
            runs[last].length += first.length;
        }
        let longest = (0..runs.len()).max_by(|a, b| runs[*a].length.total_cmp(&runs[*b].length));
        runs.rotate_left(longest.unwrap_or(0));
    }
    runs
}

fn contours<'a>(pieces: &'a [Piece], curve: &'a Strung<Node>) -> impl Iterator<Item = &'a Piece> {
    curve.pieces.iter().map(|i| &pieces[*i]).filter(|piece| piece.bound() == Bound::Contour)
}

fn is_ring(pieces: &[Piece], curve: &Strung<Node>) -> bool {
    curve.closed && contours(pieces, curve).count() == curve.pieces.len()
}

/// Joins what lies on both sides of the shortest run until none between two others is shorter than `least` px.
fn closed(mut runs: Vec<Run>, least: f64) -> Vec<Run> {
    loop {
        let shortest = (0..runs.len()).min_by(|a, b| runs[*a].length.total_cmp(&runs[*b].length));
        let Some(at) = shortest.filter(|at| runs[*at].length < least) else { return runs };
        let after = (at + 1 < runs.len()).then(|| runs.remove(at + 1));
        let lost = runs.remove(at);
        if let Some(before) = at.checked_sub(1) {
            runs[before].length += lost.length + after.map_or(0.0, |run| run.length);
        } else if let Some(after) = after {
            runs.insert(0, Run { length: lost.length + after.length, ..after });
        }
    }
}

/// Cusps of a form on the page, px.
pub fn cusps_on_page(form: &Form, camera: &Camera) -> Vec<DVec2> {
    let page = |p: &DVec2| camera.project(from_middle(form.point(*p))).0;
    cusps(form, camera).iter().map(page).filter(|p| on_page(*p)).collect()
}

fn on_page(place: DVec2) -> bool {
    place.cmpge(DVec2::ZERO).all() && place.cmplt(PAGE.map(f64::from).into()).all()
}

/// Where on the page contours turn from convex to concave or back, runs under `least` px closed; px.
fn turns(twin: &Twin, camera: &Camera, least: f64) -> Vec<DVec2> {
    let pieces = twin.pieces();
    let of_curve = |curve: Strung<Node>| {
        let mut runs = closed(runs(twin, &pieces, &curve, camera), least);
        // The first of a ring is a turn unless the last is of its kind.
        let turns_first = is_ring(&pieces, &curve) && runs.len().is_multiple_of(2);
        runs.drain(..usize::from(!turns_first && !runs.is_empty()));
        runs.into_iter().map(|run| run.start).filter(|place| on_page(*place))
    };
    string_pieces(&pieces).into_iter().flat_map(of_curve).collect()
}

/// Not of the sphere and the cone that touches it, where curvature jumps: facets turn there, for a pixel or two.
#[test]
fn contours_turn_once_at_each_cusp() {
    let mut met = 0;
    for case in &CASES[1..] {
        let (camera, surface, name) = (case.camera(), case.surface(), case.form.name);
        let expected = cusps_on_page(&case.form, &camera);
        for n in LEVELS {
            let twin = twin(&surface, n, &camera);
            let found = turns(&twin, &camera, CUSP_RUN_PX);
            let off = |p: &DVec2| found.iter().map(|q| q.distance(*p)).fold(f64::INFINITY, f64::min);
            let offs: Vec<f64> = expected.iter().map(off).collect();
            println!(
                "{name}, level {n}: {} turns at {} cusps, {offs:.3?} px off; all: {}",
                found.len(),
                expected.len(),
                turns(&twin, &camera, 0.0).len()
            );
            assert_eq!(found.len(), expected.len(), "{name}, level {n}: {found:?}, cusps {expected:?}");
            assert!(offs.iter().all(|off| *off <= CUSP_PX), "{name}, level {n}: {offs:?} px off");
        }
        met += expected.len();
    }
    assert!(met >= 6, "only {met} cusps");
}
