//! What cannot be drawn is refused with what, where and remedy, before anything is allocated.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::DVec2;
use hachure::dem::Dem;
use hachure::door::cli::words::{exit_code, line};
use hachure::door::gpu::CameraUniform;
use hachure::door::plan::{PassName, Pieces};
use hachure::door::surface::Lattice;
use hachure::error::{Error, Result};
use hachure::gpu::{AdapterChoice, Gpu, Int64};
use hachure::plan::{Border, Method, Plan};
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::common::gpu;
use crate::frames::Planned;
use crate::scenes::{aimed, gpu_without_int64, level, noisy, over};

/// The error of a call that must fail, with the words it must contain.
fn refused<T>(outcome: Result<T>, words: &[&str]) -> Error {
    let Err(error) = outcome else { panic!("this must be refused: {words:?}") };
    let line = line(&error);
    assert!(!line.contains('\n'), "one line: {line}");
    words.iter().for_each(|word| assert!(line.contains(word), "`{word}` is missing in: {line}"));
    error
}

fn flat(columns: usize, rows: usize) -> Dem {
    Dem::from_heights(columns, DVec2::splat(30.0), DVec2::ZERO, vec![0.0; columns * rows])
}

#[test]
fn an_adapter_of_no_name_is_refused_with_those_there_are() {
    let there = &gpu().info.name;
    let choice = AdapterChoice::Named("no such".into());
    let error = refused(Gpu::open(&choice, Int64::IfPresent), &["no such", "there is: ", there]);
    assert!(matches!(error, Error::NoAdapter { .. }));
    assert_eq!(exit_code(&error), 1);
}

/// From south of a [`flat`] DEM.
fn from_south(width: u32, height: u32) -> Camera {
    let eye = glam::DVec3::new(50.0, -200.0, 100.0);
    Camera { eye, azimuth: 0.0, altitude: -20.0, fov: 60.0, width, height }
}

#[test]
fn facets_beyond_their_ids_are_refused_with_numbers() {
    // 2896 x 2896 chunks of 512 facets have IDs, 2900 x 2900 have not; at level 64 a chunk is a quarter of a cell.
    assert!(Lattice::uniform(&flat(725, 725), level(64)).is_ok());
    let error =
        refused(Lattice::uniform(&flat(726, 726), level(64)), &["level 64", "4305920000 facets", "8388607", "--level"]);
    assert!(matches!(error, Error::Limit { .. }));
    refused(Lattice::uniform(&flat(131_001, 2), level(1)), &["131001 x 2", "131000", "--crop"]);
    assert!(Lattice::uniform(&flat(131_000, 2), level(1)).is_ok());
    // 2048 x 4096 chunks would need an ID of 2^32 - 1, and a pixel holds ID + 1.
    refused(Lattice::uniform(&flat(513, 1025), level(64)), &["level 64", "8388608 chunks"]);
    assert!(Lattice::uniform(&flat(512, 1025), level(64)).is_ok());
}

#[test]
fn pages_too_large_are_refused_with_numbers() {
    let scene = Arc::new(Surface::new(flat(4, 4)));
    let mut renderer = Planned::new(gpu(), &scene, Plan::new(level(1), Method::Walk, Border::On));
    let plan = renderer.plan;
    let mut draw = |pieces: Pieces| {
        let [width, height] = pieces.page();
        let frame = renderer.plan(&plan, &from_south(width, height))?.cut(pieces)?;
        renderer.page_of(frame, |_| ()).map(drop)
    };
    let piece = |size| Pieces::new(size, size);
    for (size, words) in [
        (piece([5000, 4000]), ["5000x4000", "20000000", "16777216", "--size"]),
        (piece([16_385, 16]), ["16385x16", "16384", "in one piece", "--size"]),
        (Pieces::from([65_537, 16]), ["65537x16", "65536", "page side", "--size"]),
        (Pieces::from([16, 70_000]), ["16x70000", "65536", "page side", "--size"]),
    ] {
        assert!(matches!(refused(draw(size), &words), Error::Limit { .. }));
    }
    assert!(draw(piece([16_384, 16])).is_ok());
    // One piece can be read back whole, of several the device holds the last alone.
    draw(Pieces::new([64, 48], [33, 48])).expect("two pieces");
    refused(renderer.read(), &["2 pieces", "--size"]);
}

