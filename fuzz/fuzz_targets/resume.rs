//! Journals of sweeps, from which `rc sweep --resume` goes on.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rc_sweep::finished_rows;

fuzz_target!(|data: &[u8]| {
    match finished_rows(data) {
        Ok(rows) => assert!(rows <= data.len()),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
