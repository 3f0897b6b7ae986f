//! No pixel of the surface is missed: seeded random terrain at several levels, seen from far and near, from within the
//! ground, with facets across the near plane and facets larger than the 126 px one invocation draws alone.

use std::sync::Arc;

use glam::DVec3;
use hachure::door::surface::Lattice;
use hachure::door::surface::lattice::{CHUNK_FACETS, CHUNK_SIDE, CHUNK_VERTICES};
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::common::gpu;
use crate::frames::{CLIPPED, Planned, Shot};
use crate::mesh::{distance, facets, pinholes};
use crate::scenes::{Random, aimed, level, noise, noisy, over, surface};

const PAGE: [u32; 2] = [360, 240];

/// What the random frames met: a test that meets none of it proves nothing.
#[derive(Debug, Default)]
struct Met {
    frames: usize,
    uncovered: usize,
    covered: usize,
    across_near: usize,
    large: usize,
}

impl Met {
    fn add(&mut self, shot: &Shot) {
        self.frames += 1;
        for id in 0..shot.lattice.chunks().len() as u32 * CHUNK_FACETS {
            let corners = corners(shot, id);
            let flags = corners.map(|c| c[3]);
            if flags.iter().any(|f| f & 64 != 0) || flags[0] & flags[1] & flags[2] & 31 != 0 {
                continue;
            }
            let clipped = flags.iter().any(|f| f & CLIPPED != 0);
            self.across_near += usize::from(flags.iter().any(|f| f & 16 != 0));
            let extent = |axis: usize| {
                let [a, b, c] = corners.map(|c| c[axis]);
                a.max(b).max(c) - a.min(b).min(c)
            };
            self.large += usize::from(!clipped && extent(0).max(extent(1)) > 126 * 256);
        }
    }
}

/// Screen vertices of a facet.
fn corners(shot: &Shot, id: u32) -> [[i32; 4]; 3] {
    let chunk = shot.lattice.chunks()[(id / CHUNK_FACETS) as usize];
    shot.lattice.facet(id).map(|at| {
        let [x, y] = [at.x - chunk.origin[0], at.y - chunk.origin[1]].map(|d| d / chunk.step);
        shot.screens[(id / CHUNK_FACETS * CHUNK_VERTICES + y * CHUNK_SIDE + x) as usize]
    })
}

/// Eyes above, skimming and within the ground, in the middle of a cell, and outside.
fn eyes(surface: &Surface, random: &mut Random) -> Vec<Camera> {
    let dem = surface.dem();
    let cell = dem.cell().x;
    let [columns, rows] = [dem.columns(), dem.rows()].map(|n| n as f64 - 1.001);
    let heights = [2.0 * cell, 0.5 * cell, 0.1 * cell, 0.01 * cell, 0.002 * cell, -0.002 * cell, -0.1 * cell];
    let mut cameras: Vec<_> = heights
        .into_iter()
        .map(|above| {
            let aside = DVec3::new(random.between(0.0, 0.015), random.between(-0.015, 0.0), 0.0) * cell;
            let eye = over(surface, random.between(0.2, columns), random.between(0.2, rows), above) + aside;
            aimed(eye, random.between(0.0, 360.0), random.between(-40.0, 15.0), PAGE)
        })
        .collect();
    let [west, south, east, north] = dem.extent();
    let azimuth = random.between(0.0, 360.0);
    let (sin, cos) = azimuth.to_radians().sin_cos();
    let middle = DVec3::new(west + east, south + north, 3000.0) / 2.0;
    let back = DVec3::new(-sin, -cos, 0.5) * (east - west);
    cameras.push(aimed(middle + back, azimuth, -25.0, PAGE));
    cameras.push(aimed(middle + DVec3::Z * 3.0 * cell, azimuth, -90.0, PAGE));
    cameras
}

fn check(surface: &Arc<Surface>, n: u32, random: &mut Random, met: &mut Met) {
    let mut renderer = Planned::by_id(gpu(), surface, n);
    let mesh = facets(surface, &Lattice::uniform(surface.dem(), level(n)).expect("IDs suffice"));
    for camera in eyes(surface, random) {
        let shot = renderer.shoot(&camera);
        let depths: Vec<u32> = shot.pixels.iter().map(|p| p[1]).collect();
        let (holes, uncovered) = pinholes(&mesh, &camera, renderer.near(), &depths);
        assert!(holes.is_empty(), "level {n}: {} pinholes, first {:?}, {camera:?}", holes.len(), &holes[..1]);
        met.uncovered += uncovered;
        met.covered += depths.len() - uncovered;
        met.add(&shot);
    }
}

