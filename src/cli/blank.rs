//! Pages without a line: what is said of them, and flags of a view that has lines.
//!
//! A view is looked for only then: from the same eye towards the middle of the DEM, else as one is chosen where none is
//! given. Each is drawn before it is named. Cost: at most three more frames.

use glam::DVec3;

use super::talk::Talk;
use super::values::{LevelChoice, Size};
use super::viewpoint::{FOV, View, ViewArguments};
use crate::error::Error;
use crate::message;
use crate::render::{Page, Renderer};
use crate::surface::Surface;
use crate::view::{Camera, direction};

/// Warns where a page holds no ink: says whether land is on it, where the DEM lies, and which flags show it.
pub(crate) fn warn(renderer: &mut Renderer, view: &View, level: LevelChoice, page: &Page, talk: &Talk) {
    if page.marks.inked() > 0 {
        return;
    }
    let surface = renderer.surface().clone();
    let (towards, lies) = where_it_lies(&surface, view);
    let what = match page.covered {
        0 => format!("no part of the DEM is on the page: {lies}"),
        covered => {
            let pixels = u64::from(page.marks.width) * u64::from(page.marks.height);
            format!("nothing is drawn: {covered} of {pixels} pixels show land, none of them a silhouette or a border")
        }
    };
    let Camera { fov, width, height, .. } = view.camera;
    let chosen = |fov| {
        let none_given = ViewArguments::of_file(None, None, view.norths.north, [None; 2], fov, Size { width, height });
        none_given.view(&surface, level.near()).ok()
    };
    let turned = || towards.map(|(azimuth, altitude)| view.turned(azimuth, altitude));
    let views: [&dyn Fn() -> Option<View>; 3] = [&turned, &|| chosen(fov), &|| chosen(FOV)];
    // What cannot be drawn is no remedy; why not is no concern of a drawing that is done.
    let plan = page.frame.plan;
    let mut shows = |view: &View| renderer.page(&plan, &view.camera, |_| ()).is_ok_and(|page| page.marks.inked() > 0);
    let remedy = match views.into_iter().find_map(|view| view().filter(&mut shows)) {
        Some(view) => format!("give {}", view.flags()),
        None if page.covered == 0 => "give an eye above the land, near it".to_owned(),
        None => "look along the land, and draw its border (--border on)".to_owned(),
    };
    talk.warn(&format!("{what}; {remedy}"));
}

/// Where the DEM lies as seen from an eye: azimuth and altitude of its middle, half-way between its lowest and its highest
/// place; and the same in words, the azimuth from the view's north.
pub(crate) fn where_it_lies(surface: &Surface, view: &View) -> (Option<(f64, f64)>, String) {
    let [west, south, east, north] = surface.dem().extent();
    let [low, high] = surface.dem().range().unwrap_or_default().map(f64::from);
    let way = DVec3::new(west + east, south + north, low + high) / 2.0 - view.camera.eye;
    let towards = direction(way);
    let words = towards.map_or_else(
        || "the eye is in its very middle".to_owned(),
        |(azimuth, altitude)| {
            let (away, azimuth) = (length(way.length()), view.norths.counted(azimuth));
            format!("its middle lies {away} from the eye at azimuth {azimuth}, altitude {altitude}")
        },
    );
    (towards, words)
}

/// An error of a view in which there is nothing to do, with where the DEM lies; others as they are.
pub(crate) fn with_place(error: Error, surface: &Surface, view: &View) -> Error {
    match error {
        Error::Scene { what, remedy } => {
            Error::Scene { what: message![what, format!(" ({})", where_it_lies(surface, view).1)], remedy }
        }
        other => other,
    }
}

/// Metres in words, with three or four figures.
pub(crate) fn length(metres: f64) -> String {
    match metres {
        m if m >= 1e4 => format!("{:.1} km", m / 1e3),
        m if m >= 10.0 => format!("{m:.0} m"),
        m if m >= 0.01 => format!("{m:.3} m"),
        m => format!("{m:.3e} m"),
    }
}
