//! Every reader of height maps; the first byte chooses the format.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rc_heights::{Format, parse};

const FORMATS: &[Format] = &[
    Format::Npy,
    Format::Csv,
    Format::Xyz,
    Format::Surfer,
    Format::Gsf,
    Format::Gwy,
    Format::Hdf5,
    Format::Ibw,
    Format::Mat,
    Format::NetCdf,
    Format::Sdf,
    Format::X3p,
    Format::Png,
    Format::Tiff,
    Format::Sur,
    Format::Nanoscope,
    Format::Opd,
    Format::MetroPro,
    Format::Al3d,
    Format::Plu,
    Format::Plux,
    Format::Vk4,
];

fuzz_target!(|data: &[u8]| {
    if let Some((first, bytes)) = data.split_first() {
        let format = FORMATS[usize::from(*first) % FORMATS.len()];
        if let Err(error) = parse(bytes, format) {
            assert!(!error.to_string().is_empty());
        }
    }
});
