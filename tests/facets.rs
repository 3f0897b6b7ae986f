//! What the CPU derives from the facets of level 1, against a plain walk over all of them: vertex normals by cross
//! products of world positions, the rim by counting the patches of each edge, the number of patches.

use std::collections::HashMap;

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::door::surface::Lattice;
use hachure::door::surface::lattice::{CELL_STEPS, CHUNK_FACETS};
use hachure::door::surface::rim::rim;
use hachure::surface::Surface;

use crate::scenes::{Random, level};
use crate::tolerances::GRADIENT;

/// Column and row of a sample.
type Sample = [usize; 2];

/// A random terrain on a grid whose columns and rows are not equally far apart; `voids` in a thousand samples are void.
fn terrain(columns: usize, rows: usize, voids: u32) -> Dem {
    let mut random = Random::new((columns * 1000 + rows) as u64);
    let height = |_| {
        let height = f64::from(random.below(1 << 20)) / 4096.0 - 128.0;
        if random.below(1000) < voids { f32::NAN } else { height as f32 }
    };
    let heights = (0..columns * rows).map(height).collect();
    Dem::from_heights(columns, DVec2::new(27.3, 31.7), DVec2::new(325_000.0, 4_118_000.0), heights)
}

/// The three samples of every facet of level 1 that has no void corner, and its half.
fn facets(dem: &Dem) -> Vec<([Sample; 3], u32)> {
    let lattice = Lattice::uniform(dem, level(1)).expect("IDs suffice");
    let samples = |id| lattice.facet(id).map(|at| [at.x, at.y].map(|steps| (steps / CELL_STEPS) as usize));
    let exists = |[c, r]: Sample| c < dem.columns() && r < dem.rows() && dem.height(c, r).is_some();
    let all = (0..lattice.chunks().len() as u32 * CHUNK_FACETS).map(|id| (samples(id), id % 2));
    all.filter(|(corners, _)| corners.iter().all(|corner| exists(*corner))).collect()
}

/// Samples whose gradient is not that of the summed cross products of their facets.
fn wrong_gradients(surface: &Surface, facets: &[([Sample; 3], u32)]) -> Vec<Sample> {
    let dem = surface.dem();
    let mut sums = vec![DVec3::ZERO; dem.held().unwrap().heights().len()];
    for (corners, _) in facets {
        let [a, b, c] = corners.map(|[c, r]| dem.position(c, r));
        for [column, row] in corners {
            sums[row * dem.columns() + column] += (b - a).cross(c - a);
        }
    }
    let samples = (0..dem.rows()).flat_map(|r| (0..dem.columns()).map(move |c| [c, r]));
    let wrong = samples.zip(&sums).filter(|([c, r], sum)| {
        let expected = if sum.z == 0.0 { DVec2::ZERO } else { -sum.truncate() / sum.z };
        let off = surface.gradient(*c, *r) - expected;
        off.abs().cmpgt(expected.abs() * GRADIENT + 1e-9).any()
    });
    wrong.map(|(sample, _)| sample).collect()
}

/// Start, direction and half of every edge that one facet alone has, sorted as `rim` is.
fn single_edges(facets: &[([Sample; 3], u32)]) -> Vec<(Sample, u32, u32)> {
    let mut halves: HashMap<(Sample, u32), Vec<u32>> = HashMap::new();
    for (corners, half) in facets {
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            let (start, end) = if [a[1], a[0]] < [b[1], b[0]] { (a, b) } else { (b, a) };
            let direction = match [end[0] - start[0], end[1] - start[1]] {
                [1, 0] => 0,
                [0, 1] => 1,
                [1, 1] => 2,
                step => panic!("no edge leads {step:?}"),
            };
            halves.entry((start, direction)).or_default().push(*half);
        }
    }
    let single = halves.into_iter().filter(|(_, halves)| halves.len() == 1);
    let mut edges: Vec<_> = single.map(|((start, direction), halves)| (start, direction, halves[0])).collect();
    edges.sort_by_key(|(start, direction, _)| (start[1], start[0], *direction));
    edges
}

/// Grids of all shapes, whole, with voids here and there, and with more voids than samples.
fn terrains() -> impl Iterator<Item = Dem> {
    let sizes = [(2, 2), (2, 9), (9, 2), (3, 3), (71, 66), (130, 40)];
    sizes.into_iter().flat_map(|(columns, rows)| [0, 30, 600].map(|voids| terrain(columns, rows, voids)))
}

#[test]
fn normals_are_sums_of_cross_products() {
    for dem in terrains() {
        let facets = facets(&dem);
        let surface = Surface::new(dem);
        let wrong = wrong_gradients(&surface, &facets);
        assert!(wrong.is_empty(), "{} x {}: {wrong:?}", surface.dem().columns(), surface.dem().rows());
    }
    let dem = terrain(71, 66, 30);
    let facets = facets(&dem);
    let surface = Surface::new(dem);
    assert_eq!(wrong_gradients(&surface, &facets[1..]).len(), 3, "a facet less is not noticed at its corners");
}

#[test]
fn gradients_of_a_plane_are_exact() {
    let heights = (0..40 * 30).map(|i| (3 * (i % 40) + 5 * (i / 40)) as f32).collect();
    let surface = Surface::new(Dem::from_heights(40, DVec2::new(30.0, 20.0), DVec2::ZERO, heights));
    let [east, north] = surface.gradients().expect("in memory");
    assert!(east.iter().all(|p| *p == 0.1) && north.iter().all(|q| *q == -0.25));
}

#[test]
fn the_rim_is_every_edge_of_one_facet() {
    for dem in terrains() {
        let facets = facets(&dem);
        let found: Vec<_> = rim(&dem)
            .expect("in memory")
            .iter()
            .map(|edge| (edge.sample.map(|i| i as usize), edge.direction, edge.half))
            .collect();
        assert!(found == single_edges(&facets), "{} x {}", dem.columns(), dem.rows());
        assert_eq!(Surface::new(dem).patches(), facets.len() as u64);
    }
    let dem = terrain(71, 66, 30);
    assert_ne!(single_edges(&facets(&dem)), single_edges(&facets(&dem)[1..]), "a facet less is not noticed");
}
