//! A view of a case while methods draw it: its truth, and where they are worst.

use super::accuracy::worst;
use super::case::{Case, View};
use super::figures::{Seen, ViewFigures, Worst};
use super::promise::Promise;
use crate::truth::{Mask, Truth};
use crate::view::Camera;

/// Side of the squares of the page by which places are told apart, px.
const SQUARE: u32 = 24;
/// Places that are marked for each method and promise.
const MARKED: usize = 3;

/// A view of a case that is being run.
pub(super) struct Sight<'a> {
    /// Which.
    pub view: &'a View,
    /// Truth, as fine as the case asks.
    pub truth: Truth,
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
