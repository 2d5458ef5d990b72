//! Every reader of height maps. The first byte chooses the format. A target says whether it accepts its input.

use rc_heights::{Format, parse};

pub(crate) fn run(data: &[u8]) -> bool {
    let Some((first, bytes)) = data.split_first() else { return false };
    let format = Format::ALL[usize::from(*first) % Format::ALL.len()];
    match parse(bytes, format) {
        Ok(_) => true,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    }
}
