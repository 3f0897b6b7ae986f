//! Opens an adapter and turns the driver's ways of failing into errors.

use std::borrow::Cow;
use std::sync::{Arc, Mutex, OnceLock};

use bytemuck::Pod;

use super::adapter::{self, AdapterChoice};
use super::clock::Clock;
use super::compiled::Compiled;
use super::memory;
use super::pace::{Pace, Work};
use super::pass::Pass;
use super::sizes::LARGEST_BINDING;
use crate::error::{Error, Result};

/// Storage buffers the largest pass binds.
const STORAGE_BUFFERS: u32 = 16;

/// What tests do to a device before each wait for it.
pub static WAITED: OnceLock<fn(&Gpu)> = OnceLock::new();

/// What 64-bit atomics take.
const INT64: wgpu::Features = wgpu::Features::SHADER_INT64.union(wgpu::Features::SHADER_INT64_ATOMIC_MIN_MAX);

/// Whether 64-bit atomics may be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Int64 {
    /// Where the adapter has them.
    #[default]
    IfPresent,
    /// Never: two 32-bit passes instead.
    Never,
}

/// An open device.
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its only queue.
    pub queue: wgpu::Queue,
    /// Name, driver and kind of the adapter.
    pub info: wgpu::AdapterInfo,
    /// Whether 64-bit atomics are in use.
    pub int64: bool,
    /// What measures the time of frames: timestamps on a GPU that has them.
    pub clock: Clock,
    /// How fast it is, by which it is known to hang.
    #[doc(hidden)]
    pub pace: Pace,
    compiled: Compiled,
    failure: Arc<Mutex<Option<String>>>,
    lost: Arc<Mutex<Option<String>>>,
}

impl Gpu {
    /// Opens an adapter.
    ///
    /// # Errors
    /// [`Error::NoAdapter`] when none fits, [`Error::Gpu`] when it opens no device.
    pub fn open(choice: &AdapterChoice, int64: Int64) -> Result<Self> {
        Self::open_with(choice, int64, wgpu::Features::empty())
    }