#[test]
fn an_eye_out_of_reach_is_wrong_usage() {
    let scene = noisy(1, [8, 8], 50.0, 40.0);
    let mut renderer = Planned::by_id(gpu(), &scene, 1);
    let near = aimed(over(&scene, 3.0, 3.0, 50.0), 0.0, 0.0, [64, 64]);
    renderer.frame(&near).expect("an eye over the DEM");
    for eye in [near.eye * 1e6, near.eye.with_x(f64::NAN), near.eye.with_y(f64::INFINITY)] {
        let far = hachure::view::Camera { eye, ..near };
        let error = refused(renderer.frame(&far), &["--eye", "million cells", "CRS"]);
        assert!(matches!(error, Error::Setting { .. }));
        assert_eq!(exit_code(&error), 2);
        assert!(CameraUniform::new(scene.dem(), &far).is_err());
    }
}

#[test]
fn pages_that_are_empty_or_of_another_frame_are_wrong_usage() {
    let scene = Arc::new(Surface::new(flat(4, 4)));
    let mut renderer = Planned::by_id(gpu(), &scene, 1);
    let plan = renderer.plan;
    for (width, height) in [(0, 0), (0, 48), (64, 0)] {
        let camera = from_south(width, height);
        for outcome in [renderer.frame(&camera).map(drop), renderer.prepare(&plan, &camera)] {
            assert_eq!(exit_code(&refused(outcome, &["--size", &format!("{width}x{height} has no pixels")])), 2);
        }
    }
    let frame = renderer.plan(&plan, &from_south(64, 48)).expect("a frame");
    for page in [[64, 49], [63, 48], [48, 64], [0, 0]] {
        let cut = frame.clone().cut(Pieces::new(page, [32, 32]));
        let of = format!("of {}x{}", page[0], page[1]);
        assert!(matches!(refused(cut, &["--size", &of, "64x48"]), Error::Setting { .. }));
    }
    assert!(frame.cut(Pieces::new([64, 48], [32, 32])).is_ok());
}

#[test]
fn what_is_read_after_a_piece_is_that_piece() {
    let scene = noisy(1, [20, 20], 50.0, 40.0);
    let mut renderer = Planned::by_id(gpu(), &scene, 1);
    let camera = aimed(over(&scene, 3.0, 3.0, 50.0), 140.0, -10.0, [64, 48]);
    let frame = renderer.plan_in(&camera, Pieces::from([64, 48]));
    let whole = renderer.draw(&camera).expect("a frame").raster;
    for piece in Pieces::new([64, 48], [20, 30]).iter() {
        let drawn = renderer.draw_piece(&frame, piece).expect("a piece").raster;
        let read = renderer.read().expect("that piece").raster;
        assert_eq!([read.width, read.height], piece.drawn.size);
        assert!(read == drawn && read != whole, "{piece:?} is read as something else");
    }
    // Of a page in several pieces none is the page.
    let frame = renderer.plan_in(&camera, Pieces::new([64, 48], [32, 48]));
    let piece = frame.pieces.iter().next().expect("a piece");
    renderer.draw_piece(&frame, piece).expect("a piece");
    refused(renderer.read(), &["2 pieces", "--size"]);
}

#[test]
fn vertices_of_pieces_are_refused_in_words_of_pieces() {
    let scene = Arc::new(Surface::new(flat(4, 4)));
    let mut renderer = Planned::by_id(gpu(), &scene, 1);
    let plan = renderer.plan;
    let mut encoder = gpu().device.create_command_encoder(&Default::default());
    let large = renderer.record_vertices(&plan, &from_south(17_000, 16), &mut encoder);
    let error = refused(large, &["the page takes 9 pieces, one can be drawn", "--size"]);
    assert!(matches!(error, Error::Limit { .. }));
}

/// A pass of a shader with one override that it needs, one that it does not, and one that it only declares.
const SHADER: &str = "
    override needed: u32;
    override optional: u32 = 3u;
    override unused: u32;
    @group(0) @binding(0) var<storage, read_write> out_words: array<u32>;
    @compute @workgroup_size(1)
    fn fill(@builtin(global_invocation_id) at: vec3<u32>) { out_words[at.x] = needed + optional; }
