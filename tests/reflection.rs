//! What Rust and WGSL both say, they say alike: structs, constants, bindings, the lattice. Read from the composed
//! shaders by naga, and from the device by wrapper kernels that return what a WGSL function returns.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::mem::offset_of;
use std::path::Path;

use glam::DVec2;
use hachure::door::cli::words::line;
use hachure::door::gpu::Capacity;
use hachure::door::gpu::pass::{parse, reflect};
use hachure::door::gpu::shaders::{STRIP_FACETS, source};
use hachure::door::gpu::sizes::{BLOCK, LARGEST_BINDING, fits, of_page, of_scene};
use hachure::door::gpu::uniforms::{BatchUniform, ChunkUniform, Counts, SceneUniform, Segment, Tally, code, seen};
use hachure::door::gpu::{CameraUniform, curves};
use hachure::door::measure::depth_draw;
use hachure::door::plan::PassName;
use hachure::door::plan::batches::{BATCH_CHUNKS, PART_CHUNKS};
use hachure::door::surface::rim::RimEdge;
use hachure::door::surface::{Lattice, lattice, quadtree, tile};
use hachure::line::{Kind, Pixel};
use hachure::plan::Visibility;
use wgpu::naga;

use crate::scenes::level;
use crate::{borders, frames, kernels};

mod bound;
mod declared;
mod on_device;

pub use bound::{Bound, bound};

/// Passes to ink.
const OF_INK: [PassName; 14] = [
    PassName::Tessellate,
    PassName::Seam,
    PassName::Facing,
    PassName::Project,
    PassName::Rasterize,
    PassName::RasterizeLarge,
    PassName::Candidates,
    PassName::Pairs,
    PassName::Walk,
    PassName::WalkRest,
    PassName::TowardAway,
    PassName::Adjacency,
    PassName::Border,
    PassName::Compose,
];

/// Passes that find curves.
const OF_CURVES: [PassName; 9] = [
    PassName::Turning,
    PassName::Wanted,
    PassName::Turn,
    PassName::Meet,
    PassName::Crossed,
    PassName::Segments,
    PassName::RimSegments,
    PassName::Lay,
    PassName::Sight,
];

/// Entry point and source of every pass to ink over a raster of this kind, where vertices are kept or found anew.
pub fn shaders(visibility: Visibility, keeps_vertices: bool) -> Vec<(&'static str, Cow<'static, str>)> {
    OF_INK.map(|pass| (pass.name(), source(pass, visibility, keeps_vertices))).to_vec()
}

/// Entry point and source of every pass that finds curves.
fn curve_shaders(keeps_vertices: bool) -> Vec<(&'static str, Cow<'static, str>)> {
    OF_CURVES.map(|pass| (pass.name(), source(pass, Visibility::Key64, keeps_vertices))).to_vec()
}

/// The shader of a pass over rasters of 64-bit words, with kept vertices.
pub fn shader_of(pass: PassName) -> Cow<'static, str> {
    source(pass, Visibility::Key64, true)
}

/// Entry point and source of every composed shader of a frame.
fn all_shaders() -> BTreeSet<(&'static str, Cow<'static, str>)> {
    let rasters = [Visibility::Key64, Visibility::Key32, Visibility::TwoDepths];
    let of_ink = rasters.into_iter().flat_map(|raster| [true, false].map(|keeps| shaders(raster, keeps)));
    of_ink.chain([true, false].map(curve_shaders)).flatten().collect()
}

/// Those, and the shaders of the depth draw.
fn all_modules() -> Vec<(&'static str, naga::Module)> {
    let drawn = [depth_draw::BY_PRIMITIVE, depth_draw::BY_VERTEX].map(|source| ("depth_draw", source.into()));
    let all = all_shaders().into_iter().chain(drawn);
    all.map(|(name, source)| (name, parse(name, &source).expect("valid WGSL").0)).collect()
}

/// Members of a struct: name, offset and size in bytes; and the struct's own size.
type Layout = (Vec<(String, usize, usize)>, usize);

/// The layouts of all named structs of a module.
fn layouts(module: &naga::Module) -> BTreeMap<String, Layout> {
    let size = |ty| module.types[ty].inner.size(module.to_ctx()) as usize;
    let structs = module.types.iter().filter_map(|(_, ty)| match &ty.inner {
        naga::TypeInner::Struct { members, span } => {
            let member = |m: &naga::StructMember| (m.name.clone().unwrap_or_default(), m.offset as usize, size(m.ty));
            Some((ty.name.clone()?, (members.iter().map(member).collect(), *span as usize)))
        }
        _ => None,
    });
    structs.collect()
}

