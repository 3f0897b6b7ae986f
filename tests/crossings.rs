//! Walks across levels against brute force in exact rationals, over the facets of lattices grown at random.
//!
//! Of every facet near the segment, collapsed ones left out, the stretch of the segment in its open interior; the first
//! away facet must come before the first missing one, and before any square without a chunk.

use glam::{DVec2, IVec2};
use hachure::dem::Dem;
use hachure::door::gpu::uniforms::SceneUniform;
use hachure::door::surface::lattice::{CHUNK_FACETS, CHUNK_QUADS};
use hachure::door::surface::quadtree::NO_SLOT;
use hachure::door::surface::{Lattice, LatticePoint};

use crate::kernels::{Share, UNITS, WALK, chunk_uniforms, entry, run, square_of};
use crate::mixed::{Kind, exists, flat, lattice, leaves, variety};
use crate::scenes::Random;
use crate::tolerances::ENTERED_STEPS;

const PAIRS: &str =
    concat!(hachure::shader!("scene", "lattice", "list", "pairs"), include_str!("kernels/pairs_probe.wgsl"));

/// A lattice with facing bits.
struct Field {
    dem: Dem,
    lattice: Lattice,
    facing: Vec<u32>,
    summaries: Vec<u32>,
    /// Corner, size and slot of every square.
    squares: Vec<([u32; 2], u32, u32)>,
    events: usize,
}

/// What a walk meets: nothing, or a facet and the place where it enters it, walk units.
type Met = Option<(u32, DVec2)>;

fn corner(at: LatticePoint) -> IVec2 {
    IVec2::new(at.x as i32, at.y as i32) * UNITS
}

/// The facet of a half of the quad at column and row of a chunk.
fn facet_in(slot: u32, [x, y]: [u32; 2], half: u32) -> u32 {
    slot * CHUNK_FACETS + (y / 8 * (CHUNK_QUADS / 8) + x / 8) * 128 + (x % 8 * 8 + y % 8) * 2 + half
}

impl Field {
    /// One facet in `rarity` is away.
    fn new(kind: Kind, rarity: u32, dropped: u32, random: &mut Random) -> Self {
        let dem = flat(kind, random);
        let lattice = lattice(&dem, kind, dropped, random);
        let facets = lattice.chunks().len() as u32 * CHUNK_FACETS;
        let (facing, summaries) = (vec![0; (facets / 32) as usize], vec![0; lattice.chunks().len()]);
        let squares = leaves(&lattice);
        let mut field = Self { facing, summaries, squares, dem, lattice, events: 0 };
        for id in 0..facets {
            let [a, b, c] = field.lattice.facet(id);
            let slot = (id / CHUNK_FACETS) as usize;
            if a == b || b == c || c == a {
                continue;
            }
            if !exists(&field.dem, [a, b, c]) {
                field.summaries[slot] |= 1 << (square_of(id) + 16);
                field.events += 1;
            } else if random.below(rarity) == 0 {
                field.facing[(id / 32) as usize] |= 1 << (id % 32);
                field.summaries[slot] |= 1 << square_of(id);
                field.events += 1;
            }
        }
        field
    }

    /// `Err` for a segment that runs along the side of a square without a chunk: on which side of it is not said.
    fn twin(&self, origin: IVec2, end: IVec2) -> Result<Met, ()> {
        let mut first: Option<(Share, Option<u32>)> = None;
        let mut note = |entry: Share, event: Option<u32>| {
            if first.as_ref().is_none_or(|(earliest, _)| entry.before(earliest)) {
                first = Some((entry, event));
            }
        };
        let touches = |low: IVec2, high: IVec2| {
            let side = |x, y| (end - origin).as_i64vec2().perp_dot((IVec2::new(x, y) - origin).as_i64vec2()).signum();
            let all = side(low.x, low.y) + side(high.x, low.y) + side(low.x, high.y) + side(high.x, high.y);
            all.abs() < 4 && low.cmple(origin.max(end)).all() && high.cmpge(origin.min(end)).all()
        };
        for (at, size, slot) in &self.squares {
            let low = IVec2::new(at[0] as i32, at[1] as i32) * UNITS;
            let high = low + *size as i32 * UNITS;
            if !touches(low, high) {
                continue;
            }
            if *slot == NO_SLOT {
                let square = [low, IVec2::new(low.x, high.y), high, IVec2::new(high.x, low.y)];
                match entry(origin, end, square) {
                    Some(entry) => note(entry, None),
                    None if (origin.x == end.x || origin.y == end.y) => return Err(()),
                    None => {}
                }
                continue;
            }
            let pair = (*size / CHUNK_QUADS) as i32 * UNITS * 2;
            for (y, x) in (0..CHUNK_QUADS as i32 / 2).flat_map(|y| (0..CHUNK_QUADS as i32 / 2).map(move |x| (y, x))) {
                let corner_of_pair = low + IVec2::new(x, y) * pair;
                if touches(corner_of_pair, corner_of_pair + pair) {
                    self.of_quads(*slot, [x as u32 * 2, y as u32 * 2], origin, end, &mut note);
                }
            }
        }
        let Some((Share(over, under), Some(id))) = first else { return Ok(None) };
        let place = origin.as_dvec2() + (end - origin).as_dvec2() * (over as f64 / under as f64);
        Ok(Some((id, place)))
    }

