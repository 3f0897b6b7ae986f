//! Thinned lines as a graph: branches between junctions and ends.
//!
//! Cells are linked to their neighbours; a diagonal link is left out where a side neighbour makes it the long way round.
//! A cell with other than two links is a node. Junction cells that touch are one node, named by the one with the most
//! links, so that all branches of a junction share its point.

use std::collections::{HashMap, HashSet};

use super::thin::Grid;

/// Branches of thinned lines, each a walk over cells.
pub struct Graph {
    /// Branches from node to node, both nodes' cells included; a lone cell is a branch of one cell.
    pub branches: Vec<Vec<usize>>,
    /// Walks round rings without a node, the first cell not repeated.
    pub rings: Vec<Vec<usize>>,
}

impl Graph {
    /// The graph of these line cells, given in reading order.
    pub fn new(lines: &Grid, cells: &[usize]) -> Self {
        let nodes = nodes(lines, cells);
        let mut graph = Self { branches: Vec::new(), rings: Vec::new() };
        let mut walked = HashSet::new();
        for &cell in cells.iter().filter(|cell| nodes.contains_key(cell)) {
            let links = links(lines, cell);
            if links.is_empty() {
                graph.branches.push(vec![cell]);
            }
            for first in links {
                // A walk is found from both its ends; the links within a node lead nowhere.
                let back = nodes.get(&first).is_some_and(|&node| node == nodes[&cell] || first < cell);
                if back || walked.contains(&first) {
                    continue;
                }
                let mut branch = vec![nodes[&cell], cell];
                let last = walk(lines, cell, first, |c| nodes.contains_key(&c), &mut branch, &mut walked);
                branch.extend([last, nodes[&last]]);
                branch.dedup();
                graph.branches.push(branch);
            }
        }
        for &cell in cells {
            if !nodes.contains_key(&cell) && !walked.contains(&cell) {
                let mut ring = vec![cell];
                let first = links(lines, cell)[0];
                walk(lines, cell, first, |c| c == cell, &mut ring, &mut walked);
                walked.insert(cell);
                graph.rings.push(ring);
            }
        }
        graph
    }
}

/// Cells a line leads to from this one.
fn links(lines: &Grid, cell: usize) -> Vec<usize> {
    let around = lines.around(cell);
    let set = lines.neighbours(cell);
    (0..8).filter(|&k| set[k] && (k % 2 == 0 || !(set[k - 1] || set[(k + 1) % 8]))).map(|k| around[k]).collect()
}

/// The cells that are no mere link of two, each with the cell that names its node.
fn nodes(lines: &Grid, cells: &[usize]) -> HashMap<usize, usize> {
    let mut junctions: Vec<(usize, usize)> = Vec::new();
    let mut nodes = HashMap::new();
    for &cell in cells {
        match links(lines, cell).len() {
            2 => {}
            0 | 1 => drop(nodes.insert(cell, cell)),
            count => junctions.push((count, cell)),
        }
    }
    junctions.sort_by_key(|&(count, cell)| (std::cmp::Reverse(count), cell));
    let all: HashSet<usize> = junctions.iter().map(|&(_, cell)| cell).collect();
    for (_, cell) in junctions {
        if nodes.contains_key(&cell) {
            continue;
        }
        nodes.insert(cell, cell);
        for neighbour in lines.around(cell) {
            if all.contains(&neighbour) {
                nodes.entry(neighbour).or_insert(cell);
            }
        }
    }
    nodes
}

/// Walks from `from` over `cell` through cells of two links until `stop`, appending them; returns the cell stopped at.
fn walk(
    lines: &Grid,
    from: usize,
    cell: usize,
    stop: impl Fn(usize) -> bool,
    path: &mut Vec<usize>,
    walked: &mut HashSet<usize>,
) -> usize {
    let (mut previous, mut current) = (from, cell);
    while !stop(current) {
        path.push(current);
        walked.insert(current);
        let next = links(lines, current).into_iter().find(|&c| c != previous).unwrap_or(previous);
        (previous, current) = (current, next);
    }
    current
}
