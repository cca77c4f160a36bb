//! OpenEXR, as a picture to compare.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| halfshade_fuzz::picture("exr", bytes));
