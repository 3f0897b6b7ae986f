//! Contours where mathematics puts them: of sphere, cone, saddle and hills, seen or not, nearer at second order with finer
//! facets.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::door::surface::Lattice;
use hachure::line::Bound;
use hachure::surface::Surface;
use hachure::truth::Truth;
use hachure::truth::metrics::Judge;
use hachure::view::Camera;

use super::twin::{Piece, Twin};
use crate::closed_forms::{CONE, GAUSSIAN, HEMISPHERE, SADDLE};
use crate::forms::{Form, about_middle, from_middle};
use crate::judged::{piece, truth};
use crate::scenes::{level, look};
use crate::tolerances::{CONTOUR_LEFT, CONTOUR_MEAN_PX, SECOND_ORDER};

/// Pixels across and down.
pub const PAGE: [u32; 2] = [256, 256];
/// Levels of the facets.
pub const LEVELS: [u32; 3] = [4, 8, 16];

/// Two hills and the saddle between them.
const PASS: Form = Form {
    name: "pass",
    height: |p| (GAUSSIAN.height)(p - TOP) + 0.8 * (GAUSSIAN.height)(p + TOP),
    gradient: |p| (GAUSSIAN.gradient)(p - TOP) + (GAUSSIAN.gradient)(p + TOP) * 0.8,
    residual: GAUSSIAN.residual,
    samples: 81,
    cell: 17.5,
};
const TOP: DVec2 = DVec2::new(220.0, 60.0);

/// A form on fewer samples, from an eye; metres about the middle.
pub struct Case {
    pub form: Form,
    eye: DVec3,
    target: DVec3,
}

impl Case {
    pub fn camera(&self) -> Camera {
        look(from_middle(self.eye), from_middle(self.target), 60.0, PAGE)
    }

    pub fn surface(&self) -> Arc<Surface> {
        Arc::new(Surface::new(self.form.dem(|_, _| true)))
    }
}

/// The form over a square of the same size or smaller, of so many samples.
const fn sampled(form: Form, samples: usize, cell: f64) -> Form {
    Form { samples, cell, ..form }
}

/// What is looked at.
pub const CASES: [Case; 5] = [
    Case {
        form: sampled(HEMISPHERE, 65, 18.0),
        eye: DVec3::new(-1300.0, -500.0, 250.0),
        target: DVec3::new(0.0, 0.0, 100.0),
    },
    Case { form: sampled(CONE, 65, 12.0), eye: DVec3::new(60.0, -900.0, 250.0), target: DVec3::new(0.0, 0.0, 150.0) },
    Case { form: sampled(SADDLE, 65, 20.0), eye: DVec3::new(80.0, -900.0, -100.0), target: DVec3::ZERO },
    Case {
        form: sampled(GAUSSIAN, 65, 18.0),
        eye: DVec3::new(-1000.0, -550.0, 340.0),
        target: DVec3::new(0.0, 0.0, 150.0),
    },
    Case { form: PASS, eye: DVec3::new(-700.0, -620.0, 360.0), target: DVec3::new(0.0, 0.0, 100.0) },
];

/// The twin of one level.
pub fn twin(surface: &Surface, n: u32, camera: &Camera) -> Twin {
    Twin::new(surface, &Lattice::uniform(surface.dem(), level(n)).expect("few chunks"), camera.eye)
}

/// The pieces of contour that are `wanted`, as a judge takes them.
fn drawn(twin: &Twin, camera: &Camera, wanted: impl Fn(&Piece) -> bool) -> Truth {
    let contours = twin.pieces().into_iter().filter(|piece| piece.bound() == Bound::Contour && wanted(piece));
    let on_page = contours.map(|of| {
        let [a, b] = of.ends.map(|node| camera.project(twin.place(node)));
        piece([a.0, b.0], (a.1 + b.1) / 2.0)
    });
    truth(PAGE, on_page.collect())
}

/// All contours of a form, seen or not, as a judge takes them.
fn mathematical(form: &Form, camera: &Camera) -> Truth {
    let pieces = form.all_contours(camera).into_iter();
    truth(PAGE, pieces.map(|of| piece(of.ends, camera.project(from_middle(of.middle)).1)).collect())
}

