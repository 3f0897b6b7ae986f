//! Branches as lines of the land: traced, laid beside each other without crossing, cut where they are no valleys or ridges.

use glam::DVec2;

use super::across::across;
use super::branches::Branch;
use super::grid::Grid;
use super::net::Net;
use super::trace::{Follows, trace};
use super::{LineKind, SurfaceLine, SurfacePoint};

/// What is known of a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Column and row.
    pub at: DVec2,
    /// As of a [`SurfacePoint`], but need not grow.
    pub length: f32,
    /// As of a [`SurfacePoint`], but need not grow.
    pub drop: f32,
    /// As of a [`SurfaceLine`].
    pub order: u8,
}

/// The lines of branches, longest first; `node` tells what is known of one of the branch of a number.
pub fn lines(
    grid: &Grid,
    branches: &[Branch],
    follows: Follows,
    node: impl Fn(usize, u32) -> Node,
) -> Vec<SurfaceLine> {
    let mut net = Net::default();
    let mut known = Vec::new();
    for (which, branch) in branches.iter().enumerate() {
        let nodes: Vec<Node> = branch.nodes.iter().chain(&branch.joins).map(|number| node(which, *number)).collect();
        if nodes.len() < 2 {
            continue;
        }
        let places: Vec<DVec2> = nodes.iter().map(|node| node.at).collect();
        let before = net.lines.len();
        net.lay(trace(grid, &places, follows), branch.joins.is_some());
        if net.lines.len() > before {
            known.push(nodes);
        }
    }
    let kind = match follows {
        Follows::Valley => LineKind::Drainage,
        Follows::Crest => LineKind::Ridge,
    };
    let line = |((places, joint), nodes): (&(Vec<super::trace::Place>, Option<super::net::Joint>), &Vec<Node>)| {
        let ats: Vec<DVec2> = places.iter().map(|place| place.at).collect();
        let mut most = [0.0_f32; 2];
        let points = places.iter().zip(across(grid, &ats, follows)).map(|(place, across)| {
            let k = (place.node as usize).min(nodes.len() - 2);
            let share = (place.node - k as f64) as f32;
            let between = |of: fn(&Node) -> f32| of(&nodes[k]) + (of(&nodes[k + 1]) - of(&nodes[k])) * share;
            most = [most[0].max(between(|node| node.length)), most[1].max(between(|node| node.drop))];
            SurfacePoint { at: place.at, across, length: most[0], drop: most[1] }
        });
        let points = points.collect();
        // The last node is the trunk's.
        let order = nodes[nodes.len() - 2].order;
        SurfaceLine { kind, order, points, closed: false, joins: joint.map(|joint| [joint.line, joint.place]) }
    };
    net.lines.iter().zip(&known).map(line).collect()
}
