//! What each pass of a frame must move and compute: the limit beside which its time stands.
//!
//! Bytes are compulsory traffic, as in a roofline (Williams, Waterman, Patterson 2009): each value that a pass reads or
//! writes counts once, however often it is touched, and twice where it is read and written, as by an atomic. What a
//! cache would have to fetch again is not in it. Operations are additions, multiplications, divisions and comparisons of
//! one number, counted in the shaders for one vertex, facet or pixel (the constants below) and rounded; addresses and
//! flow are not in it. Both follow from how much a frame worked through, [`Quantities`], alone.
//!
//! Does not handle: facets that cover a pixel farther away than another (each pixel of land counts once), the steps of
//! walks (each pixel with open pairs counts as one pair), pixels of border lines, chunks above or below the page.

use std::collections::HashMap;

use crate::error::Result;
use crate::gpu::sizes::{CHUNK_BYTES, PIXEL_BYTES, RIM_EDGE_BYTES, VERTEX_BYTES, WORD_BYTES};
use crate::plan::detail::across;
use crate::plan::{Method, Plan, Thrift, Visibility};
use crate::surface::lattice::{CELL_STEPS, CHUNK_FACETS, CHUNK_QUADS, CHUNK_VERTICES, CHUNK_WORDS};
use crate::surface::tile::TILE_SAMPLES;
use crate::surface::{Lattice, Surface, Tile};
use crate::view::Camera;

/// Bytes of a sample of which gradients are read too.
const SAMPLE_BYTES: u64 = 3 * WORD_BYTES;
/// Bytes that a point on a facet depends on: its vertices.
const POINT_BYTES: u64 = 3 * VERTEX_BYTES;

/// From a vertex on the surface to the page: eye-relative, turned, tested against six sides, projected, snapped.
const PROJECT: u64 = 60;
/// A point of a patch: ten terms of three coordinates and their weights.
const PATCH_POINT: u64 = 90;
/// The control points of a patch: three normals, six tangents, the centre.
const PATCH: u64 = 170;
/// The facing of a facet: two edges, their cross product, a dot product, three comparisons of vertices.
const FACE: u64 = 40;
/// The edge functions of a facet, their biases and steps, and its box.
const SET_UP: u64 = 80;
/// A pixel of a facet: three edge functions, depth by barycentrics, clamped.
const COVER: u64 = 20;
/// A large facet: clipped to the near plane and the guard band, edge functions in 64 bits.
const CLIP: u64 = 400;
/// A pixel and the chunks of four neighbours.
const LIST: u64 = 60;
/// A pair: the rectangle between two facets, and its facing bits.
const LOOK: u64 = 80;
/// A walk: where two rays meet their facets, each by its three vertices, and a step across a chunk.
const WALK: u64 = 2 * 100 + 80;
/// Nearest depths of a pixel against those of eight neighbours.
const TOWARD_AWAY: u64 = 40;
/// Vertices of a facet against those of eight neighbours.
const ADJACENCY: u64 = 8 * 25;
/// An edge of the rim: its two ends on the page.
const EDGE: u64 = 2 * (PATCH + PATCH_POINT + PROJECT);

/// How much a frame worked through.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Quantities {
    /// Pixels of the page.
    pub pixels: u64,
    /// Of them, those that show land.
    pub land: u64,
    /// Chunks of the lattice.
    pub chunks: u64,
    /// Of them, those that are not beside the page: their facing is found.
    pub across: u64,
    /// Chunks whose vertices are made.
    pub made: u64,
    /// Of those, the ones finer than the grid.
    pub fine: u64,
    /// Patches under them.
    pub patches: u64,
    /// Of the chunks across the page, those that are rasterized.
    pub drawn: u64,
    /// Samples under chunks whose vertices are made: of which heights are read, and of which gradients too.
    pub samples: [u64; 2],
    /// Vertices, of those made, that take the place of another, on sides shared with coarser chunks.
    pub shared: u64,
    /// Whether chunks of different levels meet.
    pub seams: bool,
    /// Vertex batches.
    pub batches: u64,
    /// Facets queued for `rasterize_large`; of several batches the last one's.
    pub queued: u64,
    /// Pixels listed by `candidates`, by `pairs`, and by `walk`.
    pub listed: [u64; 3],
    /// Edges of the rim that are drawn.
    pub rim: u64,
}

