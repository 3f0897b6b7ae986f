//! The end of a process by a signal: outputs that are not whole go first.
//!
//! Two kinds of end. One is asked for ([`end_when_asked`]): by the user, or by the system that shuts down. A thread of its own
//! removes what was begun; work that would rather come to an end by itself ([`finish_first`]) is asked once. The other is a failure in the midst of the work ([`fail_through`]): there may be no memory left
//! and any lock may be held, so whoever is called may only do what needs neither, as [`end_now`] does.
//!
//! Does not handle: signals that no process can catch.

use std::io;
#[cfg(unix)]
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use super::output::{discard_all, discard_now};

/// Whether the present work ends by itself when it is asked.
static FINISHES: AtomicBool = AtomicBool::new(false);
/// Whether it was asked.
static ASKED: AtomicBool = AtomicBool::new(false);

/// From here on a process that is asked to end (SIGINT, SIGTERM, SIGHUP) removes what was begun and ends with this code.
///
/// # Errors
/// The system's, where it takes no handler: a signal may leave temporary files behind then.
pub fn end_when_asked(code: i32) -> io::Result<()> {
    ctrlc::set_handler(move || ask(code)).map_err(io::Error::other)
}

/// Asks the process to end, as a signal does. Where nothing is at hand that would come to an end by itself, it ends here, with
/// this code.
pub fn ask(code: i32) {
    if FINISHES.load(Ordering::SeqCst) && !ASKED.swap(true, Ordering::SeqCst) {
        return;
    }
    discard_all();
    exit(code)
}

/// Work that comes to an end by itself, as long as this is there.
pub struct Finishing(());

/// As long as what it gives is there, the work looks by itself whether the process [is asked](is_asked) to end; asked again, it
/// ends at once.
#[must_use]
pub fn finish_first() -> Finishing {
    FINISHES.store(true, Ordering::SeqCst);
    Finishing(())
}

impl Drop for Finishing {
    fn drop(&mut self) {
        FINISHES.store(false, Ordering::SeqCst);
    }
}

/// Whether the process was asked to end.
pub fn is_asked() -> bool {
    ASKED.load(Ordering::SeqCst)
}

/// Removes what was begun and ends the process with this code. Asks for no memory, and waits for no thread.
pub fn end_now(code: i32) -> ! {
    discard_now();
    exit(code)
}

fn exit(code: i32) -> ! {
    // SAFETY: it ends the process and touches nothing. Destructors of drivers would run while their threads draw.
    unsafe { libc::_exit(code) }
}

/// From here on a file beyond `ulimit -f` is an error of writing, no signal.
#[cfg(unix)]
pub fn refuse_large_files() {
    // SAFETY: ignoring a signal touches nothing else.
    unsafe { libc::signal(libc::SIGXFSZ, libc::SIG_IGN) };
}

/// Who ends a process that failed.
#[cfg(unix)]
static END: OnceLock<fn() -> !> = OnceLock::new();

/// From here on libraries that abort or touch a null pointer end the process by way of `end`, which may ask for no memory.
#[cfg(unix)]
pub fn fail_through(end: fn() -> !) {
    END.get_or_init(|| end);
    for signal in [libc::SIGABRT, libc::SIGSEGV, libc::SIGBUS] {
        // SAFETY: `failed` asks for no memory, and nothing returns from it.
        unsafe {
            let mut action: libc::sigaction = std::mem::zeroed();
            action.sa_sigaction = failed as *const () as usize;
            action.sa_flags = libc::SA_ONSTACK | libc::SA_RESETHAND;
            libc::sigaction(signal, &action, std::ptr::null_mut());
        }
    }
    // `std::set_terminate`: C++ would print the name of its exception first.
    // SAFETY: where the name is known it is this function of the C++ library, whichever is loaded.
    unsafe {
        let set = libc::dlsym(libc::RTLD_DEFAULT, c"_ZSt13set_terminatePFvvE".as_ptr());
        if !set.is_null() {
            let set: unsafe extern "C" fn(extern "C" fn()) -> *const () = std::mem::transmute(set);
            set(terminated);
        }
    }
}

#[cfg(unix)]
extern "C" fn failed(_: libc::c_int) {
    terminated()
}

#[cfg(unix)]
extern "C" fn terminated() {
    if let Some(end) = END.get() {
        end()
    }
}
