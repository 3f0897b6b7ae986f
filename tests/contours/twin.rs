//! A twin of the contours in f64: the boundary of what faces the eye, on the facets of a lattice.
//!
//! Method: g = n . (eye - p) at every vertex of every chunk, n the sum of the cross products of all facets that have the
//! vertex or, inside a chunk where they do not all face one way, as much of the normals of the patches there; on each facet with both signs (zero is away) one piece between the two sides it crosses (Hertzmann, Zorin 2000,
//! section 3); sides with one facet where the land ends, as far as g > 0. Pieces have what faces the eye on their left and
//! are strung together by lattice vertices alone. Brute force: every chunk, every facet, no look at what may be left out.
//! Cost: about a microsecond a facet.

use std::collections::{HashMap, HashSet};
use std::fmt::Debug;
use std::hash::Hash;

use glam::DVec3;
use hachure::dem::Dem;
use hachure::door::surface::lattice::{CELL_STEPS, CHUNK_FACETS, CHUNK_QUADS, EAST, NORTH, SOUTH, WEST};
use hachure::door::surface::patch::Patch;
use hachure::door::surface::{Chunk, Lattice, LatticePoint};
use hachure::line::Bound;
use hachure::surface::Surface;
use rayon::prelude::*;

use crate::mixed::exists;
use crate::quadtrees::on_rim;

/// Two ends of a lattice edge, the lower first unless said otherwise.
pub type Edge = [LatticePoint; 2];

/// A facet by its vertices, counter-clockwise seen from above.
pub type Corners = [LatticePoint; 3];

/// Where two pieces meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Node {
    /// The only place of a lattice edge with g = 0.
    Crossing(Edge),
    /// A vertex of the rim that faces the eye, and the vertex to which the rim goes on: several parts of the land may meet
    /// there. Itself where the land goes on and its chunk was left out.
    Corner(LatticePoint, LatticePoint),
}

/// A piece of the boundary of what faces the eye, which lies on its left seen from above.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Piece {
    /// Where it starts and where it ends.
    pub ends: [Node; 2],
    /// The facet on which, or along which, it runs.
    pub facet: Corners,
    /// Along which side of it, with the facet on the left; `None` across it.
    pub side: Option<Edge>,
}

impl Piece {
    /// What it bounds.
    pub fn bound(&self) -> Bound {
        if self.side.is_some() { Bound::Rim } else { Bound::Contour }
    }

    /// What no other piece is called.
    pub fn name(&self) -> Name {
        self.side.map_or(Name::Across(self.facet), Name::Along)
    }
}

/// What a piece is called.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Name {
    /// The one across a facet.
    Across(Corners),
    /// The one along a side of the rim, from its first vertex on.
    Along(Edge),
}

/// Pieces strung together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Strung<N> {
    /// Where they meet, in their order; of a closed one the first is not repeated.
    pub nodes: Vec<N>,
    /// The pieces by their number, each from the node of its place to the next.
    pub pieces: Vec<usize>,
    /// Whether the last piece leads to the first node.
    pub closed: bool,
}

/// A vertex of the lattice.
#[derive(Debug, Clone, Copy)]
pub struct Vertex {
    /// Metres from the eye.
    pub p: DVec3,
    /// Sum of the cross products of its facets, square metres.
    pub n: DVec3,
    /// n . (eye - p): above 0 it faces the eye.
    pub g: f64,
    /// How g changes along the view direction, a mean over its facets: below 0 the surface is convex there. Not to scale.
    pub along: f64,
}

impl Vertex {
    /// Sine of the angle between surface and ray.
    pub fn sine(&self) -> f64 {
        self.g / (self.n.length() * self.p.length())
    }
}

/// The facets of a lattice with what is known at their vertices.
#[derive(Debug, Clone)]
pub struct Twin {
    eye: DVec3,
    /// All vertices of the lattice, sorted.
    points: Vec<LatticePoint>,
    vertices: Vec<Vertex>,
    /// By the places of their vertices.
    facets: Vec<[usize; 3]>,
    /// Sides of facets where the land ends, by facet and number of the vertex they start at.
    rim: Vec<(usize, usize)>,
}

impl Twin {
    /// Of all chunks of a lattice.
    pub fn new(surface: &Surface, lattice: &Lattice, eye: DVec3) -> Self {
        Self::of(surface, lattice.chunks(), eye)
    }