/// The layout of a Rust struct. A field that is not named does not compile.
macro_rules! layout {
    ($type:ident: $($field:ident),+) => {{
        let $type { $($field),+ } = <$type as bytemuck::Zeroable>::zeroed();
        let members = vec![$((stringify!($field).to_owned(), offset_of!($type, $field), size_of_val(&$field))),+];
        (members, size_of::<$type>())
    }};
}

/// WGSL name and Rust layout of every struct both know.
fn shared_structs() -> Vec<(&'static str, Layout)> {
    vec![
        ("Scene", layout!(SceneUniform: cell, samples, roots, root_size, near)),
        (
            "Camera",
            layout!(CameraUniform: right, up, forward, eye_cell, eye_offset, eye_height, centre, focal, chunks, size, frustum, origin, seen, fresh),
        ),
        ("Batch", layout!(BatchUniform: first_slot, part_slot, round, passing)),
        ("Counts", layout!(Counts: longest_walk, orphans, cut_short)),
        ("Chunk", layout!(ChunkUniform: origin, step, coarser, low, high, beyond, tile, block, pad)),
        ("RimEdge", layout!(RimEdge: sample, direction, half)),
        ("Segment", layout!(Segment: start, fall, end, behind, at, facet, code, outward, pixel, sight)),
        ("Tally", layout!(Tally: wanted, crossed, segments, asked, cut_short)),
    ]
}

/// The constants of a module.
///
/// # Panics
/// Where one is no number.
fn constants(module: &naga::Module) -> BTreeMap<String, f64> {
    let value = |c: &naga::Constant| match module.global_expressions[c.init] {
        naga::Expression::Literal(naga::Literal::U32(n)) => f64::from(n),
        naga::Expression::Literal(naga::Literal::I32(n)) => f64::from(n),
        naga::Expression::Literal(naga::Literal::F32(n)) => f64::from(n),
        ref other => panic!("{:?} is no number: {other:?}", c.name),
    };
    module.constants.iter().filter_map(|(_, c)| Some((c.name.clone()?, value(c)))).collect()
}

/// Constants of Rust by their own names, as numbers.
macro_rules! named {
    ($($path:path),+ $(,)?) => {
        [$((stringify!($path).rsplit("::").next().unwrap_or_default(), $path as f64)),+]
    };
}

/// Name and value of every constant both know.
fn shared_constants() -> Vec<(&'static str, f64)> {
    let words = PART_CHUNKS * lattice::CHUNK_WORDS;
    assert!(words.is_power_of_two());
    let kind = |kind| f64::from(bytemuck::cast::<Pixel, [u32; 2]>(Pixel::new(kind, DVec2::ZERO, 0.0))[0]);
    let mut all = named![
        lattice::CELL_STEPS,
        lattice::CHUNK_QUADS,
        lattice::CHUNK_BLOCKS,
        lattice::CHUNK_FACETS,
        lattice::CHUNK_SIDE,
        lattice::CHUNK_VERTICES,
        lattice::CHUNK_WORDS,
        lattice::NORTH,
        lattice::EAST,
        lattice::SOUTH,
        lattice::WEST,
        quadtree::NO_SLOT,
        quadtree::INNER,
        BATCH_CHUNKS,
        curves::AROUND,
        curves::SIDE_VERTICES,
        code::LAID,
        code::AWAY_CORNER,
        code::OF_RIM,
        code::STARTS,
        code::ENDS,
        code::STARTS_TURNING,
        code::ENDS_TURNING,
        code::PART_SHIFT,
        seen::FREE,
        seen::HIDDEN,
        seen::NEAREST_FREE,
        seen::NEAREST_HIDDEN,
        seen::NOT_ASKED,
        tile::TILE_SIDE,
        tile::TILE_SAMPLES,
        STRIP_FACETS,
        // What tests say of shaders.
        frames::BESIDE,
        frames::CLIPPED,
        frames::MISSING,
        kernels::UNITS,
        borders::BORDER,
    ]
    .to_vec();
    all.extend([
        ("PART_WORDS_LOG2", f64::from(words.ilog2())),
        ("COLUMNS", f64::from(BLOCK[0])),
        ("ROWS", f64::from(BLOCK[1])),
        ("MOST_GROUPS", f64::from(wgpu::Limits::default().max_compute_workgroups_per_dimension)),
        ("KIND_SKY", kind(Kind::Sky)),
        ("KIND_COVER", kind(Kind::Cover)),
        ("KIND_SILHOUETTE", kind(Kind::Silhouette)),
        ("KIND_BORDER", kind(Kind::Border)),
    ]);
    all
}

