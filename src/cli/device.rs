//! Flags of every subcommand that draws: which device.

use super::talk::Talk;
use super::values;
use crate::error::Result;
use crate::gpu::{AdapterChoice, Gpu, Int64};

/// The flags, as typed.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Device")]
pub(crate) struct DeviceArguments {
    /// Adapter: cpu, gpu, its number in `hachure info --adapters`, where 0 is the best, or words of its name or its bus [default:
    /// the best one]
    #[arg(long, value_name = "N|NAME|cpu|gpu", value_parser = values::adapter)]
    adapter: Option<AdapterChoice>,
    /// Draw as on a device without 64-bit atomics
    #[arg(long, hide = true)]
    no_int64: bool,
}

impl DeviceArguments {
    /// Opens the device with those of the `extra` features that it has, and says which it is.
    ///
    /// # Errors
    /// As [`Gpu::open_with`].
    pub(crate) fn open_with(&self, extra: wgpu::Features, talk: &Talk) -> Result<Gpu> {
        let gpu = self.open_silently(extra)?;
        Self::tell(&gpu, talk)?;
        Ok(gpu)
    }

    /// The same for those who say later which it is.
    ///
    /// # Errors
    /// As [`Gpu::open_with`].
    pub(crate) fn open_silently(&self, extra: wgpu::Features) -> Result<Gpu> {
        let int64 = if self.no_int64 { Int64::Never } else { Int64::IfPresent };
        Gpu::open_with(&self.adapter.clone().unwrap_or_default(), int64, extra)
    }

    /// Says which device it is.
    ///
    /// # Errors
    /// As [`Talk::say`].
    pub(crate) fn tell(gpu: &Gpu, talk: &Talk) -> Result<()> {
        talk.say(&format!("adapter: {}", gpu.info.name))?;
        talk.detail(&format!("driver: {} {}", gpu.info.driver, gpu.info.driver_info))
    }
}
