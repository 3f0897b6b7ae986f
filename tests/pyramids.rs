//! What the pyramid says of the surface, against dense looks at it in f64: how far facets leave it, between which heights
//! it lies, the fences of samples across each square.

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::door::surface::lattice::{CELL_STEPS, CHUNK_QUADS};
use hachure::door::surface::{Chunk, LatticePoint, Pyramid};
use hachure::surface::Surface;

use crate::scenes::rough;
use crate::tolerances::{DEVIATION_MOST, DEVIATION_SHARE};

/// Places along a facet's sides at which it is compared with the surface.
const DENSE: u32 = 8;

fn scenes() -> [Surface; 4] {
    let smooth = |c: usize, r: usize| (40.0 * (c as f64 / 23.0).sin() * (r as f64 / 31.0).cos()) as f32;
    let heights = (0..257 * 140).map(|i| smooth(i % 257, i / 257)).collect();
    let smooth = Dem::from_heights(257, DVec2::new(20.0, 30.0), DVec2::new(3e5, 4e6), heights);
    [rough(129, 97, 1.0, 5.0, false), rough(70, 66, 4.0, 8.0, false), rough(131, 70, 1.0, 2.0, true), smooth]
        .map(Surface::new)
}

/// Every square that chunks of this step may fill.
fn squares(surface: &Surface, step: u32) -> impl Iterator<Item = [u32; 2]> {
    let dem = surface.dem();
    let [across, down] = [dem.columns(), dem.rows()].map(|n| (n as u32 - 1) * CELL_STEPS);
    let size = (CHUNK_QUADS * step) as usize;
    (0..down).step_by(size).flat_map(move |y| (0..across).step_by(size).map(move |x| [x, y]))
}

/// The facets of a chunk that exist, by their vertices and these places.
fn facets(surface: &Surface, origin: [u32; 2], step: u32) -> Vec<([LatticePoint; 3], [DVec3; 3])> {
    let chunk = Chunk { origin, step, coarser: 0 };
    let quads = (0..CHUNK_QUADS * CHUNK_QUADS).map(|i| [i % CHUNK_QUADS, i / CHUNK_QUADS]);
    let halves = quads.flat_map(|[x, y]| [[[x, y], [x, y + 1], [x + 1, y + 1]], [[x, y], [x + 1, y + 1], [x + 1, y]]]);
    let existing = halves.filter_map(|corners| {
        let vertices = corners.map(|at| chunk.vertex(at));
        let [a, b, c] = vertices.map(|at| surface.position(at));
        Some((vertices, [a?, b?, c?]))
    });
    existing.collect()
}

/// The largest distance between facets and the surface at the same places of the lattice, metres; and how low and high they
/// lie and how far beside their square.
fn farthest(surface: &Surface, vertices: [LatticePoint; 3], corners: [DVec3; 3]) -> f64 {
    let mut farthest = 0.0_f64;
    let side = DENSE.min(vertices[0].x.abs_diff(vertices[2].x).max(vertices[0].y.abs_diff(vertices[2].y)));
    for (i, j) in (0..=side).flat_map(|i| (0..=side - i).map(move |j| (i, j))) {
        let weights = [side - i - j, i, j];
        let sum = |of: fn(LatticePoint) -> u32| (0..3).map(|k| of(vertices[k]) * weights[k]).sum::<u32>();
        let (x, y) = (sum(|v| v.x), sum(|v| v.y));
        if x % side == 0 && y % side == 0 {
            let on_facet: DVec3 = (0..3).map(|k| corners[k] * f64::from(weights[k]) / f64::from(side)).sum();
            let on_surface = surface.position(LatticePoint { x: x / side, y: y / side });
            farthest = farthest.max(on_surface.map_or(0.0, |p| p.distance(on_facet)));
        }
    }
    farthest
}

/// The largest share of what is promised that facets of one step leave the surface by, and the median share.
fn shares(surface: &Surface, pyramid: &Pyramid, step: u32) -> Vec<f64> {
    let origins: Vec<_> = squares(surface, step).filter(|origin| pyramid.bounds(*origin, step).is_some()).collect();
    let several = origins.len().div_ceil(8);
    let of = |origin: &[u32; 2]| {
        let promised = pyramid.deviation(*origin, step);
        let facets = facets(surface, *origin, step);
        let off = facets.iter().map(|(v, p)| farthest(surface, *v, *p)).fold(0.0, f64::max);
        promised.is_finite().then_some(off / promised)
    };
    let mut shares: Vec<f64> = origins.iter().step_by(several).filter_map(of).collect();
    shares.sort_by(f64::total_cmp);
    shares
}

