//! Libraries under GDAL that print on standard error by themselves, told not to.
//!
//! HDF5 prints the stack of each error, thread by thread; PROJ and libgeotiff print where they are not asked through
//! GDAL. No error handler of GDAL's hears of it, but each has a switch, looked up by name among the libraries of the
//! process: GDAL brings them along, and this crate links none of them. What they would say is said by GDAL, too, in
//! fewer words. Cost: a millisecond a thread, once. Not handled: builds of GDAL that hold them under other names, and
//! systems other than Unix; there they go on printing.

/// Silences them for this thread; other threads have their own HDF5 to silence.
#[cfg(unix)]
pub(super) fn hush() {
    use std::cell::Cell;
    use std::sync::Once;

    static ONCE: Once = Once::new();
    thread_local! {
        static DONE: Cell<bool> = const { Cell::new(false) };
    }
    ONCE.call_once(printers::silence_process);
    if !DONE.replace(true) {
        printers::silence_thread();
    }
}

/// Nothing is silenced here.
#[cfg(not(unix))]
pub(super) fn hush() {}

#[cfg(unix)]
mod printers {
    use std::ffi::{CStr, c_char, c_int, c_void};
    use std::mem::transmute;
    use std::ptr::null_mut;

    type Log = extern "C" fn(*mut c_void, c_int, *const c_char);
    type Handler = extern "C" fn(c_int, c_int, *const c_char);

    /// PROJ's default, which contexts made without GDAL take over, and libgeotiff's.
    pub(super) fn silence_process() {
        if let Some(set) = found(c"proj_log_func") {
            // SAFETY: `void proj_log_func(PJ_CONTEXT *, void *, PJ_LOG_FUNCTION)`; a null context is the default one.
            unsafe {
                let set: extern "C" fn(*mut c_void, *mut c_void, Log) = transmute(set);
                set(null_mut(), null_mut(), no_log);
            }
        }
        if let Some(set) = found(c"gtCPLSetErrorHandler") {
            // SAFETY: `gtCPLErrorHandler gtCPLSetErrorHandler(gtCPLErrorHandler)`, the handler before is a pointer.
            unsafe {
                let set: extern "C" fn(Handler) -> *mut c_void = transmute(set);
                set(no_handler);
            }
        }
    }

    /// HDF5's automatic printing.
    pub(super) fn silence_thread() {
        if let Some(set) = found(c"H5Eset_auto2") {
            // SAFETY: `herr_t H5Eset_auto2(hid_t, H5E_auto2_t, void *)`, ids of 64 bits since HDF5 1.10; 0 is the default
            // stack, and no function means no printing.
            unsafe {
                let set: extern "C" fn(i64, *mut c_void, *mut c_void) -> c_int = transmute(set);
                set(0, null_mut(), null_mut());
            }
        }
    }

    fn found(name: &CStr) -> Option<*mut c_void> {
        // SAFETY: the name ends in 0; looking it up changes nothing.
        let place = unsafe { libc::dlsym(libc::RTLD_DEFAULT, name.as_ptr()) };
        (!place.is_null()).then_some(place)
    }

    extern "C" fn no_log(_: *mut c_void, _: c_int, _: *const c_char) {}

    extern "C" fn no_handler(_: c_int, _: c_int, _: *const c_char) {}
}
