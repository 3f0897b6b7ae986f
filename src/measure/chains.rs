//! What is measured of the chains of a run, beside those of truth.

use glam::DVec2;

use super::figures::ChainFigures;
use crate::line::{Chain, Economy, Kind, Mark, Marks, Pixel, economised, trace};
use crate::truth::metrics::{Judge, Offsets};
use crate::truth::{Inked, Mask};
use crate::view::{Camera, Perspective};

/// The figures of chains; `ids_kept` is their share that the next frame keeps, if it is known, and `economy` that of their
/// page, where they are drawn by one.
pub(super) fn figures(
    judge: &Judge<'_>,
    chains: &[Chain],
    ids_kept: Option<f64>,
    economy: Option<&Economy>,
) -> ChainFigures {
    let scores = judge.measure_chains(&chains.iter().map(places).collect::<Vec<_>>());
    let of_offsets = |figure: fn(&Offsets) -> f64| scores.offsets.as_ref().map(figure);
    ChainFigures {
        chains: scores.count,
        chains_px: scores.length,
        short_chains: scores.short,
        chain_mean_px: of_offsets(|offsets| offsets.mean),
        chain_p95_px: of_offsets(|offsets| offsets.p95),
        chain_precision: scores.agreement.precision,
        chain_recall: scores.agreement.recall,
        economy_removed: economy.map(|economy| scores.agreement.recall - drawn_recall(judge, chains, economy)),
        ids_kept,
    }
}

/// Share of short chains among those that truth's drawing, one pixel wide, is traced to.
pub(super) fn short_of_drawing(judge: &Judge<'_>, drawing: &Mask, camera: &Camera) -> f64 {
    // Depths of a near plane 1 m away.
    let pixel = |p: &Inked| Pixel::new(Kind::Silhouette, DVec2::ZERO, (1.0 / p.distance) as f32);
    let mark = |p: &Inked| Mark { column: p.column, row: p.row, pixel: pixel(p), beside_sky: false };
    let marks = Marks::new(drawing.size, drawing.inked.iter().map(mark).collect());
    let chains = trace(&marks, &Perspective::new(camera, 1.0));
    judge.measure_chains(&chains.iter().map(places).collect::<Vec<_>>()).short
}

/// Share of truth's length within 1 px of what economy draws of chains at half its width or more.
pub fn drawn_recall(judge: &Judge<'_>, chains: &[Chain], economy: &Economy) -> f64 {
    let chains = economised(chains, economy);
    let drawn = chains.iter().flat_map(Chain::pairs).filter(|[a, b]| a.weight + b.weight >= 1.0);
    judge.recalled(&drawn.map(|[a, b]| vec![a.place, b.place]).collect::<Vec<_>>())
}

/// Its corners on the page.
fn places(chain: &Chain) -> Vec<DVec2> {
    let closing = chain.points.first().filter(|_| chain.closed);
    chain.points.iter().chain(closing).map(|point| point.place).collect()
}
