//! Bounds that were exaggerated hold the exaggerated surface: no sample was looked at for them.

use glam::DVec3;
use hachure::surface::{Pyramid, Surface};

use super::{facets, farthest, squares};
use crate::scenes::{Random, rough};
use crate::tolerances::DEVIATION_MOST;

const FACTORS: [f64; 4] = [0.3, 2.0, 2.5, 10.0];

/// Rough and smooth land, plain and with every height times `k`: the same noise.
fn pairs(k: f64) -> [[Surface; 2]; 3] {
    [(5.0, false), (0.3, false), (2.0, true)].map(|(noise, voids)| {
        let plain = rough(97, 81, 1.0, noise, voids);
        let heights = (0..97 * 81).map(|i| plain.height(i % 97, i / 97).unwrap_or(f32::NAN));
        let times = heights.map(|height| (f64::from(height) * k) as f32).collect();
        let drawn = hachure::dem::Dem::from_heights(97, plain.cell(), plain.position(0, 0).truncate(), times);
        [plain, drawn].map(Surface::new)
    })
}

/// Slopes dz/d east and dz/d north of the sides of a facet that run that way on the lattice.
fn slopes(corners: [DVec3; 3], axis: usize, ends: [usize; 2]) -> f64 {
    let side = corners[ends[1]] - corners[ends[0]];
    side.z / side[axis]
}

/// Facets, low, high and aside, and slopes of some squares against what `pyramid` says of them: how many facets were outside.
fn outside(surface: &Surface, pyramid: &Pyramid, random: &mut Random) -> [usize; 2] {
    let zero = surface.dem().position(0, 0).with_z(0.0);
    let [mut outside, mut all] = [0, 0];
    for step in [4, 16, 64, 128].into_iter().filter(|step| *step <= pyramid.coarsest_step()) {
        for origin in squares(surface, step).filter(|_| random.below(if step < 16 { 40 } else { 4 }) == 0) {
            let Some([low, high]) = pyramid.bounds(origin, step) else { continue };
            let [least, most] = pyramid.slopes(origin, step);
            for (vertices, corners) in facets(surface, origin, step) {
                let inside =
                    corners.map(|p| p - zero).iter().all(|p| p.cmpge(low - 1e-6).all() && p.cmple(high + 1e-6).all());
                let is_lower = vertices[0].x == vertices[1].x;
                let (east, north) = if is_lower { ([1, 2], [1, 0]) } else { ([0, 2], [1, 2]) };
                let steep = |axis: usize, ends| {
                    let slope = slopes(corners, axis, ends);
                    slope < least[axis] - 1e-6 || slope > most[axis] + 1e-6
                };
                // Coarse facets are chords of many patches: their slopes are means of slopes.
                outside += usize::from(!inside || steep(0, east) || steep(1, north));
                all += 1;
            }
        }
    }
    [outside, all]
}

#[test]
fn exaggerated_bounds_hold_the_exaggerated_surface() {
    let mut random = Random::new(29);
    for k in FACTORS {
        for (i, [plain, drawn]) in pairs(k).iter().enumerate() {
            let derived = plain.pyramid().expect("in memory").exaggerated(k);
            let [strays, all] = outside(drawn, &derived, &mut random);
            assert!(all > 5000 && strays == 0, "scene {i} times {k}: {strays} of {all} facets lie outside");
            // The check itself: bounds of the plain land do not hold the other.
            let [strays, _] = outside(drawn, plain.pyramid().expect("in memory"), &mut random);
            assert!(strays > 0, "scene {i} times {k}: nothing can be noticed");
        }
    }
}

#[test]
fn exaggerated_facets_leave_the_surface_as_far_as_is_said() {
    for k in FACTORS {
        for (i, [plain, drawn]) in pairs(k).iter().enumerate() {
            let (derived, own) =
                (plain.pyramid().expect("in memory").exaggerated(k), drawn.pyramid().expect("in memory"));
            for step in [8, 32, 64, 128, 256].into_iter().filter(|step| *step <= own.coarsest_step()) {
                for origin in squares(drawn, step).step_by(1 + squares(drawn, step).count() / 6) {
                    let (said, of_own) = (derived.deviation(origin, step), own.deviation(origin, step));
                    assert_eq!(
                        said.is_infinite(),
                        of_own.is_infinite(),
                        "scene {i} times {k}, {origin:?}, step {step}"
                    );
                    let off =
                        facets(drawn, origin, step).iter().map(|(v, p)| farthest(drawn, *v, *p)).fold(0.0, f64::max);
                    assert!(
                        off <= said * DEVIATION_MOST,
                        "scene {i} times {k}, {origin:?}, step {step}: {off}, not {said}"
                    );
                    let fences =
                        |pyramid: &Pyramid| pyramid.fences(origin, step).map(|f| [f.along_east, f.along_north]);
                    assert_eq!(fences(&derived), fences(own), "scene {i} times {k}, {origin:?}, step {step}");
                }
            }
        }
    }
}

#[test]
fn gentle_slopes_stay_known() {
    let heights = (0..65 * 65).map(|i| 3.0 * ((i % 65) as f32 / 11.0).sin() + (i / 65) as f32).collect();
    let dem = hachure::dem::Dem::from_heights(65, glam::DVec2::splat(20.0), glam::DVec2::ZERO, heights);
    let surface = Surface::new(dem);
    let derived = surface.pyramid().expect("in memory").exaggerated(2.0);
    for origin in squares(&surface, 16) {
        let [low, high] = derived.slopes(origin, 16);
        assert!((high - low).max_element() < 1.0, "{low} to {high}: of no use");
    }
}
