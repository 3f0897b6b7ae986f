//! Lists of frames, in the grammar of render farms: `3, 5-10, 47-327`, `0-100:5`; numbers count from 0, ranges hold both ends.

use std::fmt::{self, Display, Formatter};
use std::str::FromStr;

/// Most frames of a sequence.
pub(crate) const MOST: u32 = 10_000_000;

/// Frames, rising, each once.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Frames(Vec<u32>);

impl Frames {
    /// The first so many.
    pub fn first(count: u32) -> Self {
        Self((0..count).collect())
    }

    /// The frames.
    pub fn numbers(&self) -> &[u32] {
        &self.0
    }

    /// The last one.
    pub fn last(&self) -> Option<u32> {
        self.0.last().copied()
    }
}

impl FromIterator<u32> for Frames {
    fn from_iter<I: IntoIterator<Item = u32>>(numbers: I) -> Self {
        let mut numbers: Vec<u32> = numbers.into_iter().collect();
        numbers.sort_unstable();
        numbers.dedup();
        Self(numbers)
    }
}

impl FromStr for Frames {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wanted = || "want numbers and ranges from 0 on, as 3,5-10,47-327 or, every fifth, 0-100:5".to_owned();
        let number = |text: &str| text.trim().parse::<u32>().ok().filter(|n| *n < MOST).ok_or_else(wanted);
        let mut numbers = Vec::new();
        for part in text.split(',') {
            let (range, step) = match part.split_once(':') {
                Some((range, step)) => (range, number(step).ok().filter(|step| *step > 0).ok_or_else(wanted)?),
                None => (part, 1),
            };
            match range.split_once('-') {
                None if range.len() == part.len() => numbers.push(number(range)?),
                None => return Err(wanted()),
                Some((first, last)) => {
                    let (first, last) = (number(first)?, number(last)?);
                    if first > last {
                        return Err(format!("{first}-{last} runs backwards; write {last}-{first}"));
                    }
                    numbers.extend((first..=last).step_by(step as usize));
                }
            }
            if numbers.len() > MOST as usize {
                return Err(format!("it names more than {MOST} frames, some of them twice"));
            }
        }
        Ok(numbers.into_iter().collect())
    }
}

/// As it is read, in as few ranges as there are.
impl Display for Frames {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for (i, run) in self.0.chunk_by(|a, b| a + 1 == *b).enumerate() {
            let separator = if i == 0 { "" } else { "," };
            match run {
                [only] => write!(f, "{separator}{only}")?,
                [first, .., last] => write!(f, "{separator}{first}-{last}")?,
                [] => {}
            }
        }
        Ok(())
    }
}
