//! What several test modules share.

use std::io::{Write, stderr};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Arc, OnceLock};
use std::thread;

use hachure::door::cli::words::told;
use hachure::error::Message;
use hachure::gpu::{AdapterChoice, Gpu, Int64};

/// The device of all tests, with 64-bit atomics where the adapter has them.
///
/// # Panics
/// Without an adapter: nothing drawn is nothing proven.
pub fn gpu() -> &'static Arc<Gpu> {
    static GPU: OnceLock<Arc<Gpu>> = OnceLock::new();
    GPU.get_or_init(|| Arc::new(Gpu::open(&AdapterChoice::Best, Int64::IfPresent).expect("an adapter")))
}

/// What was converted or assumed, in the words of the command line.
pub fn words(clauses: &[Message]) -> Vec<String> {
    clauses.iter().map(told).collect()
}

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

/// Copies a raster as netCDF-4, which is HDF5, in a process of its own: that library serves one thread at a time, and other
/// tests use it meanwhile. `false`, with a line that says so, where GDAL's tools are missing.
pub fn netcdf_4(from: &Path, to: &Path) -> bool {
    let options = ["-q", "-of", "netCDF", "-co", "FORMAT=NC4", "-co", "COMPRESS=DEFLATE"];
    match Command::new("gdal_translate").args(options).args([from, to]).output() {
        Ok(output) => {
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            true
        }
        Err(_) => {
            let _ = writeln!(stderr(), "SKIP {}: install gdal_translate", thread::current().name().unwrap_or("test"));
            false
        }
    }
}
