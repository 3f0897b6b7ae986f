//! One renderer, kept warm: whatever it has drawn before, a frame has the bytes that a new renderer draws; what frames have in
//! common is compiled and uploaded once; and memory does not grow.

use std::collections::HashSet;
use std::sync::Arc;

use glam::DVec3;
use hachure::door::gpu::pass::reflect;
use hachure::door::plan::Pieces;
use hachure::door::plan::passes::passes;
use hachure::door::surface::Tile;
use hachure::gpu::{AdapterChoice, Gpu, Int64};
use hachure::plan::{Border, Detail, Method, Plan, Visibility};
use hachure::render::Renderer;
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::frames::{METHODS, Planned};
use crate::reflection::shaders;
use crate::scenes::{Random, gpu, level, look, rough};

/// Frames that are drawn one after the other.
const FRAMES: usize = 200;
/// Sizes of their pages.
const PAGES: [[u32; 2]; 4] = [[96, 64], [64, 96], [160, 90], [33, 47]];

/// Each plan with each size once, then any.
fn plan_of(i: usize, random: &mut Random) -> (Plan, [u32; 2]) {
    let details: [Detail; 4] = [level(1).into(), Detail::Adaptive { error_px: 0.5 }, level(4).into(), level(2).into()];
    let all = METHODS.len() * details.len() * 2;
    let k = if i < all { i } else { random.below(all as u32) as usize };
    let border = [Border::On, Border::Off][k / details.len() % 2];
    let plan = Plan::new(details[k % details.len()], METHODS[k / details.len() / 2].1, border);
    (plan, PAGES[random.below(PAGES.len() as u32) as usize])
}

/// From anywhere outside, towards somewhere inside.
fn camera(surface: &Surface, random: &mut Random, size: [u32; 2]) -> Camera {
    let [west, south, east, north] = surface.dem().extent();
    let mut inside =
        |low, high| DVec3::new(random.between(west, east), random.between(south, north), random.between(low, high));
    let (target, eye) = (inside(0.0, 1.0), inside(150.0, 600.0));
    look(eye, target, 60.0, size)
}

#[test]
fn two_hundred_frames_of_changing_size_method_and_level_are_those_of_new_renderers() {
    let gpu = Arc::new(Gpu::open(&AdapterChoice::Best, Int64::IfPresent).expect("an adapter"));
    let surface = Arc::new(Surface::new(rough(70, 60, 1.0, 6.0, true)));
    let mut warm = Renderer::new(gpu.clone(), surface.clone()).expect("a renderer");
    let mut random = Random::new(29);
    let (mut kinds, mut tiles, mut pages) = (HashSet::new(), HashSet::new(), HashSet::new());
    let (mut plans, mut half) = (Vec::new(), None);
    for i in 0..FRAMES {
        let (plan, size) = plan_of(i, &mut random);
        let camera = camera(&surface, &mut random, size);
        let compiled = gpu.compiled();
        let drawn = warm.draw(&plan, &camera).expect("a frame").raster;
        let frame = warm.last().expect("a frame").clone();
        let is_new = kinds.insert(format!("{plan:?}"));
        assert!(is_new || gpu.compiled() == compiled, "frame {i}: {plan:?} was compiled before");
        if is_new {
            plans.push((plan, camera));
        }
        tiles.extend(frame.lattice.chunks().iter().map(Tile::of));
        assert_eq!(warm.on_device().scene.uploaded(), tiles.len() as u64, "frame {i}: a tile was uploaded twice");
        let fresh = Planned::new(&gpu, &surface, plan).draw(&camera).expect("a frame").raster;
        assert!(drawn == fresh, "frame {i}: {plan:?}, {camera:?} differs from that of a new renderer");
        pages.insert(bytemuck::cast_slice::<_, u8>(&drawn.pixels).to_vec());
        if i + 1 == FRAMES / 2 {
            // All sizes were drawn by then, and all plans.
            half = Some(bytes_by_size(&mut warm));
        }
    }
    assert_eq!(kinds.len(), METHODS.len() * 8, "not every plan was drawn");
    assert!(pages.len() > FRAMES * 9 / 10, "{} pages, most are alike", pages.len());
    assert_eq!(half, Some(bytes_by_size(&mut warm)), "memory on the device has grown");
    // Another renderer finds all passes of all plans there: no more of them than differ.
    let mut second = Renderer::new(gpu.clone(), surface.clone()).expect("a renderer");
    plans.iter().for_each(|(plan, camera)| second.prepare(plan, camera).expect("a plan"));
    assert_eq!(gpu.compiled(), distinct_passes(&plans, gpu.int64), "passes were compiled more than once");
    println!("{FRAMES} frames, {} compiled, {} tiles, {half:?} bytes on the device", gpu.compiled(), tiles.len());
}