    /// Opens an adapter with those of the `extra` features it has: for callers that add passes of their own, or want
    /// the timestamps of a software driver.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn open_with(choice: &AdapterChoice, int64: Int64, extra: wgpu::Features) -> Result<Self> {
        let adapter = adapter::find(choice)?;
        let mut features = extra;
        if int64 == Int64::IfPresent && adapter.features().contains(INT64) {
            features |= INT64;
        }
        if adapter.get_info().device_type != wgpu::DeviceType::Cpu {
            features |= wgpu::Features::TIMESTAMP_QUERY;
        }
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("hachure"),
            required_features: features & adapter.features(),
            required_limits: Self::limits(),
            ..Default::default()
        }))
        .map_err(|e| memory::failure(one_line(&e)))?;
        Self::from_parts(device, queue)
    }

    /// What a device must grant, at least.
    pub fn limits() -> wgpu::Limits {
        wgpu::Limits { max_storage_buffers_per_shader_stage: STORAGE_BUFFERS, ..wgpu::Limits::default() }
    }

    /// Takes a device that is open already, as a viewer has one. Its features decide whether 64-bit atomics and timestamps
    /// are used; its callbacks for errors and for its loss are ours from then on.
    ///
    /// # Errors
    /// [`Error::Limit`] when it grants less than [`Self::limits`] of what passes use.
    pub fn from_parts(device: wgpu::Device, queue: wgpu::Queue) -> Result<Self> {
        check_limits(&device.limits())?;
        let int64 = device.features().contains(INT64);
        let stamps = device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let clock = if stamps { Clock::Timestamps } else { Clock::Wall };
        let (failure, lost) = (Arc::new(Mutex::new(None)), Arc::new(Mutex::new(None)));
        let slot = failure.clone();
        device.on_uncaptured_error(Arc::new(move |e: wgpu::Error| note(&slot, one_line(&e))));
        let slot = lost.clone();
        device.set_device_lost_callback(move |_, message| {
            let words = one_line(&message);
            note(&slot, if words.is_empty() { "its driver does not say why".to_owned() } else { words });
        });
        let info = device.adapter_info();
        let pace = Pace::new(info.device_type == wgpu::DeviceType::Cpu);
        Ok(Self { device, queue, info, int64, clock, pace, compiled: Compiled::default(), failure, lost })
    }

    /// Adapter and driver in words.
    pub(crate) fn adapter_and_driver(&self) -> String {
        format!("{} ({})", self.info.name, self.info.driver_info)
    }

    /// Does work of this thread, and gives the error that the driver reports of it: no other thread's, and to no other
    /// thread.
    ///
    /// # Errors
    /// [`Error::Gpu`] with the driver's words, [`Error::DeviceLost`].
    pub(super) fn checked<T>(&self, work: impl FnOnce() -> T) -> Result<T> {
        use wgpu::ErrorFilter::{Internal, OutOfMemory, Validation};
        let scopes = [Validation, Internal, OutOfMemory].map(|filter| self.device.push_error_scope(filter));
        let done = work();
        // The last one first; and all, whatever one of them holds.
        let failure = scopes.into_iter().rev().fold(None, |first: Option<wgpu::Error>, scope| {
            let failure = pollster::block_on(scope.pop());
            first.or(failure)
        });
        match failure {
            Some(e) => Err(self.failed(one_line(&e))),
            // What is asked of a lost device fails in silence.
            None => self.lost().map_or(Ok(done), Err),
        }
    }

    /// Copies the first `count` values of a buffer to the CPU.
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub fn read<T: Pod>(&self, buffer: &wgpu::Buffer, count: usize) -> Result<Vec<T>> {
        let size = (count * size_of::<T>()) as u64;
        if size == 0 {
            return Ok(Vec::new());
        }
        let staging = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, size);
        self.queue.submit([encoder.finish()]);
        let mapped = Arc::new(Mutex::new(None));
        let slot = mapped.clone();
        staging.slice(..).map_async(wgpu::MapMode::Read, move |outcome| {
            if let Err(e) = outcome {
                note(&slot, one_line(&e));
            }
        });
        self.wait_for(Work::bytes(size))?;
        if let Some(what) = take(&mapped) {
            return Err(self.failed(what));
        }
        let view = staging.slice(..).get_mapped_range().map_err(|e| self.failed(one_line(&e)))?;
        let mut values = bytemuck::zeroed_vec(count);
        bytemuck::cast_slice_mut(&mut values).copy_from_slice(&view);
        Ok(values)
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Gpu {
    /// The pass of a composed shader with the pipeline constants on which it depends: compiled when it is first asked for,
    /// the same from then on.
    ///
    /// # Errors
    /// [`Error::Mistake`] when the shader is no valid WGSL, lacks the entry point `name`, declares none of one of the
    /// constants, or depends on one that has no value; [`Error::Gpu`] when the driver refuses.
    pub fn pass(
        &self,
        name: &'static str,
        source: impl Into<Cow<'static, str>>,
        constants: &[(&str, f64)],
    ) -> Result<Arc<Pass>> {
        self.compiled.pass(self, name, source.into(), constants)
    }

    /// How many passes were compiled so far.
    pub fn compiled(&self) -> usize {
        self.compiled.count()
    }

    /// Drops all compiled passes, so that the next frames compile theirs again: for measuring what setting up takes.
    /// Renderers keep those they have bound.
    pub fn forget_passes(&self) {
        self.compiled.forget();
    }

    /// Waits until all submitted work is done, of which nothing is known.
    ///
    /// # Errors
    /// Whatever the driver reported since the last call; [`Error::DeviceLost`] when it hangs.
    pub fn wait(&self) -> Result<()> {
        self.wait_through(None).map(drop)
    }

    /// Waits until all submitted work is done, and learns from the time it takes.
    ///
    /// # Errors
    /// As [`Self::wait`].
    pub fn wait_for(&self, work: Work) -> Result<()> {
        let seconds = self.wait_through(Some(work))?;
        self.pace.took(work, seconds);
        Ok(())
    }

    /// Seconds that the driver had for it.
    fn wait_through(&self, work: Option<Work>) -> Result<f64> {
        WAITED.get().into_iter().for_each(|waited| waited(self));
        let mut watch = self.pace.watch(work);
        loop {
            let wait = wgpu::PollType::Wait { submission_index: None, timeout: Some(watch.look()) };
            let outcome = self.device.poll(wait);
            let seconds = watch.tick();
            self.check()?;
            match outcome {
                Ok(_) => return Ok(seconds),
                Err(wgpu::PollError::Timeout) => {}
                Err(e) => return Err(Error::DeviceLost { what: one_line(&e) }),
            }
            if let Some(what) = watch.hangs() {
                // Whoever drops a device waits for its work.
                std::mem::forget((self.device.clone(), self.queue.clone()));
                return Err(Error::DeviceLost { what });
            }
        }
    }

    /// The first error the driver reported to no one else since the last call, of whatever thread, if any.
    ///
    /// # Errors
    /// [`Error::Gpu`] with the driver's words, [`Error::DeviceLost`].
    pub fn check(&self) -> Result<()> {
        match (self.lost(), take(&self.failure)) {
            (None, None) => Ok(()),
            (Some(lost), _) => Err(lost),
            (None, Some(what)) => Err(self.failed(what)),
        }
    }

    /// That the device is lost, which it stays.
    fn lost(&self) -> Option<Error> {
        let what = self.lost.lock().ok()?.clone()?;
        Some(Error::DeviceLost { what })
    }

    /// The driver's failure in its `words`, which may only follow from the loss of the device: that is told by the next look.
    fn failed(&self, words: String) -> Error {
        let _ = self.device.poll(wgpu::PollType::Poll);
        self.lost().unwrap_or_else(|| memory::failure(words))
    }
}

