//! How long work may take before its driver is said to hang.
//!
//! Work is submitted in parts, each expected to take less than [`LONGEST_PART`]. What is expected is what the part's facets and
//! pixels would take a plain software driver, times the pace of this device: the slowest that its last parts had, of which each
//! of some work makes forget up to a half. A part that takes [`TIMES`] as long, and [`LEAST`] at least, hangs.
//!
//! Machines are shared, so time that the driver did not have counts neither for a part nor for the pace. A software driver works
//! in our own process: its time is what the process had of the cores. Of a GPU it is the wall clock; but between two looks at it
//! no more than a few of them pass, for a process that was stopped, or a machine that slept. Whatever the pace, a driver that
//! does nothing for [`PATIENCE`] hangs.
//!
//! Does not handle: a part of one pass is not divided, however long it takes; a GPU that others keep from us for 30 times as long
//! as before.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Parts are cut so that each is expected to take no more, seconds.
const LONGEST_PART: f64 = 2.0;
/// A part that takes so many times what was expected hangs,
const TIMES: f64 = 30.0;
/// and it takes so many seconds at least.
const LEAST: f64 = 30.0;
/// Waiting so many seconds for one part means that the driver hangs, whatever it was expected to take.
const PATIENCE: f64 = 900.0;
/// How often it is looked whether a part is done: seldom, for where a look just misses what another thread hears of, wgpu panics
/// (<https://github.com/gfx-rs/wgpu/pull/9958>, mended after version 30).
const LOOK: Duration = Duration::from_secs(10);
/// No more time than so many looks take passes between two of them.
const LOOKS: f64 = 4.0;
/// What each part takes beside its work, seconds: submitting, waiting.
const OVERHEAD: f64 = 0.05;
/// Seconds for a facet in a pass of a software driver on two cores.
const FACET: f64 = 50e-9;
/// The same for a pixel, a rim edge, a piece of a line.
const ITEM: f64 = 25e-9;
/// The same for a byte that is copied.
const BYTE: f64 = 1e-9;

/// Work of a part: seconds that it takes a software driver on two cores.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default)]
pub struct Work(f64);

impl Work {
    /// None.
    pub const NONE: Self = Self(0.0);

    /// A pass over so many facets.
    pub fn facets(count: u64) -> Self {
        Self(count as f64 * FACET)
    }

    /// A pass over so many pixels, or other things of which each takes about as long.
    pub fn items(count: u64) -> Self {
        Self(count as f64 * ITEM)
    }

    /// A copy of so many bytes.
    pub fn bytes(count: u64) -> Self {
        Self(count as f64 * BYTE)
    }

    /// Both.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

/// When a part hangs.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// Seconds, at least.
    pub least: f64,
    /// How many times what was expected.
    pub times: f64,
    /// Seconds, whatever was expected.
    pub patience: f64,
    /// How often it is looked.
    pub look: Duration,
}

impl Default for Limits {
    fn default() -> Self {
        Self { least: LEAST, times: TIMES, patience: PATIENCE, look: LOOK }
    }
}

/// The pace of a device.
#[derive(Debug)]
pub struct Pace {
    limits: Mutex<Limits>,
    /// How many times as long as a software driver on two cores it takes.
    pace: Mutex<f64>,
    /// Whether it works in our process.
    is_software: bool,
}

impl Pace {
    /// Of a device that has done nothing yet.
    pub fn new(is_software: bool) -> Self {
        Self { limits: Mutex::default(), pace: Mutex::new(1.0), is_software }
    }

    /// Other limits than those of every device.
    pub fn set_limits(&self, limits: Limits) {
        *self.limits.lock().unwrap_or_else(PoisonError::into_inner) = limits;
    }

    /// Seconds that work is expected to take.
    pub fn expected(&self, work: Work) -> f64 {
        *self.pace.lock().unwrap_or_else(PoisonError::into_inner) * (OVERHEAD + work.0)
    }

    /// Whether work is too much for one part.
    pub(super) fn is_too_long(&self, work: Work) -> bool {
        self.expected(work) > LONGEST_PART
    }

    /// Takes into account that work has taken so many seconds.
    pub fn took(&self, work: Work, seconds: f64) {
        let mut pace = self.pace.lock().unwrap_or_else(PoisonError::into_inner);
        let of_work = work.0 / (OVERHEAD + work.0);
        *pace = (seconds / (OVERHEAD + work.0)).max(*pace * (1.0 - of_work / 2.0));
    }

    /// Begins to wait for work; without any, for what nothing is known of.
    pub fn watch(&self, work: Option<Work>) -> Watch {
        let limits = *self.limits.lock().unwrap_or_else(PoisonError::into_inner);
        let expected = work.map(|work| self.expected(work));
        Watch { limits, expected, is_software: self.is_software, last: Moment::now(), waited: 0.0, worked: 0.0 }
    }
}

/// The time by the wall and by the cores.
#[derive(Debug, Clone, Copy)]
struct Moment {
    wall: Instant,
    /// Seconds that this process had of all cores.
    cores: Option<f64>,
}

impl Moment {
    fn now() -> Self {
        Self { wall: Instant::now(), cores: of_cores() }
    }
}

/// Time that passes for a part.
#[derive(Debug)]
pub struct Watch {
    limits: Limits,
    expected: Option<f64>,
    is_software: bool,
    last: Moment,
    /// Seconds since it began, as far as the process ran.
    waited: f64,
    /// Seconds of these that the driver had.
    worked: f64,
}

impl Watch {
    /// How often to look.
    pub(super) fn look(&self) -> Duration {
        self.limits.look
    }

    /// Seconds that the driver had for it so far.
    pub fn tick(&mut self) -> f64 {
        let last = std::mem::replace(&mut self.last, Moment::now());
        let waited = (self.last.wall - last.wall).as_secs_f64().min(LOOKS * self.limits.look.as_secs_f64());
        let cores = self.last.cores.zip(last.cores).map(|(now, last)| now - last).filter(|_| self.is_software);
        self.waited += waited;
        self.worked += cores.map_or(waited, |cores| cores.min(waited));
        self.worked
    }

    /// What to say where the driver hangs.
    pub fn hangs(&self) -> Option<String> {
        let Limits { least, times, patience, .. } = self.limits;
        let limit = self.expected.map(|expected| least.max(times * expected));
        match (self.expected, limit) {
            (Some(expected), Some(limit)) if self.worked > limit => {
                let worked = self.worked;
                Some(format!("it hangs: work that should take {expected:.1} s is not done after {worked:.0} s"))
            }
            _ if self.waited > patience => Some(format!("it hangs: nothing came of it for {:.0} s", self.waited)),
            _ => None,
        }
    }
}

/// Seconds that this process had of the cores, of which it may use so many at once; `None` where the system does not tell.
fn of_cores() -> Option<f64> {
    #[cfg(unix)]
    {
        // SAFETY: it is plain numbers, which the call fills.
        let usage = unsafe {
            let mut usage: libc::rusage = std::mem::zeroed();
            (libc::getrusage(libc::RUSAGE_SELF, &mut usage) == 0).then_some(usage)
        }?;
        let seconds = |time: libc::timeval| time.tv_sec as f64 + time.tv_usec as f64 * 1e-6;
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        Some((seconds(usage.ru_utime) + seconds(usage.ru_stime)) / cores as f64)
    }
    #[cfg(not(unix))]
    None
}
