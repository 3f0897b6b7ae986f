//! Every integration test in one binary: linked once, one module a subject.

mod cli;
mod common;
mod coverage;
mod dem;
mod drawn;
mod gpu_errors;
mod hardware;
mod ink;
mod mesh;
mod reflection;
mod tolerances;
mod vertices;
mod watertight;
