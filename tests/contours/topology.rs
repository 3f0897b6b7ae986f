//! The boundary of what faces the eye hangs together: it neither branches nor ends where the land goes on, it has what
//! faces the eye on its left, and there are as many curves as counting vertices, edges and facets says (Euler).

use std::collections::HashMap;

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::door::plan::detail;
use hachure::door::surface::{Lattice, LatticePoint};
use hachure::line::Bound;
use hachure::plan::{Culling, Curves};
use hachure::surface::Surface;

use super::twin::{Edge, Node, Piece, Twin, string_pieces};
use crate::mixed::{Kind, lattice, variety};
use crate::quadtrees::above;
use crate::scenes::{Random, level, rough};

/// How often each lattice edge is a side of a facet.
fn edges(twin: &Twin) -> HashMap<Edge, u32> {
    let mut edges = HashMap::new();
    for corners in twin.facets() {
        sides(corners).for_each(|[a, b]| *edges.entry([a.min(b), a.max(b)]).or_default() += 1);
    }
    edges
}

fn sides(corners: [LatticePoint; 3]) -> impl Iterator<Item = [LatticePoint; 2]> {
    (0..3).map(move |k| [corners[k], corners[(k + 1) % 3]])
}

/// What is wrong with the nodes of pieces: but where chunks were left out, each has one piece before and one after it, and
/// every edge whose ends differ is crossed.
fn wrong_nodes(twin: &Twin, pieces: &[Piece]) -> Option<String> {
    let mut met: HashMap<Node, [u32; 2]> = HashMap::new();
    for piece in pieces {
        (0..2).for_each(|end| met.entry(piece.ends[end]).or_default()[end] += 1);
    }
    let mut edges = edges(twin);
    // Each side where the land ends counts as a facet more: what is left with one lies where the land goes on.
    twin.rim().for_each(|[a, b]| *edges.entry([a.min(b), a.max(b)]).or_default() += 1);
    let cut = |edge: &Edge| edges[edge] == 1;
    let cut_vertices: Vec<LatticePoint> = edges.keys().filter(|edge| cut(edge)).flatten().copied().collect();
    let may_end = |node: &Node| match node {
        Node::Crossing(edge) => cut(edge),
        Node::Corner(at, _) => cut_vertices.contains(at),
    };
    if let Some((node, times)) = met.iter().find(|(node, times)| **times != [1, 1] && !may_end(node)) {
        return Some(format!("{node:?} is the start and the end of {times:?} pieces"));
    }
    if let Some((node, times)) = met.iter().find(|(_, times)| times.iter().any(|n| *n > 1)) {
        return Some(format!("{node:?} branches, {times:?}"));
    }
    let toward = |at: LatticePoint| twin.vertex(at).g > 0.0;
    let crossed = |node: &&Node| matches!(node, Node::Crossing(_));
    let [flips, crossings] =
        [edges.keys().filter(|[a, b]| toward(*a) != toward(*b)).count(), met.keys().filter(crossed).count()];
    (flips != crossings).then(|| format!("{flips} edges between toward and away, {crossings} crossings"))
}

/// What lies on the wrong side of a piece of contour: on the map of the lattice.
fn wrong_side(twin: &Twin, pieces: &[Piece]) -> Option<Piece> {
    let on_map = |at: LatticePoint| DVec2::new(f64::from(at.x), -f64::from(at.y));
    let place = |node: Node| match node {
        Node::Corner(at, _) => on_map(at),
        Node::Crossing([a, b]) => {
            let [g, h] = [a, b].map(|at| twin.vertex(at).g);
            on_map(a).lerp(on_map(b), g / (g - h))
        }
    };
    let wrong = |piece: &&Piece| {
        let [start, end] = piece.ends.map(place);
        // In lattice units; of a piece as short as rounding no side is known.
        let left = |at: LatticePoint| (end - start).perp_dot(on_map(at) - start);
        piece.facet.iter().any(|at| if twin.vertex(*at).g > 0.0 { left(*at) < -1e-6 } else { left(*at) > 1e-6 })
    };
    pieces.iter().filter(|piece| piece.bound() == Bound::Contour).find(wrong).copied()
}

