//! OBJ models.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| halfshade_fuzz::model("obj", bytes));
