//! The program in a shell: how loud it is, `-` for standard output, colours, progress, help, completions, man pages.

use std::fs;
use std::process::{Command, Output, Stdio};
#[cfg(target_os = "linux")]
use std::thread;
#[cfg(target_os = "linux")]
use std::time::{Duration, Instant};

use clap::{CommandFactory, Parser};
use hachure::door::cli::Arguments;
use serde_json::Value;

use crate::cli::{DRAW, Place, QUICK, refuses, stderr};

/// An eye that is worth a warning.
const BELOW: [&str; 4] = ["--eye", "500200,4000200,20", "--azimuth", "0"];
/// A progress bar begins so behind its stage; no line does.
#[cfg(target_os = "linux")]
const BAR: &str = "  [";

fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn succeeds(output: Output) -> Output {
    assert!(output.status.success(), "{}", stderr(&output));
    output
}

#[test]
fn quiet_says_errors_and_answers_only() {
    let place = Place::new();
    let loud = succeeds(place.run(&[&QUICK[..], &BELOW].concat()));
    assert!(stdout(&loud).contains("view: ") && stderr(&loud).contains("warning: "));
    for quiet in [[&["-q"], &QUICK[..], &BELOW].concat(), [&QUICK[..], &BELOW, &["--quiet"]].concat()] {
        let output = succeeds(place.run(&quiet));
        assert_eq!((stdout(&output), stderr(&output)), (String::new(), String::new()), "{quiet:?}");
    }
    let failed = place.run(&["-q", "draw", "none.tif", "-o", "out.png"]);
    assert_eq!(failed.status.code(), Some(1));
    assert!(stderr(&failed).starts_with("error: none.tif: "), "{}", stderr(&failed));
    let [loud, quiet] = [&["info", "hill.asc"][..], &["-q", "info", "hill.asc"]].map(|a| stdout(&place.run(a)));
    assert!(loud.lines().count() > 4);
    assert_eq!(loud, quiet);
    assert_eq!(place.run(&[&QUICK[..], &["-q", "-v"]].concat()).status.code(), Some(2));
}

#[test]
fn verbose_says_what_was_left_out_and_the_times_that_were_taken() {
    let place = Place::new();
    let draw = [&QUICK[..], &["--border", "off"]].concat();
    let said = |more: &[&str]| stdout(&succeeds(place.run(&[&draw[..], more].concat())));
    let (normal, verbose, timed) = (said(&[]), said(&["-v"]), said(&["-v", "--json", "report.json"]));
    for (words, expected) in [
        ("driver: ", [false, true, true]),
        ("left out: border pass, --border off", [false, true, true]),
        ("pass rasterize: ", [false, false, true]),
        ("median frame: ", [false, false, true]),
    ] {
        assert_eq!([&normal, &verbose, &timed].map(|text| text.contains(words)), expected, "{words}");
    }
}

#[test]
fn a_dash_gives_the_bytes_of_the_file_and_nothing_else() {
    let place = Place::new();
    succeeds(place.run(&[&QUICK[..], &["--mask", "mask.png"]].concat()));
    let written = ["out.png", "mask.png"].map(|name| fs::read(place.path(name)).expect(name));
    let picture = succeeds(place.run(&[&["draw", "hill.asc", "-o", "-", "-v"], &QUICK[4..]].concat()));
    let mask = succeeds(place.run(&[&QUICK[..], &["--mask", "-"]].concat()));
    assert!([picture.stdout, mask.stdout] == written, "standard output differs from the files");
    let lines = String::from_utf8_lossy(&picture.stderr).into_owned();
    assert!(lines.contains("view: ") && lines.contains("driver: "), "lines go aside: {lines}");
    let report = succeeds(place.run(&[&QUICK[..], &["--json", "-"]].concat()));
    let report: Value = serde_json::from_slice(&report.stdout).expect("nothing but JSON");
    assert!(report["facets"].is_number());
    assert_eq!(place.written(), ["mask.png", "out.png"]);
}

#[test]
fn standard_output_holds_one_file() {
    let place = Place::new();
    let words = "standard output is another output already";
    refuses(&place, &["draw", "hill.asc", "-o", "-", "--mask", "-"], 2, words);
    refuses(&place, &["draw", "hill.asc", "-o", "-", "--json", "-"], 2, words);
    refuses(&place, &[&QUICK[..], &["--mask", "-", "--json", "-"]].concat(), 2, words);
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_standard_output_leaves_no_file_and_a_closed_one_is_no_error() {
    let place = Place::new();
    let draw = [&QUICK[..], &["--mask", "-"]].concat();
    let full = fs::OpenOptions::new().write(true).open("/dev/full").expect("/dev/full");
    let output = place.command(&draw).stdout(full).output().expect("hachure runs");
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stderr(&output).contains("error: standard output: cannot be written"), "{}", stderr(&output));
    assert_eq!(place.written(), Vec::<String>::new());

    let mut child = place.command(&draw).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("hachure runs");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("a status");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(!stderr(&output).contains("error"), "{}", stderr(&output));
    assert_eq!(place.written(), ["out.png"]);
}

