//! Truth of forms whose contours mathematics knows: it lies there, it is all there, and it comes nearer at second order.
//!
//! Lengths are compared in pixels drawn: the edges of facets run to and fro along a contour, most where it runs aslant
//! to the grid, and add up to more than its length whatever the level.

use hachure::surface::Surface;
use hachure::truth::metrics::Judge;
use hachure::truth::{Mask, Terrain, Truth};
use hachure::view::Camera;

use crate::closed_forms::each_view;
use crate::scenes::level;
use crate::tolerances::{CONTOUR_H95_PX, CONTOUR_PIXELS, SECOND_ORDER};

fn contours(surface: &Surface, camera: &Camera, n: u32) -> Truth {
    Terrain::new(surface).truth(camera, level(n)).without_border()
}

/// The larger of the two directed 95 % distances, px.
fn h95(a: &Truth, b: &Truth) -> f64 {
    let directed = |from: &Truth, to| Judge::new(to).expect("a line").offsets_of(from).expect("a line").p95;
    directed(a, b).max(directed(b, a))
}

/// Pixels of a truth drawn one pixel wide.
fn pixels(truth: &Truth) -> f64 {
    Mask::of_truth(truth).inked.len() as f64
}

#[test]
fn truth_is_where_mathematics_puts_it() {
    each_view(|case, surface, camera, lines| {
        let name = case.form.name;
        let truth = contours(surface, camera, 16);
        let (off, share) = (h95(&truth, lines), pixels(&truth) / pixels(lines));
        println!(
            "{name}: {off:.5} px off, {share:.4} of the pixels; edges of {:.1} px along {:.1} px of contour",
            truth.length(),
            lines.length()
        );
        assert!(off <= CONTOUR_H95_PX, "{name}: 95 % lie within {off} px only");
        assert!((share - 1.0).abs() <= CONTOUR_PIXELS, "{name}: {share} of the pixels of the contour");
        // Negative control: an eye 1 m to the side, and a line with a hole.
        let aside = Camera { eye: camera.eye + camera.axes()[0], ..*camera };
        let off = h95(&contours(surface, &aside, 16), lines);
        assert!(off > CONTOUR_H95_PX, "{name}: another eye passes, {off} px off");
        let half = Truth { pieces: truth.pieces[..truth.pieces.len() / 2].to_vec(), ..truth };
        assert!(h95(&half, lines) > CONTOUR_H95_PX, "{name}: half of the line passes");
        assert!((pixels(&half) / pixels(lines) - 1.0).abs() > CONTOUR_PIXELS, "{name}: half of the line passes");
    });
}

#[test]
fn truth_comes_nearer_at_second_order() {
    each_view(|case, surface, camera, lines| {
        let judge = Judge::new(lines).expect("a line");
        let median = |camera: &Camera, n| judge.offsets_of(&contours(surface, camera, n)).expect("a line").median;
        // Above what the samples leave of the form.
        let offs = [1, 2, 4].map(|n| median(camera, n));
        let slope = |offs: [f64; 3]| (offs[2] / offs[0]).log2() / 2.0;
        let name = case.form.name;
        println!("{name}: levels 1, 2, 4 lie {offs:.5?} px off, slope {:.3}", slope(offs));
        assert!((slope(offs) + 2.0).abs() <= SECOND_ORDER, "{name}: slope {:.3}, {offs:?} px", slope(offs));
        // Negative control: the contour of another eye comes no nearer.
        let aside = Camera { eye: camera.eye + camera.axes()[0], ..*camera };
        let stuck = slope([1, 2, 4].map(|n| median(&aside, n)));
        assert!((stuck + 2.0).abs() > SECOND_ORDER, "{name}: from another eye the slope is {stuck:.3}");
    });
}