    /// The same where n is the sum of whole facets at every vertex.
    pub fn of_whole_facets(surface: &Surface, lattice: &Lattice, eye: DVec3) -> Self {
        Self::made(surface, lattice.chunks(), eye, false)
    }

    /// Of these chunks alone.
    pub fn of(surface: &Surface, chunks: &[Chunk], eye: DVec3) -> Self {
        Self::made(surface, chunks, eye, true)
    }

    fn made(surface: &Surface, chunks: &[Chunk], eye: DVec3, looks_closely: bool) -> Self {
        let dem = surface.dem();
        let facets: Vec<Corners> = chunks.par_iter().flat_map_iter(|chunk| facets(dem, chunk)).collect();
        let mut points = facets.as_flattened().to_vec();
        points.par_sort_unstable();
        points.dedup();
        let place = |at: &LatticePoint| points.binary_search(at).expect("a vertex of a facet");
        let facets: Vec<[usize; 3]> = facets.par_iter().map(|corners| corners.each_ref().map(place)).collect();
        let position = |at: &LatticePoint| surface.position(*at).expect("a vertex of land") - eye;
        let vertex = |at| Vertex { p: position(at), n: DVec3::ZERO, g: 0.0, along: 0.0 };
        let vertices = points.par_iter().map(vertex).collect();
        let mut twin = Self { eye, points, vertices, facets, rim: Vec::new() };
        twin.face(surface, if looks_closely { chunks } else { &[] });
        let sides = (0..twin.facets.len()).flat_map(|f| (0..3).map(move |k| (f, k)));
        twin.rim = sides.filter(|(f, k)| twin.ends_land(dem, twin.side(*f, *k))).collect();
        twin
    }

    /// Sums normals, then g, then its change along the view.
    fn face(&mut self, surface: &Surface, chunks: &[Chunk]) {
        // Of each vertex how many facets face the eye, and how many away.
        let mut faces = vec![[0; 2]; self.points.len()];
        for facet in &self.facets {
            let corners = facet.map(|v| self.vertices[v].p);
            let normal = normal(corners);
            facet.iter().for_each(|v| self.vertices[*v].n += normal);
            let is_away = usize::from(normal.dot(corners[0]) >= 0.0);
            facet.iter().for_each(|v| faces[*v][is_away] += 1);
        }
        for chunk in chunks.iter().filter(|chunk| chunk.step < CELL_STEPS) {
            // Not on sides, nor beside them where the next chunk is coarser.
            let beside = |first, last, at| {
                (at == 1 && chunk.coarser & first != 0) || (at == CHUNK_QUADS - 1 && chunk.coarser & last != 0)
            };
            let columns = (1..CHUNK_QUADS).filter(|column| !beside(WEST, EAST, *column));
            let rows = (1..CHUNK_QUADS).filter(|row| !beside(NORTH, SOUTH, *row));
            let inside = rows.flat_map(|row| columns.clone().map(move |column| [column, row]));
            for at in inside.map(|at| chunk.vertex(at)) {
                let Ok(v) = self.points.binary_search(&at) else { continue };
                if faces[v].iter().all(|count| *count > 0) && faces[v].iter().sum::<i32>() == 6 {
                    let quads = f64::from(chunk.step) / f64::from(CELL_STEPS);
                    self.vertices[v].n = 6.0 * quads * quads * patch_normal(surface, at);
                }
            }
        }
        self.vertices.iter_mut().for_each(|vertex| vertex.g = -vertex.n.dot(vertex.p));
        for facet in &self.facets {
            let corners = facet.map(|v| self.vertices[v]);
            let normal = normal(corners.map(|corner| corner.p));
            let share = |k: usize| {
                let opposite = corners[(k + 2) % 3].p - corners[(k + 1) % 3].p;
                normal.cross(opposite) * corners[k].g
            };
            // The gradient of g on the facet, times twice its area.
            let gradient = (share(0) + share(1) + share(2)) / normal.length();
            facet.iter().for_each(|v| self.vertices[*v].along += gradient.dot(self.vertices[*v].p));
        }
    }

    /// The ends of a facet's side, counter-clockwise.
    fn side(&self, facet: usize, k: usize) -> [usize; 2] {
        [self.facets[facet][k], self.facets[facet][(k + 1) % 3]]
    }

    fn ends_land(&self, dem: &Dem, side: [usize; 2]) -> bool {
        let [a, b] = side.map(|v| self.points[v]);
        let whole = |at: u32| at.is_multiple_of(CELL_STEPS);
        let on_grid = a.x == b.x && whole(a.x) || a.y == b.y && whole(a.y);
        let on_diagonal = a.x != b.x && a.y != b.y && whole(a.x.wrapping_sub(a.y));
        (on_grid || on_diagonal) && on_rim(dem, a, b)
    }

