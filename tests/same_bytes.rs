//! The same bytes on every run, after other frames, from another renderer, and without 64-bit atomics.

use glam::DVec3;
use hachure::gpu::Gpu;
use hachure::plan::batches::BATCH_CHUNKS;
use hachure::plan::{Border, Detail, Method, Plan, Thrift};
use hachure::render::Renderer;
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::scenes::{METHODS, gpu, gpu_without_int64, level, look, renderer, rough};

const PAGE: [u32; 2] = [256, 192];
/// The page as packed for readback and, below it, depth and ID of each pixel.
fn bytes(gpu: &Gpu, renderer: &Renderer<'_>, camera: &Camera) -> Vec<u8> {
    renderer.frame(camera).expect("a frame");
    renderer.read().expect("no pixel without a facet");
    let size = u64::from(camera.width) * u64::from(camera.height) * 8;
    let read = |name| gpu.read(renderer.buffers().get(name).expect(name), size).expect(name);
    [read("page"), read("pixels")].concat()
}

/// From outside, from above a slope with facets cut by the near plane, and straight down.
fn views(surface: &Surface) -> [Camera; 3] {
    let [west, south, east, north] = surface.dem().extent();
    let middle = DVec3::new((west + east) / 2.0, (south + north) / 2.0, 0.0);
    let eyes = [DVec3::new(-700.0, -900.0, 250.0), DVec3::new(31.0, -57.0, 110.0), DVec3::new(3.0, 2.0, 900.0)];
    eyes.map(|eye| look(middle + eye, middle, 60.0, PAGE))
}

#[test]
fn frames_are_the_same_on_every_run_and_without_int64() {
    let surface = Surface::new(rough(70, 60, 1.0, 6.0, true));
    let views = views(&surface);
    assert!(!gpu_without_int64().int64, "the second device must do without");
    for (_, method) in METHODS {
        let make = |gpu| renderer(gpu, &surface, &views[0], level(4), method, Border::On);
        let (first, second, narrow) = (make(gpu()), make(gpu()), make(gpu_without_int64()));
        let before: Vec<Vec<u8>> = views.iter().map(|v| bytes(gpu(), &first, v)).collect();
        for (view, expected) in views.iter().zip(&before) {
            assert!(bytes(gpu(), &first, view) == *expected, "{method:?}: differs after other frames");
            assert!(bytes(gpu(), &first, view) == *expected, "{method:?}: differs the second time");
            assert!(bytes(gpu(), &second, view) == *expected, "{method:?}: differs in another renderer");
            assert!(
                bytes(gpu_without_int64(), &narrow, view) == *expected,
                "{method:?}: differs without 64-bit atomics"
            );
        }
        // Negative controls: another view, and an eye a millimetre away.
        assert!(before[0] != before[1] && before[1] != before[2]);
        let moved = Camera { eye: views[0].eye + DVec3::X * 1e-3, ..views[0] };
        assert!(bytes(gpu(), &first, &moved) != before[0], "the comparison is blind");
    }
}

#[test]
fn several_batches_draw_the_same_with_and_without_int64() {
    // 65 x 65 cells at level 32: 130 x 130 chunks, two batches.
    let surface = Surface::new(rough(66, 66, 1.0, 0.0, false));
    let camera = views(&surface)[0];
    let make = |gpu, n| renderer(gpu, &surface, &camera, level(n), Method::Walk, Border::On);
    let (wide, narrow) = (make(gpu(), 32), make(gpu_without_int64(), 32));
    assert!(wide.lattice().chunks().len() > BATCH_CHUNKS as usize, "one batch is enough here");
    let expected = bytes(gpu(), &wide, &camera);
    assert!(bytes(gpu_without_int64(), &narrow, &camera) == expected, "differs without 64-bit atomics");
    assert!(bytes(gpu(), &wide, &camera) == expected, "differs the second time");
    // Against one batch at level 16: the same picture, but for facets of half the size.
    let ink = |bytes: &[u8]| bytes[..bytes.len() / 2].chunks_exact(8).map(|p| p[0] & 2 != 0).collect::<Vec<bool>>();
    let (fine, coarse) = (ink(&expected), ink(&bytes(gpu(), &make(gpu(), 16), &camera)));
    let count = |bits: &[bool]| bits.iter().filter(|b| **b).count();
    let differ = fine.iter().zip(&coarse).filter(|(a, b)| a != b).count();
    println!("batches: {} and {} px of ink at levels 32 and 16, {differ} differ", count(&fine), count(&coarse));
    assert!(count(&fine) > 500 && differ * 20 < count(&fine), "levels 32 and 16 differ");
}

#[test]
fn walks_meet_the_same_where_vertices_stay_and_where_they_are_found_again() {
    let surface = Surface::new(rough(120, 110, 1.0, 1.0, true));
    let [west, south, east, north] = surface.dem().extent();
    let middle = DVec3::new(west + east, south + north, 0.0) / 2.0;
    let camera = look(middle + DVec3::new(-300.0, -700.0, 160.0), middle, 15.0, PAGE);
    let make = |thrift| {
        let plan = Plan { thrift, ..Plan::new(Detail::Adaptive { error_px: 0.002 }, Method::Walk, Border::Off) };
        Renderer::new(gpu(), &surface, plan, PAGE).expect("a renderer")
    };
    let [few, all] = [Thrift::LeaveOut, Thrift::Nothing].map(make);
    let frames = [&few, &all].map(|renderer| renderer.draw(&camera).expect("a frame"));
    let chunks = [&few, &all].map(|renderer| renderer.lattice().chunks().len());
    let inked = frames[0].inked();
    println!("{chunks:?} chunks, {inked} px of ink");
    let made = [&few, &all].map(|renderer| {
        renderer.frame(&camera).expect("a frame");
        renderer.buffers().made().len()
    });
    assert_eq!(made, [0, chunks[1]], "the vertices of one batch stay, those of several do not");
    let batch = BATCH_CHUNKS as usize;
    assert!(chunks[0] <= batch && chunks[1] > batch && inked > 100, "{chunks:?} chunks, {inked} px of ink");
    assert!(frames[0].raster == frames[1].raster, "ink, places or depths differ");
}

#[test]
fn a_second_frame_uploads_nothing_but_the_camera() {
    let surface = Surface::new(rough(70, 60, 1.0, 6.0, false));
    let [first, second, _] = views(&surface);
    for name in ["heights", "gradients_east", "gradients_north", "chunks", "nodes", "scene"] {
        let renderer = renderer(gpu(), &surface, &first, level(2), Method::Walk, Border::On);
        let expected = bytes(gpu(), &renderer, &first);
        assert!(bytes(gpu(), &renderer, &second) != expected, "the camera is uploaded");
        // What is spoilt on the device stays so: a frame that uploaded it again would mend it.
        let buffer = renderer.buffers().get(name).expect(name).clone();
        gpu().queue.write_buffer(&buffer, 0, &vec![0; buffer.size() as usize]);
        assert!(bytes(gpu(), &renderer, &first) != expected, "{name} was uploaded again");
    }
}
