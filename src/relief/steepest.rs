//! The neighbour to which water runs from each sample: of the eight that with the steepest fall (D8; O'Callaghan and Mark 1984).
//!
//! Cells may be oblong. No two directions cross: of four samples, were that of NW to SE and that of NE to SW, then the one of whom the
//! lower of SE and SW is not the goal would have it beside itself, nearer than its own goal and no higher: steeper. Cost: 8
//! multiplications a sample, in vectors. Not handled: water that spreads, as over a cone; it all goes one way.

use super::frame::FramedGrid;

/// No neighbour is lower: a pit or a flat.
pub(super) const NONE: u8 = 8;
/// Water ends here.
pub(super) const OUTLET: u8 = 9;
/// There is no land.
pub(super) const VOID: u8 = 10;

/// Of each sample the number of the neighbour, [`NONE`] or [`VOID`].
pub(super) fn steepest(frame: FramedGrid, heights: &[f32]) -> Vec<u8> {
    let mut to = vec![VOID; frame.samples()];
    let mut best = vec![0.0_f32; frame.size[0]];
    let mut which = vec![0_u32; frame.size[0]];
    let inverse = frame.distances().map(|metres| (1.0 / metres) as f32);
    for r in 0..frame.size[1] {
        best.fill(0.0);
        which.fill(u32::from(NONE));
        let row = frame.row(r);
        let here = &heights[row.clone()];
        for ((k, step), inverse) in (0..).zip(frame.steps()).zip(inverse) {
            let there = &heights[row.start.wrapping_add(step)..][..here.len()];
            for (((best, which), here), there) in best.iter_mut().zip(&mut which).zip(here).zip(there) {
                let fall = (here - there) * inverse;
                let is_steeper = fall > *best;
                *best = if is_steeper { fall } else { *best };
                *which = if is_steeper { k } else { *which };
            }
        }
        for ((to, which), here) in to[row].iter_mut().zip(&which).zip(here) {
            *to = if here.is_nan() { VOID } else { *which as u8 };
        }
    }
    to
}
