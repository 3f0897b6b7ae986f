//! Times of frames: every pass has one, they add up, and taking them changes no bit of the picture.

use std::sync::{Arc, OnceLock};

use glam::DVec3;
use hachure::door::gpu::Clock;
use hachure::door::gpu::clock::{CLEAR, PASSES_OF_SET, Stamps};
use hachure::door::plan::batches::BATCH_CHUNKS;
use hachure::door::surface::Lattice;
use hachure::gpu::{AdapterChoice, Gpu, Int64};
use hachure::plan::{Border, Method, Plan};
use hachure::render::{FrameTime, PassTime};
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::frames::{METHODS, Planned};
use crate::scenes::{gpu, gpu_without_int64, level, look, rough};

const PAGE: [u32; 2] = [96, 64];

/// The devices of [`gpu`] and [`gpu_without_int64`], made to stamp even where that is a software driver.
fn stamping(int64: Int64) -> &'static Arc<Gpu> {
    static GPUS: [OnceLock<Arc<Gpu>>; 2] = [OnceLock::new(), OnceLock::new()];
    let gpu = GPUS[usize::from(int64 == Int64::Never)].get_or_init(|| {
        let gpu = Gpu::open_with(&AdapterChoice::Best, int64, wgpu::Features::TIMESTAMP_QUERY);
        Arc::new(gpu.expect("an adapter"))
    });
    assert_eq!(gpu.clock, Clock::Timestamps, "{} has no timestamps, nothing is proven", gpu.info.name);
    gpu
}

/// The passes of a frame with border lines, in their order; vertices are made anew or stay.
fn passes(method: Method, anew: bool) -> Vec<&'static str> {
    let vertices: &[&str] = if anew { &["tessellate"] } else { &[] };
    let own: Vec<_> = method.entry().passes.iter().map(|pass| pass.name()).collect();
    [&[CLEAR], vertices, &["facing", "project", "rasterize", "rasterize_large"], own.as_slice(), &["border"]].concat()
}

/// What is wrong with the time of a frame of these passes.
fn fault(time: &FrameTime, passes: &[&str]) -> Option<String> {
    let names: Vec<_> = time.passes.iter().map(|pass| pass.name).collect();
    if names != passes {
        return Some(format!("passes {names:?} instead of {passes:?}"));
    }
    if let Some(pass) = time.passes.iter().find(|pass| !pass.ms.is_finite() || pass.ms < 0.0) {
        return Some(format!("{} ms in {}", pass.ms, pass.name));
    }
    let sum: f64 = time.passes.iter().map(|pass| pass.ms).sum();
    // Beyond what adding in f64 loses.
    (!time.ms.is_finite() || sum > time.ms * (1.0 + 1e-12)).then(|| format!("{sum} ms of passes in {} ms", time.ms))
}

/// Page, depths and IDs of the last frame.
fn picture(renderer: &mut Planned) -> Vec<u8> {
    renderer.read().expect("no pixel without a facet");
    ["page", "pixels"].map(|name| renderer.values(name, PAGE[0] as usize * PAGE[1] as usize * 8)).concat()
}

/// Two views of a scene from outside.
fn views(surface: &Surface) -> [Camera; 2] {
    let [west, south, east, north] = surface.dem().extent();
    let middle = DVec3::new((west + east) / 2.0, (south + north) / 2.0, 0.0);
    [DVec3::new(-700.0, -900.0, 250.0), DVec3::new(800.0, -600.0, 300.0)]
        .map(|eye| look(middle + eye, middle, 60.0, PAGE))
}

/// Times a frame, and compares its picture with that of an untimed one on another device.
fn time_and_compare(surface: &Arc<Surface>, n: u32, method: Method, int64: Int64) -> FrameTime {
    let [view, other] = views(surface);
    let plain = if int64 == Int64::Never { gpu_without_int64() } else { gpu() };
    let make = |gpu| Planned::new(gpu, surface, Plan::new(level(n), method, Border::On));
    let mut untimed = make(plain);
    untimed.frame(&view).expect("a frame");
    let expected = picture(&mut untimed);
    let mut timed = make(stamping(int64));
    // Another picture first: one that is left to stand must not pass.
    timed.timed_frame(&other).expect("a timed frame");
    assert!(picture(&mut timed) != expected, "{method:?}: the comparison is blind");
    let time = timed.timed_frame(&view).expect("a timed frame");
    assert!(picture(&mut timed) == expected, "{method:?}, level {n}: timing changes the picture");
    // The other frame left them, unless several batches share one buffer.
    let anew = timed.lattice().chunks().len() > BATCH_CHUNKS as usize;
    assert_eq!(fault(&time, &passes(method, anew)), None, "{method:?}, level {n}");
    println!("{method:?}, level {n}, {int64:?}: {time:?}");
    time
}

#[test]
fn stamps_time_every_pass_and_change_no_bit() {
    let surface = Arc::new(Surface::new(rough(70, 60, 1.0, 6.0, true)));
    for (_, method) in METHODS {
        for int64 in [Int64::IfPresent, Int64::Never] {
            let time = time_and_compare(&surface, 4, method, int64);
            assert!(time.ms > 0.0, "{method:?}: a frame takes time");
        }
    }
}

