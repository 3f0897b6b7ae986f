//! Devices that are lost or hang while they draw.

use std::process::{Command, Output, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use clap::Parser;
use hachure::door::cli::words::{exit_code, line};
use hachure::door::cli::{Arguments, threads};
use hachure::door::gpu::device::WAITED;
use hachure::door::gpu::pace::{Limits, Work};
use hachure::error::Error;
use hachure::gpu::{AdapterChoice, Gpu, Int64};

use super::{DRAW, ended, files, undisturbed};
use crate::cli::Place;
use crate::fly::{bytes, fly, frames, half_made};
use crate::frames::Planned;
use crate::scenes::{aimed, noisy, over};

/// Whatever happens, a child ends sooner.
const PATIENCE: Duration = Duration::from_secs(60);
/// What is done to the device of a child, and the words between its arguments.
const FAULT: &str = "HACHURE_TEST_FAULT";
const RUN: &str = "HACHURE_TEST_RUN";

/// Each invocation goes round as often as software drivers let any, which end loops of more than 65 535 turns.
const SLOW: &str = "
    @group(0) @binding(0) var<storage, read_write> out_words: array<u32>;
    @compute @workgroup_size(1)
    fn fill(@builtin(global_invocation_id) at: vec3<u32>) {
        var word = at.x;
        for (var i = 0u; i < 60000u; i++) { word = word * 1664525u + (word >> 16u) + i; }
        out_words[word & 3u] = word;
    }
";

/// So many invocations across and down as nobody sees the end of.
const ENDLESS: [u32; 2] = [65_535; 2];

/// Submits work of so many invocations.
fn busy(gpu: &Gpu, invocations: [u32; 2]) {
    let pass = gpu.pass("fill", SLOW, &[]).expect("a pass");
    let words = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("words"),
        size: 16,
        usage: wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    });
    let group = pass.bind(gpu, |_| Some(words.as_entire_binding())).expect("a group");
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    pass.record(&mut encoder.begin_compute_pass(&Default::default()), &group, invocations);
    gpu.queue.submit([encoder.finish()]);
}

fn open() -> Gpu {
    Gpu::open(&AdapterChoice::Best, Int64::IfPresent).expect("an adapter")
}

/// Whatever is expected, it hangs after so long.
fn hasty(seconds: f64) -> Limits {
    Limits { least: seconds, times: 0.0, look: Duration::from_millis(20), ..Limits::default() }
}

#[test]
fn work_that_is_slow_is_waited_for_and_work_that_hangs_is_not() {
    let gpu = open();
    // A device that is told to be hasty waits for what is done in time,
    busy(&gpu, [1; 2]);
    gpu.wait_for(Work::NONE).expect("it compiles");
    gpu.pace.set_limits(hasty(5.0));
    busy(&gpu, [100, 1]);
    gpu.wait_for(Work::NONE).expect("slow is not hanging");
    // and not for what is not: some seconds of work, since whoever ends the process waits for it.
    gpu.pace.set_limits(hasty(0.05));
    busy(&gpu, [20_000, 1]);
    let Err(error) = gpu.wait_for(Work::NONE) else { panic!("it hangs") };
    assert!(matches!(error, Error::DeviceLost { .. }) && exit_code(&error) == 75);
    let line = line(&error);
    assert!(line.starts_with("the GPU was lost: it hangs: work that should take "), "{line}");
    assert!(line.ends_with("; try again, or use `--adapter cpu`"), "{line}");
}

#[test]
fn a_device_that_is_lost_stays_lost_whatever_is_asked() {
    let gpu = Arc::new(open());
    let scene = noisy(1, [20, 20], 50.0, 40.0);
    let camera = aimed(over(&scene, 3.0, 3.0, 50.0), 140.0, -10.0, [64, 48]);
    let mut renderer = Planned::by_id(&gpu, &scene, 1);
    renderer.frame(&camera).expect("a frame");
    gpu.device.destroy();
    for _ in 0..3 {
        let lost = |error: Option<Error>| assert!(matches!(error, Some(Error::DeviceLost { .. })), "{error:?}");
        lost(gpu.wait().err());
        lost(gpu.check().err());
        lost(gpu.pass("fill", SLOW, &[]).err());
        lost(renderer.frame(&camera).err());
    }
}

