//! The device, its buffers and its passes. The mathematics stands in `shaders/`.

pub(crate) mod adapter;
pub(crate) mod buffers;
pub(crate) mod capacity;
pub(crate) mod clock;
mod compiled;
pub(crate) mod curves;
pub(crate) mod device;
pub(crate) mod memory;
pub(crate) mod on_device;
pub(crate) mod pace;
pub(crate) mod page;
pub(crate) mod pass;
pub(crate) mod scene;
pub(crate) mod shaders;
pub(crate) mod sizes;
pub(crate) mod slot_cache;
pub(crate) mod stages;
pub(crate) mod uniforms;
pub(crate) mod work;

pub use adapter::{Adapter, AdapterChoice};
pub(crate) use capacity::Capacity;
pub(crate) use clock::Clock;
pub(crate) use curves::CurveBuffers;
pub use device::{Gpu, Int64};
pub(crate) use on_device::OnDevice;
pub(crate) use page::PageBuffers;
pub(crate) use scene::Scene;
pub(crate) use stages::Stages;