#[test]
fn facets_leave_the_surface_as_far_as_the_pyramid_says() {
    for (i, surface) in scenes().iter().enumerate() {
        let pyramid = surface.pyramid().expect("in memory");
        // Level 64 has no place between vertices where the surface could be looked at.
        let steps = (1..).map(|k| 1 << k).take_while(|step| *step <= pyramid.coarsest_step());
        for step in steps {
            let shares = shares(surface, pyramid, step);
            let Some(largest) = shares.last() else { continue };
            let median = shares[shares.len() / 2];
            println!(
                "scene {i}, step {step}: {} squares, {median:.2} of what is said, at most {largest:.2}",
                shares.len()
            );
            assert!(*largest <= DEVIATION_MOST, "scene {i}, step {step}: {largest} of what is said");
            // The largest of a few hundred facets is near the bound, but for the coarsest ones of the smoothest land.
            assert!(median >= DEVIATION_SHARE, "scene {i}, step {step}: {median} of what is said");
        }
    }
}

#[test]
fn facets_lie_between_bounds() {
    for (i, surface) in scenes().iter().enumerate() {
        let pyramid = surface.pyramid().expect("in memory");
        let zero = surface.dem().position(0, 0).with_z(0.0);
        let mut all = 0;
        for step in [2, 8, 16, 64, 128].into_iter().filter(|step| *step <= pyramid.coarsest_step()) {
            for origin in squares(surface, step).step_by(1 + squares(surface, step).count() / 6) {
                let facets = facets(surface, origin, step);
                let Some([low, high]) = pyramid.bounds(origin, step) else {
                    assert!(facets.is_empty(), "scene {i}: {origin:?} of step {step} has facets and no bounds");
                    continue;
                };
                for (_, corners) in facets {
                    for p in corners.map(|p| p - zero) {
                        let inside = p.cmpge(low - 1e-6).all() && p.cmple(high + 1e-6).all();
                        assert!(inside, "scene {i}: {p} of {origin:?}, step {step}, lies outside {low} to {high}");
                    }
                    all += 1;
                }
            }
        }
        assert!(all > 10_000, "scene {i}: {all} facets");
    }
}

/// The fences of a square by their definition; `None` where it has voids or leaves the DEM.
fn fences(dem: &Dem, origin: [u32; 2], step: u32) -> Option<[f32; 2]> {
    let size = ((CHUNK_QUADS * step / CELL_STEPS) as usize).max(4);
    let [c, r] = origin.map(|at| (at / CELL_STEPS) as usize / size * size);
    let highest_of_lowest = |at: &dyn Fn(usize, usize) -> [usize; 2]| {
        let line = |i| {
            (0..=size).map(|k| at(i, k)).map(|[c, r]| dem.height(c, r)).try_fold(f32::INFINITY, |l, h| Some(l.min(h?)))
        };
        (0..=size).map(line).try_fold(f32::NEG_INFINITY, |highest, lowest| Some(highest.max(lowest?)))
    };
    Some([highest_of_lowest(&|i, k| [c + k, r + i])?, highest_of_lowest(&|i, k| [c + i, r + k])?])
}

#[test]
fn fences_are_the_highest_of_the_lowest() {
    let mut found = [0, 0];
    for (i, surface) in scenes().iter().enumerate() {
        let pyramid = surface.pyramid().expect("in memory");
        for step in [4, 8, 16, 32, 64] {
            for origin in squares(surface, step) {
                let told = pyramid.fences(origin, step).map(|f| [f.along_east, f.along_north]);
                let expected = fences(surface.dem(), origin, step);
                assert_eq!(told, expected, "scene {i}, {origin:?}, step {step}");
                found[usize::from(told.is_none())] += 1;
            }
        }
    }
    assert!(found.iter().all(|n| *n > 100), "{found:?} squares with and without fences");
}

#[test]
fn chunks_that_must_not_be_coarse_deviate_infinitely() {
    let mut found = [0, 0];
    for (i, surface) in scenes().iter().enumerate() {
        let (dem, pyramid) = (surface.dem(), surface.pyramid().expect("in memory"));
        for step in [128, 256, 512].into_iter().filter(|step| *step <= pyramid.coarsest_step()) {
            for origin in squares(surface, step) {
                let may = crate::mixed::may_be_coarse(dem, origin, step);
                let told = pyramid.deviation(origin, step).is_finite();
                assert_eq!(told, may, "scene {i}, {origin:?}, step {step}");
                found[usize::from(may)] += 1;
            }
        }
    }
    assert!(found.iter().all(|n| *n > 1), "{found:?} squares that must not and may be coarse");
}

#[test]
fn another_surface_is_noticed() {
    let [a, b] = [rough(70, 66, 4.0, 8.0, false), rough(70, 66, 4.2, 8.0, false)].map(Surface::new);
    let (mine, other) = (a.pyramid().expect("in memory"), b.pyramid().expect("in memory"));
    let largest = |pyramid| shares(&b, pyramid, 32).last().copied().expect("a square");
    assert!(largest(mine) > largest(other));
    let origin = [0, 0];
    assert_ne!(mine.fences(origin, 64).map(|f| f.along_east), other.fences(origin, 64).map(|f| f.along_east));
}
