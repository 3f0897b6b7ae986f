//! Our rasterizer against the device's own over the same snapped triangles: the same pixels covered, and the same
//! facets but for ties; and our three kinds of raster against each other, to the bit.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::door::surface::lattice::{CHUNK_FACETS, CHUNK_SIDE, CHUNK_VERTICES};
use hachure::geo::read;
use hachure::plan::{Border, Method, Plan};
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::common::{gpu, shared_dems};
use crate::frames::{BESIDE, CLIPPED, MISSING, Planned, Shot};
use crate::hardware::{Vertex, draw};
use crate::scenes::{aimed, gpu_without_int64, level, noise, noisy, over, surface};
use crate::tolerances::raster::{HARDWARE_DEPTH, HARDWARE_IDS};

/// How two rasters differ.
#[derive(Debug, Default, Clone, Copy, PartialEq)]
struct Difference {
    covered: usize,
    coverage: usize,
    ids: usize,
    /// Largest relative difference of the depths where the facet differs.
    depth: f64,
}

fn compare(ours: &[[u32; 2]], theirs: &[[u32; 2]]) -> Difference {
    assert_eq!(ours.len(), theirs.len());
    let mut found = Difference::default();
    for ([id, depth], [their_id, their_depth]) in ours.iter().zip(theirs) {
        found.covered += usize::from(*depth != 0);
        if (*depth != 0) != (*their_id != 0) {
            found.coverage += 1;
        } else if id != their_id {
            let [near, far] = [depth, their_depth].map(|bits| f64::from(f32::from_bits(*bits)));
            found.ids += 1;
            found.depth = found.depth.max((near / far - 1.0).abs());
        }
    }
    found
}

/// The triangles of a frame in the order of their IDs. Of those in view none may be clipped, by us or by the device.
fn triangles(shot: &Shot, size: [u32; 2]) -> Vec<[Vertex; 3]> {
    let mut found = Vec::new();
    for id in 0..shot.lattice.chunks().len() as u32 * CHUNK_FACETS {
        let slot = id / CHUNK_FACETS;
        let chunk = shot.lattice.chunks()[slot as usize];
        let corners = shot.lattice.facet(id).map(|at| {
            let [x, y] = [at.x - chunk.origin[0], at.y - chunk.origin[1]].map(|d| d / chunk.step);
            shot.screens[(slot * CHUNK_VERTICES + y * CHUNK_SIDE + x) as usize]
        });
        let [a, b, c] = corners.map(|v| v[3]);
        let left_out = corners.contains(&[0; 4]);
        if left_out || (a | b | c) & MISSING != 0 || a & b & c & BESIDE != 0 {
            continue;
        }
        assert_eq!((a | b | c) & CLIPPED, 0, "facet {id} is clipped");
        for (axis, sides) in size.iter().enumerate() {
            let reach = *sides as i32 * 256;
            let within = corners.iter().all(|v| v[axis] > -reach / 2 && v[axis] < reach * 3 / 2);
            assert!(within, "facet {id} leaves the device's guard band: {corners:?}");
        }
        found.push(corners.map(|[x, y, depth, _]| [x, y, depth, id as i32]));
    }
    found
}

fn check(name: &str, surface: &Arc<Surface>, n: u32, camera: &Camera) -> Vec<[Vertex; 3]> {
    let shot = Planned::by_id(gpu(), surface, n).shoot(camera);
    check_shot(&format!("{name}, level {n}"), &shot, [camera.width, camera.height])
}

/// Compares a frame with the device's own; returns its triangles.
pub fn check_shot(name: &str, shot: &Shot, size: [u32; 2]) -> Vec<[Vertex; 3]> {
    let triangles = triangles(shot, size);
    let found = compare(&shot.pixels, &draw(gpu(), &triangles, size));
    println!("{name}, {} triangles: {found:?}", triangles.len());
    assert!(found.covered > 1000, "{name}: {found:?}");
    assert_eq!(found.coverage, 0, "{name}: {found:?}");
    assert!(found.ids as f64 <= HARDWARE_IDS * found.covered as f64, "{name}: {found:?}");
    assert!(found.depth <= HARDWARE_DEPTH, "{name}: {found:?}");
    triangles
}

