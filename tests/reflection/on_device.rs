//! The lattice on the device: wrapper kernels return what the WGSL functions return, compared with `Lattice` and with
//! the drawing of a quad and its neighbours.

use glam::DVec2;
use hachure::dem::Dem;
use hachure::door::gpu::uniforms::SceneUniform;
use hachure::door::surface::lattice::CHUNK_FACETS;
use hachure::door::surface::quadtree::NO_SLOT;
use hachure::door::surface::{Lattice, LatticePoint};
use hachure::gpu::Gpu;
use wgpu::util::{BufferInitDescriptor, DeviceExt};

use crate::common::gpu;
use crate::kernels::chunk_uniforms;
use crate::scenes::level;

/// Eight words a facet: its three vertices, its ID again by way of its place, its half.
const DECODE: &str = concat!(
    hachure::shader!("scene", "lattice"),
    "
    @group(0) @binding(20) var<storage, read_write> out_values: array<u32>;

    @compute @workgroup_size(64)
    fn decode(@builtin(global_invocation_id) invocation: vec3<u32>) {
        let id = invocation.x;
        if id >= arrayLength(&out_values) / 8u {
            return;
        }
        let f = facet_of(id);
        for (var k = 0u; k < 3u; k++) {
            let v = array<vec2<u32>, 3>(f.a, f.b, f.c)[k];
            out_values[8u * id + 2u * k] = v.x;
            out_values[8u * id + 2u * k + 1u] = v.y;
        }
        let step = chunks[id / CHUNK_FACETS].step;
        let local = quad_local(f.a / step % CHUNK_QUADS) + id % 2u;
        out_values[8u * id + 6u] = slot_at(vec2<i32>(f.a)) * CHUNK_FACETS + local;
        out_values[8u * id + 7u] = slot_at(vec2<i32>(f.a) - 2097152);
    }"
);

/// One word a pair of facets: how many lattice vertices they have in common.
const PAIRS: &str = concat!(
    hachure::shader!("scene", "lattice", "ink", "adjacency"),
    "
    @group(0) @binding(20) var<storage, read_write> out_values: array<u32>;
    @group(0) @binding(21) var<storage, read> pairs: array<vec2<u32>>;

    @compute @workgroup_size(64)
    fn common_vertices(@builtin(global_invocation_id) invocation: vec3<u32>) {
        if invocation.x < arrayLength(&out_values) {
            let pair = pairs[invocation.x];
            out_values[invocation.x] = shares(facet_of(pair.x), facet_of(pair.y));
        }
    }"
);

/// 6 x 4 chunks at level 2, four of them all void.
fn lattice() -> (Dem, Lattice) {
    let [columns, rows] = [47, 31];
    let void = |i: usize| (15..=33).contains(&(i % columns)) && i / columns <= 17;
    let heights = (0..columns * rows).map(|i| if void(i) { f32::NAN } else { 7.0 }).collect();
    let dem = Dem::from_heights(columns, DVec2::splat(10.0), DVec2::ZERO, heights);
    let lattice = Lattice::uniform(&dem, level(2)).expect("IDs suffice");
    assert_eq!(lattice.tree().roots(), [6, 4]);
    let rows = [
        [0, 1, NO_SLOT, NO_SLOT, 2, 3],
        [4, 5, NO_SLOT, NO_SLOT, 6, 7],
        [8, 9, 10, 11, 12, 13],
        [14, 15, 16, 17, 18, 19],
    ];
    assert_eq!(lattice.tree().nodes(), rows.as_flattened());
    (dem, lattice)
}

/// Runs a wrapper kernel over `count` invocations of `words` words each.
fn run(gpu: &Gpu, name: &'static str, source: &str, pairs: &[[u32; 2]], count: u32, words: u32) -> Vec<u32> {
    let (dem, lattice) = lattice();
    let scene = SceneUniform::new(&dem, &lattice);
    let storage = wgpu::BufferUsages::STORAGE;
    let upload =
        |contents: &[u8], usage| gpu.device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage });
    let size = u64::from(count) * u64::from(words) * 4;
    let usage = storage | wgpu::BufferUsages::COPY_SRC;
    let values = wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false };
    let values = gpu.device.create_buffer(&values);
    let buffers = [
        ("scene", upload(bytemuck::bytes_of(&scene), wgpu::BufferUsages::UNIFORM)),
        ("chunks", upload(bytemuck::cast_slice(&chunk_uniforms(&lattice)), storage)),
        ("nodes", upload(bytemuck::cast_slice(lattice.tree().nodes()), storage)),
        ("pairs", upload(bytemuck::cast_slice(pairs), storage)),
        ("values", values),
    ];
    let pass = gpu.pass(name, source.to_owned(), &[]).expect("the wrapper compiles");
    let named = |wanted: &str| buffers.iter().find(|b| b.0 == wanted).map(|b| b.1.as_entire_binding());
    let group = pass.bind(gpu, named).expect("the wrapper binds");
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    pass.record(&mut encoder.begin_compute_pass(&Default::default()), &group, [count, 1]);
    gpu.queue.submit([encoder.finish()]);
    gpu.read(&buffers[4].1, (count * words) as usize).expect("a copy of the values")
}

