//! What strokes of a drawing lie at or near a place of its frame.
//!
//! Cost: a look at each piece of each stroke.

use glam::DVec2;

use super::{Drawing, Stroke, StrokePoint};
use crate::line::Id;
use crate::line::near::share_nearest;

/// The nearest place of a stroke.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct InkedNear<'a> {
    /// What its layer is called.
    pub layer: &'a str,
    /// The chain that it draws.
    pub chain: Option<Id>,
    /// How far off the middle of its line is, pixels of the frame.
    pub px: f64,
    /// How broad it is there, mm.
    pub width: f64,
    /// Half of that in pixels of the frame.
    pub half_px: f64,
}

impl Drawing {
    /// The strokes whose middles come within `reach` px of a place of a frame of that size, from the top of the page down.
    pub(crate) fn inked_near(&self, frame: [u32; 2], place: DVec2, reach: f64) -> Vec<InkedNear<'_>> {
        let placement = self.sheet.placement(frame);
        let (at, reach) = (placement.on_sheet(place), reach / placement.px_per_mm);
        let layers = self.layers.iter().rev();
        let strokes = layers.flat_map(|layer| layer.strokes.iter().rev().map(move |stroke| (layer, stroke)));
        let near = strokes.filter_map(|(layer, stroke)| {
            let (off, share) = nearest(stroke, at).filter(|(off, _)| *off <= reach)?;
            let width = share * layer.pen.width;
            let half_px = width / 2.0 * placement.px_per_mm;
            let px = off * placement.px_per_mm;
            Some(InkedNear { layer: &layer.name, chain: stroke.chain, px, width, half_px })
        });
        near.collect()
    }
}

/// How far off the middle of a stroke is, mm, and how wide it is there as a share of its pen.
fn nearest(stroke: &Stroke, at: DVec2) -> Option<(f64, f64)> {
    let points = &stroke.points;
    let closing = points.last().zip(points.first()).filter(|_| stroke.closed || points.len() == 1);
    let pairs = points.windows(2).map(|pair| (&pair[0], &pair[1])).chain(closing);
    let nearest = |(a, b): (&StrokePoint, &StrokePoint)| {
        let share = share_nearest(a.place, b.place, at);
        (a.place.lerp(b.place, share).distance(at), a.width + (b.width - a.width) * share)
    };
    pairs.map(nearest).min_by(|a, b| a.0.total_cmp(&b.0))
}
