//! The lines of a level by the definition alone, as slowly as it can be done: all facets in a list, edges by the lattice
//! vertices they have in common, every piece looked at past every facet. Nothing of the library is used but places on
//! the surface and the camera's projection: no bounds, no tree, no proof of facing. Cost: pieces times facets.
//!
//! What is decided by less than rounding is told apart as doubtful: both answers are right.

use std::collections::BTreeMap;

use glam::{DMat3, DVec2, DVec3};
use hachure::door::surface::LatticePoint;
use hachure::surface::{Level, Surface};
use hachure::truth::{TruthLine, TruthPiece};
use hachure::view::Camera;

use crate::tolerances::DOUBT;

/// Pieces by how sure it is that they are seen.
#[derive(Debug, Default)]
pub struct Found {
    pub seen: Vec<TruthPiece>,
    pub doubtful: Vec<TruthPiece>,
}

/// A facet with its lattice vertices, counter-clockwise from above.
type Facet = [(LatticePoint, DVec3); 3];

/// All facets of a level, metres of the world.
pub struct Slow {
    facets: Vec<Facet>,
    /// Metres along the view axis before which nothing is drawn: 1/1024 of a cell.
    near: f64,
}

/// A facet as metres from the eye.
#[derive(Clone, Copy)]
struct Seen([DVec3; 3]);

impl Slow {
    pub fn new(surface: &Surface, level: Level) -> Self {
        let (dem, n) = (surface.dem(), level.subdivisions() as usize);
        let vertex = |x: usize, y: usize| {
            let at = LatticePoint { x: x as u32 * level.step(), y: y as u32 * level.step() };
            (at, surface.position(at).expect("a vertex of a patch"))
        };
        let mut facets = Vec::new();
        for (y, x) in (0..(dem.rows() - 1) * n).flat_map(|y| (0..(dem.columns() - 1) * n).map(move |x| (y, x))) {
            let (c, r) = (x / n, y / n);
            // The north-west and south-east halves of the quad, and the patches they belong to: that of the quad off the
            // cell's diagonal, their own on it.
            for half in [0, 1] {
                let south_west = if x % n == y % n { half == 0 } else { x % n < y % n };
                let third = if south_west { (c, r + 1) } else { (c + 1, r) };
                let exists = [(c, r), (c + 1, r + 1), third].iter().all(|&(c, r)| dem.height(c, r).is_some());
                let [second, last] = if half == 0 { [(0, 1), (1, 1)] } else { [(1, 1), (1, 0)] };
                if exists {
                    facets.push([(0, 0), second, last].map(|(dx, dy)| vertex(x + dx, y + dy)));
                }
            }
        }
        Self { facets, near: dem.cell().min_element() / 1024.0 }
    }

    /// How many facets there are.
    pub fn facets(&self) -> usize {
        self.facets.len()
    }

    /// The same without one facet.
    pub fn without(mut self, i: usize) -> Self {
        self.facets.remove(i);
        self
    }

    /// The pieces of line on the page and 4 px around it.
    pub fn lines(&self, camera: &Camera) -> Found {
        let facets: Vec<Seen> = self.facets.iter().map(|f| Seen(f.map(|(_, p)| p - camera.eye))).collect();
        // Facets on either side of each edge, with the vertex across from it.
        let mut edges: BTreeMap<[LatticePoint; 2], Vec<(usize, usize)>> = BTreeMap::new();
        for (i, facet) in self.facets.iter().enumerate() {
            for k in 0..3 {
                let mut ends = [facet[(k + 1) % 3].0, facet[(k + 2) % 3].0];
                ends.sort();
                edges.entry(ends).or_default().push((i, k));
            }
        }
        let mut found = Found::default();
        for sides in edges.values() {
            let (facet, k) = sides[0];
            let edge = [1, 2].map(|i| facets[facet].0[(k + i) % 3]);
            let lift = |up: DVec3| up.normalize() * 0.05 * edge[0].distance(edge[1]);
            let facings: Vec<f64> = sides.iter().map(|(i, _)| facets[*i].facing()).collect();
            let (doubtful, nudge, line) = match sides[..] {
                [(a, _), (b, across)] => {
                    let towards = facings[0] > 0.0;
                    if towards == (facings[1] > 0.0) && facings.iter().all(|f| f.abs() > DOUBT) {
                        continue;
                    }
                    // Convex: the other facet's vertex lies below the plane.
                    let rise = facets[a].up().normalize().dot((facets[b].0[across] - edge[0]).normalize());
                    if rise >= DOUBT {
                        continue;
                    }
                    let doubtful = rise > -DOUBT || facings.iter().any(|f| f.abs() <= DOUBT);
                    (doubtful, lift(facets[a].up().normalize() + facets[b].up().normalize()), TruthLine::Contour)
                }
                [(only, _)] => {
                    if facings[0] <= -DOUBT {
                        continue;
                    }
                    (facings[0] <= DOUBT, lift(facets[only].up()), TruthLine::Border)
                }
                _ => panic!("{} facets share an edge", sides.len()),
            };
            for (piece, place) in self.cut(camera, edge, line) {
                match seen(place + nudge, &facets) {
                    Some(false) => {}
                    Some(true) if !doubtful => found.seen.push(piece),
                    _ => found.doubtful.push(piece),
                }
            }
        }
        found
    }