/// Bytes of the scene on the device; and of all that lies there, with pages of each size.
fn bytes_by_size(renderer: &mut Renderer) -> (u64, [u64; PAGES.len()]) {
    let all = PAGES.map(|size| {
        let camera = camera(&renderer.surface().clone(), &mut Random::new(5), size);
        renderer.draw(&Plan::default(), &camera).expect("a frame");
        renderer.on_device().bytes()
    });
    (renderer.on_device().scene.buffers().bytes(), all)
}

/// How many passes these plans need that differ in name, source or the constants on which they depend, of a surface with
/// voids in one batch.
fn distinct_passes(plans: &[(Plan, Camera)], int64: bool) -> usize {
    let mut distinct = HashSet::new();
    for (plan, _) in plans {
        let (entry, visibility) = (plan.method.entry(), plan.method.visibility(int64));
        let flags = [("two_depths", visibility == Visibility::TwoDepths), ("conservative", entry.conservative)];
        let constants =
            flags.map(|(name, on)| (name, f64::from(u8::from(on)))).into_iter().chain(entry.constants.iter().copied());
        let constants: Vec<_> = constants.collect();
        for (name, source) in shaders(visibility, true) {
            if passes(plan).iter().any(|pass| pass.name.name() == name) {
                let overrides = reflect(name, &source).expect("valid WGSL").overrides;
                let used = constants.iter().filter(|(name, _)| overrides.iter().any(|o| o.is_used && o.name == *name));
                distinct.insert((name, source, used.map(|(name, value)| (*name, value.to_bits())).collect::<Vec<_>>()));
            }
        }
    }
    distinct.len()
}

#[test]
fn frames_in_batches_and_in_one_are_those_of_new_renderers() {
    // At level 32 its chunks are more than share the vertex buffer.
    let surface = Arc::new(Surface::new(rough(72, 64, 1.0, 6.0, true)));
    let mut warm = Renderer::new(gpu().clone(), surface.clone()).expect("a renderer");
    let size = [48, 32];
    let mut random = Random::new(11);
    let auto = Detail::Adaptive { error_px: 0.5 };
    let [walk, toward_away] = [Method::Walk, Method::TowardAway { wide: false }];
    let steps: [(Detail, Method, bool); 7] = [
        (level(1).into(), walk, true),
        (level(32).into(), walk, false),
        (level(4).into(), toward_away, true),
        (level(32).into(), toward_away, false),
        (level(32).into(), walk, false),
        (auto, walk, true),
        (level(4).into(), walk, true),
    ];
    for (i, (detail, method, is_one)) in steps.into_iter().enumerate() {
        let plan = Plan::new(detail, method, Border::On);
        let camera = camera(&surface, &mut random, size);
        if i % 3 == 1 {
            // What fails in between leaves nothing behind.
            let far = Camera { eye: camera.eye * 1e6, ..camera };
            assert!(warm.frame(&plan, &far).is_err() && warm.last().is_none(), "step {i}: out of reach");
        }
        let drawn = warm.draw(&plan, &camera).expect("a frame").raster;
        let frame = warm.last().expect("a frame").clone();
        assert_eq!(frame.batches.len() == 1, is_one, "step {i}: {} batches", frame.batches.len());
        let mut fresh = Planned::new(gpu(), &surface, plan);
        assert!(drawn == fresh.draw(&camera).expect("a frame").raster, "step {i}: {plan:?} differs");
        if i % 4 == 1 {
            let pieces = frame.cut(Pieces::new(size, [30, 32])).expect("pieces");
            let page = warm.page_of(pieces, |_| ()).expect("a page").marks;
            assert!(page == fresh.page(&camera).expect("a page").marks, "step {i}: {plan:?} differs in pieces");
        }
    }
}

#[cfg(target_os = "linux")]
mod process {
    use std::process::Command;

    use super::*;
    use crate::tolerances::GROWN_BYTES;

    #[test]
    fn two_hundred_frames_take_no_more_memory_than_one_hundred() {
        // Alone in a process, for what is resident is the process's.
        let test = std::env::current_exe().expect("this test");
        let child = "one_renderer::process::child_draws_frame_after_frame";
        let ran = Command::new(test).args(["--exact", child, "--ignored", "--nocapture"]).output().expect("a process");
        let said = String::from_utf8_lossy(&ran.stdout).into_owned();
        assert!(ran.status.success() && said.contains("resident: "), "{said}");
        print!("{said}");
    }

