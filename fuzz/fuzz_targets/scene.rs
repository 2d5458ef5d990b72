//! Scene files.
#![no_main]

#[path = "../targets/scene.rs"]
mod scene;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    scene::run(data);
});
