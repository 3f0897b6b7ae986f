//! The same bytes on every run, after other frames, from another renderer, and without 64-bit atomics.

use std::sync::Arc;

use glam::DVec3;
use hachure::door::plan::batches::BATCH_CHUNKS;
use hachure::plan::{Border, Culling, Detail, Method, Plan};
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::frames::{METHODS, Planned};
use crate::scenes::{gpu, gpu_without_int64, level, look, rough};

const PAGE: [u32; 2] = [256, 192];
/// The page as packed for readback and, below it, depth and ID of each pixel.
fn bytes(renderer: &mut Planned, camera: &Camera) -> Vec<u8> {
    renderer.draw(camera).expect("no pixel without a facet");
    ["page", "pixels"].map(|name| renderer.values(name, camera.width as usize * camera.height as usize * 8)).concat()
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
    let surface = Arc::new(Surface::new(rough(70, 60, 1.0, 6.0, true)));
    let views = views(&surface);
    assert!(!gpu_without_int64().int64, "the second device must do without");
    for (_, method) in METHODS {
        let make = |gpu| Planned::new(gpu, &surface, Plan::new(level(4), method, Border::On));
        let (mut first, mut second, mut narrow) = (make(gpu()), make(gpu()), make(gpu_without_int64()));
        let before: Vec<Vec<u8>> = views.iter().map(|v| bytes(&mut first, v)).collect();
        for (view, expected) in views.iter().zip(&before) {
            assert!(bytes(&mut first, view) == *expected, "{method:?}: differs after other frames");
            assert!(bytes(&mut first, view) == *expected, "{method:?}: differs the second time");
            assert!(bytes(&mut second, view) == *expected, "{method:?}: differs in another renderer");
            assert!(bytes(&mut narrow, view) == *expected, "{method:?}: differs without 64-bit atomics");
        }
        // Negative controls: another view, and an eye a millimetre away.
        assert!(before[0] != before[1] && before[1] != before[2]);
        let moved = Camera { eye: views[0].eye + DVec3::X * 1e-3, ..views[0] };
        assert!(bytes(&mut first, &moved) != before[0], "the comparison is blind");
    }
}

#[test]
fn several_batches_draw_the_same_with_and_without_int64() {
    // 65 x 65 cells at level 32: 130 x 130 chunks, two batches.
    let surface = Arc::new(Surface::new(rough(66, 66, 1.0, 0.0, false)));
    let camera = views(&surface)[0];
    let make = |gpu, n| Planned::new(gpu, &surface, Plan::new(level(n), Method::Walk, Border::On));
    let (mut wide, mut narrow) = (make(gpu(), 32), make(gpu_without_int64(), 32));
    let expected = bytes(&mut wide, &camera);
    assert!(wide.lattice().chunks().len() > BATCH_CHUNKS as usize, "one batch is enough here");
    assert!(bytes(&mut narrow, &camera) == expected, "differs without 64-bit atomics");
    assert!(bytes(&mut wide, &camera) == expected, "differs the second time");
    // Against one batch at level 16: the same picture, but for facets of half the size.
    let ink = |bytes: &[u8]| bytes[..bytes.len() / 2].chunks_exact(8).map(|p| p[0] & 2 != 0).collect::<Vec<bool>>();
    let (fine, coarse) = (ink(&expected), ink(&bytes(&mut make(gpu(), 16), &camera)));
    let count = |bits: &[bool]| bits.iter().filter(|b| **b).count();
    let differ = fine.iter().zip(&coarse).filter(|(a, b)| a != b).count();
    println!("batches: {} and {} px of ink at levels 32 and 16, {differ} differ", count(&fine), count(&coarse));
    assert!(count(&fine) > 500 && differ * 20 < count(&fine), "levels 32 and 16 differ");
}

#[test]
fn walks_meet_the_same_where_vertices_stay_and_where_they_are_found_again() {
    let surface = Arc::new(Surface::new(rough(120, 110, 1.0, 1.0, true)));
    let [west, south, east, north] = surface.dem().extent();
    let middle = DVec3::new(west + east, south + north, 0.0) / 2.0;
    let camera = look(middle + DVec3::new(-300.0, -700.0, 160.0), middle, 15.0, PAGE);
    let make = |culling| {
        let plan = Plan { culling, ..Plan::new(Detail::Adaptive { error_px: 0.002 }, Method::Walk, Border::Off) };
        Planned::new(gpu(), &surface, plan)
    };
    let [mut few, mut all] = [Culling::On, Culling::Off].map(make);
    let frames = [&mut few, &mut all].map(|renderer| renderer.draw(&camera).expect("a frame"));
    let chunks = [&few, &all].map(|renderer| renderer.lattice().chunks().len());
    let inked = frames[0].inked();
    println!("{chunks:?} chunks, {inked} px of ink");
    let made = [&mut few, &mut all].map(|renderer| {
        renderer.frame(&camera).expect("a frame");
        renderer.on_device().scene.made().len()
    });
    assert_eq!(made, [0, chunks[1]], "the vertices of one batch stay, those of several do not");
    let batch = BATCH_CHUNKS as usize;
    assert!(chunks[0] <= batch && chunks[1] > batch && inked > 100, "{chunks:?} chunks, {inked} px of ink");
    assert!(frames[0].raster == frames[1].raster, "ink, places or depths differ");
}

#[test]
fn a_second_frame_uploads_nothing_but_the_camera() {
    let surface = Arc::new(Surface::new(rough(70, 60, 1.0, 6.0, false)));
    let [first, second, _] = views(&surface);
    for name in ["heights", "gradients_east", "gradients_north", "chunks", "nodes", "scene"] {
        let mut renderer = Planned::new(gpu(), &surface, Plan::new(level(2), Method::Walk, Border::On));
        let expected = bytes(&mut renderer, &first);
        assert!(bytes(&mut renderer, &second) != expected, "the camera is uploaded");
        // What is spoilt on the device stays so: a frame that uploaded it again would mend it.
        let buffer = renderer.buffer(name);
        gpu().queue.write_buffer(&buffer, 0, &vec![0; buffer.size() as usize]);
        assert!(bytes(&mut renderer, &first) != expected, "{name} was uploaded again");
    }
}
