#![no_main]

#[path = "../formats.rs"]
mod formats;

// What is kept is made before the first bytes are timed.
libfuzzer_sys::fuzz_target!(init: formats::read("caches", &[]), |bytes: &[u8]| formats::read("caches", bytes));
