//! The hardware depth draw shows what our visibility passes show, and the bare copy copies.

use std::sync::{Arc, OnceLock};

use glam::DVec3;
use hachure::door::gpu::Clock;
use hachure::door::measure::depth_draw;
use hachure::door::measure::depth_draw::shows_facets;
use hachure::door::measure::{BareCopy, Floor};
use hachure::gpu::{AdapterChoice, Gpu, Int64};
use hachure::plan::{Border, Detail, Method, Plan};
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::frames::Planned;
use crate::scenes::{level, look, rough};

/// Sides that are no powers of two, and rows that are no multiple of what those of a texture are aligned to.
const PAGE: [u32; 2] = [331, 200];
/// Pixels that may show another facet: equal depths, facets across the guard band.
const MOST_OTHERS: f64 = 0.01;

/// A device that numbers primitives, timed by a clock of its own.
fn numbering(clock: Clock) -> &'static Arc<Gpu> {
    static GPUS: [OnceLock<Arc<Gpu>>; 2] = [OnceLock::new(), OnceLock::new()];
    let stamps = clock == Clock::Timestamps;
    let gpu = GPUS[usize::from(stamps)].get_or_init(|| {
        let extra = if stamps { wgpu::Features::TIMESTAMP_QUERY } else { wgpu::Features::empty() };
        let gpu = Gpu::open_with(&AdapterChoice::Best, Int64::IfPresent, depth_draw::FEATURE | extra);
        Arc::new(gpu.expect("an adapter"))
    });
    assert!(shows_facets(gpu), "{} numbers no primitives, nothing is proven", gpu.info.name);
    gpu
}

/// From outside: facets around the eye would be clipped, and those the draw leaves out.
fn camera(surface: &Surface) -> Camera {
    let [west, south, east, north] = surface.dem().extent();
    let middle = DVec3::new((west + east) / 2.0, (south + north) / 2.0, 0.0);
    look(middle + DVec3::new(-1600.0, -1700.0, 500.0), middle, 60.0, PAGE)
}

/// ID + 1 of each pixel of the last frame, by our passes.
fn ours(renderer: &Planned) -> Vec<u32> {
    let pixels: Vec<[u32; 2]> = renderer.values("pixels", PAGE[0] as usize * PAGE[1] as usize);
    pixels.iter().map(|pixel| pixel[0]).collect()
}

/// Share of the pixels that either covers in which they differ.
fn others(a: &[u32], b: &[u32]) -> f64 {
    let covered = a.iter().zip(b).filter(|(a, b)| **a != 0 || **b != 0).count();
    let differ = a.iter().zip(b).filter(|(a, b)| a != b).count();
    assert!(covered > a.len() / 10, "{covered} pixels prove nothing");
    differ as f64 / covered as f64
}

/// Draws two views one after the other, of which the lattice may differ, and compares each with our passes.
fn draw_and_compare(surface: &Arc<Surface>, detail: Detail) {
    let (gpu, view) = (numbering(Clock::Wall), camera(surface));
    let plan = Plan::new(detail, Method::Walk, Border::Off);
    let mut renderer = Planned::new(gpu, surface, plan);
    let mut floor = Floor::new(gpu.clone(), PAGE, 1 << 20).expect("a floor");
    let mut lattices = Vec::new();
    for eye in [view.eye, view.eye + DVec3::new(200.0, 300.0, 0.0)] {
        let camera = Camera { eye, ..view };
        renderer.frame(&camera).expect("a frame");
        lattices.push(renderer.lattice().chunks().to_vec());
        assert!(floor.draw_ms(&renderer).expect("a draw").expect("a time") > 0.0);
        let (expected, drawn) = (ours(&renderer), floor.ids().expect("IDs"));
        let share = others(&expected, &drawn);
        println!("{detail:?}: {:.3} % of the pixels show another facet", share * 100.0);
        assert!(share < MOST_OTHERS, "{detail:?}: {share} of the pixels show another facet");
        // Negative control: one facet on, and the comparison must notice.
        let shifted: Vec<u32> = drawn.iter().map(|id| if *id == 0 { 0 } else { id + 1 }).collect();
        assert!(others(&expected, &shifted) > 0.9, "the comparison is blind");
    }
    let adaptive = matches!(detail, Detail::Adaptive { .. });
    assert_eq!(renderer.lattice().has_seams(), adaptive, "what is to be drawn");
    assert_eq!(lattices[0] != lattices[1], adaptive, "each frame has its own lattice, or none has");
}

#[test]
fn the_draw_shows_the_facets_of_our_passes() {
    for voids in [false, true] {
        let surface = Arc::new(Surface::new(rough(120, 110, 1.0, 6.0, voids)));
        for detail in [level(1).into(), level(4).into(), Detail::Adaptive { error_px: 0.2 }] {
            draw_and_compare(&surface, detail);
        }
    }
}

#[test]
fn stamps_time_copy_and_draw() {
    let surface = Arc::new(Surface::new(rough(70, 60, 1.0, 6.0, false)));
    let camera = camera(&surface);
    for clock in [Clock::Wall, Clock::Timestamps] {
        let gpu = numbering(clock);
        if gpu.info.device_type == wgpu::DeviceType::Cpu {
            assert_eq!(gpu.clock, clock);
        }
        let plan = Plan::new(level(4), Method::Walk, Border::Off);
        let mut renderer = Planned::new(gpu, &surface, plan);
        let [mut little, much] = [1 << 12, 1 << 28].map(|bytes| Floor::new(gpu.clone(), PAGE, bytes).expect("a floor"));
        renderer.frame(&camera).expect("a frame");
        let draw = little.draw_ms(&renderer).expect("a draw").expect("a time");
        assert!(draw.is_finite() && draw > 0.0, "{clock:?}: {draw} ms");
        // The least of some: other tests use the device meanwhile.
        let least = |floor: &Floor| {
            let copies = (0..5).map(|_| floor.copy_ms().expect("a copy").expect("a time"));
            copies.fold(f64::INFINITY, f64::min)
        };
        let [few, many] = [&little, &much].map(least);
        assert!(many > few, "{clock:?}: 256 MiB take {many} ms, 4 KiB {few} ms");
    }
}

#[test]
fn several_vertex_batches_cannot_be_drawn() {
    // 66 x 66 cells at level 32: more chunks than a batch takes.
    let surface = Arc::new(Surface::new(rough(67, 67, 1.0, 0.0, false)));
    let gpu = numbering(Clock::Wall);
    let mut renderer = Planned::new(gpu, &surface, Plan::new(level(32), Method::Walk, Border::Off));
    let frame = renderer.frame(&camera(&surface)).expect("a frame");
    let mut floor = Floor::new(gpu.clone(), PAGE, 1 << 20).expect("a floor");
    assert!(!frame.keeps_vertices() && floor.draw_ms(&renderer).expect("no error").is_none());
}

#[test]
fn the_copy_copies_in_as_many_commands_as_it_takes() {
    let gpu = numbering(Clock::Wall);
    // Half of it is more than a buffer may hold.
    for bytes in [1 << 16, 2 * gpu.device.limits().max_buffer_size + (1 << 16)] {
        let copy = BareCopy::new(gpu, bytes).expect("a copy");
        gpu.queue.write_buffer(copy.from(), 0, &[7; 1 << 15]);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        copy.record(&mut encoder);
        gpu.queue.submit([encoder.finish()]);
        assert_eq!(gpu.read::<u8>(copy.to(), 1 << 15).expect("the copy"), [7; 1 << 15]);
    }
}
