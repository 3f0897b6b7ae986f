//! What each pass of a frame must move and compute: the limit beside which its time stands.
//!
//! Bytes are compulsory traffic, as in a roofline (Williams, Waterman, Patterson 2009): each value that a pass reads or
//! writes counts once, however often it is touched, and twice where it is read and written, as by an atomic. What a
//! cache would have to fetch again is not in it. Operations are additions, multiplications, divisions and comparisons of
//! one number, counted in the shaders for one vertex, facet or pixel (the constants below) and rounded; addresses and
//! flow are not in it. Both follow from how much a frame worked through, [`Quantities`], alone.
//!
//! Does not handle: facets that cover a pixel farther away than another (each pixel of land counts once, in `rasterize`),
//! the steps of walks (each pixel with open pairs counts as one pair), pixels of border lines, chunks above or below the
//! page, the quadtree and void marks on the way to a sample, uniforms and counters of a few words.

use std::collections::HashMap;

use crate::error::Result;
use crate::gpu::sizes::{CHUNK_BYTES, PIXEL_BYTES, RIM_EDGE_BYTES, VERTEX_BYTES, WORD_BYTES};
use crate::plan::passes::{Often, Over, PlannedPass};
use crate::plan::{Frame, Method, PassName, Visibility};
use crate::surface::lattice::{CELL_STEPS, CHUNK_FACETS, CHUNK_QUADS, CHUNK_VERTICES, CHUNK_WORDS};
use crate::surface::tile::TILE_SAMPLES;
use crate::surface::{Surface, Tile};

/// Bytes of the vertices of a chunk.
const VERTICES_BYTES: u64 = CHUNK_VERTICES as u64 * VERTEX_BYTES;
/// Bytes of the facing bits of a chunk.
const FACING_BYTES: u64 = CHUNK_WORDS as u64 * WORD_BYTES;
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
    /// Facets queued for `rasterize_large`; of several batches the last one's.
    pub queued: u64,
    /// Pixels listed by `candidates`, by `pairs`, and by `walk`.
    pub listed: [u64; 3],
    /// Edges of the rim.
    pub rim: u64,
}

/// What a pass must move of a buffer, bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Traffic {
    /// As shaders name it; both parts of the facing bits are `facing`.
    pub buffer: &'static str,
    /// Read.
    pub read: u64,
    /// Written.
    pub written: u64,
}

/// What a pass must move and compute.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PassCost {
    /// The pass.
    pub name: &'static str,
    /// Of every buffer that counts, once, be it nothing.
    pub traffic: Vec<Traffic>,
    /// Of one number each.
    pub operations: u64,
}

impl PassCost {
    /// Bytes read and written, of all buffers.
    pub fn bytes(&self) -> u64 {
        self.traffic.iter().map(|of| of.read + of.written).sum()
    }

    /// The same so many times.
    fn times(mut self, n: u64) -> Self {
        for of in &mut self.traffic {
            (of.read, of.written) = (of.read * n, of.written * n);
        }
        self.operations *= n;
        self
    }
}

fn cost<const N: usize>(name: &'static str, operations: u64, traffic: [Traffic; N]) -> PassCost {
    PassCost { name, traffic: traffic.into(), operations }
}

fn read(buffer: &'static str, bytes: u64) -> Traffic {
    Traffic { buffer, read: bytes, written: 0 }
}

fn written(buffer: &'static str, bytes: u64) -> Traffic {
    Traffic { buffer, read: 0, written: bytes }
}

/// So many bytes each way.
fn both(buffer: &'static str, bytes: u64) -> Traffic {
    Traffic { buffer, read: bytes, written: bytes }
}

