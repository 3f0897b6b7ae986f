//! What is told of how much land makes a channel.

use std::process::Command;

use hachure::door::relief::auto_cells;
use hachure::door::relief::threshold::found;
use hachure::relief::{ChannelArea, Relief};

use super::sample;

/// What `info --channels` adds to what `info` says of the sample, or a part of it, and the error.
fn told(more: &[&str]) -> (Vec<String>, String) {
    let dem = concat!(env!("CARGO_MANIFEST_DIR"), "/dem/golden-gate.tif");
    let mut info = Command::new(env!("CARGO_BIN_EXE_hachure"));
    let output = info.args(["info", dem, "--channels"]).args(more).output().expect("hachure runs");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let lines =
        text(&output.stdout).lines().skip_while(|line| !line.starts_with("channels")).map(str::to_owned).collect();
    (lines, text(&output.stderr))
}

#[test]
fn info_lists_what_was_tried_and_says_what_is_taken() {
    let relief = Relief::of(&sample(), 1.0).expect("a relief");
    let (trials, lines) = (relief.trials(), told(&[]).0);
    let taken = relief.channel_cells(ChannelArea::Auto);
    let km2 = f64::from(taken) * relief.grid().frame.area() / 1e6;
    println!("{}", lines.join("\n"));
    assert!(
        lines[0]
            .starts_with(&format!("channels   from {taken} cells, {km2:.4} km2 on: the first from which streams of")),
        "{}",
        lines[0]
    );
    assert_eq!(lines.len(), trials.len() + 1);
    for (n, (trial, line)) in trials.iter().zip(&lines[1..]).enumerate() {
        let [first, higher] = trial.streams;
        let start = format!("trial {:<4} {} cells, ", n + 1, trial.cells);
        let mark = if trial.cells == taken { ", from here on" } else { "" };
        let end = format!(" km2: streams {first} of order 1, {higher} of higher ones, t {:.2}{mark}", trial.t);
        assert!(line.starts_with(&start) && line.ends_with(&end), "{line}");
    }
    assert_eq!(lines[1..].iter().filter(|line| line.ends_with(", from here on")).count(), 1);
    let (lines, said) = told(&["--memory", "64KiB"]);
    assert!(lines.is_empty() && said.contains("samples stay in their files"), "{said}");
}

#[test]
fn what_the_land_tells_is_taken_within_bounds() {
    let trial = |cells| Some(hachure::door::relief::threshold::AreaTrial { cells, streams: [100, 30], t: 0.0 });
    assert_eq!([None, trial(10), trial(28), trial(100), trial(217)].map(auto_cells), [25, 25, 28, 100, 100]);
    assert_eq!(found(&[]), None);
    // A part of the sample has too few streams to tell.
    let few = told(&["--crop", "540000,4184000,540600,4184600"]).0;
    assert_eq!(few.len(), 1, "{few:?}");
    assert!(
        few[0].starts_with("channels   from 25 cells, 0.0225 km2 on: the least, for the land has under 20 streams of the first order or 5 of higher ones"),
        "{few:?}"
    );
}