    /// The part of an edge that lies before the eye and on the page or 4 px around it, in equal pieces of at most a
    /// quarter pixel, with their middles in metres from the eye.
    fn cut(&self, camera: &Camera, edge: [DVec3; 2], line: TruthLine) -> Vec<(TruthPiece, DVec3)> {
        let place = |p: DVec3| camera.project(camera.eye + p);
        let depths = edge.map(|p| place(p).1 - self.near);
        if depths.iter().all(|d| *d < 0.0) {
            return Vec::new();
        }
        let crossing = edge[0].lerp(edge[1], depths[0] / (depths[0] - depths[1]));
        let ends = [0, 1].map(|i| place(if depths[i] < 0.0 { crossing } else { edge[i] }));
        let [a, b] = ends.map(|(p, _)| p);
        let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
        // One side of the page after another cuts its part off.
        let (mut from, mut to) = (0.0, 1.0);
        for (inward, offset) in
            [(DVec2::X, 4.0), (DVec2::NEG_X, size.x + 4.0), (DVec2::Y, 4.0), (DVec2::NEG_Y, size.y + 4.0)]
        {
            let [start, end] = [a, b].map(|p| p.dot(inward) + offset);
            match (start >= 0.0, end >= 0.0) {
                (true, true) => {}
                (false, false) => return Vec::new(),
                (false, true) => from = f64::max(from, start / (start - end)),
                (true, false) => to = f64::min(to, start / (start - end)),
            }
        }
        if from >= to {
            return Vec::new();
        }
        let (first, last) = (a.lerp(b, from), a.lerp(b, to));
        let count = (first.distance(last) / 0.25).ceil().max(1.0);
        let piece = |i: f64| {
            let at = |k: f64| first.lerp(last, (i + k) / count);
            // The inverse of depth runs straight along an edge.
            let share = from + (to - from) * (i + 0.5) / count;
            let distance = 1.0 / ((1.0 - share) / ends[0].1 + share / ends[1].1);
            (TruthPiece { ends: [at(0.0), at(1.0)], distance, line }, camera.ray(at(0.5)) * distance)
        };
        (0..count as u32).map(|i| piece(f64::from(i))).collect()
    }
}

impl Seen {
    fn up(&self) -> DVec3 {
        let [a, b, c] = self.0;
        (b - a).cross(c - a)
    }

    /// Sine of the angle at which the eye sees the plane from above.
    fn facing(&self) -> f64 {
        -self.up().normalize().dot(self.0[0].normalize())
    }
}

/// Whether no facet stands between the eye and a place; `None` where that is decided by less than rounding.
fn seen(place: DVec3, facets: &[Seen]) -> Option<bool> {
    let mut sure = Some(true);
    for Seen([a, b, c]) in facets {
        // The segment's share before the plane, and the shares of b and c where it meets it.
        let hit = DMat3::from_cols(place, *a - *b, *a - *c).inverse() * *a;
        let within = [hit.x, 1.0 - hit.x, hit.y, hit.z, 1.0 - hit.y - hit.z].into_iter().fold(f64::INFINITY, f64::min);
        if within > DOUBT {
            return Some(false);
        }
        if within >= -DOUBT {
            sure = None;
        }
    }
    sure
}
