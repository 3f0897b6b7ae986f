//! What several test modules share.

use std::io::{Write, stderr};
use std::path::PathBuf;
use std::thread;

/// The folder of shared terrain named by `HACHURE_DEMS`. `None`, with a line that says so, when the variable is
/// unset: the test that called is skipped.
///
/// # Panics
/// When the variable names no folder: a wrong path must not pass for a skip.
pub fn shared_dems() -> Option<PathBuf> {
    let Some(folder) = std::env::var_os("HACHURE_DEMS").map(PathBuf::from) else {
        // Past the capture of the test harness, which shows nothing of a test that passes.
        let _ = writeln!(stderr(), "SKIP {}: set HACHURE_DEMS", thread::current().name().unwrap_or("test"));
        return None;
    };
    assert!(folder.is_dir(), "HACHURE_DEMS: {} is no folder", folder.display());
    Some(folder)
}
