//! Flat water that is an end of all flow: the sea.
//!
//! Samples of exactly 0 m that hang together by their sides, so many that no noise makes them. Cost: a pass, memory of an eighth of
//! a byte a sample and for the front. Not handled: lakes, which water leaves; seas of another height.

use super::bits::Bits;
use super::frame::FramedGrid;

/// Least samples of a sea.
const LEAST: usize = 32;

/// Which of the framed heights are sea.
pub(super) fn sea(frame: FramedGrid, heights: &[f32]) -> Bits {
    let [mut sea, mut seen] = [Bits::none(frame.samples()), Bits::none(frame.samples())];
    let steps = frame.steps();
    let mut piece = Vec::new();
    for first in frame.indices() {
        let mut next = 0;
        piece.clear();
        let take = |i: usize, piece: &mut Vec<u32>, seen: &mut Bits| {
            if heights[i] == 0.0 && !seen.has(i) {
                seen.take(i);
                piece.push(i as u32);
            }
        };
        take(first, &mut piece, &mut seen);
        while let Some(i) = piece.get(next) {
            let i = *i as usize;
            next += 1;
            steps.iter().step_by(2).for_each(|step| take(i.wrapping_add(*step), &mut piece, &mut seen));
        }
        if piece.len() >= LEAST {
            piece.iter().for_each(|i| sea.take(*i as usize));
        }
    }
    sea
}