#[test]
fn no_colour_goes_into_a_pipe() {
    let place = Place::new();
    let below = [&QUICK[..], &BELOW].concat();
    let cases: [(&[&str], &str); 4] = [
        (&below, "warning:"),
        (&["info", "none.tif"], "error:"),
        (&["info", "--size"], "error:"),
        (&["draw", "--help"], "Usage:"),
    ];
    for (arguments, word) in cases {
        let text = |force: &str| {
            let output = place.command(arguments).env("CLICOLOR_FORCE", force).output().expect("hachure runs");
            stdout(&output) + &stderr(&output)
        };
        let (plain, forced) = (text(""), text("1"));
        assert!(plain.contains(word) && !plain.contains('\x1b'), "{arguments:?}: {plain:?}");
        assert!(forced.contains('\x1b'), "{arguments:?}, where colour is forced: {forced:?}");
    }
}

#[test]
fn completions_and_man_pages_hold_every_flag() {
    let place = Place::new();
    let generate = |arguments: &[&str]| stdout(&succeeds(place.run(&[&["generate"], arguments].concat())));
    let completions = ["bash", "zsh", "fish", "elvish", "powershell"].map(|shell| generate(&["completions", shell]));
    let pages = generate(&["man"]).replace("\\-", "-");
    assert_eq!(pages.matches("\n.TH hachure").count(), 11, "one page a subcommand: {pages}");
    let command = Arguments::command();
    let of = |name| command.find_subcommand(name).expect("a subcommand").get_arguments();
    let shown = of("draw")
        .chain(of("fly"))
        .chain(of("stress"))
        .chain(of("batch"))
        .chain(of("merge"))
        .chain(of("compare"))
        .chain(of("pick"))
        .chain(of("styles"))
        .filter(|a| !a.is_hide_set());
    let shown = shown.filter_map(|a| a.get_long()).collect::<Vec<_>>();
    assert!(["azimuth", "output", "truth-level"].iter().all(|flag| shown.contains(flag)));
    for flag in shown {
        assert!(pages.contains(&format!("--{flag}")), "no man page knows --{flag}");
        assert!(completions[0].contains(&format!("--{flag} ")), "bash does not know --{flag}");
        assert!(completions.iter().all(|text| text.contains(flag)), "a shell does not know --{flag}");
    }
    generate(&["man", "-o", "."]);
    assert_eq!(
        place.written(),
        ["batch", "cache", "compare", "draw", "fly", "info", "merge", "pick", "stress", "styles"]
            .map(|name| format!("hachure-{name}.1"))
            .into_iter()
            .chain(["hachure.1".to_owned()])
            .collect::<Vec<_>>()
    );
    let names = ["draw", "fly", "batch", "merge", "compare", "stress", "pick", "cache", "styles", "info"]
        .map(|name| format!("-{name}"));
    let files = [""].into_iter().chain(names.iter().map(String::as_str)).map(|name| format!("hachure{name}.1"));
    let files = files.map(|name| fs::read_to_string(place.path(&name)).expect("a page")).collect::<String>();
    assert_eq!(files.replace("\\-", "-"), pages);
    assert!(!stdout(&place.run(&["--help"])).contains("generate"), "it is for packagers, so hidden");
}

#[test]
fn terrain_is_made_of_any_size_and_the_same_again() {
    let place = Place::new();
    for name in ["a.tif", "b.tif"] {
        succeeds(place.run(&["generate", "dem", "-o", name, "--size", "700x530"]));
    }
    let [a, b] = ["a.tif", "b.tif"].map(|name| fs::read(place.path(name)).expect(name));
    assert!(a == b && a.len() > 100_000, "{} and {} bytes", a.len(), b.len());
    let told = stdout(&succeeds(place.run(&["info", "--memory", "64KiB", "a.tif"])));
    assert!(told.contains("700 columns x 530 rows") && told.contains("cell       30 m x 30 m"), "{told}");
    for wrong in ["1x5", "131001x5", "5", "-5x5", ""] {
        assert_eq!(place.run(&["generate", "dem", "-o", "c.tif", "--size", wrong]).status.code(), Some(2), "{wrong}");
    }
    for wrong in ["64", "GiB", "-1GiB", "0B", "1e9GiB", "NaNB", "1 XB"] {
        assert_eq!(place.run(&["info", "--memory", wrong, "a.tif"]).status.code(), Some(2), "{wrong}");
    }
    let failed = place.run(&["generate", "dem", "-o", "nowhere/c.tif", "--size", "9x9"]);
    assert!(stderr(&failed).starts_with("error: nowhere/c.tif: cannot be written"), "{}", stderr(&failed));
}

/// Lines of a text that begin with our name, and what does so behind a pipe; those that go on are put together.
pub fn commands(text: &str) -> Vec<String> {
    let text = text.replace("\\\n", " ");
    let piped = text.lines().flat_map(|line| line.split("| ")).map(str::trim);
    piped.filter(|line| line.starts_with("hachure ")).map(str::to_owned).collect()
}

