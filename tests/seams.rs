//! Frames of several levels: chunks have the same vertices on the sides they share, no pixel of the surface is missed,
//! the device's own rasterizer covers the same pixels.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;
use hachure::door::plan::batches;
use hachure::door::surface::lattice::{CHUNK_QUADS, CHUNK_SIDE, CHUNK_VERTICES};
use hachure::door::surface::{Chunk, LatticePoint};
use hachure::plan::{Border, Culling, Detail, Plan};
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::common::gpu;
use crate::coverage;
use crate::frames::{BY_ID, CLIPPED, Planned, Shot};
use crate::mesh::{facets, pinholes};
use crate::mixed::variety;
use crate::quadtrees::moor;
use crate::scenes::{Random, aimed, over, rough};

const PAGE: [u32; 2] = [360, 240];

fn renderer(surface: &Arc<Surface>, error_px: f64, culling: Culling) -> Planned {
    let plan = Plan { culling, ..Plan::new(Detail::Adaptive { error_px }, BY_ID, Border::Off) };
    Planned::new(gpu(), surface, plan)
}

fn scenes() -> Vec<Arc<Surface>> {
    let dems =
        [rough(90, 75, 1.0, 0.5, false), rough(60, 50, 2.0, 2.0, true), rough(200, 97, 0.1, 0.02, false), moor()];
    dems.map(|dem| Arc::new(Surface::new(dem))).into()
}

/// Eyes near the ground, in it, above it and far away.
fn eyes(surface: &Surface, random: &mut Random, size: [u32; 2]) -> Vec<Camera> {
    let dem = surface.dem();
    let cell = dem.cell().x;
    let mut near = |above: f64| {
        let place = std::iter::repeat_with(|| {
            let [c, r] = [dem.columns(), dem.rows()].map(|n| random.between(0.2, n as f64 - 1.2));
            LatticePoint { x: (c * 64.0) as u32, y: (r * 64.0) as u32 }
        });
        let at = place.into_iter().find(|at| surface.position(*at).is_some()).expect("land");
        let eye = over(surface, f64::from(at.x) / 64.0, f64::from(at.y) / 64.0, above * cell);
        aimed(eye, random.between(0.0, 360.0), random.between(-50.0, 15.0), size)
    };
    let mut cameras: Vec<_> = [8.0, 2.0, 0.5, 0.05, -0.02].into_iter().map(&mut near).collect();
    let [west, south, east, north] = dem.extent();
    let azimuth = random.between(0.0, 360.0);
    let (sin, cos) = azimuth.to_radians().sin_cos();
    let middle = DVec3::new(west + east, south + north, 0.0) / 2.0;
    cameras.push(aimed(middle + DVec3::new(-sin, -cos, 0.4) * (east - west), azimuth, -22.0, size));
    cameras
}

/// How many vertices that chunks share were compared; how many of them differ between two chunks.
fn unlike(chunks: &[Chunk], screens: &[[i32; 4]]) -> [usize; 2] {
    let mut first: HashMap<LatticePoint, [i32; 4]> = HashMap::new();
    let (mut compared, mut unlike) = (0, 0);
    for (chunk, screens) in chunks.iter().zip(screens.chunks_exact(CHUNK_VERTICES as usize)) {
        // Left out: nothing was written.
        if screens.iter().all(|screen| *screen == [0; 4]) {
            continue;
        }
        for (v, screen) in (0..).zip(screens) {
            let at = [v % CHUNK_SIDE, v / CHUNK_SIDE];
            if at.iter().all(|k| (1..CHUNK_QUADS).contains(k)) {
                continue;
            }
            if let Some(other) = first.insert(chunk.vertex(at), *screen) {
                compared += 1;
                unlike += usize::from(other != *screen);
            }
        }
    }
    [compared, unlike]
}

