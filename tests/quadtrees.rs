//! Lattices of several levels against slow looks at every leaf and facet: squares tile the DEM, neighbours differ by one
//! level at most, facets make one mesh without T-junctions whose rim is that of the land.

use std::collections::HashMap;

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::door::plan::detail;
use hachure::door::surface::lattice::{CELL_STEPS, CHUNK_FACETS, CHUNK_QUADS};
use hachure::door::surface::quadtree::NO_SLOT;
use hachure::door::surface::{Lattice, LatticePoint};
use hachure::plan::{Culling, Curves};
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::mixed::{Kind, exists, flat, has_void, lattice, leaves, may_be_coarse, sides, variety};
use crate::scenes::{Random, rough};

/// Whether a square begins on the land's rectangle.
fn starts_on(dem: &Dem, [x, y]: [u32; 2]) -> bool {
    x < (dem.columns() as u32 - 1) * CELL_STEPS && y < (dem.rows() as u32 - 1) * CELL_STEPS
}

/// What is wrong with a lattice's squares, none of it dropped but voids.
fn wrong_squares(dem: &Dem, lattice: &Lattice) -> Option<String> {
    let squares = leaves(lattice);
    let tree = lattice.tree();
    let whole = tree.roots().map(|n| u64::from(n) * u64::from(tree.root_size()));
    let area: u64 = squares.iter().map(|(_, size, _)| u64::from(*size).pow(2)).sum();
    if area != whole[0] * whole[1] {
        return Some(format!("squares cover {area} of {whole:?}"));
    }
    let holds = |at: [i64; 2]| {
        let inside = |([x, y], size, _): &&([u32; 2], u32, u32)| {
            let size = i64::from(*size);
            (i64::from(*x)..i64::from(*x) + size).contains(&at[0])
                && (i64::from(*y)..i64::from(*y) + size).contains(&at[1])
        };
        squares.iter().find(inside)
    };
    // Of chunks that may appear, and of the others behind them.
    let mut slots = [0, lattice.seen()];
    for &(corner, size, slot) in &squares {
        let [x, y] = corner.map(i64::from);
        let s = i64::from(size);
        for at in [
            [x - 1, y - 1],
            [x + s, y - 1],
            [x - 1, y + s],
            [x + s, y + s],
            [x, y - 1],
            [x + s, y],
            [x, y + s],
            [x - 1, y],
        ] {
            if let Some((_, other, _)) = holds(at).filter(|(_, other, _)| *other > 2 * size) {
                return Some(format!("{corner:?} of size {size} touches one of size {other} at {at:?}"));
            }
        }
        if slot == NO_SLOT {
            continue;
        }
        let role = usize::from(slot >= lattice.seen());
        if slot != slots[role] {
            return Some(format!("slot {slot} follows {slots:?} slots"));
        }
        slots[role] += 1;
        let chunk = lattice.chunks()[slot as usize];
        let step = size / CHUNK_QUADS;
        if chunk.origin != corner || chunk.step != step {
            return Some(format!("{chunk:?} lies at {corner:?}, size {size}"));
        }
        let coarser = sides((corner, size), |at| {
            holds(at).is_some_and(|(corner, other, _)| *other > size && starts_on(dem, *corner))
        });
        if chunk.coarser != coarser {
            return Some(format!("{chunk:?} has coarser sides {coarser:b}"));
        }
        if step == CELL_STEPS && coarser != 0 && has_void(dem, corner, step) {
            return Some(format!("{chunk:?} with a void lies beside a coarser one"));
        }
        if step > CELL_STEPS && !may_be_coarse(dem, corner, step) {
            return Some(format!("{chunk:?} has a void, or an edge of the DEM between its vertices"));
        }
    }
    (slots != [lattice.seen(), lattice.chunks().len() as u32]).then(|| format!("{slots:?} slots"))
}

/// The facets that exist, by their vertices.
fn facets(dem: &Dem, lattice: &Lattice) -> Vec<[LatticePoint; 3]> {
    let all = (0..lattice.chunks().len() as u32 * CHUNK_FACETS).map(|id| lattice.facet(id));
    all.filter(|[a, b, c]| a != b && b != c && c != a && exists(dem, [*a, *b, *c])).collect()
}

