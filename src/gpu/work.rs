//! The commands of a frame on their way to the queue, timed where that is asked.

use super::clock::{CLEAR, Timer};
use super::device::Gpu;
use super::on_device::OnDevice;
use super::pace::Work;
use super::sizes::LIST_HEADER;
use crate::error::Result;
use crate::plan::{Frame, PagePiece, PassName};

/// Commands for a piece of a frame, recorded and not yet submitted. What the device is expected to work at for long is cut into
/// parts, each waited for before the next is recorded.
pub(crate) struct FrameWork<'a> {
    on_device: OnDevice<'a>,
    frame: &'a Frame,
    piece: PagePiece,
    timer: Option<&'a mut Timer>,
    encoder: wgpu::CommandEncoder,
    /// Since the device was last waited for.
    part: Work,
}

impl<'a> FrameWork<'a> {
    /// Nothing recorded yet.
    pub(crate) fn new(
        on_device: OnDevice<'a>,
        frame: &'a Frame,
        piece: PagePiece,
        timer: Option<&'a mut Timer>,
    ) -> Self {
        let encoder = on_device.gpu.device.create_command_encoder(&Default::default());
        let mut work = Self { on_device, frame, piece, timer, encoder, part: Work::NONE };
        if work.timer.is_some() {
            // A pass without work marks the beginning: clears, which come first, cannot be stamped themselves.
            work.begin(CLEAR);
        }
        work
    }

    /// Zeroes buffers.
    ///
    /// # Errors
    /// [`Error::Mistake`](crate::error::Error::Mistake) where there is none of a name; whatever the driver reports.
    pub(crate) fn clear(&mut self, names: &[&str]) -> Result<()> {
        for name in names {
            self.encoder.clear_buffer(self.on_device.buffer(name)?, 0, None);
        }
        self.timed(CLEAR)
    }

    /// Empties a list by the header of an empty one.
    ///
    /// # Errors
    /// As [`Self::clear`].
    pub(crate) fn empty(&mut self, list: &str, header: &str) -> Result<()> {
        let (list, header) = (self.on_device.buffer(list)?, self.on_device.buffer(header)?);
        self.encoder.copy_buffer_to_buffer(header, 0, list, 0, LIST_HEADER);
        self.timed(CLEAR)
    }

    /// Records a pass over a batch in a round, where the frame runs it then.
    ///
    /// # Errors
    /// As [`OnDevice::dispatch`]; whatever the driver reports.
    pub(crate) fn run(&mut self, name: PassName, [batch, round]: [u32; 2]) -> Result<()> {
        let Some(planned) = self.frame.pass(name, round) else { return Ok(()) };
        let Some(dispatch) = self.on_device.dispatch(self.frame, self.piece, planned, [batch, round])? else {
            return Ok(());
        };
        let part = self.part.and(dispatch.work());
        if self.part > Work::NONE && self.on_device.gpu.pace.is_too_long(part) {
            self.wait()?;
        }
        self.part = self.part.and(dispatch.work());
        dispatch.record(&mut self.begin(name.name()));
        self.timed(name.name())
    }

    /// Submits what is recorded and waits until it is done: drivers may let nobody submit more behind a part that hangs, and do
    /// not come back then.
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub(crate) fn wait(&mut self) -> Result<()> {
        submit(self.on_device.gpu, &mut self.encoder)?;
        self.on_device.gpu.wait_for(std::mem::take(&mut self.part))
    }

    fn begin(&mut self, name: &'static str) -> wgpu::ComputePass<'_> {
        let gpu = self.on_device.gpu;
        let timestamp_writes = self.timer.as_mut().and_then(|timer| timer.writes(gpu, name));
        self.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(name), timestamp_writes })
    }

    fn timed(&mut self, name: &'static str) -> Result<()> {
        let gpu = self.on_device.gpu;
        let Some(timer) = &mut self.timer else { return Ok(()) };
        timer.wait(name, || {
            submit(gpu, &mut self.encoder)?;
            gpu.wait_for(std::mem::take(&mut self.part))
        })
    }
}

fn submit(gpu: &Gpu, encoder: &mut wgpu::CommandEncoder) -> Result<()> {
    let next = gpu.device.create_command_encoder(&Default::default());
    gpu.queue.submit([std::mem::replace(encoder, next).finish()]);
    gpu.check()
}