impl Quantities {
    /// What a frame takes, of which the vertices of the chunks in the slots `made` are made. Pixels, lists and rim are for the
    /// caller to say.
    ///
    /// # Errors
    /// As [`Surface::pyramid`].
    pub fn of(frame: &Frame, surface: &Surface, made: &[u32]) -> Result<Self> {
        let chunks = frame.lattice.chunks();
        let mut of = Self { chunks: chunks.len() as u64, made: made.len() as u64, ..Self::default() };
        for (slot, _) in (0..).zip(frame.across(surface)?).filter(|(_, across)| *across) {
            of.across += 1;
            of.drawn += u64::from(slot < frame.seen);
        }
        // Whether a tile's gradients are read.
        let mut tiles = HashMap::new();
        for chunk in made.iter().filter_map(|slot| chunks.get(*slot as usize)) {
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

    /// What each pass of a frame costs, in its order; `clear` stands for clears and copies.
    pub fn passes(&self, frame: &Frame) -> Vec<PassCost> {
        let passes = frame.passes.iter().filter(|pass| self.runs(pass)).filter_map(|pass| self.pass(pass.name, frame));
        std::iter::once(self.clear(frame.plan.method)).chain(passes).collect()
    }

    /// Whether there is something for a pass to do in a frame.
    fn runs(&self, pass: &PlannedPass) -> bool {
        match pass.over {
            Over::FreshChunks => self.made > 0,
            Over::RimEdges => self.rim > 0,
            Over::Chunks | Over::AllChunks | Over::SeenChunks | Over::Found | Over::List(_) | Over::Pixels => {
                pass.often != Often::OnReading
            }
        }
    }

    /// What a pass costs over all rounds of a frame; `None` where it is not counted as part of one.
    fn pass(&self, name: PassName, frame: &Frame) -> Option<PassCost> {
        let [_, pairs, rest] = self.listed;
        let method = frame.plan.method;
        let rounds = (0..frame.visibility.rounds()).filter(|round| frame.pass(name, *round).is_some()).count() as u64;
        Some(match name {
            PassName::Tessellate => self.tessellate().times(rounds),
            PassName::Seam => self.seam().times(rounds),
            PassName::Facing => self.facing().times(rounds),
            PassName::Project => self.project().times(rounds),
            PassName::Rasterize => self.rasterize(method, frame.visibility, rounds),
            PassName::RasterizeLarge => self.rasterize_large().times(rounds),
            PassName::Candidates => self.candidates(),
            PassName::Pairs => self.pairs(),
            PassName::Walk => {
                let mut walk = self.walk("walk", "pairs", pairs, frame.keeps_vertices());
                walk.traffic.push(written("rest", rest * WORD_BYTES));
                walk
            }
            PassName::WalkRest => self.walk("walk_rest", "rest", rest, frame.keeps_vertices()),
            PassName::TowardAway => self.toward_away(method),
            PassName::Adjacency => self.adjacency(),
            PassName::Border => self.border(),
            PassName::Turning
            | PassName::Wanted
            | PassName::Turn
            | PassName::Meet
            | PassName::Crossed
            | PassName::Segments
            | PassName::RimSegments
            | PassName::Lay
            | PassName::Sight
            | PassName::Compose => return None,
        })
    }

    fn clear(&self, method: Method) -> PassCost {
        let traffic = [
            written("pixels", self.pixels * PIXEL_BYTES),
            written("ink", self.pixels * WORD_BYTES),
            written("touched", self.pixels * of_its_own(method)),
            written("summaries", self.chunks * WORD_BYTES),
        ];
        cost("clear", 0, traffic)
    }

    fn tessellate(&self) -> PassCost {
        let [heights, gradients] = self.samples;
        let traffic = [
            read("fresh", self.made * WORD_BYTES),
            read("chunks", self.made * CHUNK_BYTES),
            read("heights", heights * WORD_BYTES),
            read("gradients_east", gradients * WORD_BYTES),
            read("gradients_north", gradients * WORD_BYTES),
            written("places", self.made * VERTICES_BYTES),
        ];
        let operations = self.fine * u64::from(CHUNK_VERTICES) * PATCH_POINT + self.patches * PATCH;
        cost("tessellate", operations, traffic)
    }

    fn seam(&self) -> PassCost {
        let traffic = [
            read("fresh", self.made * WORD_BYTES),
            read("chunks", self.made * CHUNK_BYTES),
            both("places", self.shared * VERTEX_BYTES),
        ];
        cost("seam", 0, traffic)
    }

    fn facing(&self) -> PassCost {
        let traffic = [
            read("chunks", self.chunks * CHUNK_BYTES),
            read("places", self.across * VERTICES_BYTES),
            written("facing", self.across * FACING_BYTES),
            written("summaries", self.across * WORD_BYTES),
        ];
        cost("facing", self.across * u64::from(CHUNK_FACETS) * FACE, traffic)
    }

    fn project(&self) -> PassCost {
        let traffic = [
            read("chunks", self.drawn * CHUNK_BYTES),
            read("places", self.drawn * VERTICES_BYTES),
            written("screens", self.drawn * VERTICES_BYTES),
        ];
        cost("project", self.drawn * u64::from(CHUNK_VERTICES) * PROJECT, traffic)
    }

    fn rasterize(&self, method: Method, visibility: Visibility, rounds: u64) -> PassCost {
        let traffic = [read("chunks", self.drawn * CHUNK_BYTES), read("screens", self.drawn * VERTICES_BYTES)];
        let operations = self.drawn * u64::from(CHUNK_FACETS) * SET_UP + self.land * COVER;
        let mut of = cost("rasterize", operations, traffic).times(rounds);
        of.traffic.push(written("queue", self.queued * WORD_BYTES));
        let words = self.land * WORD_BYTES;
        match visibility {
            Visibility::Key64 => of.traffic.push(both("pixels", self.land * PIXEL_BYTES)),
            // The depth both ways; then it is read, and the ID goes both ways.
            Visibility::Key32 => of.traffic.push(Traffic { buffer: "pixels", read: 3 * words, written: 2 * words }),
            // Of toward and away at least one.
            Visibility::TwoDepths => of.traffic.extend([
                read("facing", self.drawn * FACING_BYTES),
                both("pixels", words),
                both("touched", self.land * of_its_own(method)),
            ]),
        }
        of
    }

    fn rasterize_large(&self) -> PassCost {
        let traffic = [read("queue", self.queued * WORD_BYTES), read("places", self.queued * POINT_BYTES)];
        cost("rasterize_large", self.queued * CLIP, traffic)
    }

    fn candidates(&self) -> PassCost {
        let traffic = [
            read("pixels", self.pixels * PIXEL_BYTES),
            read("summaries", self.drawn * WORD_BYTES),
            written("candidates", self.listed[0] * WORD_BYTES),
        ];
        cost("candidates", self.pixels * LIST, traffic)
    }

    fn pairs(&self) -> PassCost {
        let [candidates, pairs, _] = self.listed;
        let traffic = [
            read("candidates", candidates * WORD_BYTES),
            read("pixels", candidates * 2 * PIXEL_BYTES),
            read("facing", candidates * WORD_BYTES),
            written("pairs", pairs * WORD_BYTES),
        ];
        cost("pairs", candidates * LOOK, traffic)
    }

    fn toward_away(&self, method: Method) -> PassCost {
        let traffic = [
            read("pixels", self.pixels * PIXEL_BYTES),
            read("touched", self.pixels * of_its_own(method)),
            written("ink", self.pixels * WORD_BYTES),
        ];
        cost("toward_away", self.pixels * TOWARD_AWAY, traffic)
    }

    fn adjacency(&self) -> PassCost {
        let traffic = [
            read("pixels", self.pixels * PIXEL_BYTES),
            read("chunks", self.drawn * CHUNK_BYTES),
            read("facing", self.drawn * FACING_BYTES),
            written("ink", self.pixels * WORD_BYTES),
        ];
        cost("adjacency", self.land * ADJACENCY, traffic)
    }

    /// Walks from so many listed pixels: of each its own pixel and a neighbour, the points that they show, and the ink of one
    /// of them.
    fn walk(&self, name: &'static str, list: &'static str, pixels: u64, keeps_vertices: bool) -> PassCost {
        let traffic = [
            read(list, pixels * WORD_BYTES),
            read("pixels", pixels * 2 * PIXEL_BYTES),
            both("ink", pixels * WORD_BYTES),
        ];
        let mut of = cost(name, pixels * WALK, traffic);
        if keeps_vertices {
            of.traffic.push(read("places", pixels * 2 * POINT_BYTES));
        } else {
            of.traffic.extend(found_anew(pixels * 2));
        }
        of
    }

    /// Each edge has two ends, found anew.
    fn border(&self) -> PassCost {
        let mut of = cost("border", self.rim * EDGE, [read("rim", self.rim * RIM_EDGE_BYTES)]);
        of.traffic.extend(found_anew(self.rim * 2));
        of
    }
}

/// So many points of the surface, where their vertices are not at hand: each from the three samples of its patch.
fn found_anew(points: u64) -> [Traffic; 3] {
    ["heights", "gradients_east", "gradients_north"].map(|buffer| read(buffer, points * 3 * WORD_BYTES))
}

/// Bytes of a pixel that only this method has.
fn of_its_own(method: Method) -> u64 {
    method.entry().words.len() as u64 * WORD_BYTES
}
