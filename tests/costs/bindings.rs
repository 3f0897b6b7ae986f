//! Costs beside what passes bind: which buffers, and which way, the shaders say; how large those are, the sizes of their
//! making; how large an item is, the layout in WGSL.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::door::gpu::Capacity;
use hachure::door::gpu::sizes::{LIST_HEADER, RIM_EDGE_BYTES, of_page, of_scene};
use hachure::door::measure::cost::{PassCost, Quantities, Traffic};
use hachure::door::measure::costs;
use hachure::door::plan::PassName;
use hachure::door::surface::Lattice;
use hachure::door::surface::lattice::{CHUNK_FACETS, CHUNK_VERTICES, CHUNK_WORDS};
use hachure::door::surface::rim::rim_length;
use hachure::door::surface::tile::TILE_SAMPLES;
use hachure::gpu::Gpu;
use hachure::plan::{Border, Detail, Method, Plan, Visibility};
use hachure::render::Drawn;
use hachure::surface::Surface;
use hachure::view::Camera;

use super::{bytes, flat, frame, from_south, in_two_batches, on_page};
use crate::frames::{METHODS, Planned};
use crate::reflection::{Bound, bound, shader_of, shaders};
use crate::scenes::{gpu, gpu_without_int64, level, rough};

/// Buffers of samples.
const OF_SAMPLES: [&str; 3] = ["heights", "gradients_east", "gradients_north"];

/// What passes bind and costs leave out: the pass, the buffers, why.
const UNCOUNTED: [(&str, &[&str], &str); 10] = [
    ("tessellate", &["valid"], "marks of voids, a bit a sample"),
    ("rasterize_large", &["chunks", "screens", "facing"], "few chunks hold facets that are large"),
    ("rasterize_large", &["pixels", "touched"], "each pixel of land counts once, in rasterize"),
    ("pairs", &["chunks", "summaries"], "candidates lie side by side in few chunks"),
    ("walk", &["chunks", "nodes", "valid", "facing", "summaries", "counts"], "steps of walks"),
    ("walk_rest", &["chunks", "nodes", "valid", "facing", "summaries", "counts"], "steps of walks"),
    ("walk", &OF_SAMPLES, "the surface under few facets, those in doubt"),
    ("walk_rest", &OF_SAMPLES, "the surface under few facets, those in doubt"),
    ("adjacency", &["valid"], "marks of voids, a bit a sample"),
    ("border", &["chunks", "nodes", "facing", "pixels", "ink"], "pixels of border lines"),
];

/// Passes over lists.
const BY_ITEM: [&str; 5] = ["rasterize_large", "pairs", "walk", "walk_rest", "border"];

/// Bytes of every buffer, by the name that costs have for it.
type Sizes = BTreeMap<String, u64>;

fn sizes(lattice: &Lattice, rim_edges: u64, page: [u32; 2]) -> Sizes {
    let mut sizes = Sizes::from([("rim".to_owned(), rim_edges * RIM_EDGE_BYTES)]);
    let of_page = of_page(page).expect("a page of this size");
    for (name, size) in of_scene(Capacity::of(lattice)).into_iter().chain(of_page) {
        *sizes.entry(if name.starts_with("facing") { "facing" } else { name }.to_owned()).or_default() += size;
    }
    sizes
}

/// What the passes of a raster of this kind bind, each by its name, where vertices are kept or found anew.
type Passes = BTreeMap<&'static str, BTreeMap<String, Bound>>;

fn passes(visibility: Visibility, keeps_vertices: bool) -> Passes {
    shaders(visibility, keeps_vertices).into_iter().map(|(name, source)| (name, bound(name, &source))).collect()
}

/// What is wrong with costs beside what passes bind, where facets are rasterized in so many rounds.
fn faults(costs: &[PassCost], passes: &Passes, sizes: &Sizes, rounds: u64) -> Vec<String> {
    let mut faults = Vec::new();
    for PassCost { name, traffic, .. } in costs.iter().filter(|cost| cost.name != "clear") {
        let Some(binds) = passes.get(name) else {
            faults.push(format!("there is no pass {name}"));
            continue;
        };
        // Passes over lists take each item by itself, and may come to a value twice.
        let most = if BY_ITEM.contains(name) { None } else { Some(rounds) };
        for of in traffic {
            faults.extend(
                wrong(of, binds.get(of.buffer), sizes.get(of.buffer), most).map(|what| format!("{name} {what}")),
            );
        }
        // Where vertices are not at hand, walks find all of them anew from the samples.
        let finds_anew = |buffer: &str| !binds.contains_key("places") && OF_SAMPLES.contains(&buffer);
        let of_pass = |buffer: &str| UNCOUNTED.iter().any(|(pass, of, _)| pass == name && of.contains(&buffer));
        let left_out = |buffer: &str| of_pass(buffer) && !finds_anew(buffer);
        for (buffer, bound) in binds.iter().filter(|(buffer, _)| !left_out(buffer)) {
            if !traffic.iter().any(|of| of.buffer == buffer) {
                let verb = if bound.is_out { "writes" } else { "reads" };
                faults.push(format!("{name} {verb} {buffer}, which costs nothing"));
            }
        }
    }
    faults
}

