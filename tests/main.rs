//! Every integration test in one binary: linked once, one module a subject.

mod borders;
mod chosen_view;
mod cli;
mod closed_forms;
mod common;
mod cover;
mod coverage;
mod dem;
mod drawing;
mod drawn;
mod facets;
mod forms;
mod gpu_errors;
mod hardware;
mod ink;
mod kernels;
mod left_out;
mod mesh;
mod metrics;
mod reflection;
mod same_bytes;
mod scenes;
mod silhouettes;
mod tolerances;
mod vertices;
mod watertight;