    /// What is known at a vertex.
    pub fn vertex(&self, at: LatticePoint) -> Vertex {
        self.vertices[self.points.binary_search(&at).expect("a vertex of the lattice")]
    }

    /// Its facets, each by its vertices.
    pub fn facets(&self) -> impl Iterator<Item = Corners> {
        self.facets.iter().map(|facet| facet.map(|v| self.points[v]))
    }

    /// Sides of facets where the land ends, from one vertex to the next with the land on their left.
    pub fn rim(&self) -> impl Iterator<Item = [LatticePoint; 2]> {
        self.rim.iter().map(|(f, k)| self.side(*f, *k).map(|v| self.points[v]))
    }

    /// The same facets with everything that faces the eye turned away.
    pub fn reversed(&self) -> Self {
        let mut reversed = self.clone();
        reversed.vertices.iter_mut().for_each(|vertex| vertex.g = -vertex.g);
        reversed
    }

    /// The whole boundary of what faces the eye, facet by facet.
    pub fn pieces(&self) -> Vec<Piece> {
        let beyond = self.beside_rim();
        let across = self.facets.iter().filter_map(|facet| self.across(facet));
        let along = self.rim.iter().filter_map(|(f, k)| self.along(*f, *k, &beyond));
        across.chain(along).collect()
    }

    /// The piece on a facet.
    fn across(&self, facet: &[usize; 3]) -> Option<Piece> {
        let toward = facet.map(|v| self.vertices[v].g > 0.0);
        let leaves = |from: bool| (0..3).find(|k| toward[*k] == from && toward[(k + 1) % 3] != from);
        let end = |k: usize| self.crossing([facet[k], facet[(k + 1) % 3]]);
        let ends = [end(leaves(true)?), end(leaves(false)?)];
        Some(Piece { ends, facet: facet.map(|v| self.points[v]), side: None })
    }

    /// The piece along a side where the land ends.
    fn along(&self, f: usize, k: usize, beside: &HashMap<[usize; 2], (usize, usize)>) -> Option<Piece> {
        let [a, b] = self.side(f, k);
        let start = Node::Corner(self.points[a], self.points[b]);
        let ends = match [a, b].map(|v| self.vertices[v].g > 0.0) {
            [true, true] => [start, self.corner(f, k, beside)],
            [true, false] => [start, self.crossing([a, b])],
            [false, true] => [self.crossing([a, b]), self.corner(f, k, beside)],
            [false, false] => return None,
        };
        Some(Piece { ends, facet: self.facets[f].map(|v| self.points[v]), side: Some([a, b].map(|v| self.points[v])) })
    }

    fn crossing(&self, [a, b]: [usize; 2]) -> Node {
        Node::Crossing([self.points[a.min(b)], self.points[a.max(b)]])
    }

    /// Facets with a vertex where the land ends, by each of their sides.
    fn beside_rim(&self) -> HashMap<[usize; 2], (usize, usize)> {
        let mut ends = vec![false; self.points.len()];
        self.rim.iter().for_each(|(f, k)| self.side(*f, *k).iter().for_each(|v| ends[*v] = true));
        let beside = (0..self.facets.len()).filter(|f| self.facets[*f].iter().any(|v| ends[*v]));
        beside.flat_map(|f| (0..3).map(move |k| (self.side(f, k), (f, k)))).collect()
    }

    /// Where a side of the rim ends: about that vertex, facet by facet, to the side on which the rim goes on.
    fn corner(&self, f: usize, k: usize, beside: &HashMap<[usize; 2], (usize, usize)>) -> Node {
        let (mut f, mut k) = (f, (k + 1) % 3);
        loop {
            let [at, next] = self.side(f, k);
            match beside.get(&[next, at]) {
                Some((facet, side)) => (f, k) = (*facet, (side + 1) % 3),
                None if self.rim.binary_search(&(f, k)).is_ok() => {
                    return Node::Corner(self.points[at], self.points[next]);
                }
                None => return Node::Corner(self.points[at], self.points[at]),
            }
        }
    }

