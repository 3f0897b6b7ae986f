//! WGSL functions tested alone, by wrapper kernels that return what they compute: the walk and 64-bit integers.
//!
//! The walk's twin is brute force in exact rationals: of every facet in the segment's bounding box, the stretch of the
//! segment that lies in its open interior. The first away facet must come before the first missing one.

use std::collections::HashMap;

use bytemuck::Zeroable;
use glam::{DVec2, IVec2};
use hachure::dem::Dem;
use hachure::door::gpu::uniforms::{ChunkUniform, SceneUniform};
use hachure::door::surface::lattice::{CELL_STEPS, CHUNK_FACETS};
use hachure::door::surface::quadtree::NO_SLOT;
use hachure::door::surface::{Chunk, Lattice, LatticePoint};
use hachure::gpu::Gpu;
use wgpu::BufferUsages;

use crate::scenes::{Random, gpu, level};

/// Walk units in a lattice step of the finest level.
pub const UNITS: i32 = 256;
pub const WALK: &str = concat!(
    hachure::shader!(
        "scene",
        "lattice",
        "surface",
        "vertex_anew",
        "wide",
        "ink",
        "list",
        "levels",
        "walk_between",
        "walk"
    ),
    include_str!("kernels/walk_probe.wgsl")
);
const WIDE: &str = concat!(hachure::shader!("wide"), include_str!("kernels/wide_probe.wgsl"));

/// Bit of a facet's square of 4 x 4 quads in the summary of its chunk.
pub fn square_of(id: u32) -> u32 {
    let (block, quad) = (id % CHUNK_FACETS / 128, id % 128 / 2);
    let [x, y] = [block % 2 * 8 + quad / 8, block / 2 * 8 + quad % 8];
    y / 4 * 4 + x / 4
}

/// Runs a kernel over `count` invocations with these buffers and returns `results`.
pub fn run(
    name: &'static str,
    source: &str,
    constants: &[(&str, f64)],
    data: &[(&str, &[u8])],
    count: u32,
) -> Vec<u32> {
    let gpu: &Gpu = gpu();
    let size = u64::from(count) * 16;
    let mut buffers: HashMap<&str, wgpu::Buffer> = HashMap::new();
    for (label, bytes) in data.iter().copied().chain([("results", &[][..])]) {
        let usage = if label == "scene" { BufferUsages::UNIFORM } else { BufferUsages::STORAGE };
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: if label == "results" { size } else { bytes.len().max(16) as u64 },
            usage: usage | BufferUsages::COPY_DST | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        gpu.queue.write_buffer(&buffer, 0, bytes);
        buffers.insert(label, buffer);
    }
    let pass = gpu.pass(name, source.to_owned(), constants).expect("a valid shader");
    let group = pass.bind(gpu, |label| Some(buffers.get(label)?.as_entire_binding())).expect("all buffers");
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    pass.record(&mut encoder.begin_compute_pass(&Default::default()), &group, [count, 1]);
    gpu.queue.submit([encoder.finish()]);
    gpu.read(&buffers["results"], 4 * count as usize).expect("the results")
}

/// A lattice with facing bits: what a walk reads, and what its twin reads.
struct Field {
    dem: Dem,
    lattice: Lattice,
    facing: Vec<u32>,
    summaries: Vec<u32>,
    /// ID of each facet that exists, by its vertices.
    ids: HashMap<[LatticePoint; 3], u32>,
}