    #[test]
    #[ignore = "run by two_hundred_frames_take_no_more_memory_than_one_hundred in a process of its own"]
    fn child_draws_frame_after_frame() {
        let surface = Arc::new(Surface::new(rough(70, 60, 1.0, 6.0, true)));
        let mut warm = Renderer::new(gpu().clone(), surface.clone()).expect("a renderer");
        let mut random = Random::new(29);
        let mut resident = Vec::new();
        for i in 0..FRAMES {
            let (plan, size) = plan_of(i, &mut random);
            warm.draw(&plan, &camera(&surface, &mut random, size)).expect("a frame");
            if (i + 1) % (FRAMES / 2) == 0 {
                // The same frames lie there at either time.
                bytes_by_size(&mut warm);
                resident.push(resident_bytes());
            }
        }
        let [half, all] = [resident[0], resident[1]];
        println!("resident: {half} bytes after half of the frames, {all} after all");
        assert!(all <= half + GROWN_BYTES, "{} bytes more", all - half);
        // Negative control: what is kept shows, 64 KiB more than are let pass.
        let kept = std::hint::black_box(vec![1_u8; (half + GROWN_BYTES).saturating_sub(all) as usize + (64 << 10)]);
        assert!(resident_bytes() > half + GROWN_BYTES, "{} bytes more are not noticed", kept.len());
    }

    /// Bytes that the process holds in memory.
    fn resident_bytes() -> u64 {
        // Counted page by page: the number in `statm` lags behind.
        let text = std::fs::read_to_string("/proc/self/smaps_rollup").expect("counts of pages");
        let resident = text.lines().find_map(|line| line.strip_prefix("Rss:")).expect("resident memory");
        resident.trim().trim_end_matches(" kB").parse::<u64>().expect("a number") << 10
    }
}

#[test]
fn tiles_move_where_room_grows_and_are_not_uploaded_again() {
    // 25 x 20 tiles of each kind, more than there is room for at first.
    let surface = Arc::new(Surface::new(rough(400, 320, 1.0, 2.0, false)));
    let mut warm = Renderer::new(gpu().clone(), surface.clone()).expect("a renderer");
    let [west, south, east, north] = surface.dem().extent();
    let middle = DVec3::new(west + east, south + north, 0.0) / 2.0;
    let camera = look(middle + DVec3::new(-4000.0, -5000.0, 1500.0), middle, 60.0, [160, 120]);
    let mut tiles = HashSet::new();
    let plans: [Detail; 5] =
        [Detail::Adaptive { error_px: 20.0 }, level(1).into(), level(2).into(), level(1).into(), Detail::default()];
    let mut bytes = Vec::new();
    for detail in plans {
        let plan = Plan::new(detail, METHODS[0].1, Border::On);
        let drawn = warm.draw(&plan, &camera).expect("a frame").raster;
        tiles.extend(warm.last().expect("a frame").lattice.chunks().iter().map(Tile::of));
        assert_eq!(warm.on_device().scene.uploaded(), tiles.len() as u64, "{detail:?}: a tile was uploaded twice");
        assert!(drawn == Planned::new(gpu(), &surface, plan).draw(&camera).expect("a frame").raster, "{detail:?}");
        bytes.push(warm.on_device().scene.buffers().bytes());
    }
    assert!(bytes[0] < bytes[1] && bytes[1] < bytes[2] && bytes[2] == bytes[3], "room did not grow: {bytes:?}");
}

#[test]
fn a_renderer_goes_to_another_thread_and_frames_outlive_it() {
    fn assert_send<T: Send>(of: T) -> T {
        of
    }
    let surface = Arc::new(Surface::new(rough(30, 30, 1.0, 2.0, false)));
    let mut renderer = assert_send(Renderer::new(gpu().clone(), surface.clone()).expect("a renderer"));
    let plan = Plan::default();
    let camera = camera(&surface, &mut Random::new(3), PAGES[0]);
    // Its lattice is held while the next frame has another.
    let first = renderer.frame(&plan, &camera).expect("a frame");
    let turned = Camera { azimuth: camera.azimuth + 40.0, ..camera };
    let (second, again) = std::thread::spawn(move || {
        let second = renderer.frame(&plan, &turned).expect("a frame");
        (second, renderer.frame(&plan, &camera).expect("a frame"))
    })
    .join()
    .expect("no panic");
    assert!(first.lattice.chunks() != second.lattice.chunks(), "frames are alike");
    assert_eq!(first.lattice.chunks(), again.lattice.chunks());
}
