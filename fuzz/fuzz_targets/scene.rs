//! Scene files.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| halfshade_fuzz::scene(bytes));
