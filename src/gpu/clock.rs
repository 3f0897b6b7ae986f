//! How long a frame and its passes take.
//!
//! On a GPU the device stamps its own time at both ends of each pass of a frame that runs as ever. Software drivers
//! stamp compute passes when they please, so there each command is submitted and waited for alone, by the wall clock:
//! the waits add to every pass, and the sum of all is more than an undisturbed frame takes.

use std::time::Instant;

use super::device::Gpu;
use crate::error::{Error, Result};

/// The name under which clears and copies are timed.
pub const CLEAR: &str = "clear";
/// Passes that a query set of the largest size takes, two stamps each.
pub const PASSES_OF_SET: usize = wgpu::QUERY_SET_MAX_QUERIES as usize / 2;

/// What measures time on a device.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Clock {
    /// The wall clock of the CPU.
    Wall,
    /// Timestamps of the device.
    Timestamps,
}

impl Clock {
    /// What the times of frames and passes are, in words.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Wall => {
                "wall clock around submit and wait, camera to mask, without compose and readback; passes one by one"
            }
            Self::Timestamps => {
                "timestamps on the device, camera to mask, without compose and readback; passes of one whole frame, \
                 clear being what lies between them"
            }
        }
    }
}

/// Milliseconds of one pass, over all batches and rounds.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct PassTime {
    /// The pass.
    pub name: &'static str,
    /// Milliseconds by the [`Clock`] of the device.
    pub ms: f64,
}

/// Milliseconds of a frame and of its passes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FrameTime {
    /// The frame as it was timed: by timestamps from the first begin to the last end, by the wall clock the sum of its
    /// passes.
    pub ms: f64,
    /// Each pass once, in the order of the frame.
    pub passes: Vec<PassTime>,
}

impl FrameTime {
    /// The time of a frame whose passes, in their order, begin and end at these stamps. What lies between them is
    /// [`CLEAR`]; passes of that name only mark a place.
    ///
    /// # Errors
    /// [`Error::Gpu`] when a pass has a stamp that was never written, which reads 0, or ends before it begins.
    pub fn of_stamps(passes: &[&'static str], stamps: &[[u64; 2]], ms_per_tick: f64) -> Result<Self> {
        let mut time = Self::default();
        time.add(CLEAR, 0.0);
        for (&name, &[begin, end]) in passes.iter().zip(stamps).filter(|(name, _)| **name != CLEAR) {
            if begin == 0 || end < begin {
                return Err(Error::Gpu { what: format!("the driver stamped pass {name} from {begin} to {end}") });
            }
            time.add(name, (end - begin) as f64 * ms_per_tick);
        }
        // A driver may drop the stamps of a pass without work, such as a mark.
        let written = || stamps.iter().flatten().copied().filter(|stamp| *stamp > 0);
        let whole = written().max().zip(written().min()).map_or(0, |(last, first)| last - first);
        let passes = std::mem::replace(&mut time.ms, whole as f64 * ms_per_tick);
        // Passes that depend on nothing in common may overlap.
        time.passes[0].ms = (time.ms - passes).max(0.0);
        Ok(time)
    }

    /// This frame's time and, pass by pass, that of another piece of the page.
    #[must_use]
    pub fn and(mut self, other: &Self) -> Self {
        let ms = self.ms + other.ms;
        other.passes.iter().for_each(|pass| self.add(pass.name, pass.ms));
        Self { ms, ..self }
    }

    /// Adds to the frame's time and to that of one of its passes.
    fn add(&mut self, name: &'static str, ms: f64) {
        self.ms += ms;
        match self.passes.iter_mut().find(|pass| pass.name == name) {
            Some(pass) => pass.ms += ms,
            None => self.passes.push(PassTime { name, ms }),
        }
    }
}

/// Times the passes of one frame.
pub(crate) enum Timer {
    /// Waits for each.
    Waits(FrameTime),
    /// Has the device stamp them.
    Stamps(Stamps),
}

impl Timer {
    /// A timer by the device's clock.
    pub(crate) fn new(gpu: &Gpu) -> Self {
        match gpu.clock {
            Clock::Wall => Self::Waits(FrameTime::default()),
            Clock::Timestamps => Self::Stamps(Stamps::default()),
        }
    }

