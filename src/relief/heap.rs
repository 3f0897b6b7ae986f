//! A queue of samples by height that never goes down (radix heap; Ahuja, Mehlhorn, Orlin and Tarjan 1990).
//!
//! Keys lie in the bucket of the highest bit in which they differ from the last one out; equal keys always share a bucket, whose
//! order is kept, so ties leave as they came. Cost: a sample moves at most once a bit, in practice two or three times; memory only
//! for what is in it.

/// Samples by keys of which none is less than the last one out.
#[derive(Debug)]
pub(super) struct RadixHeap {
    buckets: [Vec<(u32, u32)>; 33],
    /// Key of the first bucket.
    last: u32,
    /// How many of the first bucket are out.
    out: usize,
}

impl RadixHeap {
    pub(super) fn new() -> Self {
        Self { buckets: [const { Vec::new() }; 33], last: 0, out: 0 }
    }

    /// Takes a sample in; its key is not below that of the last one out.
    pub(super) fn push(&mut self, key: u32, sample: u32) {
        let bucket = u32::BITS - (key ^ self.last).leading_zeros();
        self.buckets[bucket as usize].push((key, sample));
    }

    /// The first of those with the least key, and that.
    pub(super) fn pop(&mut self) -> Option<(u32, u32)> {
        if self.out == self.buckets[0].len() {
            self.refill()?;
        }
        let next = self.buckets[0][self.out];
        self.out += 1;
        Some(next)
    }

    /// Spreads the least bucket that is not empty over those before it.
    fn refill(&mut self) -> Option<()> {
        self.buckets[0].clear();
        self.out = 0;
        let least = self.buckets.iter().position(|bucket| !bucket.is_empty())?;
        let mut spread = std::mem::take(&mut self.buckets[least]);
        self.last = spread.iter().map(|(key, _)| *key).min()?;
        for (key, sample) in spread.drain(..) {
            self.push(key, sample);
        }
        // It keeps its room.
        self.buckets[least] = spread;
        Some(())
    }
}

/// A key that orders as heights do; -0 is 0.
pub(super) fn key(height: f32) -> u32 {
    let bits = (height + 0.0).to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}
