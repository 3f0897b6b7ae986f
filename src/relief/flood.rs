//! How water rises from where it may end until it stands everywhere (Priority-Flood; Barnes, Lehman and Mulla 2014, algorithm 1),
//! ties by arrival.
//!
//! It gives every sample a parent, the neighbour from which it was reached: those lead back to a seed, over the lowest pass. No
//! height changes. Cost: a pass of the heap a sample, memory of 1 byte a sample and for the front.

use super::frame::Frame;
use super::heap::{RadixHeap, key};

/// Water rises from here first.
pub const SEED: u8 = 8;
const UNSEEN: u8 = 9;
const VOID: u8 = 10;

/// Floods from seeds, each a sample that is no void. `reached` hears of each sample, lowest first, by when the parents of all on its
/// way back are known.
pub fn flood(frame: Frame, heights: &[f32], seeds: impl Iterator<Item = usize>, mut reached: impl FnMut(usize, &[u8])) {
    let mut parents: Vec<u8> = heights.iter().map(|height| if height.is_nan() { VOID } else { UNSEEN }).collect();
    let (steps, mut heap) = (frame.steps(), RadixHeap::new());
    for seed in seeds {
        parents[seed] = SEED;
        heap.push(key(heights[seed]), seed as u32);
    }
    while let Some((level, sample)) = heap.pop() {
        let sample = sample as usize;
        reached(sample, &parents);
        for (k, step) in steps.iter().enumerate() {
            let next = sample.wrapping_add(*step);
            if parents[next] == UNSEEN {
                parents[next] = (k as u8 + 4) % 8;
                heap.push(key(heights[next]).max(level), next as u32);
            }
        }
    }
}