    /// Notes where a segment enters what stops it in two by two quads.
    fn of_quads(&self, slot: u32, at: [u32; 2], origin: IVec2, end: IVec2, note: &mut impl FnMut(Share, Option<u32>)) {
        for k in 0..8 {
            let [x, y] = [at[0] + (k >> 1) % 2, at[1] + k / 4];
            let id = facet_in(slot, [x, y], k % 2);
            let vertices = self.lattice.facet(id);
            let away = self.facing[(id / 32) as usize] >> (id % 32) & 1 == 1;
            let missing = !exists(&self.dem, vertices);
            if (away || missing)
                && let Some(entry) = entry(origin, end, vertices.map(corner))
            {
                note(entry, (!missing).then_some(id));
            }
        }
    }

    /// Whether pass `pairs` holds walks between facets open.
    fn open(&self, pairs: &[[u32; 2]]) -> Vec<bool> {
        let scene = SceneUniform::new(&self.dem, &self.lattice);
        let chunks = chunk_uniforms(&self.lattice);
        let data: [(&str, &[u8]); 6] = [
            ("scene", bytemuck::bytes_of(&scene)),
            ("chunks", bytemuck::cast_slice(&chunks)),
            ("summaries", bytemuck::cast_slice(&self.summaries)),
            ("facing_0", bytemuck::cast_slice(&self.facing)),
            ("facing_1", &[]),
            ("facet_pairs", bytemuck::cast_slice(pairs)),
        ];
        run("pairs_probe", PAIRS, &[], &data, pairs.len() as u32).chunks_exact(4).map(|f| f[0] == 1).collect()
    }

    /// A place inside a facet, walk units; `None` where it has collapsed or does not exist.
    fn inside(&self, id: u32, random: &mut Random) -> Option<IVec2> {
        let [a, b, c] = self.lattice.facet(id);
        let is_facet = a != b && b != c && c != a && exists(&self.dem, [a, b, c]);
        let [u, v] = [1 + random.below(14) as i32, 1 + random.below(14) as i32];
        let [u, v] = if u + v < 16 { [u, v] } else { [15 - u, 15 - v] };
        let from_a = |to: LatticePoint, share: i32| (corner(to) - corner(a)) / 16 * share;
        is_facet.then(|| corner(a) + from_a(b, u.max(1)) + from_a(c, v.max(1)))
    }

    /// A facet and another a few quads from it, in its chunk or beyond.
    fn pair(&self, random: &mut Random) -> Option<[u32; 2]> {
        let slot = random.below(self.lattice.chunks().len() as u32);
        // Along a side of its chunk, mostly.
        let [x, y] = match random.below(5) {
            0 => [random.below(2), random.below(CHUNK_QUADS)],
            1 => [CHUNK_QUADS - 2 + random.below(2), random.below(CHUNK_QUADS)],
            2 => [random.below(CHUNK_QUADS), random.below(2)],
            3 => [random.below(CHUNK_QUADS), CHUNK_QUADS - 2 + random.below(2)],
            _ => [random.below(CHUNK_QUADS), random.below(CHUNK_QUADS)],
        };
        let p = facet_in(slot, [x, y], random.below(2));
        let side = self.lattice.chunks()[(p / CHUNK_FACETS) as usize].step as i32 * UNITS;
        let mut off = || (random.below(7) as i32 - 3) * side / 2;
        let beyond = IVec2::new(off(), off());
        let at = (self.inside(p, random)? + beyond) / UNITS;
        let (corner, size, slot) = *self.squares.iter().find(|(corner, size, _)| {
            let inner = at - IVec2::new(corner[0] as i32, corner[1] as i32);
            inner.cmpge(IVec2::ZERO).all() && inner.cmplt(IVec2::splat(*size as i32)).all()
        })?;
        let [x, y] = [at.x as u32 - corner[0], at.y as u32 - corner[1]].map(|at| at / (size / CHUNK_QUADS));
        (slot != NO_SLOT).then(|| [p, facet_in(slot, [x, y], random.below(2))])
    }

