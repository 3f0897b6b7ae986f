//! Which adapters there are, and which one is meant: two equal ones are the software driver, listed twice.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

use hachure::gpu::Adapter;

use crate::cli::{Place, QUICK, stderr};
use crate::common::gpu;

/// The manifest of the software driver, where drivers are found on Linux.
fn software() -> PathBuf {
    let entries = fs::read_dir("/usr/share/vulkan/icd.d").expect("drivers of Vulkan").flatten();
    let mut paths = entries.map(|entry| entry.path());
    paths.find(|path| path.to_string_lossy().contains("lvp")).expect("the software driver")
}

/// The program on a machine with two adapters that nothing but their numbers tells apart.
fn on_two(place: &Place, arguments: &[&str]) -> Output {
    let both = ["a.json", "b.json"].map(|name| place.path(name));
    for copy in &both {
        fs::copy(software(), copy).expect("room");
    }
    let both = std::env::join_paths(both).expect("two paths");
    let mut command: Command = place.command(arguments);
    command.env("VK_DRIVER_FILES", &both).env("VK_ICD_FILENAMES", &both).output().expect("hachure runs")
}

/// Numbers and names of a table.
fn rows(output: &Output) -> Vec<(String, String)> {
    assert_eq!(output.status.code(), Some(0), "{}", stderr(output));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().expect("a header").split_whitespace().collect();
    assert_eq!(header, ["number", "bus", "memory", "name"]);
    let row = |line: &str| {
        let cells: Vec<&str> = line.split_whitespace().collect();
        assert!(cells[2].parse::<f64>().is_ok_and(|size| size > 0.0) && cells[3] == "GiB", "{line}");
        (cells[0].to_owned(), cells[4..].join(" "))
    };
    lines.map(row).collect()
}

#[test]
fn adapters_are_listed_with_the_best_one_first() {
    let place = Place::new();
    let listed = rows(&place.run(&["info", "--adapters"]));
    let all = Adapter::all().expect("adapters");
    let known: Vec<_> = all.iter().map(|adapter| (adapter.number.to_string(), adapter.name.clone())).collect();
    assert_eq!(listed, known);
    assert_eq!((all[0].number, &all[0].name), (0, &gpu().info.name), "what is taken unless told");
    assert_eq!(rows(&place.run(&["-q", "info", "--adapters"])), listed, "it was asked for");
    for (arguments, words) in [
        (&["info", "--adapters", "hill.asc"][..], "cannot be used with"),
        (&["info"], "<DEM>..."),
        (&["draw", "--adapters"], "--adapter"),
    ] {
        let output = place.run(arguments);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(words), "{arguments:?}: {}", stderr(&output));
    }
    let none = place
        .command(&["info", "--adapters"])
        .env("VK_DRIVER_FILES", "/none")
        .env("VK_ICD_FILENAMES", "/none")
        .output();
    let none = none.expect("hachure runs");
    assert_eq!(none.status.code(), Some(1));
    assert!(
        stderr(&none).contains("no GPU adapter: this machine has none; install a Vulkan driver"),
        "{}",
        stderr(&none)
    );
}

#[test]
fn equal_adapters_are_told_apart_by_their_numbers() {
    let place = Place::new();
    let listed = rows(&on_two(&place, &["info", "--adapters"]));
    assert!(matches!(&listed[..], [(a, one), (b, other)] if (&**a, &**b) == ("0", "1") && one == other), "{listed:?}");
    let drawn = |flags: &[&str]| {
        let output = on_two(&place, &[&QUICK[..], flags].concat());
        assert_eq!(output.status.code(), Some(0), "{flags:?}: {}", stderr(&output));
        fs::read(place.path("out.png")).expect("a picture")
    };
    let first = drawn(&[]);
    for number in ["0", "1"] {
        assert!(drawn(&["--adapter", number]) == first, "adapter {number} draws another picture");
    }
    fs::remove_file(place.path("out.png")).expect("it is there");
    let beyond = on_two(&place, &[&QUICK[..], &["--adapter", "2"]].concat());
    let (name, said) = (&listed[0].1, stderr(&beyond));
    assert_eq!(beyond.status.code(), Some(1), "{said}");
    assert!(said.contains(&format!("none has the number 2; there is: 0 {name}, 1 {name}")), "{said}");
    assert!(!place.path("out.png").exists());
}

#[test]
fn an_adapter_is_named_by_words_too() {
    let place = Place::new();
    let name = &gpu().info.name;
    let words = name.to_uppercase();
    let words = words.split(' ').next().expect("a word");
    let output = place.run(&[&QUICK[..], &["--adapter", words]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let output = place.run(&[&QUICK[..], &["--adapter", "0000:ff:1f.7"]].concat());
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("none is named `0000:ff:1f.7`, nor is its bus; there is: 0 "), "{said}");
    let empty = place.run(&[&QUICK[..], &["--adapter", ""]].concat());
    assert_eq!(empty.status.code(), Some(2));
    assert!(stderr(&empty).contains("want cpu, gpu, an adapter's number, or words of its name or its bus"));
}
