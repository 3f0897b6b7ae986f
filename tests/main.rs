//! Every integration test in one binary: linked once, one module a subject.

mod common;
mod dem;
mod ink;