    /// What the shader's walk meets.
    fn walk(&self, segments: &[[i32; 4]]) -> Vec<Met> {
        let scene = SceneUniform::new(&self.dem, &self.lattice);
        let chunks = chunk_uniforms(&self.lattice);
        let data: [(&str, &[u8]); 8] = [
            ("scene", bytemuck::bytes_of(&scene)),
            ("chunks", bytemuck::cast_slice(&chunks)),
            ("nodes", bytemuck::cast_slice(self.lattice.tree().nodes())),
            ("summaries", bytemuck::cast_slice(&self.summaries)),
            ("valid", bytemuck::cast_slice(self.dem.validity().expect("in memory").words())),
            ("facing_0", bytemuck::cast_slice(&self.facing)),
            ("facing_1", &[]),
            ("segments", bytemuck::cast_slice(segments)),
        ];
        let constants = [("has_voids", f64::from(u8::from(self.dem.voids() > 0))), ("defers", 0.0)];
        let found = run("walk_probe", WALK, &constants, &data, segments.len() as u32);
        let meet = |f: &[u32]| {
            assert!(f[0] < 2, "a walk was cut short");
            let from = corner(self.lattice.facet(f[1])[0]).as_dvec2();
            let entered = [f[2], f[3]].map(|bits| f64::from(f32::from_bits(bits)));
            (f[0] == 1).then(|| (f[1], from + DVec2::from(entered)))
        };
        found.chunks_exact(4).map(meet).collect()
    }
}

/// Segments in walk units between places on grids of chunks: anywhere, on lattice lines, at corners, on borders.
fn segments(field: &Field, count: usize, random: &mut Random) -> Vec<[i32; 4]> {
    let limit = IVec2::new(field.dem.columns() as i32 - 1, field.dem.rows() as i32 - 1) * 64 * UNITS;
    let chunks = field.lattice.chunks();
    let segment = || {
        let slot = random.below(chunks.len() as u32);
        let beside = (slot + random.below(5)) % chunks.len() as u32;
        let other = if random.below(2) == 0 { beside } else { random.below(chunks.len() as u32) };
        let side = chunks[slot as usize].step as i32 * UNITS;
        let mut place = |slot: u32| {
            let chunk = chunks[slot as usize];
            let side = chunk.step as i32 * UNITS;
            let grain = [1, 1, 1, side / 2, side, 2 * side, 32 * side][random.below(7) as usize];
            let mut at = || random.below((32 * side / grain) as u32 + 1) as i32 * grain;
            corner(LatticePoint { x: chunk.origin[0], y: chunk.origin[1] }) + IVec2::new(at(), at())
        };
        let (mut origin, mut end) = (place(slot), place(other));
        let reach = [1, 2, 8, 64][random.below(4) as usize];
        end = origin + (end - origin) / reach;
        match random.below(10) {
            0 => end.x = origin.x,
            1 => end.y = origin.y,
            2 => end = origin + IVec2::splat(end.x - origin.x),
            3 => end = origin + IVec2::new(end.x - origin.x, origin.x - end.x),
            4 | 5 => {
                let mut small = || random.below(9) as i32 - 4;
                let d = IVec2::new(small(), small()) * side / 2;
                origin = origin / (side / 2) * (side / 2);
                end = origin + d * (2 + random.below(40) as i32);
            }
            _ => {}
        }
        let [origin, end] = [origin, end].map(|at| at.clamp(IVec2::ZERO, limit));
        [origin.x, origin.y, end.x, end.y]
    };
    // A place alone meets nothing, even on an away facet.
    let segments = std::iter::repeat_with(segment).filter(|s| s[..2] != s[2..]);
    segments.take(count).collect()
}

const KINDS: [(Kind, u32, u32); 7] = [
    (Kind { cells: [70, 61], steps: [64, 4], rarity: 3, voids: 0 }, 400, 0),
    (Kind { cells: [70, 61], steps: [64, 4], rarity: 3, voids: 20 }, 100, 0),
    (Kind { cells: [40, 33], steps: [32, 1], rarity: 3, voids: 60 }, 60, 0),
    (Kind { cells: [256, 512], steps: [512, 16], rarity: 4, voids: 0 }, 1000, 0),
    (Kind { cells: [300, 277], steps: [256, 8], rarity: 4, voids: 0 }, 300, 5),
    (Kind { cells: [600, 400], steps: [1024, 32], rarity: 3, voids: 2 }, 200, 9),
    (Kind { cells: [20, 22], steps: [16, 1], rarity: 4, voids: 200 }, 30, 9),
];

