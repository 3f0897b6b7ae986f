//! The adapters of this machine: which there are, and which one is meant.
//!
//! They are numbered from 0, real GPUs first and software drivers last, those of a kind as the system's loader lists them:
//! alike in every process that sees the same cards. Which card a number is its bus tells.
//! Not handled: how much memory an adapter has where it is not reached through Vulkan.

use super::memory;
use crate::error::{Error, Result};

/// Which adapter to open.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum AdapterChoice {
    /// A discrete GPU before an integrated one before a software driver: number 0.
    #[default]
    Best,
    /// The software driver.
    Cpu,
    /// Any real GPU.
    Gpu,
    /// The one of this number.
    Number(usize),
    /// The first whose name, or whose bus, contains these words, in any case.
    Named(String),
}

/// An adapter, as users tell it from others.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Adapter {
    /// From 0 on.
    pub number: usize,
    /// As its driver calls it.
    pub name: String,
    /// Where it is plugged in, as `0000:01:00.0`; `None` for a software driver, or where the system does not tell.
    pub bus: Option<String>,
    /// Bytes of memory of its own, or of the system's that it takes for such; `None` where the system does not tell.
    pub memory: Option<u64>,
}

impl Adapter {
    /// All, in the order of their numbers. Cost: that of starting the drivers.
    ///
    /// # Errors
    /// [`Error::NoAdapter`] where there is none; [`Error::Limit`] where there is too little memory to start a driver.
    pub fn all() -> Result<Vec<Self>> {
        let found = adapters()?;
        if found.is_empty() {
            return Err(missing(&AdapterChoice::Best, &found));
        }
        let told = |(number, adapter): (usize, &wgpu::Adapter)| {
            let info = adapter.get_info();
            let bus = Some(info.device_pci_bus_id).filter(|bus| !bus.is_empty());
            Self { number, name: info.name, bus, memory: memory_of(adapter) }
        };
        Ok(found.iter().enumerate().map(told).collect())
    }
}

/// The adapter that is meant.
///
/// # Errors
/// As [`Adapter::all`], and where there is none like it.
pub(super) fn find(choice: &AdapterChoice) -> Result<wgpu::Adapter> {
    let is_cpu = |a: &wgpu::Adapter| a.get_info().device_type == wgpu::DeviceType::Cpu;
    let mut found = adapters()?;
    let at = match choice {
        AdapterChoice::Best => Some(0),
        AdapterChoice::Cpu => found.iter().position(is_cpu),
        AdapterChoice::Gpu => found.iter().position(|a| !is_cpu(a)),
        AdapterChoice::Number(number) => Some(*number),
        AdapterChoice::Named(words) => found.iter().position(|a| {
            let (info, words) = (a.get_info(), words.to_lowercase());
            info.name.to_lowercase().contains(&words) || info.device_pci_bus_id.to_lowercase().contains(&words)
        }),
    };
    match at.filter(|at| *at < found.len()) {
        Some(at) => Ok(found.swap_remove(at)),
        None => Err(missing(choice, &found)),
    }
}

/// The adapters in the order of their numbers.
fn adapters() -> Result<Vec<wgpu::Adapter>> {
    if let Some(error) = memory::too_little() {
        return Err(error);
    }
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let mut adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    adapters.sort_by_key(|a| match a.get_info().device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    });
    Ok(adapters)
}

/// Why none of those found is the one that is meant.
fn missing(choice: &AdapterChoice, found: &[wgpu::Adapter]) -> Error {
    let what = match choice {
        AdapterChoice::Best => "this machine has none".to_owned(),
        AdapterChoice::Cpu => "no software driver among the adapters".to_owned(),
        AdapterChoice::Gpu => "no real GPU among the adapters".to_owned(),
        AdapterChoice::Number(number) => format!("none has the number {number}"),
        AdapterChoice::Named(words) => format!("none is named `{words}`, nor is its bus"),
    };
    let names: Vec<String> =
        found.iter().enumerate().map(|(number, a)| format!("{number} {}", a.get_info().name)).collect();
    let remedy = match names.is_empty() {
        true => "install a Vulkan driver: on Debian or Ubuntu `apt-get install mesa-vulkan-drivers`".to_owned(),
        false => format!("there is: {}", names.join(", ")),
    };
    // Drivers that open none for lack of memory do not say why.
    memory::too_little().unwrap_or(Error::NoAdapter { what, remedy })
}

/// Bytes of memory of the adapter's own.
#[cfg(any(windows, target_os = "linux", target_os = "android", target_os = "freebsd"))]
fn memory_of(adapter: &wgpu::Adapter) -> Option<u64> {
    /// `VK_MEMORY_HEAP_DEVICE_LOCAL_BIT`.
    const DEVICE_LOCAL: u32 = 1;
    // SAFETY: it is asked what it is, and nothing of it is destroyed.
    let adapter = unsafe { adapter.as_hal::<wgpu::hal::api::Vulkan>() }?;
    let instance = adapter.shared_instance().raw_instance();
    // SAFETY: the adapter is one of this instance, and both live as long as the guard.
    let memory = unsafe { instance.get_physical_device_memory_properties(adapter.raw_physical_device()) };
    let own = memory.memory_heaps_as_slice().iter().filter(|heap| heap.flags.as_raw() & DEVICE_LOCAL != 0);
    Some(own.map(|heap| heap.size).sum())
}

/// Not told here.
#[cfg(not(any(windows, target_os = "linux", target_os = "android", target_os = "freebsd")))]
fn memory_of(_: &wgpu::Adapter) -> Option<u64> {
    None
}
