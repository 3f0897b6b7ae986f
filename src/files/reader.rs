//! Whether somebody reads standard output: a pipe or a socket whose other end is gone has no reader.
//!
//! Files and terminals always have one. Not handled: systems that are no Unix, where only writing tells.

#[cfg(unix)]
use std::io::stdout;
#[cfg(unix)]
use std::os::fd::AsRawFd;

/// Waits until there is none; for ever where that cannot be told.
pub(crate) fn wait_until_gone() {
    #[cfg(unix)]
    while !is_gone_within(-1) {
        // A signal came between, or the system cannot tell of such a file.
        std::thread::sleep(std::time::Duration::from_secs(1));
    }
    #[cfg(not(unix))]
    loop {
        std::thread::park();
    }
}

/// Whether the reader goes within so many milliseconds, of which -1 are without end.
#[cfg(unix)]
fn is_gone_within(milliseconds: libc::c_int) -> bool {
    // Without events to wait for, what is told is that the other end is gone.
    let mut output = libc::pollfd { fd: stdout().as_raw_fd(), events: 0, revents: 0 };
    // SAFETY: it writes to the one entry that it is given.
    let told = unsafe { libc::poll(&mut output, 1, milliseconds) };
    told > 0 && output.revents & (libc::POLLERR | libc::POLLHUP) != 0
}
