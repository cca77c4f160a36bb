//! PNG, as a picture to compare and as a texture.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| halfshade_fuzz::picture("png", bytes));
