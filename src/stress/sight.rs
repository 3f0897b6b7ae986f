//! A view of a case while methods draw it: its truth, and where they are worst.

use super::accuracy::{Accuracy, worst};
use super::case::{Case, View};
use super::figures::{Seen, ViewFigures, Worst};
use super::promise::Promise;
use crate::surface::Level;
use crate::truth::{Mask, Terrain, Truth};
use crate::view::Camera;

/// Side of the squares of the page by which places are told apart, px.
const SQUARE: u32 = 24;
/// Places that are marked for each method and promise.
const MARKED: usize = 3;

/// A view of a case that is being run.
pub(super) struct Sight<'a> {
    /// Which.
    pub view: &'a View,
    /// Its land, for truth.
    pub terrain: &'a Terrain<'a>,
    /// Truth, as fine as the case asks.
    pub truth: Truth,
    /// F of truth, drawn one pixel wide, against truth of twice the level, where that was asked.
    pub settled: Option<f64>,
    /// Camera and truth a step on.
    pub stepped: (Camera, Truth),
    /// Share of truth, drawn one pixel wide, that pops then.
    pub truth_popped: f64,
    /// Cameras of a flight after the first, and truth drawn one pixel wide; none where nothing is promised of it.
    pub flight: Vec<(Camera, Mask)>,
    /// Where each method is worst, by promise.
    pub worst: Vec<Worst>,
    /// What the picture shows.
    pub seen: Seen,
}

impl Sight<'_> {
    /// Marks places at which a promise is measured.
    pub(super) fn mark(&mut self, method: &'static str, promise: Promise, places: &[[u32; 2]]) {
        if !promise.is_of(method) {
            return;
        }
        let found = worst(places, SQUARE, MARKED).into_iter();
        self.worst.extend(found.map(|place| Worst::new(method, promise, place)));
    }

    /// How far truth agrees with truth of twice the level: what does not is made by roundings, and nothing can be held to it.
    pub(super) fn settles(&mut self) -> f64 {
        *self.settled.get_or_insert_with(|| {
            let finer = Level::new(2 * self.truth.level.subdivisions());
            let finer = finer.map(|level| self.terrain.truth(&self.view.camera, level));
            finer.map_or(1.0, |finer| Accuracy::of(&Mask::of_truth(&self.truth), &finer).f().unwrap_or(0.0))
        })
    }

    /// Its figures, when all methods have drawn it.
    pub(super) fn figures(self, case: &Case, truth_ms: f64) -> ViewFigures {
        let Camera { eye, azimuth, altitude, fov, width, height } = self.view.camera;
        ViewFigures {
            name: self.view.name,
            eye_m: eye.to_array(),
            azimuth,
            altitude,
            fov,
            width,
            height,
            truth_level: self.truth.level.subdivisions(),
            truth_px: self.truth.length(),
            truth_settled: self.settled,
            truth_ms,
            picture: picture_name(case.name, self.view.name),
            worst: self.worst,
            seen: self.seen,
        }
    }
}

/// File name of the picture of a view.
pub(crate) fn picture_name(case: &str, view: &str) -> String {
    format!("{case}_{view}.png")
}
