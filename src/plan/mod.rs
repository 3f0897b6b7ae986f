//! What a frame needs: which method, over which chunks, in which batches.

pub mod batches;
pub mod method;

pub use batches::{Batch, batches};
pub use method::{Border, Method, Share, Thrift, Visibility};
