//! Vertices of the GPU against `Surface::position` and `Camera::project` in f64, which share the DEM and its normals
//! with it and nothing else. A twin of shaders/surface.wgsl; the surface itself is tested elsewhere.
//!
//! The promise is for what is on the page. Beside it a vertex is only an end of an edge that leaves the page, and f32
//! grows coarser with the distance from the view axis; those are measured and printed.

use std::sync::Arc;

use glam::DVec3;
use hachure::door::gpu::uniforms::near_plane;
use hachure::door::surface::LatticePoint;
use hachure::door::surface::lattice::{CHUNK_SIDE, CHUNK_VERTICES};
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::common::gpu;
use crate::frames::{BESIDE, CLIPPED, MISSING, Planned, Shot};
use crate::scenes::{aimed, noise, noisy, over, surface};
use crate::tolerances::raster::{VERTEX_DEPTH, VERTEX_PX};

const PAGE: [u32; 2] = [1280, 720];

/// How far the vertices of a frame are from the truth at worst, and how many were seen.
#[derive(Debug, Default, Clone, Copy)]
struct Worst {
    on_page: usize,
    px: f64,
    depth: f64,
    farthest_metres: f64,
    /// Largest distance of vertices beside the page, px, per 1000 px from its centre.
    beside_px: f64,
    /// Vertices whose flags contradict the truth by more than a pixel.
    wrong_flags: usize,
}

impl Worst {
    fn with(self, other: Self) -> Self {
        Self {
            on_page: self.on_page + other.on_page,
            px: self.px.max(other.px),
            depth: self.depth.max(other.depth),
            farthest_metres: self.farthest_metres.max(other.farthest_metres),
            beside_px: self.beside_px.max(other.beside_px),
            wrong_flags: self.wrong_flags + other.wrong_flags,
        }
    }
}

/// Compares every vertex of a frame.
fn compare(surface: &Surface, camera: &Camera, shot: &Shot) -> Worst {
    let mut worst = Worst::default();
    let near = near_plane(surface.dem());
    for (chunk, screens) in shot.lattice.chunks().iter().zip(shot.screens.chunks_exact(CHUNK_VERTICES as usize)) {
        let left_out = screens.iter().all(|s| *s == [0; 4]);
        for (v, screen) in (0..).zip(screens) {
            let [x, y] = [v % CHUNK_SIDE, v / CHUNK_SIDE];
            let at = LatticePoint { x: chunk.origin[0] + x * chunk.step, y: chunk.origin[1] + y * chunk.step };
            let truth = surface.position(at);
            worst = worst.with(one(truth, left_out, *screen, camera, near));
        }
    }
    worst
}

fn one(truth: Option<DVec3>, left_out: bool, screen: [i32; 4], camera: &Camera, near: f64) -> Worst {
    let mut worst = Worst::default();
    let [x, y, depth, flags] = screen;
    let Some(point) = truth else {
        worst.wrong_flags = usize::from(!left_out && flags & MISSING == 0);
        return worst;
    };
    let (place, along) = camera.project(point);
    let page = glam::DVec2::new(f64::from(camera.width), f64::from(camera.height));
    let from_centre = (place - page / 2.0).abs();
    let inside = along > near && (from_centre - page / 2.0).max_element() < 0.0;
    // Flags are set a pixel beyond the page.
    let outside = along < near * 0.99 || (from_centre - page / 2.0).max_element() > 2.0;
    if inside && (left_out || flags & (BESIDE | CLIPPED | MISSING) != 0) || outside && !left_out && flags & 63 == 0 {
        worst.wrong_flags = 1;
    }
    if left_out || flags & (CLIPPED | MISSING) != 0 {
        return worst;
    }
    let off = place.distance(glam::DVec2::new(f64::from(x), f64::from(y)) / 256.0);
    if inside {
        worst.on_page = 1;
        worst.px = off;
        worst.depth = (f64::from(f32::from_bits(depth as u32)) / (near / along) - 1.0).abs();
        worst.farthest_metres = point.distance(camera.eye);
    } else {
        worst.beside_px = off / (from_centre.length() / 1000.0).max(1.0);
    }
    worst
}