/// Runs the command line in a process of its own, in which something is done to the device.
fn faulty(place: &Place, fault: &str, arguments: &[&str]) -> Output {
    let mut child = Command::new(std::env::current_exe().expect("this program"));
    child.args(["--exact", "faults::devices::child_has_a_fault", "--ignored", "--nocapture"]);
    child.current_dir(place.path("")).env(FAULT, fault).env(RUN, arguments.join("\n"));
    let mut child = child.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("a child");
    let began = Instant::now();
    while child.try_wait().expect("a status").is_none() {
        if began.elapsed() > PATIENCE {
            let _ = child.kill();
            panic!("{fault}: {arguments:?} does not end");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    child.wait_with_output().expect("a status")
}

/// The fault as an environment tells it: that the device hangs, or is lost, and at which of the waits for it.
fn afflict(gpu: &Gpu) {
    static WAITS: AtomicU32 = AtomicU32::new(0);
    let fault = std::env::var(FAULT).expect("a fault");
    let (what, at) = fault.split_once(' ').expect("what and when");
    if WAITS.fetch_add(1, Ordering::SeqCst) != at.parse::<u32>().expect("a number") {
        return;
    }
    match what {
        "hangs" => {
            gpu.pace.set_limits(hasty(0.5));
            busy(gpu, ENDLESS);
        }
        _ => gpu.device.destroy(),
    }
}

#[test]
#[ignore = "run by others here in a process of its own"]
fn child_has_a_fault() {
    threads::prepare();
    let run = std::env::var(RUN).expect("arguments");
    let arguments = Arguments::parse_from(["hachure"].into_iter().chain(run.lines()));
    assert!(WAITED.set(afflict).is_ok());
    let code = arguments.run_to_end(&arguments.talk());
    // Nothing of the harness is said after the program's own words.
    std::process::exit(if code == std::process::ExitCode::SUCCESS { 0 } else { 1 });
}

/// The waits at which something happens: of a drawing there are a dozen and, by the pace of the device, some more.
const STAGES: [u32; 5] = [0, 2, 4, 7, 1000];

/// What is said of it, from the beginning and at the end.
const WORDS: [&str; 2] = ["error: the GPU was lost: it", "; try again, or use `--adapter cpu`"];

/// Draws with a fault at every stage: what is drawn is whole, else nothing is there.
fn draws_with(fault: &str) {
    let place = Place::new();
    let draw = [&DRAW[..], &["--hachures", "none"]].concat();
    std::fs::create_dir_all(place.path("out")).expect("a folder");
    let whole = undisturbed(&place, &draw);
    let ends = STAGES.map(|stage| {
        let about = format!("{fault} {stage}");
        std::fs::create_dir_all(place.path("out")).expect("a folder");
        let output = faulty(&place, &about, &draw);
        let [made, half] = files(&place.path("out"));
        assert!(half.is_empty(), "{about}");
        if output.status.code() == Some(0) {
            assert!(made == whole, "{about}: another picture");
            return true;
        }
        ended(&output, 75, &WORDS, &about);
        assert!(made.is_empty(), "{about}: {} files", made.len());
        false
    });
    assert!(!ends[0] && ends[4] && ends.is_sorted(), "what comes after the end alone changes nothing: {ends:?}");
}

#[test]
fn a_driver_that_hangs_at_any_stage_ends_the_process_with_75() {
    draws_with("hangs");
}

#[test]
fn a_device_that_is_lost_at_any_stage_ends_the_process_with_75() {
    draws_with("lost");
}

#[test]
fn a_flight_goes_on_where_its_device_was_lost() {
    let (place, whole) = (Place::new(), crate::fly::undisturbed());
    let flight = fly("flown/%05d.png", &["--hachures", "none"]);
    for fault in ["lost 20", "hangs 40"] {
        ended(&faulty(&place, fault, &flight), 75, &WORDS[..1], fault);
        let made = frames(&place.path("flown"));
        assert!(made.len() < whole.len(), "{fault}");
        made.iter().for_each(|(name, (bytes, _))| assert_eq!(*bytes, whole[name].0, "{name}"));
        assert_eq!(half_made(&place.path("flown")), Vec::<String>::new(), "{fault}");
    }
    let output = place.run(&flight);
    assert_eq!(output.status.code(), Some(0), "{}", crate::cli::stderr(&output));
    assert_eq!(bytes(&frames(&place.path("flown"))), bytes(whole));
}