/// How many facets the device places elsewhere than the CPU does, and how many it does not find again.
fn misplaced(source: &str) -> [usize; 2] {
    let (_, lattice) = lattice();
    let count = lattice.chunks().len() as u32 * CHUNK_FACETS;
    let values = run(gpu(), "decode", source, &[[0; 2]], count, 8);
    assert_eq!(values.len(), 8 * count as usize);
    let (mut elsewhere, mut lost) = (0, 0);
    for (id, found) in (0..count).zip(values.chunks_exact(8)) {
        let vertices = [0, 2, 4].map(|i| LatticePoint { x: found[i], y: found[i + 1] });
        elsewhere += usize::from(vertices != lattice.facet(id));
        lost += usize::from(found[6] != id || found[7] != NO_SLOT);
    }
    [elsewhere, lost]
}

#[test]
fn facets_are_the_same_on_device_and_cpu() {
    assert_eq!(misplaced(DECODE), [0, 0]);
    let turned = DECODE.replace("0x1cu", "0x34u");
    assert!(misplaced(&turned)[0] > 1000, "corners in another order must be noticed");
    let transposed = DECODE.replace("(quad.x & 7u) * 8u + (quad.y & 7u)", "(quad.y & 7u) * 8u + (quad.x & 7u)");
    assert!(misplaced(&transposed)[1] > 1000, "another order of quads must be noticed");
}

/// IDs by place: quad across and down, and which half.
fn by_place(lattice: &Lattice) -> std::collections::HashMap<[u32; 3], u32> {
    let step = lattice.chunks()[0].step;
    let place = |id| {
        let nw = lattice.facet(id)[0];
        [nw.x / step, nw.y / step, id % 2]
    };
    (0..lattice.chunks().len() as u32 * CHUNK_FACETS).map(|id| (place(id), id)).collect()
}

/// The three facets beside a facet, as the drawing of a quad shows them.
fn beside([x, y, half]: [u32; 3]) -> [[u32; 3]; 3] {
    if half == 0 { [[x, y, 1], [x - 1, y, 1], [x, y + 1, 1]] } else { [[x, y, 0], [x + 1, y, 0], [x, y - 1, 0]] }
}

#[test]
fn facets_share_an_edge_where_two_vertices_are_common() {
    let (_, lattice) = lattice();
    let ids = by_place(&lattice);
    // Around a corner of chunks and the quads on both sides of it.
    let window: Vec<[u32; 3]> = (60..68)
        .flat_map(|x| (29..36).flat_map(move |y| [[x, y, 0], [x, y, 1]]))
        .filter(|place| ids.contains_key(place))
        .collect();
    let pairs: Vec<_> = window.iter().flat_map(|p| window.iter().map(move |q| [*p, *q])).collect();
    let by_id: Vec<[u32; 2]> = pairs.iter().map(|pair| pair.map(|place| ids[&place])).collect();
    let common = run(gpu(), "common_vertices", PAIRS, &by_id, pairs.len() as u32, 1);
    let mut edges = 0;
    for (([p, q], ids), common) in pairs.iter().zip(&by_id).zip(common) {
        let is_edge = beside(*p).contains(q);
        assert_eq!(is_edge, common == 2, "{p:?} and {q:?} have {common} vertices in common");
        assert_eq!(p == q, common == 3);
        let [a, b] = ids.map(|id| lattice.facet(id));
        assert_eq!(a.iter().filter(|v| b.contains(v)).count() as u32, common, "{p:?} and {q:?}");
        edges += usize::from(is_edge);
    }
    assert!(edges > 100, "{edges} edges");
}
