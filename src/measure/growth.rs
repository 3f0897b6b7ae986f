//! How time grows with the size of something, beside what is promised.

use std::fmt;

/// Times of the same work at growing sizes.
#[derive(Debug, Clone)]
pub struct Growth {
    /// What the plot is about.
    pub title: String,
    /// What was drawn.
    pub caption: String,
    /// By what, and how times were taken.
    pub note: String,
    /// What grows, and its unit.
    pub across: String,
    /// Sizes, growing, and the time of a frame at each, ms; above 0.
    pub points: Vec<[f64; 2]>,
    /// What is promised of these times.
    pub promise: Promise,
}

/// How much time may grow from the first size on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Promise {
    /// To less than so many times the first time, whatever the size.
    Below(f64),
    /// As many times as the size at most.
    Linear,
}

impl fmt::Display for Promise {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Below(times) => write!(f, "less than {times} times the first"),
            Self::Linear => write!(f, "at most linear"),
        }
    }
}

impl Growth {
    /// At a size the time promised, ms; `None` where nothing was measured.
    pub fn promised(&self, size: f64) -> Option<f64> {
        let [first, ms] = *self.points.first()?;
        Some(match self.promise {
            Promise::Below(times) => ms * times,
            Promise::Linear => ms * size / first,
        })
    }

    /// Of each point how many times the first time it takes, and whether that is more than promised.
    pub fn growth(&self) -> Vec<(f64, bool)> {
        let of = |&[size, ms]: &[f64; 2]| {
            let promised = self.promised(size)?;
            let broken = match self.promise {
                Promise::Below(_) => ms >= promised,
                Promise::Linear => ms > promised,
            };
            Some((ms / self.points[0][1], broken))
        };
        self.points.iter().filter_map(of).collect()
    }

    /// Whether no point breaks the promise.
    pub fn is_kept(&self) -> bool {
        self.growth().iter().all(|(_, broken)| !broken)
    }
}