fn random_terrain_has_no_pinhole(n: u32, samples: usize, seeds: u64) {
    let mut met = Met::default();
    for seed in 0..seeds {
        let mut random = Random::new(1000 * u64::from(n) + seed);
        let cell = [10.0, 50.0, 400.0][seed as usize % 3];
        let scene = noisy(seed + 77, [samples, samples + 1], cell, cell * random.between(0.2, 2.0));
        check(&scene, n, &mut random, &mut met);
    }
    println!("level {n}: no pinhole in {met:?}");
    assert!(met.uncovered > 1000 && met.covered > 10_000 && met.across_near > 0, "{met:?}");
    assert!(met.large > 0 || n > 2, "no large facet: {met:?}");
}

#[test]
fn no_pinhole_at_level_1() {
    random_terrain_has_no_pinhole(1, 9, 6);
}

#[test]
fn no_pinhole_at_level_2() {
    random_terrain_has_no_pinhole(2, 7, 6);
}

#[test]
fn no_pinhole_at_level_8() {
    random_terrain_has_no_pinhole(8, 6, 6);
}

#[test]
fn no_pinhole_at_level_64() {
    random_terrain_has_no_pinhole(64, 4, 3);
}

#[test]
fn no_pinhole_around_voids() {
    let mut met = Met::default();
    for seed in 0..3 {
        let mut heights = noise(seed, [12, 11], 50.0, 60.0);
        heights[40 + seed as usize] = f32::NAN;
        let holed = surface(12, 50.0, heights);
        let mut renderer = Planned::by_id(gpu(), &holed, 4);
        let mesh = facets(&holed, &Lattice::uniform(holed.dem(), level(4)).expect("IDs suffice"));
        for azimuth in [0.0, 100.0, 200.0, 300.0] {
            let camera = aimed(over(&holed, 1.0, 1.0, 300.0 + azimuth), azimuth, -70.0, PAGE);
            let shot = renderer.shoot(&camera);
            let depths: Vec<u32> = shot.pixels.iter().map(|p| p[1]).collect();
            assert!(pinholes(&mesh, &camera, renderer.near(), &depths).0.is_empty(), "seed {seed}, {camera:?}");
            met.covered += depths.iter().filter(|d| **d != 0).count();
        }
    }
    assert!(met.covered > 10_000);
}

#[test]
fn pinholes_are_found() {
    let mut heights = noise(9, [9, 9], 50.0, 30.0);
    let whole = surface(9, 50.0, heights.clone());
    heights[40] = f32::NAN;
    let holed = surface(9, 50.0, heights);
    let camera = aimed(over(&whole, 4.0, 4.0, 150.0), 20.0, -90.0, PAGE);
    let mesh = facets(&whole, &Lattice::uniform(whole.dem(), level(2)).expect("IDs suffice"));
    let near = hachure::door::gpu::uniforms::near_plane(whole.dem());
    let depths =
        |surface| Planned::by_id(gpu(), surface, 2).shoot(&camera).pixels.iter().map(|p| p[1]).collect::<Vec<_>>();
    // Drawn without the patches around one sample: a hexagon is missing.
    let missing = pinholes(&mesh, &camera, near, &depths(&holed)).0;
    assert!(missing.len() > 1000, "{} pinholes", missing.len());
    // Drawn whole, but for one pixel.
    let mut punched = depths(&whole);
    assert!(pinholes(&mesh, &camera, near, &punched).0.is_empty());
    punched[(100 * PAGE[0] + 200) as usize] = 0;
    assert_eq!(pinholes(&mesh, &camera, near, &punched).0, [[200, 100]]);
    // Nearer than the near plane nothing counts.
    assert!(pinholes(&mesh, &camera, 1e5, &punched).0.is_empty());
}

#[test]
fn rays_meet_facets_where_they_should() {
    let facet = [DVec3::new(-1.0, -1.0, 4.0), DVec3::new(3.0, -1.0, 4.0), DVec3::new(-1.0, 3.0, 4.0)];
    assert_eq!(distance(facet, DVec3::Z), Some(4.0));
    assert_eq!(distance(facet, DVec3::new(0.25, 0.25, 1.0)), Some(4.0), "a border belongs to the facet");
    assert_eq!(distance(facet, DVec3::new(0.26, 0.25, 1.0)), None);
    assert_eq!(distance(facet, DVec3::X), None, "parallel");
    assert_eq!(distance(facet, -DVec3::Z), Some(-4.0), "behind: the caller compares with the near plane");
}
