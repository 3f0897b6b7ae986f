//! A spire one or two pixels wide against the sky: the walk inks all of its skyline, and the cut that finds it goes from
//! facet to facet as the lattice has them.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::door::gpu::shaders;
use hachure::door::gpu::uniforms::SceneUniform;
use hachure::door::plan::PassName;
use hachure::door::surface::LatticePoint;
use hachure::door::surface::lattice::CHUNK_FACETS;
use hachure::line::Kind as LineKind;
use hachure::plan::{Border, Detail, Method, Plan, Visibility};
use hachure::surface::Surface;
use hachure::truth::{Terrain, Truth};
use hachure::view::Camera;

use crate::frames::Planned;
use crate::judged::{Score, mask, score};
use crate::kernels::{chunk_uniforms, run};
use crate::mixed::{Kind, exists, flat, lattice, variety};
use crate::scenes::{ORIGIN, Random, gpu, hashed, level, look, rough, surface};
use crate::tolerances::SPIRE;

/// What a kernel says where there is no facet.
const NO_FACET: u32 = u32::MAX;

/// Samples across and down.
const SIDE: usize = 65;

/// A spire on one sample of gently rough land, and whence it is looked at.
struct Spire {
    /// Metres between samples.
    cell: f64,
    /// Metres.
    height: f64,
    /// Cells from it to the eye.
    away: f64,
    /// Eye and what is looked at, metres above the land.
    above: [f64; 2],
    fov: f64,
    page: [u32; 2],
}

/// Seen from there each is one to two pixels wide, against the sky: the tip, which is thinner, lies above the page, the foot, before
/// land, below it.
const SPIRES: [Spire; 3] = [
    Spire { cell: 30.0, height: 10_000.0, away: 167.0, above: [1500.0, 2900.0], fov: 60.0, page: [256, 216] },
    Spire { cell: 30.0, height: 2000.0, away: 150.0, above: [300.0, 700.0], fov: 40.0, page: [160, 40] },
    Spire { cell: 1.0, height: 50.0, away: 150.0, above: [8.0, 20.0], fov: 40.0, page: [160, 40] },
];

impl Spire {
    /// With a ring of voids about it, or none.
    fn surface(&self, voids: bool) -> Arc<Surface> {
        let height = |i: usize| {
            let (x, y) = ((i % SIDE) as f64, (i / SIDE) as f64);
            if voids && (9.0..10.0).contains(&DVec2::new(x - 32.0, y - 32.0).abs().max_element()) {
                return f32::NAN;
            }
            let land = 0.2 * (x / 7.0).sin() * (y / 5.0).cos() + 0.02 * hashed(i as u64);
            let spire = if [x, y] == [32.0, 32.0] { self.height } else { 0.0 };
            (land * self.cell + spire) as f32
        };
        surface(SIDE, self.cell, (0..SIDE * SIDE).map(height).collect())
    }

    /// The view from where a way leads from the spire.
    fn camera(&self, way: DVec2) -> Camera {
        let foot = (ORIGIN + DVec2::new(32.0, -32.0) * self.cell).extend(0.0);
        let eye = foot + (way * self.away * self.cell).extend(self.above[0]);
        look(eye, foot + DVec3::Z * self.above[1], self.fov, self.page)
    }

    fn score(&self, surface: &Arc<Surface>, camera: &Camera, detail: Detail, truth: &Truth) -> Score {
        let mut renderer = Planned::new(gpu(), surface, Plan::new(detail, Method::Walk, Border::On));
        score(&mask(&renderer.draw(camera).expect("a frame").raster, renderer.near()), truth)
    }
}

#[test]
fn a_spire_as_thin_as_a_pixel_has_its_skyline() {
    for (spire, voids) in SPIRES.iter().flat_map(|spire| [(spire, false), (spire, true)]) {
        let surface = spire.surface(voids);
        for way in [DVec2::new(0.0, -1.0), DVec2::new(1.0, 0.0), DVec2::new(-0.8, -0.6)] {
            let camera = spire.camera(way);
            let truth = Terrain::new(&surface).truth(&camera, level(16));
            for detail in [level(4).into(), level(8).into(), Detail::default()] {
                let found = spire.score(&surface, &camera, detail, &truth);
                println!("{} m on {} m, voids {voids}, from {way}, {detail:?}: {found:?}", spire.height, spire.cell);
                assert!(
                    found.precision >= SPIRE && found.recall >= SPIRE,
                    "{} m, voids {voids}, from {way}, {detail:?}: {found:?}",
                    spire.height
                );
            }
        }
    }
}