";

/// The error of a call that fails by our mistake, and says so.
fn mistake<T>(outcome: Result<T>, words: &[&str]) {
    let error = refused(outcome, &[words, &["hachure's mistake", "report it"]].concat());
    assert!(matches!(error, Error::Mistake { .. }), "{error:?}");
    assert_eq!(exit_code(&error), 1);
}

#[test]
fn constants_that_a_shader_does_not_know_or_lacks_are_mistakes() {
    let pass = |constants: &[(&str, f64)]| gpu().pass("fill", SHADER, constants);
    mistake(pass(&[("needed", 1.0), ("needles", 1.0)]), &["pass fill", "no constant is named needles"]);
    mistake(pass(&[("optional", 1.0)]), &["pass fill", "needed has no value"]);
    assert!(pass(&[("needed", 1.0)]).is_ok() && pass(&[("needed", 1.0), ("unused", 1.0)]).is_ok());
}

#[test]
fn a_pass_is_compiled_once_for_the_constants_on_which_it_depends() {
    let gpu = Gpu::open(&AdapterChoice::Best, Int64::IfPresent).expect("an adapter");
    let pass = |constants: &[(&str, f64)]| gpu.pass("fill", SHADER, constants).expect("a pass");
    let first = pass(&[("needed", 1.0), ("unused", 1.0)]);
    assert!(Arc::ptr_eq(&first, &pass(&[("needed", 1.0), ("unused", 2.0)])));
    assert_eq!(gpu.compiled(), 1);
    assert!(!Arc::ptr_eq(&first, &pass(&[("needed", 2.0)])));
    assert!(!Arc::ptr_eq(&first, &pass(&[("needed", 1.0), ("optional", 1.0)])));
    assert_eq!(gpu.compiled(), 3);
    gpu.forget_passes();
    assert!(!Arc::ptr_eq(&first, &pass(&[("needed", 1.0)])));
    assert_eq!(gpu.compiled(), 4);
}

#[test]
fn what_the_driver_refuses_is_refused_whatever_other_threads_ask() {
    const TRIES: usize = 50;
    let gpu = Gpu::open(&AdapterChoice::Best, Int64::IfPresent).expect("an adapter");
    // More invocations than any device must grant.
    let source = SHADER.replace("workgroup_size(1)", "workgroup_size(4096)");
    let pass = gpu.pass("fill", SHADER, &[("needed", 1.0)]).expect("a pass");
    let usage = wgpu::BufferUsages::UNIFORM;
    let descriptor = wgpu::BufferDescriptor { label: None, size: 16, usage, mapped_at_creation: false };
    let no_storage = gpu.device.create_buffer(&descriptor);
    let done = AtomicBool::new(false);
    let (refusals, taken) = std::thread::scope(|scope| {
        let other = scope.spawn(|| {
            std::iter::repeat_with(|| gpu.check())
                .take_while(|_| !done.load(Ordering::Relaxed))
                .filter(Result::is_err)
                .count()
        });
        let tries = (0..TRIES).map(|_| {
            let bound = pass.bind(&gpu, |_| Some(no_storage.as_entire_binding())).map(drop);
            [gpu.pass("fill", source.clone(), &[("needed", 1.0)]).map(drop), bound]
        });
        let refusals: Vec<_> = tries.collect();
        done.store(true, Ordering::Relaxed);
        (refusals, other.join().expect("no panic"))
    });
    for [compiled, bound] in refusals {
        assert!(matches!(refused(compiled, &["workgroup"]), Error::Gpu { .. }));
        assert!(matches!(refused(bound, &["STORAGE"]), Error::Gpu { .. }));
    }
    assert_eq!(taken, 0, "errors went to another thread");
    assert_eq!(gpu.compiled(), 1 + TRIES, "a refused pass was kept");
}

#[test]
fn wrong_shaders_and_missing_buffers_are_mistakes() {
    mistake(gpu().pass("fill", "fn fill( {", &[]), &["pass fill", "error"]);
    mistake(gpu().pass("fill", "@compute @workgroup_size(1) fn fill() { let a: u32 = 1.0f; }", &[]), &["pass fill"]);
    mistake(gpu().pass("spill", SHADER, &[("needed", 1.0)]), &["pass spill", "no entry point"]);
    let pass = gpu().pass("fill", SHADER, &[("needed", 1.0)]).expect("a pass");
    mistake(pass.bind(gpu(), |_| None), &["pass fill", "no buffer is named words"]);
}