impl Field {
    /// A field in which one facet in `rarity` is away, with or without voids.
    fn new(subdivisions: u32, rarity: u32, voids: bool, random: &mut Random) -> Self {
        let (columns, rows) = (100 / subdivisions as usize + 3, 90 / subdivisions as usize + 3);
        let height = |i: usize, void: bool| {
            // A whole chunk.
            let in_block = |v: usize| (31..=66).contains(&(v * subdivisions as usize));
            let block = in_block(i % columns) && in_block(i / columns);
            if voids && (void || block) { f32::NAN } else { 0.0 }
        };
        let heights = (0..columns * rows).map(|i| height(i, random.below(rarity) == 0)).collect();
        let dem = Dem::from_heights(columns, DVec2::ONE, DVec2::ZERO, heights);
        let lattice = Lattice::uniform(&dem, level(subdivisions)).expect("a small lattice");
        let facets = lattice.chunks().len() as u32 * CHUNK_FACETS;
        let mut field = Self {
            facing: vec![0; (facets / 32) as usize],
            summaries: vec![0; lattice.chunks().len()],
            ids: HashMap::new(),
            dem,
            lattice,
        };
        for id in 0..facets {
            let vertices = field.lattice.facet(id);
            let slot = (id / CHUNK_FACETS) as usize;
            if !field.exists(vertices) {
                field.summaries[slot] |= 1 << (square_of(id) + 16);
                continue;
            }
            field.ids.insert(vertices, id);
            if random.below(rarity) == 0 {
                field.facing[(id / 32) as usize] |= 1 << (id % 32);
                field.summaries[slot] |= 1 << square_of(id);
            }
        }
        field
    }

    /// Whether the patch of a facet is there: by the corners of the cell and half in which its middle lies.
    fn exists(&self, vertices: [LatticePoint; 3]) -> bool {
        let [x, y] = [vertices.map(|v| v.x), vertices.map(|v| v.y)].map(|v| v.iter().sum::<u32>());
        let (c, r) = ((x / (3 * CELL_STEPS)) as usize, (y / (3 * CELL_STEPS)) as usize);
        if c + 1 >= self.dem.columns() || r + 1 >= self.dem.rows() {
            return false;
        }
        let above = x % (3 * CELL_STEPS) > y % (3 * CELL_STEPS);
        let third = if above { (c + 1, r) } else { (c, r + 1) };
        [(c, r), (c + 1, r + 1), third].into_iter().all(|(c, r)| self.dem.height(c, r).is_some())
    }

    /// The first away facet the segment meets before any that is missing; its north-west vertex and half.
    fn twin(&self, origin: IVec2, end: IVec2) -> Option<[u32; 3]> {
        let step = self.lattice.chunks()[0].step as i32;
        let side = step * UNITS;
        let low = origin.min(end).map(|v| v.div_euclid(side)) - 1;
        let high = origin.max(end).map(|v| v.div_euclid(side)) + 1;
        let mut first: Option<(Share, Option<[u32; 3]>)> = None;
        for (y, x) in (low.y..=high.y).flat_map(|y| (low.x..=high.x).map(move |x| (y, x))) {
            for half in 0..2 {
                let corners = [(0, 0), [(0, 1), (1, 1)][half], [(1, 1), (1, 0)][half]];
                let corners = corners.map(|(dx, dy)| IVec2::new(x + dx, y + dy) * side);
                let Some(entry) = entry(origin, end, corners) else { continue };
                let vertex = |v: IVec2| LatticePoint { x: (v.x / UNITS) as u32, y: (v.y / UNITS) as u32 };
                let id = if x < 0 || y < 0 { None } else { self.ids.get(&corners.map(vertex)) };
                let event = match id {
                    Some(&id) if self.facing[(id / 32) as usize] >> (id % 32) & 1 == 0 => continue,
                    Some(_) => Some([(x * step) as u32, (y * step) as u32, half as u32]),
                    None => None,
                };
                if first.as_ref().is_none_or(|(earliest, _)| entry.before(earliest)) {
                    first = Some((entry, event));
                }
            }
        }
        first?.1
    }
}

/// A share of a segment, exactly: numerator over positive denominator.
#[derive(Debug, Clone, Copy)]
pub struct Share(pub i128, pub i128);

impl Share {
    /// Whether it comes first.
    pub fn before(&self, other: &Self) -> bool {
        self.0 * other.1 < other.0 * self.1
    }
}