/// Walks over so many random lattices, so many a lattice.
fn check(lattices: u64, count: usize) {
    let (mut all_seams, mut all_met) = (0, 0);
    for seed in 1..=lattices {
        let (kind, rarity, dropped) = KINDS[seed as usize % KINDS.len()];
        let mut random = Random::new(seed * 7919);
        let mut field = Field::new(kind, rarity, dropped, &mut random);
        let segments = segments(&field, count, &mut random);
        let found = field.walk(&segments);
        let ends = |s: &[i32; 4]| (IVec2::new(s[0], s[1]), IVec2::new(s[2], s[3]));
        let twins = |field: &Field| segments.iter().map(|s| field.twin(ends(s).0, ends(s).1)).collect::<Vec<_>>();
        let expected = twins(&field);
        let met = found.iter().flatten().count();
        let doubtful = expected.iter().filter(|e| e.is_err()).count();
        let [levels, seams] = variety(&field.lattice);
        let chunks = field.lattice.chunks().len();
        let mut farthest = 0.0_f64;
        for ((found, expected), segment) in found.iter().zip(&expected).zip(&segments) {
            let Ok(expected) = expected else { continue };
            let same = found.map(|(id, _)| id) == expected.map(|(id, _)| id);
            let what = format!("seed {seed}, {kind:?}: {segment:?} meets {found:?}, exactly {expected:?}");
            assert!(same, "{what}");
            if let (Some((id, at)), Some((_, exactly))) = (found, expected) {
                let side = f64::from(field.lattice.chunks()[(id / CHUNK_FACETS) as usize].step as i32 * UNITS);
                let off = at.distance(*exactly) / side;
                assert!(off <= ENTERED_STEPS, "{what}");
                farthest = farthest.max(off);
            }
        }
        println!(
            "seed {seed}: {chunks} chunks of {levels} levels, {seams} seams, {met} of {count} walks meet one, \
             {doubtful} beside nothing, entered up to {farthest:.5} steps off"
        );
        assert!(doubtful < count / 10, "{doubtful} segments along nothing are many");
        all_met += met;
        all_seams += seams;
        // Negative control: one facing bit flipped, of a facet that some walk meets.
        let Some((id, _)) = found.iter().flatten().next().copied() else { continue };
        field.facing[(id / 32) as usize] ^= 1 << (id % 32);
        let ids = |met: &Met| met.map(|(id, _)| id);
        let blind = found.iter().zip(twins(&field)).all(|(f, e)| e.is_err() || ids(f) == ids(&e.unwrap_or(None)));
        assert!(!blind, "the comparison is blind");
    }
    let least = [100, count / 10].map(|each| each * lattices as usize);
    assert!(all_seams > least[0] && all_met > least[1], "{all_seams} seams, {all_met} walks that meet one");
}

#[test]
fn walks_across_levels_meet_what_exact_arithmetic_meets() {
    check(14, 900);
}

#[test]
#[ignore = "a minute: while working on walks"]
fn many_walks_across_levels_meet_what_exact_arithmetic_meets() {
    check(300, 2000);
}

#[test]
fn pairs_that_are_closed_meet_nothing() {
    let (mut closed, mut beside) = (0, [0, 0]);
    for seed in 1..=14 {
        let (kind, _, dropped) = KINDS[seed as usize % KINDS.len()];
        let mut random = Random::new(seed * 104_729);
        let field = Field::new(kind, 12, dropped, &mut random);
        let pairs: Vec<_> = (0..20_000).filter_map(|_| field.pair(&mut random)).collect();
        for (pair, open) in pairs.iter().zip(field.open(&pairs)) {
            closed += usize::from(!open);
            let [p, q] = pair.map(|id| field.lattice.chunks()[(id / CHUNK_FACETS) as usize]);
            beside[usize::from(p != q)] += usize::from(!open && p.coarser | q.coarser != 0);
            let [Some(origin), Some(end)] = pair.map(|id| field.inside(id, &mut random)) else { continue };
            if !open && origin != end {
                let met = field.twin(origin, end);
                assert!(!matches!(met, Ok(Some(_))), "seed {seed}, {kind:?}: {pair:?} are closed and meet {met:?}");
            }
        }
    }
    println!("{closed} pairs are closed, {beside:?} of them in and between chunks beside coarser ones");
    assert!(closed > 5000 && beside.iter().all(|n| *n > 200), "{closed}, {beside:?}");
}
