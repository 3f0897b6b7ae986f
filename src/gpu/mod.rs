//! The device, its buffers, and one adapter a pass. The mathematics stands in `shaders/`.

pub mod adjacency;
pub mod border;
pub mod buffers;
pub mod candidates;
pub mod clock;
pub mod compose;
pub mod device;
pub mod facing;
pub mod memory;
pub mod pairs;
pub mod pass;
pub mod pool;
pub mod project;
pub mod rasterize;
pub mod rasterize_large;
pub mod seam;
pub mod silhouette;
pub mod sizes;
pub mod stages;
pub mod tessellate;
pub mod toward_away;
pub mod uniforms;
pub mod walk;
pub mod walk_rest;
pub mod work;

pub use buffers::Buffers;
pub use clock::Clock;
pub use device::{AdapterChoice, Gpu, Int64};
pub use pass::{Extent, Pass};
pub use uniforms::CameraUniform;
