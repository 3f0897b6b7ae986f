//! The commands of a frame on their way to the queue, timed where that is asked.

use super::buffers::Buffers;
use super::clock::{CLEAR, Timer};
use super::device::Gpu;
use super::pass::{Extent, Pass};
use super::sizes::LIST_HEADER;
use crate::error::Result;

/// A compiled pass with what it binds: once for the page, or for each round of each batch.
pub struct Stage {
    /// The pass.
    pub pass: Pass,
    /// Its bind groups.
    pub groups: Vec<wgpu::BindGroup>,
}

/// Commands recorded and not yet submitted.
pub struct Work<'a> {
    gpu: &'a Gpu,
    buffers: &'a Buffers,
    timer: Option<&'a mut Timer>,
    encoder: wgpu::CommandEncoder,
}

impl<'a> Work<'a> {
    /// Nothing recorded yet.
    pub fn new(gpu: &'a Gpu, buffers: &'a Buffers, timer: Option<&'a mut Timer>) -> Self {
        let mut work = Self { encoder: gpu.device.create_command_encoder(&Default::default()), gpu, buffers, timer };
        if work.timer.is_some() {
            // A pass without work marks the beginning: clears, which come first, cannot be stamped themselves.
            work.begin(CLEAR);
        }
        work
    }

    /// Zeroes buffers.
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub fn clear(&mut self, names: &[&str]) -> Result<()> {
        for name in names {
            self.encoder.clear_buffer(self.buffers.get(name)?, 0, None);
        }
        self.timed(CLEAR)
    }

    /// Empties a list by the header of an empty one.
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub fn empty(&mut self, list: &str, header: &str) -> Result<()> {
        let (list, header) = (self.buffers.get(list)?, self.buffers.get(header)?);
        self.encoder.copy_buffer_to_buffer(header, 0, list, 0, LIST_HEADER);
        self.timed(CLEAR)
    }

    /// Records a pass with one of its bind groups.
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub fn record(&mut self, stage: &Stage, group: usize, extent: impl Into<Extent>) -> Result<()> {
        let buffers = self.buffers;
        let mut pass = self.begin(stage.pass.name);
        if let Some(group) = stage.groups.get(group) {
            match extent.into() {
                Extent::Invocations(wanted) => stage.pass.record(&mut pass, group, wanted),
                Extent::List(name) => stage.pass.record_over(&mut pass, group, buffers.get(name)?),
            }
        }
        drop(pass);
        self.timed(stage.pass.name)
    }

    /// Submits what is recorded, and goes on.
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub fn submit(&mut self) -> Result<()> {
        submit(self.gpu, &mut self.encoder)
    }

    /// Submits and waits until all is done.
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub fn finish(mut self) -> Result<()> {
        self.submit()?;
        self.gpu.wait()
    }

    fn begin(&mut self, name: &'static str) -> wgpu::ComputePass<'_> {
        let timestamp_writes = self.timer.as_mut().and_then(|timer| timer.writes(self.gpu, name));
        self.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(name), timestamp_writes })
    }

    fn timed(&mut self, name: &'static str) -> Result<()> {
        let Some(timer) = &mut self.timer else { return Ok(()) };
        timer.wait(self.gpu, name, || submit(self.gpu, &mut self.encoder))
    }
}

fn submit(gpu: &Gpu, encoder: &mut wgpu::CommandEncoder) -> Result<()> {
    let next = gpu.device.create_command_encoder(&Default::default());
    gpu.queue.submit([std::mem::replace(encoder, next).finish()]);
    gpu.check()
}
