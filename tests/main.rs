//! Every integration test in one binary: linked once, one module a subject.

mod borders;
mod closed_forms;
mod common;
mod cover;
mod dem;
mod forms;
mod ink;
mod kernels;
mod metrics;
mod same_bytes;
mod scenes;
mod silhouettes;
mod tolerances;