/// What a pass must move and compute.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PassCost {
    /// The pass.
    pub name: &'static str,
    /// Read and written.
    pub bytes: u64,
    /// Of one number each.
    pub operations: u64,
}

impl Quantities {
    /// What a lattice seen by a camera takes, of which the chunks in the first `seen` slots are rasterized and the
    /// vertices of those in the slots `made` are made. Pixels, lists and rim are for the caller to say.
    ///
    /// # Errors
    /// As [`Surface::pyramid`].
    pub fn of(
        plan: &Plan,
        surface: &Surface,
        lattice: &Lattice,
        seen: u32,
        made: &[u32],
        camera: &Camera,
    ) -> Result<Self> {
        let mut of = Self {
            chunks: lattice.chunks().len() as u64,
            made: made.len() as u64,
            seams: lattice.has_seams(),
            ..Self::default()
        };
        let across = across(surface, lattice, camera)?.map(|across| across || plan.thrift == Thrift::Nothing);
        for (slot, _) in (0..).zip(across).filter(|(_, across)| *across) {
            of.across += 1;
            of.drawn += u64::from(slot < seen);
        }
        // Whether a tile's gradients are read.
        let mut tiles = HashMap::new();
        for chunk in made.iter().filter_map(|slot| lattice.chunks().get(*slot as usize)) {
            of.shared += u64::from(chunk.coarser.count_ones() * CHUNK_QUADS / 2);
            let fine = chunk.step < CELL_STEPS;
            if fine {
                of.fine += 1;
                of.patches += 2 * u64::from(chunk.size().div_ceil(CELL_STEPS)).pow(2);
            }
            *tiles.entry(Tile::of(chunk)).or_default() |= fine;
        }
        let with_gradients = tiles.values().filter(|fine| **fine).count();
        of.samples = [tiles.len(), with_gradients].map(|n| n as u64 * u64::from(TILE_SAMPLES));
        Ok(of)
    }

    /// What each pass costs, in the order of a frame; `clear` stands for clears and copies.
    pub fn passes(&self, method: Method, visibility: Visibility) -> Vec<PassCost> {
        let rounds = u64::from(visibility.rounds());
        // Vertices are found anew where other batches have overwritten them.
        let vertex_rounds = if self.batches > 1 { rounds } else { 1 };
        let mut costs = vec![self.clear(method)];
        if self.made > 0 {
            costs.push(times(self.tessellate(), vertex_rounds));
        }
        if self.made > 0 && self.seams {
            costs.push(times(self.seam(), vertex_rounds));
        }
        costs.extend([self.facing(), times(self.project(), vertex_rounds)]);
        costs.extend([self.rasterize(method, visibility), times(self.rasterize_large(), rounds)]);
        costs.extend(self.silhouettes(method));
        if self.rim > 0 {
            costs.push(cost("border", self.rim * (RIM_EDGE_BYTES + 2 * 3 * SAMPLE_BYTES), self.rim * EDGE));
        }
        costs
    }

    fn clear(&self, method: Method) -> PassCost {
        cost("clear", self.pixels * (PIXEL_BYTES + WORD_BYTES + touched(method)) + self.chunks * WORD_BYTES, 0)
    }

    fn tessellate(&self) -> PassCost {
        let [heights, gradients] = self.samples;
        let of_chunk = WORD_BYTES + CHUNK_BYTES + u64::from(CHUNK_VERTICES) * VERTEX_BYTES;
        let read = heights * WORD_BYTES + gradients * (SAMPLE_BYTES - WORD_BYTES);
        let operations = self.fine * u64::from(CHUNK_VERTICES) * PATCH_POINT + self.patches * PATCH;
        cost("tessellate", read + self.made * of_chunk, operations)
    }