/// Whether no patch, or only one, has a piece of a lattice line between two places.
pub fn on_rim(dem: &Dem, a: LatticePoint, b: LatticePoint) -> bool {
    // A little to either side of the middle, in thirds of a lattice unit.
    let middle = [a.x + b.x, a.y + b.y].map(|v| i64::from(v) * 3);
    let across = [i64::from(b.y) - i64::from(a.y), i64::from(a.x) - i64::from(b.x)].map(i64::signum);
    let lies = |sign: i64| {
        let at = [0, 1].map(|i| middle[i] + sign * across[i]);
        let cell = 6 * i64::from(CELL_STEPS);
        let [c, r] = at.map(|v| v.div_euclid(cell));
        let inside = c >= 0 && r >= 0 && c + 1 < dem.columns() as i64 && r + 1 < dem.rows() as i64;
        let third = if at[0].rem_euclid(cell) > at[1].rem_euclid(cell) { (c + 1, r) } else { (c, r + 1) };
        inside && [(c, r), (c + 1, r + 1), third].iter().all(|(c, r)| dem.height(*c as usize, *r as usize).is_some())
    };
    lies(1) != lies(-1)
}

/// What is wrong with a mesh of facets over all the land.
fn wrong_mesh(dem: &Dem, facets: &[[LatticePoint; 3]]) -> Option<String> {
    let mut edges: HashMap<[LatticePoint; 2], [u32; 2]> = HashMap::new();
    let mut area = 0_i64;
    for corners in facets {
        let [a, b, c] = corners.map(|v| [i64::from(v.x), i64::from(v.y)]);
        let twice = (c[0] - a[0]) * (b[1] - a[1]) - (b[0] - a[0]) * (c[1] - a[1]);
        if twice <= 0 {
            return Some(format!("{corners:?} is not counter-clockwise"));
        }
        area += twice;
        for k in 0..3 {
            let (p, q) = (corners[k], corners[(k + 1) % 3]);
            edges.entry(if p < q { [p, q] } else { [q, p] }).or_default()[usize::from(p < q)] += 1;
        }
    }
    for ([a, b], ways) in &edges {
        let rim = ways[0] + ways[1] == 1;
        if ways.iter().any(|n| *n > 1) || rim != on_rim(dem, *a, *b) {
            return Some(format!("edge {a:?} {b:?} has {ways:?} facets"));
        }
    }
    let patches = hachure::surface::Surface::new(dem.clone()).patches() as i64;
    (area != patches * i64::from(CELL_STEPS).pow(2)).then(|| format!("{area} units for {patches} patches"))
}

const KINDS: [Kind; 7] = [
    Kind { cells: [70, 61], steps: [64, 8], rarity: 3, voids: 0 },
    Kind { cells: [70, 61], steps: [64, 8], rarity: 3, voids: 20 },
    Kind { cells: [20, 17], steps: [32, 2], rarity: 3, voids: 100 },
    Kind { cells: [256, 512], steps: [512, 32], rarity: 4, voids: 0 },
    Kind { cells: [300, 277], steps: [256, 32], rarity: 4, voids: 0 },
    Kind { cells: [600, 400], steps: [1024, 64], rarity: 3, voids: 2 },
    Kind { cells: [5, 3], steps: [16, 1], rarity: 4, voids: 400 },
];

fn check(dem: &Dem, lattice: &Lattice, what: &str) {
    let wrong = wrong_squares(dem, lattice);
    assert!(wrong.is_none(), "{what}: {wrong:?}");
    let facets = facets(dem, lattice);
    let wrong = wrong_mesh(dem, &facets);
    assert!(wrong.is_none(), "{what}: {wrong:?}");
    assert_eq!(lattice.facets(dem), facets.len() as u64, "{what}");
}

#[test]
fn random_lattices_are_conforming_meshes_of_the_land() {
    let mut seams = 0;
    for seed in 1..=21 {
        let kind = KINDS[seed as usize % KINDS.len()];
        let mut random = Random::new(seed * 104_729);
        let dem = flat(kind, &mut random);
        let lattice = lattice(&dem, kind, 0, &mut random);
        check(&dem, &lattice, &format!("seed {seed}, {kind:?}"));
        seams += variety(&lattice)[1];
    }
    assert!(seams > 1000, "{seams} seams");
}