fn note(slot: &Mutex<Option<String>>, what: String) {
    if let Ok(mut slot) = slot.lock() {
        slot.get_or_insert(what);
    }
}

fn take(slot: &Mutex<Option<String>>) -> Option<String> {
    slot.lock().ok().and_then(|mut slot| slot.take())
}

/// Whether a device grants what passes use.
fn check_limits(has: &wgpu::Limits) -> Result<()> {
    let needs = Gpu::limits();
    let number = |of: fn(&wgpu::Limits) -> u64| [of(&needs), of(has)];
    let largest = [LARGEST_BINDING, has.max_storage_buffer_binding_size];
    let limits = [
        ("max_storage_buffers_per_shader_stage", number(|l| l.max_storage_buffers_per_shader_stage.into())),
        ("max_storage_buffer_binding_size", largest),
        ("max_buffer_size", [LARGEST_BINDING, has.max_buffer_size]),
        ("max_compute_workgroups_per_dimension", number(|l| l.max_compute_workgroups_per_dimension.into())),
        ("max_compute_invocations_per_workgroup", number(|l| l.max_compute_invocations_per_workgroup.into())),
        ("max_compute_workgroup_storage_size", number(|l| l.max_compute_workgroup_storage_size.into())),
        ("max_uniform_buffer_binding_size", number(|l| l.max_uniform_buffer_binding_size)),
    ];
    match limits.into_iter().find(|(_, [needed, granted])| granted < needed) {
        None => Ok(()),
        Some((name, [needed, granted])) => Err(Error::limit(
            format!("the device grants {granted} as {name}, {needed} are needed"),
            "open it with the limits of `Gpu::limits`",
        )),
    }
}

/// Words on one line.
pub(super) fn one_line(e: &dyn std::fmt::Display) -> String {
    e.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}
