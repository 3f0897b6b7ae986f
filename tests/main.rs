//! Every integration test in one binary: linked once, one module a subject.

mod cli;
mod common;
mod dem;
mod ink;
