//! Ids of chains from one frame to the next: known by construction.

use glam::DVec3;
use hachure::door::measure::kept::{SeenChains, ids_kept};
use hachure::line::{Chain, ChainPoint, Id, Line};
use hachure::view::{Camera, Perspective};

use crate::tolerances::SUM;

/// Looks north from the origin, 100 px per unit of tangent.
fn camera(metres_on: f64) -> Camera {
    Camera { eye: DVec3::Y * metres_on, azimuth: 0.0, altitude: 0.0, fov: 90.0, width: 200, height: 200 }
}

/// A level line of the world, `distance` metres from the first eye, seen by it at `row` px from `left` to `right` px.
#[derive(Clone, Copy)]
struct Level {
    id: u64,
    distance: f64,
    row: f64,
    left: f64,
    right: f64,
}

impl Level {
    fn new(id: u64, row: f64) -> Self {
        Self { id, distance: 400.0, row, left: 60.0, right: 140.0 }
    }

    fn called(self, id: u64) -> Self {
        Self { id, ..self }
    }

    /// As an eye so many metres on sees it.
    fn seen(self, metres_on: f64) -> Chain {
        let seen = Perspective::new(&camera(metres_on), 1.0);
        let world = |column: f64| DVec3::new(column - 100.0, 100.0, 100.0 - self.row) * (self.distance / 100.0);
        let point = |column: f64| {
            let (place, depth) = seen.project(world(column));
            ChainPoint {
                place,
                line: Line::Occluding,
                depth: depth as f32,
                behind: 0.0,
                world: world(column),
                crowd: 0,
                weight: 1.0,
                black: 1.0,
            }
        };
        // Corners elsewhere in each frame.
        let corners = [0.0, 0.3 + metres_on / 10.0, 1.0].map(|share| self.left + (self.right - self.left) * share);
        Chain { id: Some(Id(self.id)), points: corners.map(point).to_vec(), closed: false }
    }
}

/// What is kept of lines, seen by the first eye, by those of the eye 1 m on.
fn kept(first: &[Level], next: &[Level]) -> Option<f64> {
    let [here, there] =
        [(first, 0.0), (next, 1.0)].map(|(lines, on)| lines.iter().map(|l| l.seen(on)).collect::<Vec<_>>());
    let cameras = [0.0, 1.0].map(camera);
    ids_kept(SeenChains { camera: &cameras[0], chains: &here }, SeenChains { camera: &cameras[1], chains: &there })
}

#[track_caller]
fn near(found: Option<f64>, known: f64) {
    assert!((found.expect("a share") - known).abs() <= SUM, "{found:?}, known {known}");
}

#[test]
fn the_same_names_are_kept_whatever_the_order() {
    let lines = [Level::new(1, 40.0), Level::new(2, 60.0), Level::new(3, 61.0)];
    near(kept(&lines, &lines), 1.0);
    near(kept(&lines, &[lines[2], lines[0], lines[1]]), 1.0);
}

#[test]
fn swapped_doubled_and_new_names_are_lost() {
    let [a, b, c] = [Level::new(1, 40.0), Level::new(2, 60.0), Level::new(3, 80.0)];
    near(kept(&[a, b], &[a.called(2), b.called(1)]), 0.0);
    near(kept(&[a, b, c], &[a.called(2), b.called(1), c]), 1.0 / 3.0);
    near(kept(&[a, b, c], &[a, b.called(7), c]), 2.0 / 3.0);
    // Two of one name: both are lost, whichever frame they are in.
    near(kept(&[a, b, c], &[a, b.called(1), c]), 1.0 / 3.0);
    near(kept(&[a, b.called(1), c], &[a, b, c]), 1.0 / 3.0);
    near(kept(&[a.called(1), b.called(1)], &[a.called(1), b.called(1)]), 0.0);
}

#[test]
fn what_is_gone_or_elsewhere_is_lost_and_halves_count_by_length() {
    let line = Level::new(1, 60.0);
    near(kept(&[line, Level::new(2, 80.0)], &[line]), 0.5);
    for (moved, known) in [(1.4, 1.0), (1.6, 0.0), (-1.4, 1.0), (-1.6, 0.0)] {
        near(kept(&[line], &[Level { row: 60.0 + moved, ..line }]), known);
    }
    // The line falls in two, one of which keeps the name.
    let halves = [Level { right: 120.0, ..line }, Level { left: 120.0, ..line }.called(9)];
    let found = kept(&[line], &halves).expect("a share");
    assert!((found - 0.75).abs() < 0.01, "{found}");
    // And grows together again.
    let found = kept(&halves, &[line]).expect("a share");
    assert!((found - 0.75).abs() < 0.01, "{found}");
}

#[test]
fn of_lines_on_one_place_of_the_page_the_one_nearest_in_the_world_counts() {
    // A far line shows 1 px below a near one; 1 m on they are nearer to each other than to their own places.
    let [near_line, far_line] = [Level { distance: 20.0, ..Level::new(1, 95.0) }, Level::new(2, 94.8)];
    let lines = [near_line, far_line];
    let place = |metres_on: f64, i: usize| lines[i].seen(metres_on).points[0].place.y;
    assert!((place(1.0, 1) - place(0.0, 0)).abs() < (place(1.0, 0) - place(0.0, 0)).abs(), "the trap is none");
    near(kept(&lines, &lines), 1.0);
    near(kept(&lines, &[near_line.called(2), far_line.called(1)]), 0.0);
}

#[test]
fn short_chains_and_what_only_one_page_shows_do_not_count() {
    let line = Level::new(1, 60.0);
    let dash = |length: f64| Level { right: 60.0 + length, ..Level::new(5, 90.0) };
    near(kept(&[line, dash(11.9)], &[line, dash(11.9).called(6)]), 1.0);
    let of = 12.1 / 92.1;
    near(kept(&[line, dash(12.1)], &[line, dash(12.1).called(6)]), 1.0 - of);
    assert_eq!(kept(&[dash(11.9)], &[dash(11.9)]), None, "none is long enough");
    // 10 m away, the outer half of the page's last columns is gone 1 m on; what is still there keeps its name.
    let beside = Level { distance: 10.0, left: 150.0, right: 200.0, ..Level::new(1, 100.0) };
    near(kept(&[beside], &[beside]), 1.0);
    let gone = Level { left: 192.0, ..beside };
    assert_eq!(kept(&[gone], &[]), None, "all of it leaves the page");
    near(kept(&[beside], &[]), 0.0);
}

#[test]
fn chains_without_names_have_no_share() {
    let line = Level::new(1, 60.0);
    let cameras = [0.0, 1.0].map(camera);
    let mut first = vec![line.seen(0.0), Level::new(2, 80.0).seen(0.0)];
    let next = [line.seen(1.0)];
    let share = |first: &[Chain]| {
        ids_kept(SeenChains { camera: &cameras[0], chains: first }, SeenChains { camera: &cameras[1], chains: &next })
    };
    near(share(&first), 0.5);
    first[0].id = None;
    near(share(&first), 0.0);
    first[1].id = None;
    assert_eq!(share(&first), None);
    assert_eq!(share(&[]), None);
}