/// What a module says of shared names, and how it differs from Rust.
fn differences(module: &naga::Module) -> (Vec<String>, Vec<String>) {
    let (structs, numbers) = (layouts(module), constants(module));
    let (mut seen, mut differ) = (Vec::new(), Vec::new());
    for (name, rust) in shared_structs() {
        let Some(wgsl) = structs.get(name) else { continue };
        seen.push(name.to_owned());
        if *wgsl != rust {
            differ.push(format!("{name}: WGSL {wgsl:?}, Rust {rust:?}"));
        }
    }
    for (name, rust) in shared_constants() {
        let Some(wgsl) = numbers.get(name) else { continue };
        seen.push(name.to_owned());
        if *wgsl != rust {
            differ.push(format!("{name}: WGSL {wgsl}, Rust {rust}"));
        }
    }
    (seen, differ)
}

/// Whether a type holds a three-component vector, whose size and stride differ between WGSL and Rust.
fn holds_vec3(module: &naga::Module, ty: naga::Handle<naga::Type>) -> bool {
    match &module.types[ty].inner {
        naga::TypeInner::Vector { size, .. } => *size == naga::VectorSize::Tri,
        naga::TypeInner::Matrix { rows, .. } => *rows == naga::VectorSize::Tri,
        naga::TypeInner::Array { base, .. } => holds_vec3(module, *base),
        naga::TypeInner::Struct { members, .. } => members.iter().any(|m| holds_vec3(module, m.ty)),
        _ => false,
    }
}

/// Names of the bound globals that hold a three-component vector.
fn globals_with_vec3(module: &naga::Module) -> Vec<String> {
    let bound = module.global_variables.iter().filter(|(_, g)| g.binding.is_some());
    bound.filter(|(_, g)| holds_vec3(module, g.ty)).map(|(_, g)| g.name.clone().unwrap_or_default()).collect()
}

#[test]
fn every_composed_shader_is_valid_and_agrees_with_rust() {
    let mut seen = Vec::new();
    for (name, source) in all_shaders() {
        let reflection = reflect(name, &source).expect("valid WGSL with this entry point");
        assert!(!reflection.bindings.is_empty(), "{name} binds nothing");
        assert!(reflection.workgroup.iter().product::<u32>() >= 32, "{name}: {:?}", reflection.workgroup);
        let (module, _) = parse(name, &source).expect("valid WGSL");
        let (found, differ) = differences(&module);
        assert!(differ.is_empty(), "{name}: {}", differ.join("; "));
        assert_eq!(globals_with_vec3(&module), Vec::<String>::new(), "{name}");
        seen.extend(found);
    }
    let all = shared_structs().into_iter().map(|(name, _)| name).chain(shared_constants().into_iter().map(|c| c.0));
    let missed: Vec<_> = all.filter(|name| !seen.iter().any(|s| s == name)).collect();
    assert!(missed.is_empty(), "no shader has {missed:?}");
}

#[test]
fn every_shader_file_is_composed_here() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let composed: Vec<_> = all_shaders().into_iter().map(|(_, source)| source).collect();
    let drawn = [depth_draw::BY_PRIMITIVE, depth_draw::BY_VERTEX];
    let mut files = 0;
    for entry in fs::read_dir(folder).expect("the shaders") {
        let path = entry.expect("an entry").path();
        let text = fs::read_to_string(&path).expect("WGSL");
        let found =
            composed.iter().any(|source| source.contains(&text)) || drawn.iter().any(|source| source.contains(&text));
        assert!(found, "{} is in no shader that is looked into", path.display());
        files += 1;
    }
    assert!(files > 20, "{files} files");
}

#[test]
fn the_depth_draw_binds_what_our_passes_leave() {
    for source in [depth_draw::BY_PRIMITIVE, depth_draw::BY_VERTEX] {
        let reflection = reflect("depth_draw", source).expect("valid WGSL with this entry point");
        assert_eq!(reflection.bindings, [(1, "camera".to_owned()), (15, "screens".to_owned())]);
        let (module, _) = parse("depth_draw", source).expect("valid WGSL");
        assert_eq!(differences(&module).1, Vec::<String>::new());
    }
}

