//! The lines of one block, from those that it depends on.

use std::sync::Arc;

use glam::DVec2;

use super::land::{Land, Walker};
use super::level::{BlockAt, Blocks};
use super::neighbours::Neighbours;
use super::seeds::seeds;
use super::trace::Tracer;
use super::{SlopeBlock, SlopeLine, SlopePoint};

/// Makes a block from all the blocks that it needs.
pub(super) fn made<'a>(
    land: &Land,
    blocks: &Blocks,
    at: BlockAt,
    needed: impl Iterator<Item = &'a Arc<SlopeBlock>>,
) -> SlopeBlock {
    let place = |point: &SlopePoint| land.metres(point.at);
    let seen = blocks.seen(at);
    let mut others = Neighbours::new(seen, blocks.spacing(at.level).max(blocks.unit / 2.0));
    let [low, high] = seen.map(|corner| land.samples(corner));
    needed.for_each(|block| {
        let lines = block.lines.iter().zip(&block.boxes);
        let seen = lines.filter(|(_, [least, most])| least.cmple(high).all() && most.cmpge(low).all());
        seen.for_each(|(line, _)| others.add(&line.points, blocks.point_step(block.level), place));
    });
    let mut tracer = Tracer::new(Walker::new(land), blocks, at.level);
    let lines = seeds(blocks, at).filter_map(|(number, seed)| {
        let points = tracer.line(&others, seed)?;
        others.add(&points, blocks.point_step(at.level), place);
        Some(SlopeLine { id: at.id() | number as u64, points })
    });
    let lines: Vec<SlopeLine> = lines.collect();
    let boxes = lines.iter().map(bounds).collect();
    SlopeBlock { level: at.level, at: [at.column, at.row], lines, boxes }
}

/// Least and most column and row.
pub(super) fn bounds(line: &SlopeLine) -> [DVec2; 2] {
    let none = [DVec2::INFINITY, DVec2::NEG_INFINITY];
    line.points.iter().fold(none, |[low, high], point| [low.min(point.at), high.max(point.at)])
}