/// From outside, looking at the middle, the whole DEM on the page or nearly.
pub fn from_outside(surface: &Surface, azimuth: f64, altitude: f64, away: f64, size: [u32; 2]) -> Camera {
    let dem = surface.dem();
    let [west, south, east, north] = dem.extent();
    let [low, high] = dem.range().expect("heights").map(f64::from);
    let middle = DVec3::new(west + east, south + north, low + high) / 2.0;
    let camera = aimed(middle, azimuth, altitude, size);
    Camera { eye: middle - camera.axes()[2] * away * (east - west), ..camera }
}

#[test]
fn coverage_is_the_hardwares_on_random_terrain() {
    for (seed, azimuth) in [(11, 20.0), (12, 140.0), (13, 275.0)] {
        let scene = noisy(seed, [40, 37], 50.0, 80.0);
        for n in [1, 2, 4] {
            for (altitude, away) in [(-35.0, 1.1), (-4.0, 1.3), (-90.0, 1.2)] {
                check("random", &scene, n, &from_outside(&scene, azimuth, altitude, away, [1024, 512]));
            }
        }
    }
}

/// Whether a triangle's box is too large for one invocation.
fn is_large(triangle: &&[Vertex; 3]) -> bool {
    (0..2).any(|axis| {
        let [a, b, c] = triangle.map(|v| v[axis]);
        a.max(b).max(c) - a.min(b).min(c) > 126 * 256
    })
}

#[test]
fn coverage_is_the_hardwares_where_facets_are_large() {
    let mut large = 0;
    for (seed, azimuth) in [(21, 20.0), (22, 140.0), (23, 275.0)] {
        let scene = noisy(seed, [4, 4], 50.0, 80.0);
        for n in [1, 2] {
            for altitude in [-60.0, -20.0, -90.0] {
                let drawn = check("large", &scene, n, &from_outside(&scene, azimuth, altitude, 1.6, [1024, 1024]));
                large += drawn.iter().filter(is_large).count();
            }
        }
    }
    assert!(large > 100, "{large} large facets");
}

#[test]
fn coverage_is_the_hardwares_where_thousands_of_facets_are_large() {
    // Noise of 60 cells' height, from the side: every facet is a spike of hundreds of pixels.
    let scene = noisy(31, [101, 101], 10.0, 600.0);
    let drawn = check("spikes", &scene, 1, &from_outside(&scene, 30.0, 0.0, 1.8, [1024, 1024]));
    let large = drawn.iter().filter(is_large).count();
    assert!(large > 10_000, "{large} large facets");
}

#[test]
fn coverage_is_the_hardwares_where_edges_meet_pixel_centres() {
    // A plain from straight above: 512 px per unit of tangent from 512 m make a metre a pixel, and half a metre aside
    // puts every sample on a pixel's centre: the top-left rule decides along every edge.
    for cell in [8.0, 50.0, 150.0] {
        let samples = 1 + (900.0 / cell) as usize;
        let dem = Dem::from_heights(samples, DVec2::splat(cell), DVec2::ZERO, vec![0.0; samples * samples]);
        let [_, south, east, _] = dem.extent();
        let eye = DVec3::new((east / 2.0 / cell).floor() * cell - 0.5, (south / 2.0 / cell).ceil() * cell + 0.5, 512.0);
        let camera = Camera { eye, azimuth: 0.0, altitude: -90.0, fov: 90.0, width: 1024, height: 1024 };
        let scene = Arc::new(Surface::new(dem));
        for n in [1, 2] {
            let drawn = check("plain", &scene, n, &camera);
            assert!(drawn.iter().flatten().all(|v| v[0] % 128 == 0 && v[1] % 128 == 0), "a place between centres");
        }
    }
}

