//! One bit a sample.

/// A set of samples. Memory: an eighth of a byte a sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Bits {
    words: Vec<u64>,
}

impl Bits {
    /// Of so many samples none.
    pub fn none(samples: usize) -> Self {
        Self { words: vec![0; samples.div_ceil(64)] }
    }

    /// Whether a sample is in it.
    pub fn has(&self, i: usize) -> bool {
        self.words[i / 64] >> (i % 64) & 1 == 1
    }

    /// Takes a sample in.
    pub fn take(&mut self, i: usize) {
        self.words[i / 64] |= 1 << (i % 64);
    }

    /// The samples in it, ascending.
    pub fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        let of_word = |(at, word): (usize, &u64)| {
            let mut left = *word;
            std::iter::from_fn(move || {
                let bit = left.trailing_zeros() as usize;
                left &= left.wrapping_sub(1);
                (bit < 64).then_some(at * 64 + bit)
            })
        };
        self.words.iter().enumerate().flat_map(of_word)
    }

    /// With how many come before each word.
    pub fn ranked(self) -> Ranked {
        let mut before = 0;
        let count = |word: &u64| {
            before += word.count_ones();
            before - word.count_ones()
        };
        Ranked { before: self.words.iter().map(count).collect(), bits: self }
    }
}

/// A set of samples that knows the number of each: how many before it are in the set.
#[derive(Debug, Clone)]
pub struct Ranked {
    bits: Bits,
    before: Vec<u32>,
}

impl Ranked {
    /// The number of a sample, `None` where it is not in the set.
    pub fn number(&self, i: usize) -> Option<usize> {
        let below = self.bits.words[i / 64] & ((1 << (i % 64)) - 1);
        self.bits.has(i).then(|| self.before[i / 64] as usize + below.count_ones() as usize)
    }
}
