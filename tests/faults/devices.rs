//! Devices that are lost or hang while they draw.

use std::process::{Command, Output};
use std::sync::Arc;
use std::time::Duration;

use clap::Parser;
use hachure::door::cli::words::{exit_code, line};
use hachure::door::cli::{Arguments, threads};
use hachure::door::gpu::device::OPENED;
use hachure::door::gpu::pace::{Limits, Work};
use hachure::error::Error;
use hachure::gpu::{AdapterChoice, Gpu, Int64};

use super::{DRAW, ended, files, undisturbed};
use crate::cli::Place;
use crate::fly::{bytes, fly, frames};
use crate::frames::Planned;
use crate::scenes::{Random, aimed, noisy, over};

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
    busy(&gpu, [65_535, 1]);
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
    child.output().expect("a child")
}

/// The fault as an environment tells it: `hang`, or after how many milliseconds the device is lost.
fn afflict(gpu: &Gpu) {
    let fault = std::env::var(FAULT).unwrap_or_default();
    if fault == "hang" {
        busy(gpu, ENDLESS);
        gpu.pace.set_limits(hasty(0.5));
        return;
    }
    let (device, after) = (gpu.device.clone(), fault.parse().expect("milliseconds"));
    std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(after));
        device.destroy();
    });
}

#[test]
#[ignore = "run by others here in a process of its own"]
fn child_has_a_fault() {
    threads::prepare();
    let run = std::env::var(RUN).expect("arguments");
    let arguments = Arguments::parse_from(["hachure"].into_iter().chain(run.lines()));
    assert!(OPENED.set(afflict).is_ok());
    let code = arguments.run_to_end(&arguments.talk());
    // Nothing of the harness is said after the program's own words.
    std::process::exit(if code == std::process::ExitCode::SUCCESS { 0 } else { 1 });
}

#[test]
fn a_driver_that_hangs_ends_the_process_with_75() {
    let place = Place::new();
    let words = ["error: the GPU was lost: it hangs: ", "; try again, or use `--adapter cpu`"];
    for run in [&[&DRAW[..], &["--hachures", "none"]].concat(), &fly("out/%05d.png", &["-q"])[..]] {
        std::fs::create_dir_all(place.path("out")).expect("a folder");
        let output = faulty(&place, "hang", run);
        ended(&output, 75, &words, run[0]);
        let [whole, half] = files(&place.path("out"));
        let pictures = whole.iter().filter(|(name, _)| !name.ends_with(".json")).count();
        assert_eq!((pictures, half.len()), (0, 0), "{}", run[0]);
    }
}

#[test]
fn a_device_lost_at_any_moment_ends_with_75_and_the_next_run_goes_on() {
    let place = Place::new();
    let draw = [&DRAW[..], &["--hachures", "none"]].concat();
    std::fs::create_dir_all(place.path("out")).expect("a folder");
    let whole = undisturbed(&place, &draw);
    let (mut random, mut lost) = (Random::new(11), 0);
    for i in 0..6 {
        std::fs::create_dir_all(place.path("out")).expect("a folder");
        // At once, and at any moment of a run of about 600 ms.
        let after = if i == 0 { 0 } else { random.below(100) * i };
        let output = faulty(&place, &after.to_string(), &draw);
        let about = format!("lost after {after} ms");
        let [made, half] = files(&place.path("out"));
        assert!(half.is_empty(), "{about}");
        match output.status.code() {
            Some(0) => assert!(made == whole, "{about}: another picture"),
            _ => {
                ended(&output, 75, &["error: the GPU was lost: ", "; try again, or use `--adapter cpu`"], &about);
                assert!(made.is_empty(), "{about}: {}", made.len());
                lost += 1;
            }
        }
    }
    assert!(lost >= 2, "only {lost} of 6 were lost");
    let flight = fly("flown/%05d.png", &["--hachures", "none"]);
    let output = faulty(&place, "700", &flight);
    let made = frames(&place.path("flown"));
    let whole = crate::fly::undisturbed();
    if output.status.code() != Some(0) {
        ended(&output, 75, &["error: the GPU was lost: "], "a flight");
        assert!(made.len() < whole.len());
    }
    made.iter().for_each(|(name, (bytes, _))| assert_eq!(*bytes, whole[name].0, "{name}"));
    assert_eq!(place.run(&flight).status.code(), Some(0));
    assert_eq!(bytes(&frames(&place.path("flown"))), bytes(whole));
}