/// Where a segment enters the open interior of a facet, or of another convex polygon, `None` if it has no part in it.
pub fn entry<const N: usize>(origin: IVec2, end: IVec2, corners: [IVec2; N]) -> Option<Share> {
    let (mut enter, mut leave) = (Share(0, 1), Share(1, 1));
    for k in 0..N {
        let (p, q) = (corners[k].as_i64vec2(), corners[(k + 1) % N].as_i64vec2());
        // Positive inside: rows grow southwards, corners run counter-clockwise seen from above.
        let side = |v: IVec2| -i128::from((q - p).perp_dot(v.as_i64vec2() - p));
        let (a, b) = (side(origin), side(end));
        match (a > 0, b > 0) {
            (true, true) => {}
            (false, false) => return None,
            (false, true) => enter = if enter.before(&Share(-a, b - a)) { Share(-a, b - a) } else { enter },
            (true, false) => leave = if Share(a, a - b).before(&leave) { Share(a, a - b) } else { leave },
        }
    }
    enter.before(&leave).then_some(enter)
}

/// Segments in walk units: short and long, anywhere, and through lattice vertices and along lattice lines.
fn segments(field: &Field, count: usize, random: &mut Random) -> Vec<[i32; 4]> {
    let side = field.lattice.chunks()[0].step as i32 * UNITS;
    let limit = IVec2::new(field.dem.columns() as i32 - 1, field.dem.rows() as i32 - 1) * (CELL_STEPS as i32 * UNITS);
    let mut place = |grain: i32| {
        let at = |limit: i32, random: &mut Random| random.below((limit / grain) as u32 + 1) as i32 * grain;
        IVec2::new(at(limit.x, random), at(limit.y, random))
    };
    let mut kinds = Random::new(99);
    let mut segment = || {
        let grain = [1, 1, side / 2, side, side / 4][kinds.below(5) as usize];
        let (mut origin, mut end) = (place(grain), place(grain));
        let reach = [1, 4, 16, 64][kinds.below(4) as usize];
        end = origin + (end - origin) / reach;
        match kinds.below(8) {
            0 => end.x = origin.x,
            1 => end.y = origin.y,
            2 => end = origin + IVec2::splat(end.x - origin.x),
            3 => end = origin + IVec2::new(end.x - origin.x, origin.x - end.x),
            // From vertex to vertex through others: quads entered by a corner.
            4 | 5 => {
                let mut small = || kinds.below(7) as i32 - 3;
                let d = IVec2::new(small(), small()) * side;
                origin = origin / side * side;
                end = origin + d * (2 + kinds.below(9) as i32);
            }
            _ => {}
        }
        let end = end.clamp(IVec2::ZERO, limit);
        [origin.x, origin.y, end.x, end.y]
    };
    (0..count).map(|_| segment()).collect()
}

/// The chunks as a walk knows them, without samples.
pub fn chunk_uniforms(lattice: &Lattice) -> Vec<ChunkUniform> {
    let uniform = |c: &Chunk| ChunkUniform { origin: c.origin, step: c.step, coarser: c.coarser, ..Zeroable::zeroed() };
    lattice.chunks().iter().map(uniform).collect()
}

/// What the shader's walk finds for each segment: met, x, y and half of the facet.
fn walk(field: &Field, segments: &[[i32; 4]]) -> Vec<Option<[u32; 3]>> {
    let scene = SceneUniform::new(&field.dem, &field.lattice);
    let chunks = chunk_uniforms(&field.lattice);
    let valid = field.dem.validity().expect("in memory").words();
    let data: [(&str, &[u8]); 8] = [
        ("scene", bytemuck::bytes_of(&scene)),
        ("chunks", bytemuck::cast_slice(&chunks)),
        ("nodes", bytemuck::cast_slice(field.lattice.tree().nodes())),
        ("summaries", bytemuck::cast_slice(&field.summaries)),
        ("valid", bytemuck::cast_slice(valid)),
        ("facing_0", bytemuck::cast_slice(&field.facing)),
        ("facing_1", &[]),
        ("segments", bytemuck::cast_slice(segments)),
    ];
    let constants = [("has_voids", f64::from(u8::from(field.dem.voids() > 0))), ("defers", 0.0)];
    let found = run("walk_probe", WALK, &constants, &data, segments.len() as u32);
    let place = |id: u32| {
        let a = field.lattice.facet(id)[0];
        [a.x, a.y, id % 2]
    };
    found.chunks_exact(4).map(|f| (f[0] == 1).then(|| place(f[1]))).collect()
}