/// How many closed curves bound what faces the eye, by counting: the parts into which it falls are discs with holes, of
/// which each has two curves less its Euler number; they shrink to the vertices that face the eye and what lies between.
fn curves_by_counting(twin: &Twin) -> i64 {
    let toward = |at: &LatticePoint| twin.vertex(*at).g > 0.0;
    let facets: Vec<[LatticePoint; 3]> = twin.facets().filter(|corners| corners.iter().any(toward)).collect();
    let mut parts: Vec<usize> = (0..facets.len()).collect();
    let mut beside: HashMap<Edge, usize> = HashMap::new();
    let (mut whole_edges, mut joined) = (0_i64, facets.len() as i64);
    for (f, corners) in facets.iter().enumerate() {
        for [a, b] in sides(*corners).filter(|side| side.iter().any(toward)) {
            match beside.insert([a.min(b), a.max(b)], f) {
                None => whole_edges += i64::from(toward(&a) && toward(&b)),
                Some(other) => joined -= i64::from(join(&mut parts, f, other)),
            }
        }
    }
    // A vertex counts as often as parts of the land meet there: inside once, on the rim once for each side that leaves it.
    let mut fans: HashMap<LatticePoint, i64> = HashMap::new();
    twin.rim().for_each(|[a, _]| *fans.entry(a).or_default() += 1);
    let mut vertices: Vec<LatticePoint> = facets.as_flattened().iter().filter(|at| toward(at)).copied().collect();
    vertices.sort_unstable();
    vertices.dedup();
    let vertices: i64 = vertices.iter().map(|at| fans.get(at).copied().unwrap_or(1)).sum();
    let whole_facets = facets.iter().filter(|corners| corners.iter().all(toward)).count() as i64;
    2 * joined - (vertices - whole_edges + whole_facets)
}

/// Joins two parts; whether they were two (Tarjan 1975, union and find).
fn join(parts: &mut [usize], a: usize, b: usize) -> bool {
    let root = |parts: &mut [usize], mut at: usize| {
        while parts[at] != at {
            parts[at] = parts[parts[at]];
            at = parts[at];
        }
        at
    };
    let (a, b) = (root(parts, a), root(parts, b));
    parts[a.max(b)] = a.min(b);
    a != b
}

/// What is wrong with the boundary as a whole; how many curves there are.
fn check(twin: &Twin, pieces: &[Piece], what: &str) -> usize {
    let wrong = wrong_nodes(twin, pieces);
    assert!(wrong.is_none(), "{what}: {wrong:?}");
    let wrong = wrong_side(twin, pieces);
    assert!(wrong.is_none(), "{what}: what faces the eye is not on the left of {wrong:?}");
    let curves = string_pieces(pieces);
    let strung: usize = curves.iter().map(|curve| curve.pieces.len()).sum();
    assert_eq!(strung, pieces.len(), "{what}: pieces in curves");
    curves.len()
}

/// Rough land with an eye above it, low enough to see slopes from behind.
fn twin_of(dem: Dem, lattice: impl FnOnce(&Dem) -> Lattice, random: &mut Random) -> Twin {
    let surface = Surface::new(dem);
    let lattice = lattice(surface.dem());
    let eye = above(&surface, random).eye;
    Twin::new(&surface, &lattice, eye)
}

/// Random lattices over rough land: (seed, twin, seams).
fn random_twins(dropped: u32) -> impl Iterator<Item = (u64, Twin, usize)> {
    const KINDS: [Kind; 4] = [
        Kind { cells: [70, 61], steps: [64, 8], rarity: 3, voids: 0 },
        Kind { cells: [70, 61], steps: [64, 32], rarity: 3, voids: 1 },
        Kind { cells: [20, 17], steps: [32, 4], rarity: 3, voids: 1 },
        Kind { cells: [128, 100], steps: [512, 32], rarity: 3, voids: 0 },
    ];
    (1..=12).map(move |seed| {
        let kind = KINDS[seed as usize % KINDS.len()];
        let mut random = Random::new(seed * 7919);
        let dem = rough(kind.cells[0] + 1, kind.cells[1] + 1, 2.0, 6.0, kind.voids > 0);
        let surface = Surface::new(dem);
        let lattice = lattice(surface.dem(), kind, dropped, &mut random);
        let twin = Twin::new(&surface, &lattice, above(&surface, &mut random).eye);
        (seed, twin, variety(&lattice)[1])
    })
}

