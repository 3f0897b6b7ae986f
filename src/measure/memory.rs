//! The most memory this process has held at once, as Linux counts it.
//!
//! Resident pages of the whole process: heap, code, and what a software driver keeps of its device. Pages that other
//! processes share count too. Elsewhere than on Linux nothing is known.

use std::fs::{OpenOptions, read_to_string};
use std::io::Write;

/// Forgets earlier peaks: from here on [`peak`] is that of the stage that begins. Where the system refuses, it stays
/// the peak since the process began.
pub fn reset_peak() {
    if let Ok(mut references) = OpenOptions::new().write(true).open("/proc/self/clear_refs") {
        // 5 resets the high-water mark and nothing else: proc(5). What is refused here is harmless, as said above.
        let _ = references.write_all(b"5");
    }
}

/// Most bytes this process has held since it began or [`reset_peak`]; `None` where the system does not say.
pub fn peak() -> Option<u64> {
    let status = read_to_string("/proc/self/status").ok()?;
    let kib = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix(" kB"))?;
    Some(kib.parse::<u64>().ok()? * 1024)
}
