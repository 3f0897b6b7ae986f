//! What happens where memory ends: one line and exit code 1, whoever asked for more.
//!
//! Rust asks an allocator that says it and ends the process, except where [`without_end`](crate::error::without_end) says that the asker copes.
//! Libraries in C and C++ (GDAL, drivers, their compilers) abort or stumble over a null pointer. Where the process lives
//! under a limit of memory (`ulimit -v`, `ulimit -d`), these ends are caught and take the same way; without one they are
//! what they were. A file beyond `ulimit -f` is an error of writing then, no signal.
//!
//! Not handled: what such a library prints of its own before it aborts, and a system that kills for memory: no signal
//! of that can be caught.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicBool, Ordering};

use super::words::FAILED;
use crate::error::copes_without;
use crate::files::signals;
#[cfg(unix)]
use crate::gpu::memory::limit;

/// The system's allocator, which says so when memory ends.
pub struct Allocator;

impl Allocator {
    fn checked(place: *mut u8, bytes: usize) -> *mut u8 {
        if place.is_null() && !copes_without() {
            end(Some(bytes));
        }
        place
    }
}

// SAFETY: all is the system's; a null place is given on or ends the process.
unsafe impl GlobalAlloc for Allocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller promises.
        Self::checked(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller promises.
        Self::checked(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, bytes: usize) -> *mut u8 {
        // SAFETY: as the caller promises.
        Self::checked(unsafe { System.realloc(place, layout, bytes) }, bytes)
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(place, layout) }
    }
}

/// Lets the process end in words where a limit of the system is reached. To be called first of all.
pub fn prepare() {
    #[cfg(unix)]
    {
        signals::refuse_large_files();
        if limit().is_none() {
            return;
        }
        // Each thread would set apart 64 MiB of addresses.
        #[cfg(all(target_os = "linux", target_env = "gnu"))]
        // SAFETY: it sets a number, and no other thread is there yet.
        unsafe {
            libc::mallopt(libc::M_ARENA_MAX, 1)
        };
        signals::fail_through(|| end(None));
    }
}

/// Says that memory ended, removes what was begun, and ends the process. Asks for no memory itself.
fn end(bytes: Option<usize>) -> ! {
    static ENDING: AtomicBool = AtomicBool::new(false);
    if !ENDING.swap(true, Ordering::SeqCst) {
        let mut line = FixedLine::default();
        line.push(b"error: out of memory");
        if let Some(bytes) = bytes {
            line.push(b": ");
            line.push_number(bytes.div_ceil(1 << 10));
            line.push(b" KiB more were needed");
        }
        line.push(b"; use a --crop, a smaller --memory or --size, or allow more (`ulimit -v` says how much)\n");
        line.print();
    }
    signals::end_now(FAILED.into())
}

/// A line made without memory of its own.
struct FixedLine {
    bytes: [u8; 256],
    length: usize,
}

impl Default for FixedLine {
    fn default() -> Self {
        Self { bytes: [0; 256], length: 0 }
    }
}

impl FixedLine {
    fn push(&mut self, bytes: &[u8]) {
        let room = self.bytes[self.length..].iter_mut();
        self.length += room.zip(bytes).map(|(to, from)| *to = *from).count();
    }

    fn push_number(&mut self, number: usize) {
        if number >= 10 {
            self.push_number(number / 10);
        }
        self.push(&[b'0' + (number % 10) as u8]);
    }

    fn print(&self) {
        // SAFETY: so many bytes are there; where nobody reads them there is nowhere left to say so.
        unsafe { libc::write(2, self.bytes.as_ptr().cast(), self.length as _) };
    }
}