#[test]
fn contours_of_one_level_are_closed_curves() {
    let mut random = Random::new(3);
    let mut met = [0; 2];
    for (columns, rows, voids, n) in [(40, 30, false, 4), (40, 30, true, 4), (120, 90, true, 1), (9, 7, true, 16)] {
        let of = |dem: &Dem| Lattice::uniform(dem, level(n)).expect("few chunks");
        let twin = twin_of(rough(columns, rows, 2.0, 5.0, voids), of, &mut random);
        let pieces = twin.pieces();
        let what = format!("{columns} x {rows}, level {n}");
        let curves = check(&twin, &pieces, &what);
        assert!(string_pieces(&pieces).iter().all(|curve| curve.closed), "{what}");
        assert_eq!(curves as i64, curves_by_counting(&twin), "{what}");
        met[0] += curves;
        met[1] += pieces.len();
    }
    println!("{met:?} curves and pieces");
    assert!(met[0] > 200 && met[1] > 10_000, "{met:?}");
}

#[test]
fn contours_of_several_levels_are_closed_curves() {
    let mut met = [0; 3];
    for (seed, twin, seams) in random_twins(0) {
        let pieces = twin.pieces();
        let curves = check(&twin, &pieces, &format!("seed {seed}"));
        assert!(string_pieces(&pieces).iter().all(|curve| curve.closed), "seed {seed}");
        assert_eq!(curves as i64, curves_by_counting(&twin), "seed {seed}");
        met = [met[0] + curves, met[1] + pieces.len(), met[2] + seams];
    }
    println!("{met:?} curves, pieces, seams");
    assert!(met[0] > 500 && met[1] > 20_000 && met[2] > 200, "{met:?}");
}

#[test]
fn contours_end_only_where_chunks_are_left_out() {
    let mut open = 0;
    for (seed, twin, _) in random_twins(5) {
        let pieces = twin.pieces();
        check(&twin, &pieces, &format!("seed {seed}"));
        open += string_pieces(&pieces).iter().filter(|curve| !curve.closed).count();
    }
    let surface = Surface::new(rough(150, 140, 1.0, 5.0, false));
    let mut random = Random::new(11);
    for _ in 0..4 {
        let camera = above(&surface, &mut random);
        let (lattice, _) = detail::adaptive(&surface, &camera, 2.0, Culling::On, Curves::Off).expect("few chunks");
        let twin = Twin::new(&surface, &lattice, camera.eye);
        let pieces = twin.pieces();
        check(&twin, &pieces, &format!("{camera:?}"));
        open += string_pieces(&pieces).iter().filter(|curve| !curve.closed).count();
    }
    println!("{open} open curves");
    assert!(open > 50, "only {open} curves end");
}

#[test]
fn a_wrong_boundary_is_noticed() {
    let (_, twin, _) = random_twins(0).nth(1).expect("a lattice");
    let pieces = twin.pieces();
    assert!(wrong_nodes(&twin, &pieces).is_none() && wrong_side(&twin, &pieces).is_none());
    for bound in [Bound::Contour, Bound::Rim] {
        let lost = pieces.iter().position(|piece| piece.bound() == bound).expect("a piece");
        let fewer = [&pieces[..lost], &pieces[lost + 1..]].concat();
        assert!(wrong_nodes(&twin, &fewer).is_some(), "a lost piece of {bound:?} is not noticed");
        let twice = [&pieces[..], &[pieces[lost]]].concat();
        assert!(wrong_nodes(&twin, &twice).is_some(), "a second piece of {bound:?} is not noticed");
    }
    // With g's sign swapped all hangs together, about what faces away: on the other side, and elsewhere on the rim.
    let swapped = twin.reversed().pieces();
    assert!(wrong_side(&twin, &swapped).is_some(), "g's sign is not noticed");
    let rim = |pieces: &[Piece]| pieces.iter().filter(|p| p.bound() == Bound::Rim).copied().collect::<Vec<_>>();
    assert_ne!(rim(&pieces), rim(&swapped));
    let counted = curves_by_counting(&twin);
    assert_eq!(counted, string_pieces(&pieces).len() as i64);
    // Without one facet there is a hole more, or a part less.
    let surface = Surface::new(rough(40, 30, 2.0, 5.0, false));
    let chunks = Lattice::uniform(surface.dem(), level(4)).expect("few chunks");
    let eye = DVec3::new(325_400.0, 4_117_700.0, 90.0);
    let [whole, less] = [0, 1].map(|skip| Twin::of(&surface, &chunks.chunks()[skip..], eye));
    assert!(wrong_nodes(&less, &less.pieces()).is_none());
    assert!(wrong_nodes(&whole, &less.pieces()).is_some(), "a chunk left out is not noticed");
}
