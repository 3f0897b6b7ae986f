//! One process's share of the frames: of n shards each has a run of its own, as long as the others' or one frame longer.
//!
//! Runs, since what one frame leaves on the device serves the next. Which shard a process is may come from the environment:
//! Slurm's job arrays, AWS Batch's array jobs, Kubernetes' indexed jobs, which do not say how many they are.

use std::fmt::{self, Display, Formatter};
use std::str::FromStr;

use super::Frames;

/// Most shards.
const MOST: u32 = 1_000_000;
/// What says how many shards there are where the system does not.
const COUNT: &str = "HACHURE_SHARDS";

/// Shard `index` of `count`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// From 0 on.
    pub index: u32,
    /// How many there are.
    pub count: u32,
}

impl Shard {
    /// The only one.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// Its share of frames.
    pub fn of(self, frames: &Frames) -> Frames {
        let numbers = frames.numbers();
        let end = |index: u32| numbers.len() * index as usize / self.count as usize;
        numbers[end(self.index)..end(self.index + 1)].iter().copied().collect()
    }

    /// One that there is; says in words why there is none.
    ///
    /// # Errors
    /// The words.
    pub(super) fn new(index: u32, count: u32) -> Result<Self, String> {
        match (index < count, count <= MOST) {
            (true, true) => Ok(Self { index, count }),
            (_, false) => Err(format!("{count} shards are too many; want at most {MOST}")),
            (false, _) if count == 0 => Err("there are no shards; want i/n, n at least 1".to_owned()),
            (false, _) => Err(format!("there is no shard {index} of {count}; i of i/n counts from 0 to {}", count - 1)),
        }
    }

    /// The one that the environment names, in which `variable` looks.
    ///
    /// # Errors
    /// In words: none is named, or it is none.
    pub fn from_env(variable: impl Fn(&str) -> Option<String>) -> Result<Self, String> {
        let number = |name: &str| match variable(name) {
            None => Ok(None),
            Some(text) => text.trim().parse::<u32>().map(Some).map_err(|_| format!("{name} is no number: {text}")),
        };
        let counted = |name: &str| match number(COUNT)? {
            Some(count) => Ok(count),
            None => number(name)?.ok_or_else(|| format!("nothing says how many shards there are; set {COUNT}")),
        };
        if let Some(id) = number("SLURM_ARRAY_TASK_ID")? {
            let first = number("SLURM_ARRAY_TASK_MIN")?.unwrap_or(0);
            let step = number("SLURM_ARRAY_TASK_STEP")?.filter(|step| *step > 0).unwrap_or(1);
            return Self::new(id.saturating_sub(first) / step, counted("SLURM_ARRAY_TASK_COUNT")?);
        }
        if let Some(index) = number("AWS_BATCH_JOB_ARRAY_INDEX")? {
            return Self::new(index, counted("AWS_BATCH_JOB_ARRAY_SIZE")?);
        }
        if let Some(index) = number("JOB_COMPLETION_INDEX")? {
            return Self::new(index, counted(COUNT)?);
        }
        Err("no shard is named: neither SLURM_ARRAY_TASK_ID nor AWS_BATCH_JOB_ARRAY_INDEX nor JOB_COMPLETION_INDEX is \
             set"
        .to_owned())
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(i, n)| Some((i.trim().parse().ok()?, n.trim().parse().ok()?)));
        let (index, count) = numbers.ok_or_else(|| "want i/n, i from 0 on, as 0/4".to_owned())?;
        Self::new(index, count)
    }
}

/// `i/n`.
impl Display for Shard {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}
