//! Limits of the system (`ulimit`): each is told in one line with exit code 1; nothing aborts, and nothing is left behind.
#![cfg(target_os = "linux")]

use std::os::unix::process::CommandExt;
use std::process::Output;

use crate::cli::{Place, stderr};

/// Runs it with a limit set to so much.
fn limited(place: &Place, resource: libc::__rlimit_resource_t, most: u64, arguments: &[&str]) -> Output {
    let mut command = place.command(arguments);
    // SAFETY: `setrlimit` may be called between fork and exec.
    unsafe {
        command.pre_exec(move || {
            let limit = libc::rlimit { rlim_cur: most, rlim_max: most };
            if libc::setrlimit(resource, &limit) == 0 { Ok(()) } else { Err(std::io::Error::last_os_error()) }
        });
    }
    command.output().expect("hachure runs")
}

/// Fails unless it drew or said why not in one line; returns that line.
fn in_one_line(output: &Output, about: &str) -> Option<String> {
    let said = stderr(output);
    let errors: Vec<_> = said.lines().filter(|line| !line.starts_with("warning: ")).collect();
    match output.status.code() {
        Some(0) => None,
        // The loader of the program had too little for its libraries: nothing of ours has run.
        Some(127) if said.contains("shared libraries") => None,
        Some(1) => {
            assert_eq!(errors.len(), 1, "{about}: {said}");
            Some(errors[0].to_owned())
        }
        code => panic!("{about}: exit {code:?}, {:?}: {said}", output.status),
    }
}

#[test]
fn a_file_too_large_is_an_error_of_writing() {
    let place = Place::new();
    for most in [0, 100] {
        let draw = ["draw", "hill.asc", "-o", "out.png", "--size", "640x480"];
        let output = limited(&place, libc::RLIMIT_FSIZE, most, &draw);
        let said = in_one_line(&output, "a file").expect("an error");
        assert!(said.starts_with("error: out.png: cannot be written (") && said.contains("`ulimit -f"), "{said}");
        assert_eq!(place.written(), Vec::<String>::new());
    }
}

#[test]
fn memory_that_ends_is_told_in_one_line() {
    let place = Place::new();
    // 2.6 million samples.
    let size = ["generate", "dem", "-o", "large.tif", "--size", "1600x1600"];
    assert!(place.run(&size).status.success());
    // From a given eye: to choose one takes longer than all else.
    let draw =
        ["draw", "large.tif", "-o", "out.png", "--size", "320x240", "--eye", "500000,5530000,+500", "--azimuth", "0"];
    let (mut told, mut drawn) = (0, 0);
    for most in [230, 330, 560, 640, 760, 4000] {
        for memory in ["1GiB", "8MiB"] {
            for command in [&["info", "large.tif"][..], &draw] {
                let about = format!("{most} MiB, --memory {memory}, {}", command[0]);
                let arguments = [command, &["--memory", memory]].concat();
                let output = limited(&place, libc::RLIMIT_AS, most << 20, &arguments);
                match in_one_line(&output, &about) {
                    Some(said) => {
                        assert!(said.to_lowercase().contains("memory"), "{about}: {said}");
                        assert!(!said.contains("no GPU adapter") && !said.contains("damaged"), "{about}: {said}");
                        told += 1;
                    }
                    None => drawn += 1,
                }
                let left: Vec<_> = place.written().into_iter().filter(|name| name.starts_with('.')).collect();
                assert!(left.is_empty(), "{about}: {left:?}");
            }
        }
    }
    assert!(told > 4 && drawn > 4, "{told} told, {drawn} drawn");
}

#[test]
fn no_adapter_is_said_only_where_there_is_none() {
    let place = Place::new();
    let draw = ["draw", "hill.asc", "-o", "out.png", "--size", "64x48"];
    let said = in_one_line(&limited(&place, libc::RLIMIT_AS, 400 << 20, &draw), "400 MiB").expect("an error");
    assert!(said.contains("MiB of memory are left, a GPU driver needs") && said.contains("ulimit -v"), "{said}");
    let mut command = place.command(&draw);
    command.env("VK_DRIVER_FILES", "/nonexistent").env("VK_ICD_FILENAMES", "/nonexistent");
    // SAFETY: as above.
    unsafe {
        command.pre_exec(|| {
            let limit = libc::rlimit { rlim_cur: 8 << 30, rlim_max: 8 << 30 };
            if libc::setrlimit(libc::RLIMIT_AS, &limit) == 0 { Ok(()) } else { Err(std::io::Error::last_os_error()) }
        });
    }
    let said = stderr(&command.output().expect("hachure runs"));
    assert!(said.contains("no GPU adapter: "), "enough memory, and none there: {said}");
}

#[test]
fn few_handles_and_little_stack_do() {
    let place = Place::new();
    let draw = ["draw", "hill.asc", "-o", "out.png", "--size", "64x48"];
    for (resource, most) in [(libc::RLIMIT_NOFILE, 12), (libc::RLIMIT_NOFILE, 40), (libc::RLIMIT_STACK, 200 << 10)] {
        let output = limited(&place, resource, most, &draw);
        in_one_line(&output, &format!("limit {resource} of {most}"));
    }
}