#[test]
fn an_underside_before_the_land_is_no_silhouette() {
    let surface = Arc::new(Surface::new(rough(60, 50, 2.0, 4.0, true)));
    let [west, south, east, north] = surface.dem().extent();
    let middle = DVec3::new((west + east) / 2.0, (south + north) / 2.0, 0.0);
    let camera = look(middle + DVec3::new(-700.0, -900.0, 250.0), middle, 60.0, [2048, 1250]);
    let mut renderer = Planned::new(gpu(), &surface, Plan::new(level(1), Method::Walk, Border::Off));
    let raster = renderer.draw(&camera).expect("a frame").raster;
    // Through a void or past the border, an away facet is seen below each, before the toward one that it shares an edge with.
    for [column, row] in [[1240, 522], [1242, 524], [1537, 540], [1660, 785]] {
        assert_eq!(raster.at(column, row).map(|pixel| pixel.kind()), Some(LineKind::Cover), "{column}, {row}");
    }
}

/// Lattices of many levels, the last two with chunks left out.
const KINDS: [(Kind, u32); 4] = [
    (Kind { cells: [30, 25], steps: [64, 8], rarity: 3, voids: 0 }, 0),
    (Kind { cells: [16, 14], steps: [32, 4], rarity: 3, voids: 200 }, 0),
    (Kind { cells: [150, 140], steps: [256, 32], rarity: 4, voids: 0 }, 5),
    (Kind { cells: [300, 200], steps: [1024, 64], rarity: 3, voids: 2 }, 9),
];

#[test]
fn beyond_each_edge_lies_the_facet_that_shares_it() {
    let section = concat!(hachure::shader!("section"), include_str!("kernels/beyond_probe.wgsl"));
    let source = [&shaders::source(PassName::Walk, Visibility::Key64, false), section].concat();
    for (seed, (kind, dropped)) in (1..).zip(KINDS) {
        let mut random = Random::new(seed * 6007);
        let dem = flat(kind, &mut random);
        let lattice = lattice(&dem, kind, dropped, &mut random);
        let is_facet = |[a, b, c]: [LatticePoint; 3]| a != b && b != c && c != a && exists(&dem, [a, b, c]);
        let ids = (0..lattice.chunks().len() as u32 * CHUNK_FACETS).filter(|id| is_facet(lattice.facet(*id)));
        let edges: Vec<[u32; 2]> = ids.flat_map(|id| [0, 1, 2].map(|k| [id, k])).collect();
        let ends = |[id, k]: [u32; 2]| [0, 1].map(|i| lattice.facet(id)[(k as usize + i) % 3]);
        let owner: HashMap<_, _> = edges.iter().map(|edge| (ends(*edge), edge[0])).collect();
        let scene = SceneUniform::new(&dem, &lattice);
        let chunks = chunk_uniforms(&lattice);
        let data: [(&str, &[u8]); 5] = [
            ("scene", bytemuck::bytes_of(&scene)),
            ("chunks", bytemuck::cast_slice(&chunks)),
            ("nodes", bytemuck::cast_slice(lattice.tree().nodes())),
            ("valid", bytemuck::cast_slice(dem.validity().expect("in memory").words())),
            ("edges", bytemuck::cast_slice(&edges)),
        ];
        let constants = [("has_voids", f64::from(u8::from(dem.voids() > 0)))];
        let found = run("beyond_probe", &source, &constants, &data, edges.len() as u32);
        let mut rim = 0;
        for (edge, found) in edges.iter().zip(found.chunks_exact(4)) {
            let [from, to] = ends(*edge);
            let expected = owner.get(&[to, from]).copied().unwrap_or(NO_FACET);
            assert_eq!(found[0], expected, "seed {seed}, {kind:?}: beyond edge {edge:?}, from {from:?} to {to:?}");
            rim += usize::from(expected == NO_FACET);
        }
        let [levels, seams] = variety(&lattice);
        println!("seed {seed}: {} edges, {rim} of them rim, {levels} levels, {seams} seams", edges.len());
        assert!(levels > 1 && seams > 10 && rim > 100, "a dull lattice");
    }
}
