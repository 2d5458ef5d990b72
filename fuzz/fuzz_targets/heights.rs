//! Every reader of height maps. The first byte chooses the format.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rc_heights::{Format, parse};

fuzz_target!(|data: &[u8]| {
    if let Some((first, bytes)) = data.split_first() {
        let format = Format::ALL[usize::from(*first) % Format::ALL.len()];
        if let Err(error) = parse(bytes, format) {
            assert!(!error.to_string().is_empty());
        }
    }
});
