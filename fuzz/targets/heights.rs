//! Every reader of height maps. The first byte chooses the format.

use rc_heights::{Format, parse};

pub(crate) fn run(data: &[u8]) {
    if let Some((first, bytes)) = data.split_first() {
        let format = Format::ALL[usize::from(*first) % Format::ALL.len()];
        if let Err(error) = parse(bytes, format) {
            assert!(!error.to_string().is_empty());
        }
    }
}
