//! How water comes from where it may end to everywhere, over the lowest passes (Priority-Flood; Barnes, Lehman and Mulla 2014).
//!
//! The lowest sample beside the flood is next, ties by arrival. Over a pass the flood runs down to the pit before it rises again, so
//! pits that lie behind others are reached over the lowest pass between them, as by Prim's shortest tree; were all below the pass
//! reached at its level, as is usual, they would be reached on straight lines. It gives every sample a parent, the neighbour
//! from which it was reached. Cost: a pass of a radix heap a sample, of a binary one in pits; 1 byte a sample, and 8 to 12 for each
//! at the front.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::frame::FramedGrid;
use super::heap::{RadixHeap, key};

/// Water rises from here first.
pub(super) const SEED: u8 = 8;
const UNSEEN: u8 = 9;
const VOID: u8 = 10;

/// Floods from seeds, each a sample that is no void. `reached` hears of each sample, by when the parents of all on its way back are
/// known.
pub(super) fn flood(
    frame: FramedGrid,
    heights: &[f32],
    seeds: impl Iterator<Item = usize>,
    mut reached: impl FnMut(usize, &[u8]),
) {
    let mut parents: Vec<u8> = heights.iter().map(|height| if height.is_nan() { VOID } else { UNSEEN }).collect();
    let (steps, mut rising) = (frame.steps(), RadixHeap::new());
    for seed in seeds {
        parents[seed] = SEED;
        rising.push(key(heights[seed]), seed as u32);
    }
    // Samples lower than the last that rose, with how many came before.
    let (mut pits, mut came) = (BinaryHeap::new(), 0_u32);
    let mut level = 0;
    loop {
        let sample = match pits.pop() {
            Some(Reverse((_, _, sample))) => sample,
            None => match rising.pop() {
                Some((height, sample)) => {
                    level = height;
                    sample
                }
                None => return,
            },
        };
        let sample = sample as usize;
        reached(sample, &parents);
        for (k, step) in steps.iter().enumerate() {
            let next = sample.wrapping_add(*step);
            if parents[next] == UNSEEN {
                parents[next] = (k as u8 + 4) % 8;
                let height = key(heights[next]);
                if height < level {
                    pits.push(Reverse((height, came, next as u32)));
                    came = came.wrapping_add(1);
                } else {
                    rising.push(height, next as u32);
                }
            }
        }
    }
}