    /// World place of a node, metres.
    pub fn place(&self, node: Node) -> DVec3 {
        self.eye
            + match node {
                Node::Corner(at, _) => self.vertex(at).p,
                Node::Crossing(edge) => {
                    let [a, b] = edge.map(|at| self.vertex(at));
                    a.p.lerp(b.p, a.g / (a.g - b.g))
                }
            }
    }

    /// How g changes along the view at a node, between that at the ends of its edge: below 0 the surface is convex and
    /// folds out of sight behind it. Not to scale.
    pub fn along_view(&self, node: Node) -> f64 {
        match node {
            Node::Corner(at, _) => self.vertex(at).along,
            Node::Crossing(edge) => {
                let [a, b] = edge.map(|at| self.vertex(at));
                let t = a.g / (a.g - b.g);
                a.along * (1.0 - t) + b.along * t
            }
        }
    }
}

/// Strings pieces together by where they start and end: those with an open start first, then the closed ones, each from its
/// first piece.
///
/// # Panics
/// Where two pieces start at one place.
pub fn string<N: Copy + Eq + Hash + Debug>(ends: &[[N; 2]]) -> Vec<Strung<N>> {
    let mut starts: HashMap<N, usize> = HashMap::new();
    for (i, [start, _]) in ends.iter().enumerate() {
        assert!(starts.insert(*start, i).is_none(), "a branch at {start:?}");
    }
    let reached: HashSet<N> = ends.iter().map(|[_, end]| *end).collect();
    let (closed, open): (Vec<usize>, Vec<usize>) = (0..ends.len()).partition(|i| reached.contains(&ends[*i][0]));
    let mut curves = Vec::new();
    for first in open.into_iter().chain(closed) {
        let mut curve = Strung { nodes: Vec::new(), pieces: Vec::new(), closed: false };
        let mut at = ends[first][0];
        while let Some(i) = starts.remove(&at) {
            curve.nodes.push(at);
            curve.pieces.push(i);
            at = ends[i][1];
        }
        let Some(start) = curve.nodes.first() else { continue };
        curve.closed = at == *start;
        if !curve.closed {
            curve.nodes.push(at);
        }
        curves.push(curve);
    }
    curves
}

/// The same of pieces of a twin.
pub fn string_pieces(pieces: &[Piece]) -> Vec<Strung<Node>> {
    string(&pieces.iter().map(|piece| piece.ends).collect::<Vec<_>>())
}

/// Facets of a chunk that exist, counter-clockwise seen from above.
fn facets(dem: &Dem, chunk: &Chunk) -> Vec<Corners> {
    let all = (0..CHUNK_FACETS).map(|local| chunk.facet(local));
    all.filter(|[a, b, c]| a != b && b != c && c != a && exists(dem, [*a, *b, *c])).collect()
}

/// The mean normal of the patches at a lattice vertex, as long as a cell is large: by central differences.
fn patch_normal(surface: &Surface, at: LatticePoint) -> DVec3 {
    const STEP: f64 = 1e-4;
    let dem = surface.dem();
    if at.x.is_multiple_of(CELL_STEPS) && at.y.is_multiple_of(CELL_STEPS) {
        let gradient = surface.gradient((at.x / CELL_STEPS) as usize, (at.y / CELL_STEPS) as usize);
        return (-gradient).extend(1.0) * dem.cell().element_product();
    }
    let cells = |at: u32| at.saturating_sub(1) / CELL_STEPS..=at / CELL_STEPS;
    let (mut sum, mut count) = (DVec3::ZERO, 0.0);
    for (c, r) in cells(at.x).flat_map(|c| cells(at.y).map(move |r| (c, r))) {
        let [u, v] = [(at.x, c), (at.y, r)].map(|(at, cell)| (f64::from(at) / f64::from(CELL_STEPS)) - f64::from(cell));
        let corners = [r, r + 1].map(|r| surface.corners(r as usize));
        let corner = |down: usize, right: u32| corners[down][(c + right) as usize];
        for half in (0..2).filter(|half| if *half == 0 { v >= u } else { u >= v }) {
            let patch = Patch::of_cell([corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)], half);
            let point = |u: f64, v: f64| {
                patch.point(if half == 0 { [1.0 - v, v - u, u] } else { [1.0 - u, v, u - v] }) - dem.position(0, 0)
            };
            let east = point(u + STEP, v) - point(u - STEP, v);
            let south = point(u, v + STEP) - point(u, v - STEP);
            sum += south.cross(east) / (4.0 * STEP * STEP);
            count += 1.0;
        }
    }
    sum / count
}

/// Up from a facet, as long as twice its area.
fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}
