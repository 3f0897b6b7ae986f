//! Branches as lines of the land: traced, laid beside each other without crossing, cut where they are no valleys or ridges.

use glam::DVec2;
use rayon::prelude::*;

use super::across::across;
use super::branches::Branch;
use super::grid::Grid;
use super::net::{Laid, Net};
use super::prune::{Lie, pruned};
use super::trace::{CurvePlace, Follows, trace};
use super::{LineKind, SurfaceLine, SurfacePoint};

/// What is known of a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NetNode {
    /// Column and row.
    pub at: DVec2,
    /// As of a [`SurfacePoint`], but need not grow.
    pub length: f32,
    /// As of a [`SurfacePoint`], but need not grow.
    pub drop: f32,
    /// As of a [`SurfaceLine`].
    pub order: u8,
}

/// The lines of branches, largest first; `node` tells what is known of one of the branch of a number.
pub(super) fn lines(
    grid: &Grid,
    branches: &[Branch],
    follows: Follows,
    node: impl Fn(usize, u32) -> NetNode + Sync,
) -> Vec<SurfaceLine> {
    let traced = |(which, branch): (usize, &Branch)| {
        let nodes: Vec<NetNode> = branch.nodes.iter().chain(&branch.joins).map(|number| node(which, *number)).collect();
        let places: Vec<DVec2> = nodes.iter().map(|node| node.at).collect();
        (trace(grid, &places, follows), nodes, branch.joins.is_some())
    };
    let long =
        branches.par_iter().enumerate().filter(|(_, branch)| branch.nodes.len() + branch.joins.iter().count() > 1);
    let traced: Vec<_> = long.map(traced).collect();
    let mut net = Net::new(grid.frame);
    let mut known = Vec::new();
    for (places, nodes, is_branch) in traced {
        if net.lay(places, is_branch) {
            known.push(nodes);
        }
    }
    let lies = |laid: &Laid| Lie { free: laid.free, lowest: laid.places.iter().map(|place| place.is_lowest).collect() };
    let lies: Vec<Lie> = net.lines.iter().map(lies).collect();
    let line = |(laid, nodes): (Laid, &Vec<NetNode>)| line(grid, laid, nodes, follows);
    let lines = net.lines.into_par_iter().zip(&known).map(line).collect();
    pruned(grid, lines, &lies)
}

/// A line with what is known of its nodes.
fn line(grid: &Grid, laid: Laid, nodes: &[NetNode], follows: Follows) -> SurfaceLine {
    let ats: Vec<DVec2> = laid.places.iter().map(|place| place.at).collect();
    let mut most = [0.0_f32; 2];
    let point = |(place, across): (&CurvePlace, [f32; 3])| {
        let k = (place.node as usize).min(nodes.len() - 2);
        let share = (place.node - k as f64) as f32;
        let between = |of: fn(&NetNode) -> f32| of(&nodes[k]) + (of(&nodes[k + 1]) - of(&nodes[k])) * share;
        most = [most[0].max(between(|node| node.length)), most[1].max(between(|node| node.drop))];
        SurfacePoint { at: place.at, across, length: most[0], drop: most[1] }
    };
    SurfaceLine {
        kind: match follows {
            Follows::Valley => LineKind::Drainage,
            Follows::Crest => LineKind::Ridge,
        },
        // The last node is that of the line it joins.
        order: nodes[nodes.len() - 2].order,
        points: laid.places.iter().zip(across(grid, &ats, follows)).map(point).collect(),
        closed: false,
        joins: laid.joint.map(|joint| [joint.line, joint.place]),
    }
}
