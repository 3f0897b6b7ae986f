//! The README as a new user follows it: short, its commands are commands, its links lead to files.

use std::fs;
use std::path::Path;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser};
use hachure::door::cli::Arguments;

use crate::shell::{commands, words};

/// Most lines of the README.
const LINES: usize = 150;
/// The pages of the repository.
const PAGES: [&str; 4] = ["README.md", "tests/README.md", "dem/README.md", "examples/farm/README.md"];

fn page(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).expect(name)
}

/// What is to be typed into a shell.
fn typed(text: &str) -> Vec<String> {
    text.split("```sh\n").skip(1).filter_map(|rest| rest.split("```").next()).flat_map(commands).collect()
}

/// What stands between single backticks on a line.
fn spans(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter(|line| !line.starts_with("```")).flat_map(|line| line.split('`').skip(1).step_by(2))
}

/// Files that a page links to or shows, as it names them.
fn linked(text: &str) -> Vec<&str> {
    let named = |mark: &'static str, end: char| text.split(mark).skip(1).filter_map(move |rest| rest.split(end).next());
    let files = named("](", ')').chain(named("src=\"", '"')).filter(|to| !to.contains("://") && !to.starts_with('#'));
    files.map(|to| to.split('#').next().unwrap_or(to)).collect()
}

/// Why a line is no command of ours; asking for help is one.
fn mistake(line: &str) -> Option<String> {
    let parsed = Arguments::try_parse_from(words(line));
    parsed.err().filter(|e| e.kind() != ErrorKind::DisplayHelp).map(|e| format!("{line}: {e}"))
}

#[test]
fn the_readme_is_short() {
    let lines = page("README.md").lines().count();
    assert!(
        lines <= LINES,
        "{lines} lines: what a flag does belongs in its help, what was measured in tests/README.md"
    );
}

#[test]
fn commands_of_the_readme_are_commands() {
    let text = page("README.md");
    let typed = typed(&text);
    assert!(typed.len() > 8, "only {typed:?}");
    assert_eq!(typed.iter().find_map(|line| mistake(line)), None);
    let known = Arguments::command();
    for span in spans(&text).filter(|span| span.starts_with("hachure ")) {
        match words(span).collect::<Vec<_>>()[..] {
            [_, name] => assert!(known.find_subcommand(name).is_some(), "`{span}` is no subcommand"),
            _ => assert_eq!(mistake(span), None),
        }
    }
    for wrong in ["hachure draw a.tif", "hachure draw a.tif -o b.png --colour red", "hachure drew a.tif -o b.png"] {
        assert!(mistake(wrong).is_some(), "{wrong}");
    }
}

#[test]
fn links_of_every_page_lead_to_files() {
    for name in PAGES {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let folder = root.join(name).parent().expect("a folder").to_owned();
        let text = page(name);
        let missing: Vec<_> = linked(&text).into_iter().filter(|to| !folder.join(to).exists()).collect();
        assert!(missing.is_empty(), "{name} links to {missing:?}");
    }
    assert!(linked(&page("README.md")).len() > 5);
    let text = "[a](b.png) ![c](d.svg#e) <img src=\"f.png\"> [g](#h) [i](https://j.k)";
    assert_eq!(linked(text), ["b.png", "d.svg", "f.png"]);
}
