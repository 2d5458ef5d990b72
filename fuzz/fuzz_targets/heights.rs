//! Every reader of height maps.
#![no_main]

#[path = "../targets/heights.rs"]
mod heights;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    heights::run(data);
});
