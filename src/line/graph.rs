//! Thinned lines as a graph: branches between junctions and ends.
//!
//! Cells are linked to their neighbours; a diagonal link is left out where a side neighbour makes it the long way round.
//! A cell with other than two links is a node, and belongs to every branch that ends there.
//!
//! Cost: one visit a cell.

use std::collections::HashSet;

use super::grid::CellGrid;

/// Branches of thinned lines, each a walk over cells.
pub(super) struct Graph {
    /// Branches from node to node, both nodes' cells included; a lone cell is a branch of one cell.
    pub branches: Vec<Vec<usize>>,
    /// Walks round rings without a node, the first cell not repeated.
    pub rings: Vec<Vec<usize>>,
}

impl Graph {
    /// The graph of these line cells, given in reading order.
    pub(super) fn new(lines: &CellGrid, cells: &[usize]) -> Self {
        let nodes: HashSet<usize> = cells.iter().copied().filter(|&c| links(lines, c).len() != 2).collect();
        let mut graph = Self { branches: Vec::new(), rings: Vec::new() };
        let mut walked = HashSet::new();
        for &cell in cells.iter().filter(|cell| nodes.contains(cell)) {
            let links = links(lines, cell);
            if links.is_empty() {
                graph.branches.push(vec![cell]);
            }
            for first in links {
                // A walk is found from both its ends.
                if walked.contains(&first) || (nodes.contains(&first) && first < cell) {
                    continue;
                }
                let mut branch = vec![cell];
                let last = walk(lines, cell, first, |c| nodes.contains(&c), &mut branch, &mut walked);
                branch.push(last);
                graph.branches.push(branch);
            }
        }
        for &cell in cells {
            if !nodes.contains(&cell) && !walked.contains(&cell) {
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
fn links(lines: &CellGrid, cell: usize) -> Vec<usize> {
    let around = lines.around(cell);
    let set = lines.neighbours(cell);
    (0..8).filter(|&k| set[k] && (k % 2 == 0 || !(set[k - 1] || set[(k + 1) % 8]))).map(|k| around[k]).collect()
}

/// Walks from `from` over `cell` through cells of two links until `stop`, appending them; returns the cell stopped at.
fn walk(
    lines: &CellGrid,
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
