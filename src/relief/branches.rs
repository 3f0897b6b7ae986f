//! A forest cut into branches: at each junction the one with the most land above it goes on, the others end.
//!
//! By length the bed at the head of a valley would end where a longer rill comes down its side. Cost: a few passes over the
//! nodes. The largest branches come first, so each after the one it joins.

use super::channels::Channels;

/// A way down the forest.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Branch {
    /// From the head on, at least one.
    pub nodes: Vec<u32>,
    /// The node of another branch to which the last flows.
    pub joins: Option<u32>,
}

/// The branches; `size` is of a node, more than that of any above it.
pub(super) fn branches(channels: &Channels, size: impl Fn(usize) -> u32) -> Vec<Branch> {
    let nodes = channels.samples.len();
    // The node above that goes on, where there is one.
    let mut main: Vec<Option<u32>> = vec![None; nodes];
    for node in 0..nodes {
        if let Some(below) = channels.below(node) {
            let is_larger = main[below].is_none_or(|other| size(node) > size(other as usize));
            if is_larger {
                main[below] = Some(node as u32);
            }
        }
    }
    let goes_on = |node: usize| channels.below(node).filter(|below| main[*below] == Some(node as u32));
    let from = |head: usize| {
        let nodes: Vec<u32> =
            std::iter::successors(Some(head), |node| goes_on(*node)).map(|node| node as u32).collect();
        let joins = nodes.last().and_then(|last| channels.below(*last as usize)).map(|below| below as u32);
        Branch { nodes, joins }
    };
    let mut branches: Vec<Branch> = (0..nodes).filter(|node| main[*node].is_none()).map(from).collect();
    let end = |branch: &Branch| branch.nodes.last().map_or(0, |last| size(*last as usize));
    branches.sort_by_key(|branch| std::cmp::Reverse(end(branch)));
    branches
}

/// Those of at least so many nodes, and those that one of them joins.
pub(super) fn lasting(branches: Vec<Branch>, channels: &Channels, least: usize) -> Vec<Branch> {
    let mut joined = vec![false; channels.samples.len()];
    let mut left: Vec<Branch> = Vec::new();
    for branch in branches.into_iter().rev() {
        if branch.nodes.len() >= least || branch.nodes.iter().any(|node| joined[*node as usize]) {
            branch.joins.iter().for_each(|node| joined[*node as usize] = true);
            left.push(branch);
        }
    }
    left.reverse();
    left
}