    /// What the next pass writes.
    pub(crate) fn writes(&mut self, gpu: &Gpu, name: &'static str) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        match self {
            Self::Waits(_) => None,
            Self::Stamps(stamps) => Some(stamps.writes(gpu, name)),
        }
    }

    /// Does a pass, which submits and waits, where that is how passes are timed.
    ///
    /// # Errors
    /// Those of `pass`.
    pub(crate) fn wait(&mut self, name: &'static str, pass: impl FnOnce() -> Result<()>) -> Result<()> {
        if let Self::Waits(time) = self {
            let start = Instant::now();
            pass()?;
            time.add(name, start.elapsed().as_secs_f64() * 1e3);
        }
        Ok(())
    }

    /// The time of the frame, once it is done.
    ///
    /// # Errors
    /// As [`Stamps::read`].
    pub(crate) fn read(self, gpu: &Gpu) -> Result<FrameTime> {
        match self {
            Self::Waits(time) => Ok(time),
            Self::Stamps(stamps) => stamps.read(gpu),
        }
    }
}

/// How long commands take that are no frame, ms, by the device's clock: the wall clock from recording to done, or
/// timestamps of marks before and behind them. `None` where the driver stamps no marks.
///
/// # Errors
/// Whatever `record` or the driver reports.
pub(crate) fn time_of(gpu: &Gpu, record: impl FnOnce(&mut wgpu::CommandEncoder) -> Result<()>) -> Result<Option<f64>> {
    let start = Instant::now();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut stamps = Stamps::default();
    let stamped = gpu.clock == Clock::Timestamps;
    let mut mark = |encoder: &mut wgpu::CommandEncoder| {
        let timestamp_writes = stamped.then(|| stamps.writes(gpu, CLEAR));
        encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some("mark"), timestamp_writes });
    };
    mark(&mut encoder);
    record(&mut encoder)?;
    mark(&mut encoder);
    gpu.queue.submit([encoder.finish()]);
    gpu.wait()?;
    let ms = if stamped { stamps.read(gpu)?.ms } else { start.elapsed().as_secs_f64() * 1e3 };
    Ok((ms > 0.0).then_some(ms))
}

/// The stamps of one frame, which may be submitted in pieces: begin and end of each pass, in the order of recording.
#[derive(Default)]
pub struct Stamps {
    /// Filled one after the other, for a frame of many batches has more passes than a set takes.
    sets: Vec<wgpu::QuerySet>,
    passes: Vec<&'static str>,
}

impl Stamps {
    /// What the next pass writes. It must be recorded with it.
    pub fn writes(&mut self, gpu: &Gpu, name: &'static str) -> wgpu::ComputePassTimestampWrites<'_> {
        let i = self.passes.len();
        self.passes.push(name);
        if i.is_multiple_of(PASSES_OF_SET) {
            self.sets.push(gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("stamps"),
                ty: wgpu::QueryType::Timestamp,
                count: wgpu::QUERY_SET_MAX_QUERIES,
            }));
        }
        let begin = (i % PASSES_OF_SET) as u32 * 2;
        wgpu::ComputePassTimestampWrites {
            query_set: &self.sets[i / PASSES_OF_SET],
            beginning_of_pass_write_index: Some(begin),
            end_of_pass_write_index: Some(begin + 1),
        }
    }

    /// Brings back the stamps of a frame that was submitted.
    ///
    /// # Errors
    /// Whatever the driver reports, and as [`FrameTime::of_stamps`].
    pub fn read(self, gpu: &Gpu) -> Result<FrameTime> {
        let set_bytes = u64::from(wgpu::QUERY_SET_MAX_QUERIES * wgpu::QUERY_SIZE);
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("stamps"),
            size: self.sets.len() as u64 * set_bytes,
            usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let offsets = (0..).step_by(set_bytes as usize);
        for ((set, passes), offset) in self.sets.iter().zip(self.passes.chunks(PASSES_OF_SET)).zip(offsets) {
            encoder.resolve_query_set(set, 0..passes.len() as u32 * 2, &buffer, offset);
        }
        gpu.queue.submit([encoder.finish()]);
        let stamps = gpu.read(&buffer, self.passes.len())?;
        let ms_per_tick = f64::from(gpu.queue.get_timestamp_period()) * 1e-6;
        FrameTime::of_stamps(&self.passes, &stamps, ms_per_tick)
    }
}