/// The words of a command, up to a file to write to or a remark.
pub fn words(command: &str) -> impl Iterator<Item = &str> {
    command.split_whitespace().take_while(|word| ![">", "#"].contains(word))
}

#[test]
fn examples_in_help_are_commands() {
    let mut command = Arguments::command();
    command.build();
    let shown = command.get_subcommands().filter(|c| !c.is_hide_set() && c.get_name() != "help");
    for command in std::iter::once(&command).chain(shown) {
        let help = command.get_after_help().unwrap_or_else(|| panic!("{} has no example", command.get_name()));
        let examples = commands(&help.to_string());
        assert!(!examples.is_empty(), "{} has no example", command.get_name());
        for example in examples {
            Arguments::try_parse_from(words(&example)).unwrap_or_else(|e| panic!("{example}: {e}"));
        }
    }
}

/// A line of shell in a terminal, all it shows as standard output.
#[cfg(target_os = "linux")]
fn terminal(line: &str) -> Command {
    let mut command = Command::new("script");
    command.args(["-qec", line, "/dev/null"]).env("TERM", "xterm").env("SHELL", "/bin/sh").stdin(Stdio::null());
    command
}

#[test]
#[cfg(target_os = "linux")]
fn a_terminal_gets_colours_and_no_picture() {
    let place = Place::new();
    let run = |line: &str| {
        let line = line.replace("hachure", env!("CARGO_BIN_EXE_hachure"));
        terminal(&line).current_dir(place.path("")).env_remove("NO_COLOR").output().expect("script runs")
    };
    let coloured = run("hachure info none.tif");
    assert_eq!(coloured.status.code(), Some(1));
    assert!(stdout(&coloured).contains("\x1b[31merror:"), "{:?}", stdout(&coloured));
    let plain = run("NO_COLOR=1 hachure info none.tif");
    assert!(stdout(&plain).contains("error: ") && !stdout(&plain).contains('\x1b'), "{:?}", stdout(&plain));
    for line in ["hachure draw hill.asc -o -", "hachure draw hill.asc -o out.png --mask -"] {
        let refused = run(line);
        assert_eq!(refused.status.code(), Some(2), "{line}");
        assert!(stdout(&refused).contains("standard output is a terminal; "), "{:?}", stdout(&refused));
    }
    assert_eq!(place.written(), Vec::<String>::new());
}

/// Draws so many facets that work is left when the first file is seen, held up for over a second then; all that was said.
#[cfg(target_os = "linux")]
fn held_up(place: &Place, arguments: &str, shell: impl Fn(&str) -> Command) -> String {
    let signal = |name: &str| {
        let pid = fs::read_to_string(place.path("pid")).expect("pid");
        assert!(Command::new("kill").args([name, pid.trim()]).status().expect("kill runs").success());
    };
    let hachure = env!("CARGO_BIN_EXE_hachure");
    let line =
        format!("{hachure} {arguments} {} --size 640x480 --level 32 & echo $! > pid; wait $!", DRAW[..4].join(" "));
    let mut command = shell(&line);
    let command = command.current_dir(place.path("")).stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = command.spawn().expect("a shell");
    while !place.written().iter().any(|name| name.starts_with(".hachure-")) {
        thread::sleep(Duration::from_millis(2));
    }
    signal("-STOP");
    thread::sleep(Duration::from_millis(1200));
    signal("-CONT");
    let output = succeeds(child.wait_with_output().expect("a status"));
    stdout(&output) + &stderr(&output)
}

#[test]
#[cfg(target_os = "linux")]
fn long_work_shows_progress_on_a_terminal_alone() {
    let place = Place::new();
    let pipe = |line: &str| {
        let mut command = Command::new("sh");
        command.args(["-c", line]);
        command
    };
    let shown = held_up(&place, "", terminal);
    assert!(shown.contains(BAR), "{shown:?}");
    let last = shown.rfind("out.png: ").expect("the last line");
    assert!(shown[..last].ends_with("\r\x1b[2K") && !shown[last..].contains(BAR), "the bar is gone: {shown:?}");
    for (said, words) in [(held_up(&place, "", pipe), "view: "), (held_up(&place, "-q", terminal), "")] {
        assert!(said.contains(words) && !said.contains(BAR), "{said:?}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn short_work_shows_no_progress() {
    let place = Place::new();
    let line = format!("{} {} --adapter none", env!("CARGO_BIN_EXE_hachure"), DRAW.join(" "));
    // A busy machine may need a second try.
    let quick = (0..20).find_map(|_| {
        let began = Instant::now();
        let output = terminal(&line).current_dir(place.path("")).output().expect("script runs");
        (began.elapsed() < Duration::from_millis(900)).then_some(output)
    });
    let said = stdout(&quick.expect("a run of less than a second"));
    assert!(said.contains("none is named") && !said.contains(BAR), "{said:?}");
}