/// What is wrong with the traffic of one buffer, which may be read and written `most` times.
fn wrong(of: &Traffic, bound: Option<&Bound>, size: Option<&u64>, most: Option<u64>) -> Option<String> {
    let Traffic { buffer, read, written } = of;
    let (Some(bound), Some(size)) = (bound, size) else { return Some(format!("does not bind {buffer}")) };
    if *written > 0 && !bound.is_out || *read > 0 && !bound.is_read {
        return Some(format!("reads {read} bytes of {buffer} and writes {written}, and is {bound:?} to it"));
    }
    if [read, written].into_iter().any(|bytes| bytes % bound.item != 0) {
        return Some(format!("moves parts of items of {} bytes of {buffer}", bound.item));
    }
    if most.is_some_and(|most| *read.max(written) > most * size) {
        return Some(format!("moves {read} and {written} bytes of {buffer}, which has {size}"));
    }
    None
}

/// A frame with all that its costs stand beside.
struct Measured {
    frame: Drawn,
    costs: Vec<PassCost>,
    sizes: Sizes,
    visibility: Visibility,
    /// As they were timed.
    names: Vec<&'static str>,
}

fn drawn(gpu: &Arc<Gpu>, surface: &Arc<Surface>, camera: &Camera, plan: Plan) -> Measured {
    let page = [camera.width, camera.height];
    let mut renderer = Planned::new(gpu, surface, plan);
    let timed = renderer.timed_frame(camera).expect("a timed frame");
    let left = renderer.read().expect("its ink");
    let costs = costs(&renderer, &left).expect("costs");
    let rim_edges = if plan.border == Border::On { rim_length(surface.dem()).expect("a rim") } else { 0 };
    Measured {
        frame: left,
        costs,
        sizes: sizes(&renderer.lattice(), rim_edges, page),
        visibility: plan.method.visibility(gpu.int64),
        names: timed.passes.iter().map(|pass| pass.name).collect(),
    }
}

#[test]
fn costs_are_of_what_passes_bind() {
    let surface = Arc::new(Surface::new(rough(70, 60, 1.0, 6.0, true)));
    let camera = from_south(&surface);
    let details: [Detail; 2] = [level(4).into(), Detail::default()];
    let mut seen = Vec::new();
    for (name, method) in METHODS {
        for gpu in [gpu(), gpu_without_int64()] {
            for detail in details {
                let drawn = drawn(gpu, &surface, &camera, Plan::new(detail, method, Border::On));
                let names: Vec<_> = drawn.costs.iter().map(|cost| cost.name).collect();
                assert_eq!(names, drawn.names, "{name}, {detail:?}");
                let rounds = u64::from(drawn.visibility.rounds());
                let faults = faults(&drawn.costs, &passes(drawn.visibility, true), &drawn.sizes, rounds);
                assert_eq!(faults, Vec::<String>::new(), "{name}, {detail:?}, {:?}", drawn.visibility);
                for cost in &drawn.costs {
                    let idle = ["rasterize_large", "walk_rest"].contains(&cost.name);
                    assert!(cost.bytes() > 0 || idle, "{name}, {detail:?}: {cost:?}");
                }
                if method == Method::Walk {
                    let inked = drawn.frame.inked() as u64;
                    let pairs = bytes(&drawn.costs, "pairs");
                    assert!(pairs > 4 * inked / 8 && inked > 0, "{detail:?}: lists were not read back");
                }
                seen.extend(names);
            }
        }
    }
    // Reading back is no part of a frame.
    let all = [Visibility::Key64, Visibility::TwoDepths].into_iter().flat_map(|visibility| shaders(visibility, true));
    let missed: Vec<_> = all.map(|(name, _)| name).filter(|name| *name != "compose" && !seen.contains(name)).collect();
    assert!(missed.is_empty(), "no frame had {missed:?}");
}

#[test]
fn what_costs_leave_out_is_bound() {
    for (pass, buffers, why) in UNCOUNTED {
        assert!(!why.is_empty());
        let rasters = [Visibility::Key64, Visibility::TwoDepths];
        let bound: Vec<_> = rasters.into_iter().flat_map(|raster| passes(raster, true)[pass].clone()).collect();
        let stale: Vec<_> = buffers.iter().filter(|buffer| !bound.iter().any(|(name, _)| name == *buffer)).collect();
        assert!(stale.is_empty(), "{pass} does not bind {stale:?}");
    }
}