/// Mean distances from the one to the other and back, px, by length.
pub fn means(a: &Truth, b: &Truth) -> [f64; 2] {
    let mean = |from: &Truth, to| Judge::new(to).expect("a line").offsets_of(from).expect("a line").mean;
    [mean(a, b), mean(b, a)]
}

fn largest(means: [f64; 2]) -> f64 {
    means[0].max(means[1])
}

#[test]
fn all_contours_lie_where_mathematics_puts_them() {
    for case in &CASES {
        let (camera, surface, name) = (case.camera(), case.surface(), case.form.name);
        let lines = mathematical(&case.form, &camera);
        for n in LEVELS {
            let found = drawn(&twin(&surface, n, &camera), &camera, |_| true);
            let off = means(&found, &lines);
            println!("{name}, level {n}: {off:.5?} px off, {:.0} of {:.0} px", found.length(), lines.length());
            assert!(largest(off) <= CONTOUR_MEAN_PX, "{name}, level {n}: {off:?} px off");
        }
        // Negative controls: an eye a metre to the side; half of the line.
        let aside = Camera { eye: camera.eye + camera.axes()[0], ..camera };
        let found = drawn(&twin(&surface, 4, &aside), &aside, |_| true);
        assert!(largest(means(&found, &lines)) > CONTOUR_MEAN_PX, "{name}: another eye is not noticed");
        let half = Truth { pieces: found.pieces[..found.pieces.len() / 2].to_vec(), ..found };
        assert!(largest(means(&half, &lines)) > CONTOUR_MEAN_PX, "{name}: half a line is not noticed");
    }
}

#[test]
fn contours_come_nearer_at_second_order() {
    for case in &CASES {
        let (camera, surface, name) = (case.camera(), case.surface(), case.form.name);
        let lines = mathematical(&case.form, &camera);
        let judge = Judge::new(&lines).expect("a line");
        let median = |camera: &Camera, n| {
            let found = drawn(&twin(&surface, n, camera), camera, |_| true);
            judge.offsets_of(&found).expect("a line").median
        };
        let slope = |offs: [f64; 3]| (offs[2] / offs[0]).log2() / 2.0;
        // Above what the samples leave of the form.
        let offs = [1, 2, 4].map(|n| median(&camera, n));
        println!("{name}: levels 1, 2, 4 lie {offs:.5?} px off, slope {:.3}", slope(offs));
        assert!((slope(offs) + 2.0).abs() <= SECOND_ORDER, "{name}: slope {:.3}, {offs:?} px", slope(offs));
        // Negative control: the contour of another eye comes no nearer.
        let aside = Camera { eye: camera.eye + camera.axes()[0], ..camera };
        let stuck = slope([1, 2, 4].map(|n| median(&aside, n)));
        assert!((stuck + 2.0).abs() > SECOND_ORDER, "{name}: from another eye the slope is {stuck:.3}");
    }
}

/// Of pieces of contour the share that has what faces the eye on the left by mathematics, and what does not on the right.
fn share_on_left(twin: &Twin, form: &Form, camera: &Camera) -> f64 {
    let eye = about_middle(camera.eye);
    let pieces: Vec<Piece> = twin.pieces().into_iter().filter(|piece| piece.bound() == Bound::Contour).collect();
    let is_right = |piece: &&Piece| {
        let [a, b] = piece.ends.map(|node| about_middle(twin.place(node)).truncate());
        let (middle, left) = (a.midpoint(b), (b - a).normalize_or_zero().perp() * form.cell);
        form.facing(middle + left, eye) > 0.0 && form.facing(middle - left, eye) < 0.0
    };
    pieces.iter().filter(is_right).count() as f64 / pieces.len() as f64
}

#[test]
fn what_faces_the_eye_is_on_the_left_by_mathematics() {
    for case in &CASES {
        let twin = twin(&case.surface(), 4, &case.camera());
        let share = share_on_left(&twin, &case.form, &case.camera());
        println!("{}: {share:.4} of the pieces have the right sides", case.form.name);
        assert!(share >= CONTOUR_LEFT, "{}: {share}", case.form.name);
        let swapped = share_on_left(&twin.reversed(), &case.form, &case.camera());
        assert!(swapped < CONTOUR_LEFT, "{}: g's sign is not noticed, {swapped}", case.form.name);
    }
}
