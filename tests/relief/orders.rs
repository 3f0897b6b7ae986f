//! Orders of streams and the area from which water runs in beds, against ways of their own.

use hachure::door::relief::channels::{Channels, NO_NODE};
use hachure::door::relief::threshold::{AreaTrial, found};
use hachure::geo::{ReadOptions, read};
use hachure::relief::{ChannelArea, Relief};

const LEAST: u32 = 30;

fn relief() -> Relief {
    let dem = read("dem/golden-gate.tif", &ReadOptions::default()).expect("the sample");
    Relief::of(&dem, 1.0).expect("flow")
}

/// Strahler's and Shreve's orders of a node, by its branches above.
fn orders(node: usize, above: &[Vec<usize>]) -> (u8, u32) {
    let branches: Vec<(u8, u32)> = above[node].iter().map(|node| orders(*node, above)).collect();
    let highest = branches.iter().map(|branch| branch.0).max().unwrap_or(0);
    let meet = branches.iter().filter(|branch| branch.0 == highest).count();
    let strahler = if branches.is_empty() { 1 } else { highest + u8::from(meet > 1) };
    (strahler, branches.iter().map(|branch| branch.1).sum::<u32>().max(1))
}

#[test]
fn orders_are_those_of_the_books() {
    let relief = relief();
    let channels = Channels::of(relief.flow(), relief.area(), LEAST);
    let found = channels.orders(relief.area(), LEAST);
    let mut above = vec![Vec::new(); channels.samples.len()];
    for (node, down) in channels.down.iter().enumerate().filter(|(_, down)| **down != NO_NODE) {
        above[*down as usize].push(node);
    }
    let mouths = || channels.down.iter().enumerate().filter(|(_, down)| **down == NO_NODE).map(|(node, _)| node);
    assert!(mouths().count() > 20);
    for mouth in mouths() {
        let mut open = vec![mouth];
        // Every node by itself is slow; those below forks and the mouths tell all.
        while let Some(node) = open.pop() {
            if node == mouth || above[node].len() > 1 {
                assert_eq!((found.strahler[node], found.shreve[node]), orders(node, &above), "node {node}");
            }
            open.extend(&above[node]);
        }
    }
    assert!(found.strahler.iter().max() >= Some(&4), "streams of several orders");
}

#[test]
fn the_area_of_channels_is_the_first_that_stays() {
    let trial = |cells, t| AreaTrial { cells, streams: [100, 30], t };
    let trials = [trial(10, 1.0), trial(17, 5.0), trial(28, -1.9), trial(47, 0.3), trial(78, 2.5)];
    assert_eq!(found(&trials).map(|trial| trial.cells), Some(28), "at 10 it only passes through 0");
    assert_eq!(found(&trials[..2]), None);
    let relief = relief();
    let all = relief.trials();
    assert!(all.windows(2).all(|pair| pair[0].cells < pair[1].cells && pair[0].streams[0] >= pair[1].streams[0]));
    let auto = relief.channel_cells(ChannelArea::Auto);
    assert_eq!(auto, found(&all).map_or(25, |trial| trial.cells.clamp(25, 100)));
    println!("relief: {auto} cells; t {:?}", all.iter().map(|trial| (trial.cells, trial.t)).collect::<Vec<_>>());
    let square = relief.grid().frame.side().powi(2);
    assert_eq!(relief.channel_cells(ChannelArea::SquareMetres(40.0 * square)), 40);
}