/// A test of [`faults`]: with costs and passes spoilt like this it finds these.
fn found(spoil: impl Fn(&mut Vec<PassCost>, &mut Passes)) -> String {
    let surface = flat();
    let lattice = Lattice::uniform(surface.dem(), level(2)).expect("a lattice");
    let mut costs = Quantities { pixels: 3072, ..on_page() }.passes(&frame(2, true));
    let mut passes = passes(Visibility::Key64, true);
    spoil(&mut costs, &mut passes);
    faults(&costs, &passes, &sizes(&lattice, 64, [64, 48]), 1).join("; ")
}

/// The traffic of a buffer in a pass.
fn of<'a>(costs: &'a mut [PassCost], pass: &str, buffer: &str) -> &'a mut Traffic {
    let cost = costs.iter_mut().find(|cost| cost.name == pass).expect("the pass");
    cost.traffic.iter_mut().find(|of| of.buffer == buffer).expect("the buffer")
}

#[test]
fn costs_that_are_wrong_are_noticed() {
    assert_eq!(found(|_, _| ()), "");
    let stranger = Traffic { buffer: "heights", read: 4, written: 0 };
    assert_eq!(found(|costs, _| costs[3].traffic.push(stranger)), "project does not bind heights");
    let forgotten = found(|costs, _| costs[2].traffic.retain(|of| of.buffer != "summaries"));
    assert_eq!(forgotten, "facing writes summaries, which costs nothing");
    let unread = found(|costs, _| costs[3].traffic.retain(|of| of.buffer != "places"));
    assert_eq!(unread, "project reads places, which costs nothing");
    let stride = found(|costs, _| of(costs, "project", "chunks").read = 4 * 36);
    assert_eq!(stride, "project moves parts of items of 40 bytes of chunks");
    let twice = found(|costs, _| of(costs, "project", "screens").written *= 2);
    assert!(twice.starts_with("project moves 0 and 36992 bytes of screens, which has 18496"), "{twice}");
    let written = found(|costs, _| of(costs, "project", "places").written = 16);
    assert!(written.starts_with("project reads 18496 bytes of places and writes 16"), "{written}");
    assert_eq!(found(|costs, _| costs[3].name = "shade"), "there is no pass shade");
    // A shader that does more than it did.
    let more = found(|_, passes| {
        let summaries = passes["facing"]["summaries"].clone();
        passes.get_mut("project").expect("the pass").insert("summaries".into(), summaries);
    });
    assert_eq!(more, "project writes summaries, which costs nothing");
}

#[test]
fn costs_of_several_batches_are_of_what_their_passes_bind() {
    let surface = flat();
    let lattice = Lattice::uniform(surface.dem(), level(2)).expect("a lattice");
    let sizes = sizes(&lattice, 64, [64, 48]);
    for (int64, visibility) in [(true, Visibility::Key64), (false, Visibility::Key32)] {
        let costs = Quantities { pixels: 3072, ..on_page() }.passes(&in_two_batches(frame(2, int64)));
        let rounds = u64::from(visibility.rounds());
        let faults = |keeps_vertices| faults(&costs, &passes(visibility, keeps_vertices), &sizes, rounds);
        assert_eq!(faults(false), Vec::<String>::new(), "{visibility:?}");
        let kept = faults(true).join("; ");
        assert!(kept.contains("walk reads places, which costs nothing"), "{kept}");
    }
}

/// Where chunks of 512 facets cover the page and all of them appear: straight down on 33 x 33 samples, a little more land than
/// page.
fn covered() -> (Arc<Surface>, Camera) {
    let heights = (0..33 * 33).map(|i| ((i * 7919) % 13) as f32 * 0.1).collect();
    let surface = Arc::new(Surface::new(Dem::from_heights(33, DVec2::splat(10.0), DVec2::ZERO, heights)));
    let [west, south, east, north] = surface.dem().extent();
    let eye = DVec3::new((west + east) / 2.0, (south + north) / 2.0, 250.0);
    (surface, Camera { eye, azimuth: 0.0, altitude: -90.0, fov: 60.0, width: 64, height: 64 })
}

/// Of a buffer in a pass of a frame that touches everything, how much is read and written, in halves of its size. `None` where
/// lists or neighbours decide.
fn whole(pass: &str, buffer: &str, visibility: Visibility) -> Option<[u64; 2]> {
    let decided = ["seam", "rasterize_large", "pairs", "walk", "walk_rest", "border"].contains(&pass);
    if decided || ["queue", "candidates"].contains(&buffer) {
        return None;
    }
    Some(match (pass, buffer, visibility) {
        ("rasterize", "chunks" | "screens", Visibility::Key32) => [4, 0],
        // Depth and ID are one word each: the depth is read once more.
        ("rasterize", "pixels", Visibility::Key32) => [3, 2],
        // Toward alone.
        ("rasterize", "pixels", Visibility::TwoDepths) => [1, 1],
        ("rasterize", "pixels" | "touched", _) => [2, 2],
        ("clear", ..) | ("tessellate", "places", _) | ("facing", "facing" | "summaries", _) => [0, 2],
        ("project", "screens", _) | (_, "ink", _) => [0, 2],
        _ => [2, 0],
    })
}