#[test]
fn stamps_survive_frames_of_several_submissions() {
    // 65 x 65 cells at level 32: 130 x 130 chunks, two batches.
    let surface = Arc::new(Surface::new(rough(66, 66, 1.0, 0.0, false)));
    let chunks = Lattice::uniform(surface.dem(), level(32)).expect("a lattice").chunks().len();
    assert!(chunks > BATCH_CHUNKS as usize, "one batch is enough here");
    for int64 in [Int64::IfPresent, Int64::Never] {
        let time = time_and_compare(&surface, 32, Method::Walk, int64);
        assert!(time.ms > 0.0, "{int64:?}: a frame takes time");
    }
}

#[test]
fn a_software_driver_is_timed_by_the_wall_clock_unless_stamps_are_asked_for() {
    let surface = Arc::new(Surface::new(rough(70, 60, 1.0, 6.0, false)));
    let [view, _] = views(&surface);
    let is_cpu = gpu().info.device_type == wgpu::DeviceType::Cpu;
    assert_eq!(gpu().clock == Clock::Wall, is_cpu, "{:?} on {}", gpu().clock, gpu().info.name);
    let mut words = Vec::new();
    for gpu in [gpu(), stamping(Int64::IfPresent)] {
        let mut renderer = Planned::new(gpu, &surface, Plan::new(level(2), Method::Walk, Border::On));
        let time = renderer.timed_frame(&view).expect("a timed frame");
        assert_eq!(fault(&time, &passes(Method::Walk, true)), None, "{:?}", gpu.clock);
        let whole = renderer.time_of_frame(&view).expect("the time of a frame");
        assert!(whole.is_finite() && whole > 0.0, "{:?}: {whole} ms", gpu.clock);
        words.push(gpu.clock.describe());
    }
    assert_eq!(words[0] != words[1], is_cpu, "{words:?}");
}

/// Records so many passes without work, in three submissions.
fn record(gpu: &Gpu, stamps: &mut Stamps, names: &[&'static str]) {
    for names in names.chunks(names.len().div_ceil(3).max(1)) {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        for name in names {
            let timestamp_writes = Some(stamps.writes(gpu, name));
            encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: None, timestamp_writes });
        }
        gpu.queue.submit([encoder.finish()]);
        gpu.check().expect("the stamps are accepted");
    }
}

#[test]
fn more_passes_than_a_query_set_takes_are_timed() {
    let gpu = stamping(Int64::IfPresent);
    let mut stamps = Stamps::default();
    let names: Vec<_> = (0..2 * PASSES_OF_SET + 1).map(|i| ["even", "odd"][i % 2]).collect();
    record(gpu, &mut stamps, &names);
    let time = stamps.read(gpu).expect("the stamps");
    assert_eq!(fault(&time, &[CLEAR, "even", "odd"]), None);
    assert!(time.ms > 0.0, "stamps of three sets lie apart");
}

#[test]
fn a_stamp_that_was_never_written_is_no_time() {
    let gpu = stamping(Int64::IfPresent);
    for forgotten in [0, 1] {
        let mut stamps = Stamps::default();
        let names = ["one", "two"];
        record(gpu, &mut stamps, &names[..forgotten]);
        let _ = stamps.writes(gpu, "forgotten");
        record(gpu, &mut stamps, &names[forgotten..]);
        let error = stamps.read(gpu).expect_err("a pass that was not recorded");
        assert!(error.to_string().contains("pass forgotten from 0 to 0"), "{error}");
    }
}

#[test]
fn stamps_are_summed_by_pass_and_what_lies_between_is_clear() {
    let passes = [CLEAR, "a", "b", "a"];
    let stamps = [[100, 100], [110, 130], [135, 135], [140, 150]];
    let time = FrameTime::of_stamps(&passes, &stamps, 0.5).expect("good stamps");
    let of = |name, ms| PassTime { name, ms };
    assert_eq!(time, FrameTime { ms: 25.0, passes: vec![of(CLEAR, 10.0), of("a", 15.0), of("b", 0.0)] });
    // The mark may be dropped, and passes may overlap.
    let stamps = [[0, 0], [110, 130], [120, 140], [140, 150]];
    let time = FrameTime::of_stamps(&passes, &stamps, 0.5).expect("good stamps");
    assert_eq!(time, FrameTime { ms: 20.0, passes: vec![of(CLEAR, 0.0), of("a", 15.0), of("b", 10.0)] });
    for wrong in [[0, 130], [110, 0], [130, 110]] {
        let stamps = [[100, 100], wrong, [135, 135], [140, 150]];
        assert!(FrameTime::of_stamps(&passes, &stamps, 0.5).is_err(), "{wrong:?}");
    }
}

#[test]
fn faults_of_times_are_noticed() {
    let time = |ms, a, b: Option<f64>| FrameTime {
        ms,
        passes: [Some(("a", a)), b.map(|b| ("b", b))]
            .into_iter()
            .flatten()
            .map(|(name, ms)| PassTime { name, ms })
            .collect(),
    };
    assert_eq!(fault(&time(3.0, 1.0, Some(2.0)), &["a", "b"]), None);
    for (wrong, what) in [
        (time(3.0, 1.0, None), "a pass is missing"),
        (time(3.0, f64::NAN, Some(2.0)), "no number"),
        (time(3.0, -1.0, Some(2.0)), "negative"),
        (time(2.9, 1.0, Some(2.0)), "less than its passes"),
        (time(f64::INFINITY, 1.0, Some(2.0)), "no end"),
    ] {
        assert!(fault(&wrong, &["a", "b"]).is_some(), "{what}");
    }
    assert!(fault(&time(3.0, 1.0, Some(2.0)), &["a"]).is_some(), "a pass that is not of the plan");
}