#[test]
fn passes_and_groups_that_no_frame_planned_are_mistakes() {
    let scene = Arc::new(Surface::new(flat(4, 4)));
    for gpu in [gpu(), gpu_without_int64()] {
        let mut renderer = Planned::by_id(gpu, &scene, 1);
        mistake(renderer.read(), &["no frame"]);
        let camera = from_south(64, 48);
        let frame = renderer.frame(&camera).expect("a frame");
        let on_device = renderer.on_device();
        mistake(on_device.buffer("no such"), &["no buffer is named no such"]);
        mistake(on_device.stages.get(PassName::Walk), &["pass walk is not of the plan"]);
        let piece = frame.pieces.iter().next().expect("a piece");
        let facing = frame.pass(PassName::Facing, 0).expect("planned");
        assert!(on_device.dispatch(&frame, piece, facing, [0, 0]).expect("a batch").is_some());
        let rounds = frame.visibility.rounds();
        for at in [[1, 0], [0, rounds]] {
            mistake(on_device.dispatch(&frame, piece, facing, at), &["pass facing binds nothing"]);
        }
        let tessellate = frame.pass(PassName::Tessellate, 0).expect("planned");
        assert!(on_device.dispatch(&frame, piece, tessellate, [0, 0]).expect("a batch").is_none(), "vertices stay");
        renderer.frame(&camera).expect("frames go on");
    }
}

#[test]
fn a_pixel_with_a_depth_and_no_facet_is_a_mistake() {
    let scene = Arc::new(Surface::new(flat(4, 4)));
    let mut renderer = Planned::by_id(gpu(), &scene, 1);
    renderer.frame(&from_south(64, 48)).expect("a frame");
    assert!(renderer.read().is_ok());
    // A depth in the higher word, no ID in the lower one, in three pixels.
    let words = [0, 1.0_f32.to_bits()].repeat(3);
    gpu().queue.write_buffer(&renderer.buffer("pixels"), 0, bytemuck::cast_slice(&words));
    mistake(renderer.read(), &["3 pixels have a depth and no facet"]);
    // What failed is not there to be read again.
    assert!(renderer.last().is_none());
    mistake(renderer.read(), &["no frame"]);
}

#[test]
fn a_device_that_grants_too_little_is_refused() {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    let open = |required_limits| {
        let descriptor = wgpu::DeviceDescriptor { required_limits, ..Default::default() };
        let (device, queue) = pollster::block_on(adapters[0].request_device(&descriptor)).expect("a device");
        Gpu::from_parts(device, queue)
    };
    let few = wgpu::Limits { max_storage_buffers_per_shader_stage: 15, ..Gpu::limits() };
    refused(open(few), &["grants 15 as max_storage_buffers_per_shader_stage, 16 are needed"]);
    let small = wgpu::Limits { max_storage_buffer_binding_size: 64 << 20, ..Gpu::limits() };
    refused(open(small), &["grants 67108864 as max_storage_buffer_binding_size, 134217728 are needed"]);
    // One that grants enough draws what ours draws.
    let scene = noisy(1, [20, 20], 50.0, 40.0);
    let camera = aimed(over(&scene, 3.0, 3.0, 50.0), 140.0, -10.0, [64, 64]);
    let theirs = Arc::new(open(Gpu::limits()).expect("a device"));
    assert!(!theirs.int64, "it was not asked for");
    let drawn = [&theirs, gpu_without_int64()].map(|gpu| Planned::by_id(gpu, &scene, 1).bytes(&camera));
    assert!(drawn[0] == drawn[1], "another picture on a device of theirs");
}

#[test]
#[should_panic(expected = "this must be refused")]
fn a_refusal_that_does_not_come_is_noticed() {
    refused(Lattice::uniform(&flat(4, 4), level(1)), &["level"]);
}

#[test]
#[should_panic(expected = "is missing in")]
fn a_refusal_without_its_numbers_is_noticed() {
    refused(Lattice::uniform(&flat(726, 726), level(64)), &["level 32"]);
}