/// Where the costs of a frame are not those of one that touches everything.
fn parts(drawn: &Measured, method: Method) -> Vec<String> {
    let mut parts = Vec::new();
    for PassCost { name, traffic, .. } in &drawn.costs {
        for of in traffic.iter().filter(|of| of.buffer != "touched" || method == Method::TowardAway { wide: true }) {
            let Some(halves) = whole(name, of.buffer, drawn.visibility) else { continue };
            let size = drawn.sizes[of.buffer];
            if [2 * of.read, 2 * of.written] != halves.map(|halves| halves * size) {
                parts.push(format!("{name}: {of:?} of {size}"));
            }
        }
    }
    parts
}

#[test]
fn a_frame_that_touches_everything_costs_every_buffer_whole() {
    let (surface, camera) = covered();
    for (name, method) in METHODS {
        for gpu in [gpu(), gpu_without_int64()] {
            for n in [1, 4] {
                let drawn = drawn(gpu, &surface, &camera, Plan::new(level(n), method, Border::Off));
                assert_eq!(parts(&drawn, method), Vec::<String>::new(), "{name} at level {n}, {:?}", drawn.visibility);
            }
        }
    }
    // Half of the page is sky, and part of the chunks is beside it.
    let away = Camera { altitude: -50.0, ..camera };
    let drawn = drawn(gpu(), &surface, &away, Plan::new(level(4), Method::Walk, Border::Off));
    let parts = parts(&drawn, Method::Walk).join("; ");
    assert!(parts.contains("rasterize: Traffic { buffer: \"pixels\"") && parts.contains("facing: "), "{parts}");
}

#[test]
fn buffers_hold_whole_items_as_shaders_lay_them_out() {
    let (surface, _) = covered();
    let lattice = Lattice::uniform(surface.dem(), level(4)).expect("a lattice");
    let (chunks, page) = (lattice.chunks().len() as u64, [64, 48]);
    let (pixels, tiles) = (64 * 48, 4 * u64::from(TILE_SAMPLES));
    let [vertices, facets, words] =
        [CHUNK_VERTICES, CHUNK_FACETS, CHUNK_WORDS].map(|of_chunk| chunks * u64::from(of_chunk));
    let items = BTreeMap::from([
        ("chunks", chunks),
        ("summaries", chunks),
        ("fresh", chunks),
        ("facing", words),
        ("places", vertices),
        ("screens", vertices),
        ("heights", tiles),
        ("gradients_east", tiles),
        ("gradients_north", tiles),
        ("pixels", pixels),
        ("touched", pixels),
        ("ink", pixels),
        ("page", pixels),
        ("queue", facets),
        ("candidates", pixels),
        ("pairs", pixels),
        ("rest", pixels),
        ("nodes", lattice.tree().nodes().len() as u64),
        ("rim", 128),
    ]);
    let sizes = sizes(&lattice, 128, page);
    let mut seen = Vec::new();
    for visibility in [Visibility::Key64, Visibility::Key32, Visibility::TwoDepths] {
        for (pass, binds) in [true, false].into_iter().flat_map(|keeps_vertices| passes(visibility, keeps_vertices)) {
            for (buffer, bound) in binds.iter().filter(|(buffer, _)| !["valid", "counts"].contains(&buffer.as_str())) {
                // Two atomic words of a pixel are two items.
                let parts = if buffer == "pixels" { 8 / bound.item } else { 1 };
                let size = bound.header + items[buffer.as_str()] * parts * bound.item;
                assert_eq!(sizes[buffer], size, "{pass}: {buffer}");
                let is_list = ["queue", "candidates", "pairs", "rest"].contains(&buffer.as_str());
                assert_eq!(bound.header, if is_list { LIST_HEADER } else { 0 }, "{pass}: {buffer}");
                seen.push(buffer.clone());
            }
        }
    }
    let missed: Vec<_> = items.keys().filter(|name| !seen.iter().any(|seen| seen == *name)).collect();
    assert!(missed.is_empty(), "no pass binds {missed:?}");
    // A chunk that grows in the shader alone.
    let grown = shader_of(PassName::Project).replacen("pad: u32,", "pad: u32, more: vec2<u32>,", 1);
    assert_ne!(sizes["chunks"], chunks * bound("project", &grown)["chunks"].item);
}
