//! How long work may take: 30 s at least, 30 times what is expected, by a clock that others do not turn.

use std::thread::sleep;
use std::time::{Duration, Instant};

use hachure::door::gpu::pace::{Limits, Pace, Watch, Work};

use super::super::cli::stderr;

/// Work of so many seconds on a device that has done nothing yet.
fn work(seconds: f64) -> Work {
    Work::bytes((seconds * 1e9) as u64)
}

/// Pace of a GPU with looks so long that they may be waited for here.
fn gpu(least: f64, patience: f64) -> Pace {
    let pace = Pace::new(false);
    pace.set_limits(Limits { least, times: 30.0, patience, look: Duration::from_millis(20) });
    pace
}

/// What is said after a wait of so many looks.
fn after(mut watch: Watch, looks: u32) -> Option<String> {
    for _ in 0..looks {
        sleep(Duration::from_millis(20));
        watch.tick();
    }
    watch.hangs()
}

#[test]
fn a_part_hangs_after_30_s_or_30_times_what_is_expected() {
    let Limits { least, times, .. } = Limits::default();
    assert_eq!([least, times], [30.0; 2]);
    // 50 ms of submitting and waiting at the pace of a device that has done nothing yet: 1.5 s are 30 times as much.
    assert_eq!(after(gpu(0.1, 900.0).watch(Some(Work::NONE)), 12), None, "before 30 times what was expected");
    let quick = gpu(0.1, 900.0);
    quick.took(work(1e3), 0.0);
    quick.took(work(1e3), 0.0);
    quick.took(work(1e3), 0.0);
    quick.took(work(1e3), 0.0);
    quick.took(work(1e3), 0.0);
    let said = after(quick.watch(Some(Work::NONE)), 12).expect("it hangs");
    assert!(said.starts_with("it hangs: work that should take 0.0 s is not done after "), "{said}");
    let patient = gpu(30.0, 900.0);
    (0..5).for_each(|_| patient.took(work(1e3), 0.0));
    assert_eq!(after(patient.watch(Some(Work::NONE)), 12), None, "before 30 s");
    // Of what is unknown it is waited as long as for anything.
    assert_eq!(after(gpu(0.0, 900.0).watch(None), 12), None);
    assert!(after(gpu(0.0, 0.1).watch(None), 12).is_some_and(|said| said.contains("nothing came of it")));
}

#[test]
fn a_slow_part_makes_more_be_expected_until_others_were_fast() {
    let pace = Pace::new(true);
    assert!((pace.expected(work(1.0)) - 1.05).abs() < 1e-9);
    // A driver that compiles at first, or a machine that has become busy.
    pace.took(Work::NONE, 5.0);
    assert!((pace.expected(work(1.0)) - 105.0).abs() < 1e-6, "{}", pace.expected(work(1.0)));
    // What is no work tells nothing of how fast work is,
    (0..100).for_each(|_| pace.took(Work::NONE, 1e-4));
    assert!(pace.expected(work(1.0)) > 104.0);
    // work does, bit by bit.
    pace.took(work(1e3), 10.0);
    assert!((52.0..53.0).contains(&pace.expected(work(1.0))));
    (0..20).for_each(|_| pace.took(work(1e3), 10.0));
    assert!((0.01..0.02).contains(&pace.expected(work(1.0))));
}

#[test]
fn a_process_that_was_stopped_has_not_waited() {
    let mut watch = gpu(0.0, 900.0).watch(None);
    sleep(Duration::from_millis(400));
    let seconds = watch.tick();
    assert!((0.079..0.081).contains(&seconds), "{seconds} s of four looks");
}

#[test]
fn the_clock_of_a_software_driver_stands_while_others_have_the_machine() {
    // Alone in a process, for the time is the process's.
    let test = std::env::current_exe().expect("this program");
    let child = "faults::pace::child_is_idle_then_busy";
    let ran = std::process::Command::new(test).args(["--exact", child, "--ignored", "--nocapture"]).output();
    let ran = ran.expect("a child");
    let said = String::from_utf8_lossy(&ran.stdout).into_owned();
    assert!(ran.status.success() && said.contains("idle, then busy"), "{said}{}", stderr(&ran));
}

#[test]
#[ignore = "run by the_clock_of_a_software_driver_stands_while_others_have_the_machine in a process of its own"]
fn child_is_idle_then_busy() {
    let looks = |is_software: bool| {
        let pace = Pace::new(is_software);
        pace.watch(Some(Work::NONE))
    };
    let (mut software, mut hardware) = (looks(true), looks(false));
    sleep(Duration::from_millis(500));
    let (idle, wall) = (software.tick(), hardware.tick());
    assert!(idle < 0.1 && wall >= 0.5, "idle: {idle} s of {wall} s");
    // So long that it had some of a core, however many want one.
    let began = Instant::now();
    while software.tick() < idle + 0.1 {
        assert!(began.elapsed() < Duration::from_secs(60), "it works, and its clock stands");
    }
    println!("idle, then busy");
}