fn check(name: &str, surface: &Arc<Surface>, n: u32, cameras: &[Camera]) -> Worst {
    let mut renderer = Planned::by_id(gpu(), surface, n);
    let mut worst = Worst::default();
    for camera in cameras {
        let found = compare(surface, camera, &renderer.shoot(camera));
        assert!(found.on_page > 0, "{name}, level {n}: nothing on the page of {camera:?}");
        assert!(found.px <= VERTEX_PX, "{name}, level {n}: {} px off, {camera:?}", found.px);
        assert!(found.depth <= VERTEX_DEPTH, "{name}, level {n}: depth off by {}, {camera:?}", found.depth);
        assert_eq!(found.wrong_flags, 0, "{name}, level {n}: flags contradict the truth, {camera:?}");
        worst = worst.with(found);
    }
    println!("{name}, level {n}: {worst:?}");
    worst
}

/// Eyes near the ground, above it, and `far` metres away in four directions.
fn eyes(surface: &Surface, far: f64) -> Vec<Camera> {
    let dem = surface.dem();
    let [west, south, east, north] = dem.extent();
    let [low, high] = dem.range().expect("heights").map(f64::from);
    let middle = DVec3::new(west + east, south + north, low + high) / 2.0;
    let [c, r] = [dem.columns(), dem.rows()].map(|n| n as f64 / 2.0 - 0.8);
    let mut cameras = vec![
        aimed(over(surface, c, r, 2.0), 17.0, 0.0, PAGE),
        aimed(over(surface, c, r, 30.0), 133.0, -20.0, PAGE),
        aimed(over(surface, c, r, 900.0), 271.0, -90.0, PAGE),
    ];
    for (k, azimuth) in [3.0, 95.0, 200.5, 310.0_f64].into_iter().enumerate() {
        let (sin, cos) = azimuth.to_radians().sin_cos();
        let eye = middle - DVec3::new(sin, cos, 0.0) * far + DVec3::Z * (300.0 * k as f64 + 100.0);
        cameras.push(aimed(eye, azimuth, -1.0, PAGE));
    }
    cameras
}

#[test]
fn vertices_agree_with_f64_up_to_20_km_away() {
    let wide = noisy(1, [401, 401], 50.0, 120.0);
    let mut cameras = eyes(&wide, 10_000.0);
    // From the north-east corner the farthest corner is 28 km away.
    cameras.push(aimed(over(&wide, 399.0, 1.0, 60.0), 225.0, -1.0, PAGE));
    let worst = check("20 km", &wide, 1, &cameras);
    assert!(worst.farthest_metres > 20_000.0, "{} m", worst.farthest_metres);
    let small = noisy(2, [61, 47], 30.0, 60.0);
    check("1.8 km", &small, 4, &eyes(&small, 20_000.0));
    let tiny = noisy(3, [9, 8], 25.0, 40.0);
    let worst = check("200 m", &tiny, 64, &eyes(&tiny, 20_000.0));
    assert!(worst.farthest_metres > 19_900.0, "{} m", worst.farthest_metres);
}

#[test]
fn vertices_agree_with_f64_when_exaggerated_and_around_voids() {
    let samples = [61, 47];
    let mut heights: Vec<f32> = noise(4, samples, 30.0, 60.0).iter().map(|h| h * 5.0).collect();
    let whole = surface(samples[0], 30.0, heights.clone());
    let cameras = eyes(&whole, 8000.0);
    check("exaggeration 5", &whole, 4, &cameras);
    for i in (40..heights.len()).step_by(97) {
        heights[i] = f32::NAN;
    }
    let holed = surface(samples[0], 30.0, heights);
    for n in [1, 8] {
        check("voids", &holed, n, &cameras);
    }
}

#[test]
fn comparison_of_vertices_can_fail() {
    let scene = noisy(5, [21, 21], 50.0, 60.0);
    let camera = &eyes(&scene, 3000.0)[4];
    let mut shot = Planned::by_id(gpu(), &scene, 2).shoot(camera);
    let seen = |s: &[i32; 4]| s[3] == 0 && s[2] != 0;
    let v = shot.screens.iter().position(seen).expect("a vertex on the page");
    shot.screens[v][0] += 6; // 6/256 px
    assert!(compare(&scene, camera, &shot).px > VERTEX_PX);
    shot.screens[v][0] -= 6;
    shot.screens[v][2] += 32; // 2^-19 or more of an f32
    assert!(compare(&scene, camera, &shot).depth > VERTEX_DEPTH);
    shot.screens[v][2] -= 32;
    shot.screens[v][3] |= BESIDE;
    assert_eq!(compare(&scene, camera, &shot).wrong_flags, 1);
    shot.screens[v][3] = 0;
    let beside = Camera { eye: camera.eye + DVec3::X * 0.5, ..*camera };
    assert!(compare(&scene, &beside, &shot).px > VERTEX_PX, "half a metre must show");
    assert_eq!(compare(&scene, camera, &shot).wrong_flags, 0);
}