#[test]
fn coverage_is_the_hardwares_on_west_temple() {
    let Some(folder) = shared_dems() else { return };
    let dem = read(folder.join("west_temple_50m.tif"), &Default::default()).expect("west-temple");
    let scene = Arc::new(Surface::new(dem));
    for n in [1, 2, 4] {
        for (azimuth, altitude) in [(310.0, -10.0), (75.0, -30.0)] {
            check("west-temple", &scene, n, &from_outside(&scene, azimuth, altitude, 1.0, [1024, 512]));
        }
    }
}

#[test]
fn rasters_of_every_kind_agree_to_the_bit() {
    assert!(!gpu_without_int64().int64);
    let mut heights = noise(41, [24, 21], 50.0, 80.0);
    heights[250] = f32::NAN;
    let scene = surface(24, 50.0, heights);
    let size = [401, 300];
    for n in [1, 8] {
        let mut by_id = Planned::by_id(gpu(), &scene, n);
        let mut without_int64 = Planned::by_id(gpu_without_int64(), &scene, n);
        let plan = Plan::new(level(n), Method::TowardAway { wide: false }, Border::Off);
        let mut two_depths = Planned::new(gpu(), &scene, plan);
        let outside = from_outside(&scene, 33.0, -25.0, 1.1, size);
        for camera in [outside, aimed(over(&scene, 5.0, 6.0, 1.0), 120.0, -5.0, size)] {
            let shot = by_id.shoot(&camera).pixels;
            assert!(shot.iter().filter(|p| p[1] != 0).count() > 1000);
            assert!(shot == without_int64.shoot(&camera).pixels, "level {n}, u32 against u64");
            let depths = two_depths.shoot(&camera).pixels;
            let nearest = depths.iter().zip(&shot).filter(|(two, one)| two[0].max(two[1]) != one[1]).count();
            assert_eq!(nearest, 0, "level {n}, two depths against u64");
        }
    }
}

#[test]
fn comparison_with_the_hardware_can_fail() {
    let scene = noisy(51, [20, 20], 50.0, 80.0);
    let size = [512, 512];
    let camera = from_outside(&scene, 20.0, -35.0, 1.2, size);
    let shot = Planned::by_id(gpu(), &scene, 2).shoot(&camera);
    let whole = triangles(&shot, size);
    let differ = |drawn: &[[Vertex; 3]]| compare(&shot.pixels, &draw(gpu(), drawn, size));
    assert_eq!(differ(&whole).coverage, 0);
    // One vertex a pixel aside, in every facet that has it: the rim moves.
    let mut moved = whole.clone();
    let leftmost = *whole.iter().flatten().min_by_key(|v| v[0]).expect("a vertex");
    let same = |v: &&mut Vertex| v[..3] == leftmost[..3];
    moved.iter_mut().flatten().filter(same).for_each(|v| v[0] -= 1024);
    assert!(differ(&moved).coverage > 0, "{:?}", differ(&moved));
    // Every vertex 1/256 px aside.
    let mut shifted = whole.clone();
    shifted.iter_mut().flatten().for_each(|v| v[0] += 1);
    let found = differ(&shifted);
    assert!(found.coverage + found.ids > 0, "{found:?}");
    // Two facets with each other's ID.
    let mut swapped = whole.clone();
    swapped.iter_mut().flatten().for_each(|v| v[3] ^= 1);
    assert!(differ(&swapped).ids > found.covered / 2);
    // Every other facet nearer than it is: hidden ones show.
    let mut nearer = whole;
    nearer.iter_mut().flatten().filter(|v| v[3] % 2 == 1).for_each(|v| v[2] += 1 << 22);
    assert!(differ(&nearer).depth > HARDWARE_DEPTH, "{:?}", differ(&nearer));
}