/// A camera anywhere over a DEM.
pub fn above(surface: &Surface, random: &mut Random) -> Camera {
    let [west, south, east, north] = surface.dem().extent();
    let [low, high] = surface.dem().range().expect("land").map(f64::from);
    let eye =
        DVec3::new(random.between(west, east), random.between(south, north), random.between(low, 2.0 * high - low));
    let azimuth = random.between(0.0, 360.0);
    Camera {
        eye,
        azimuth,
        altitude: random.between(-40.0, 10.0),
        fov: random.between(10.0, 90.0),
        width: 320,
        height: 240,
    }
}

/// Wide gentle land with a few voids: coarse chunks next to chunks with voids.
pub fn moor() -> Dem {
    let mut random = Random::new(8);
    let height = |i: usize| ((i % 331) as f32 / 20.0).sin() * ((i / 331) as f32 / 27.0).cos() * 9.0;
    let mut height = |i| if random.below(14_000) == 0 { f32::NAN } else { height(i) };
    let heights = (0..331 * 290).map(&mut height).collect();
    Dem::from_heights(331, DVec2::splat(20.0), DVec2::new(325_000.0, 4_118_000.0), heights)
}

#[test]
fn lattices_of_frames_are_conforming_meshes_of_the_land() {
    let mut levels = [0; 2];
    let mut random = Random::new(11);
    let scenes =
        [rough(150, 140, 1.0, 5.0, false), rough(60, 50, 2.0, 2.0, true), rough(258, 97, 0.1, 0.2, false), moor()];
    for (i, dem) in scenes.into_iter().enumerate() {
        let surface = Surface::new(dem);
        for error_px in [0.5, 3.0, 20.0] {
            let camera = above(&surface, &mut random);
            let (lattice, _) =
                detail::adaptive(&surface, &camera, error_px, Culling::Off, Curves::Off).expect("few chunks");
            check(surface.dem(), &lattice, &format!("scene {i}, {error_px} px, {camera:?}"));
            levels[0] = levels[0].max(variety(&lattice)[0]);
            levels[1] += variety(&lattice)[1];
        }
    }
    assert!(levels[0] > 3 && levels[1] > 200, "{levels:?} levels and seams");
}

#[test]
fn a_wrong_lattice_is_noticed() {
    let mut random = Random::new(4);
    let kind = KINDS[1];
    let dem = flat(kind, &mut random);
    let right = lattice(&dem, kind, 0, &mut random);
    let mut facets = facets(&dem, &right);
    let seam = right.chunks().iter().find(|chunk| chunk.coarser != 0).expect("a seam");
    // A chunk that does not know of a coarser one beside it.
    let plain =
        |at: [u32; 2]| LatticePoint { x: seam.origin[0] + at[0] * seam.step, y: seam.origin[1] + at[1] * seam.step };
    let first = facets.iter().position(|f| f.contains(&plain([1, 1]))).expect("a facet");
    facets[first][0].x += 1;
    assert!(wrong_mesh(&dem, &facets).is_some());
    facets.swap_remove(first);
    assert!(wrong_mesh(&dem, &facets).is_some(), "a facet less");
    // Another DEM: with a void more, with a row less.
    let whole = Dem::from_heights(601, DVec2::ONE, DVec2::ZERO, vec![0.0; 601 * 401]);
    let coarse = lattice(&whole, Kind { voids: 0, ..KINDS[5] }, 0, &mut random);
    assert_eq!(wrong_squares(&whole, &coarse), None);
    let largest = coarse.chunks().iter().max_by_key(|chunk| chunk.step).expect("a chunk");
    let [c, r] = largest.origin.map(|at| (at / CELL_STEPS) as usize + 1);
    let mut heights = vec![0.0; 601 * 401];
    heights[601 * r + c] = f32::NAN;
    let holed = Dem::from_heights(601, DVec2::ONE, DVec2::ZERO, heights);
    assert!(wrong_squares(&holed, &coarse).is_some_and(|w| w.contains("void")));
    let shorter = Dem::from_heights(601, DVec2::ONE, DVec2::ZERO, vec![0.0; 601 * 400]);
    assert!(wrong_squares(&shorter, &coarse).is_some_and(|w| w.contains("edge")));
}