#[test]
fn walks_meet_what_exact_arithmetic_meets() {
    let mut random = Random::new(5);
    for (subdivisions, rarity, voids) in
        [(1, 30, true), (2, 300, false), (1, 600, true), (4, 60, true), (8, 500, false)]
    {
        let mut field = Field::new(subdivisions, rarity, voids, &mut random);
        let segments = segments(&field, 3000, &mut random);
        let found = walk(&field, &segments);
        let expected = |field: &Field| -> Vec<Option<[u32; 3]>> {
            segments.iter().map(|s| field.twin(IVec2::new(s[0], s[1]), IVec2::new(s[2], s[3]))).collect()
        };
        let met = found.iter().flatten().count();
        println!("level {subdivisions}, 1 in {rarity} away, voids {voids}: {met} of {} walks meet one", segments.len());
        assert!(met > 50 && met < segments.len() - 50, "a dull field");
        assert!(!voids || field.lattice.tree().nodes().contains(&NO_SLOT), "no chunk is void");
        let wrong = found.iter().zip(expected(&field)).position(|(f, e)| *f != e);
        if let Some(i) = wrong {
            let [a, b, c, d] = segments[i];
            let twin = field.twin(IVec2::new(a, b), IVec2::new(c, d));
            panic!("level {subdivisions}: {:?} meets {:?}, exactly {twin:?}", segments[i], found[i]);
        }
        // Negative control: one facing bit flipped, of a facet that some walk meets.
        let [x, y, half] = found.iter().flatten().next().copied().expect("one is met");
        let id = (0..field.lattice.chunks().len() as u32 * CHUNK_FACETS)
            .find(|id| field.lattice.facet(*id)[0] == LatticePoint { x, y } && id % 2 == half)
            .expect("the facet met");
        field.facing[(id / 32) as usize] ^= 1 << (id % 32);
        assert_ne!(found, expected(&field), "the comparison is blind");
    }
}

#[test]
fn wide_integers_are_those_of_i64() {
    let mut random = Random::new(3);
    let extremes = [0, 1, u32::MAX, 0x8000_0000, 0x7fff_ffff, 0xffff, 0x10000];
    let mut next = || if random.below(3) == 0 { extremes[random.below(7) as usize] } else { random.bits() };
    let inputs: Vec<[u32; 4]> = (0..20_000).map(|_| [next(), next(), next(), next()]).collect();
    for op in 0..6_u32 {
        let exact = |&[a, b, c, d]: &[u32; 4]| {
            let (p, q) = (u64::from(a) | u64::from(b) << 32, u64::from(c) | u64::from(d) << 32);
            match op {
                0 => u64::from(a) * u64::from(b),
                1 => (i64::from(a as i32) * i64::from(b as i32)) as u64,
                2 => p.wrapping_add(q),
                3 => p.wrapping_sub(q),
                4 => p.wrapping_mul(u64::from(c & 63)),
                _ => (p as i64).signum() as i32 as u32 as u64,
            }
        };
        let constants = [("operation", f64::from(op))];
        let data: [(&str, &[u8]); 1] = [("operands", bytemuck::cast_slice(&inputs))];
        let found = run("wide_probe", WIDE, &constants, &data, inputs.len() as u32);
        let values = found.chunks_exact(4).map(|f| u64::from(f[0]) | u64::from(f[1]) << 32);
        let wrong = values.zip(&inputs).find(|(value, input)| *value != exact(input));
        assert!(wrong.is_none(), "operation {op}: {wrong:x?}");
        // Negative control: results compared with their neighbours' operands.
        let values = found.chunks_exact(4).map(|f| u64::from(f[0]) | u64::from(f[1]) << 32);
        let blind = values.zip(&inputs[1..]).all(|(value, input)| value == exact(input));
        assert!(!blind, "operation {op}: the comparison is blind");
    }
}