    fn seam(&self) -> PassCost {
        cost("seam", self.made * (WORD_BYTES + CHUNK_BYTES) + self.shared * 2 * VERTEX_BYTES, 0)
    }

    fn project(&self) -> PassCost {
        let vertices = self.drawn * u64::from(CHUNK_VERTICES);
        cost("project", self.drawn * CHUNK_BYTES + vertices * 2 * VERTEX_BYTES, vertices * PROJECT)
    }

    fn facing(&self) -> PassCost {
        let of_chunk = u64::from(CHUNK_VERTICES) * VERTEX_BYTES + u64::from(CHUNK_WORDS) * WORD_BYTES + WORD_BYTES;
        let operations = self.across * u64::from(CHUNK_FACETS) * FACE;
        cost("facing", self.chunks * CHUNK_BYTES + self.across * of_chunk, operations)
    }

    fn rasterize(&self, method: Method, visibility: Visibility) -> PassCost {
        let chunk = CHUNK_BYTES + u64::from(CHUNK_VERTICES) * VERTEX_BYTES;
        let facing = u64::from(CHUNK_WORDS) * WORD_BYTES;
        let (of_chunk, of_pixel) = match visibility {
            Visibility::Key64 => (chunk, 2 * PIXEL_BYTES),
            // The depth both ways; then it is read, and the ID goes both ways.
            Visibility::Key32 => (2 * chunk, 5 * WORD_BYTES),
            // Of toward and away at least one.
            Visibility::TwoDepths => (chunk + facing, 2 * (WORD_BYTES + touched(method))),
        };
        let bytes = self.drawn * of_chunk + self.land * of_pixel + self.queued * WORD_BYTES;
        let operations = self.drawn * u64::from(CHUNK_FACETS) * SET_UP + self.land * COVER;
        cost("rasterize", bytes, u64::from(visibility.rounds()) * operations)
    }

    fn rasterize_large(&self) -> PassCost {
        cost("rasterize_large", self.queued * (WORD_BYTES + 3 * VERTEX_BYTES), self.queued * CLIP)
    }

    fn silhouettes(&self, method: Method) -> Vec<PassCost> {
        let [candidates, pairs, rest] = self.listed;
        let facing = self.drawn * u64::from(CHUNK_WORDS) * WORD_BYTES;
        // Its own pixel, a neighbour, and the ink of one of them both ways.
        let walk = WORD_BYTES + 2 * (PIXEL_BYTES + POINT_BYTES) + 2 * WORD_BYTES;
        match method {
            Method::Walk => vec![
                cost(
                    "candidates",
                    self.pixels * PIXEL_BYTES + self.drawn * WORD_BYTES + candidates * WORD_BYTES,
                    self.pixels * LIST,
                ),
                cost(
                    "pairs",
                    candidates * (WORD_BYTES + 2 * PIXEL_BYTES + WORD_BYTES) + pairs * WORD_BYTES,
                    candidates * LOOK,
                ),
                cost("walk", pairs * walk + rest * WORD_BYTES, pairs * WALK),
                cost("walk_rest", rest * walk, rest * WALK),
            ],
            Method::TowardAway { .. } => vec![cost(
                "toward_away",
                self.pixels * (PIXEL_BYTES + touched(method) + WORD_BYTES),
                self.pixels * TOWARD_AWAY,
            )],
            Method::Adjacency { .. } => {
                let bytes = self.pixels * (PIXEL_BYTES + WORD_BYTES) + self.drawn * CHUNK_BYTES + facing;
                vec![cost("adjacency", bytes, self.land * ADJACENCY)]
            }
        }
    }
}

/// Bytes of a pixel that only wide toward-away has: the nearest away depth that touches it.
fn touched(method: Method) -> u64 {
    if method == (Method::TowardAway { wide: true }) { WORD_BYTES } else { 0 }
}

fn cost(name: &'static str, bytes: u64, operations: u64) -> PassCost {
    PassCost { name, bytes, operations }
}

fn times(of: PassCost, n: u64) -> PassCost {
    PassCost { bytes: of.bytes * n, operations: of.operations * n, ..of }
}