#[test]
fn a_vertex_unlike_its_neighbours_is_noticed() {
    let surface = &scenes()[0];
    let camera = eyes(surface, &mut Random::new(5), PAGE)[0];
    let mut shot: Shot = renderer(surface, 1.0, Culling::Off).shoot(&camera);
    let chunks = shot.lattice.chunks();
    assert_eq!(unlike(chunks, &shot.screens)[1], 0);
    let slot = chunks.iter().position(|chunk| chunk.coarser != 0).expect("a seam");
    let bits = chunks[slot].coarser;
    let (half, end) = (CHUNK_QUADS / 2, CHUNK_QUADS);
    let at =
        [half, half * CHUNK_SIDE + end, end * CHUNK_SIDE + half, half * CHUNK_SIDE][bits.trailing_zeros() as usize];
    shot.screens[slot * CHUNK_VERTICES as usize + at as usize][0] ^= 1;
    assert!(unlike(shot.lattice.chunks(), &shot.screens)[1] > 0);
}

#[test]
fn frames_of_several_levels_have_one_vertex_a_place_and_no_pinhole() {
    let (mut covered, mut uncovered, mut seams, mut clipped, mut compared) = (0, 0, 0, 0, 0);
    for (seed, surface) in (1..).zip(scenes()) {
        let mut random = Random::new(seed + 50);
        for error_px in [0.6, 8.0] {
            let mut renderer = renderer(&surface, error_px, Culling::On);
            for camera in eyes(&surface, &mut random, PAGE) {
                let shot = renderer.shoot(&camera);
                let what = format!("scene {seed}, {error_px} px, {camera:?}");
                let [shared, wrong] = unlike(shot.lattice.chunks(), &shot.screens);
                assert_eq!(wrong, 0, "{what}: of {shared} shared vertices");
                let mesh = facets(&surface, &shot.lattice);
                let depths: Vec<u32> = shot.pixels.iter().map(|p| p[1]).collect();
                let (holes, none) = pinholes(&mesh, &camera, renderer.near(), &depths);
                assert!(holes.is_empty(), "{what}: {} pinholes, {:?}", holes.len(), holes[0]);
                covered += depths.len() - none;
                uncovered += none;
                compared += shared;
                seams += variety(&shot.lattice)[1];
                clipped += shot.screens.iter().filter(|s| s[3] & CLIPPED != 0).count();
            }
        }
    }
    println!("{covered} px covered, {uncovered} not; {seams} seams; {compared} vertices compared, {clipped} clipped");
    assert!(covered > 500_000 && uncovered > 50_000 && seams > 400 && clipped > 1000 && compared > 50_000);
}

#[test]
fn the_last_of_several_batches_has_one_vertex_a_place() {
    let surface = Arc::new(Surface::new(rough(90, 75, 1.0, 0.5, false)));
    // Of chunks that are left out the buffer would keep what earlier batches have written.
    let mut renderer = renderer(&surface, 0.0005, Culling::Off);
    let (mut compared, mut seams) = (0, 0);
    let cameras = [7, 8, 9].map(|seed| eyes(&surface, &mut Random::new(seed), PAGE)).concat();
    for camera in cameras {
        let lattice = renderer.frame(&camera).expect("a frame").lattice;
        let all = batches(lattice.chunks().len() as u32);
        let Some(last) = all.last().filter(|_| all.len() > 1) else { continue };
        let chunks = &lattice.chunks()[last.first_slot as usize..];
        // Its vertices have taken the place of those of the batches before it.
        let screens = renderer.values("screens", chunks.len() * CHUNK_VERTICES as usize);
        let [shared, wrong] = unlike(chunks, &screens);
        assert_eq!(wrong, 0, "{camera:?}: of {shared} shared vertices of {} chunks", chunks.len());
        compared += shared;
        seams += chunks.iter().filter(|chunk| chunk.coarser != 0).count();
    }
    println!("{compared} vertices of last batches compared, {seams} chunks with seams");
    assert!(compared > 10_000 && seams > 100, "{compared} vertices, {seams} seams");
}

#[test]
fn coverage_of_several_levels_is_the_hardwares() {
    let mut seams = 0;
    for (seed, surface) in (1..).zip(scenes()) {
        for (azimuth, altitude, error_px) in [(20.0, -35.0, 1.0), (140.0, -8.0, 2.0)] {
            let size = [1024, 512];
            let camera = coverage::from_outside(&surface, azimuth, altitude, 1.1, size);
            let shot = renderer(&surface, error_px, Culling::On).shoot(&camera);
            coverage::check_shot(&format!("scene {seed}, {error_px} px"), &shot, size);
            seams += variety(&shot.lattice)[1];
        }
    }
    assert!(seams > 20, "{seams} seams");
}