#[test]
fn one_name_has_one_value_in_all_shaders() {
    let mut values = BTreeMap::new();
    for (name, module) in all_modules() {
        for (constant, value) in constants(&module) {
            let first = *values.entry(constant.clone()).or_insert(value);
            assert_eq!(first, value, "{constant} in {name}");
        }
    }
    assert!(values.len() > 20, "{values:?}");
}

#[test]
fn differences_between_rust_and_wgsl_are_noticed() {
    let source = shader_of(PassName::Tessellate);
    let differ = |from: &str, to: &str| {
        assert!(source.contains(from), "`{from}` is no longer there");
        let module = naga::front::wgsl::parse_str(&source.replacen(from, to, 1)).expect("WGSL");
        differences(&module).1.join("; ")
    };
    assert_eq!(differ("struct Chunk", "struct Chunk"), "");
    assert!(differ("    seen: u32, ", "    shown: u32, ").starts_with("Camera"));
    assert!(differ("coarser: u32, ", "spare: u32, coarser: u32, ").starts_with("Chunk"));
    assert!(differ("near: f32,", "near: f32, far: f32,").starts_with("Scene"));
    assert!(differ("part_slot: u32,", "slot_of_part: u32,").starts_with("Batch"));
    assert!(differ("CHUNK_VERTICES: u32 = 289u", "CHUNK_VERTICES: u32 = 288u").starts_with("CHUNK_VERTICES"));
    assert!(differ("PART_WORDS_LOG2: u32 = 25u", "PART_WORDS_LOG2: u32 = 24u").starts_with("PART_WORDS_LOG2"));
    let threes = source.replacen(" places: array<vec4<f32>>", " places: array<vec3<f32>>", 1);
    let module = naga::front::wgsl::parse_str(&threes).expect("WGSL");
    assert_eq!(globals_with_vec3(&module), ["places"]);
    assert!(reflect("tessellate", &format!("{source} fn broken() -> u32 {{ return nowhere(); }}")).is_err());
    assert!(reflect("tessellate", &format!("{source} fn broken() -> u32 {{ return 1.5; }}")).is_err());
    assert!(reflect("tesselate", &source).is_err(), "no entry point of this name");
}

#[test]
fn every_binding_fits_at_every_level() {
    // 450 x 450 samples on the largest page.
    let heights = vec![0.0; 450 * 450];
    let dem = hachure::dem::Dem::from_heights(450, glam::DVec2::splat(30.0), glam::DVec2::ZERO, heights);
    for n in [1, 2, 4, 8, 16, 32, 64] {
        let lattice = Lattice::uniform(&dem, level(n)).expect("IDs suffice");
        let chunks = lattice.chunks().len() as u64;
        let room = Capacity::of(&lattice);
        // Cells of 450 x 450 samples in tiles of 16 x 16.
        assert_eq!((room.chunks as usize, room.tiles), (lattice.chunks().len(), 29 * 29));
        assert_eq!(room.patched, if n == 1 { 0 } else { 29 * 29 }, "facets of level 1 are planes between samples");
        let sizes = [of_scene(room), of_page([16_384, 1024]).expect("a page of this size")].concat();
        for (name, size) in &sizes {
            assert!(fits(name, *size).is_ok(), "level {n}: {name} takes {size} bytes");
        }
        // Facing bits of all chunks, vertices and queue of a batch.
        let of = |wanted: &str| sizes.iter().filter(|s| s.0.starts_with(wanted)).map(|s| s.1).sum::<u64>();
        assert_eq!(of("facing"), chunks * u64::from(lattice::CHUNK_FACETS) / 8);
        assert_eq!(of("screens"), chunks.min(u64::from(BATCH_CHUNKS)) * u64::from(lattice::CHUNK_VERTICES) * 16);
        assert!(of("queue") >= 4 + chunks.min(u64::from(BATCH_CHUNKS)) * u64::from(lattice::CHUNK_FACETS) * 4);
    }
    assert!(fits("heights", LARGEST_BINDING).is_ok());
    let line = line(&fits("heights", LARGEST_BINDING + 1).expect_err("a byte too many"));
    assert!(line.contains("129 MiB of heights, a device binds 128; use --level auto or a --crop"), "{line}");
    assert!(of_page([16_384, 1025]).is_err());
}
