//! Measured height maps: what instruments and other programs write, read into a [`HeightMap`], treated and described.
//!
//! [`read`] knows a file by its first bytes, or by its extension where the format has no mark: text as instruments and
//! Gwyddion export it, lists of `x y z`, arrays (`.npy`, `.mat`, `.h5`, `.nc`), Gwyddion `.gwy` and `.gsf`, Surfer
//! `.grd`, Igor `.ibw`, ISO 25178-71 `.sdf`, ISO 5436-2 `.x3p`, files of instruments (Digital Surf `.sur`, Nanoscope
//! `.spm`, Wyko `.opd`, MetroPro `.dat`, Alicona `.al3d`, Sensofar `.plu` and `.plux`, Keyence `.vk4`), grayscale PNG
//! and TIFF, and any of them packed with gzip. Of several [`channels`] it reads the first with heights; [`read_with`]
//! reads another. [`Treatment`]s level, fill, crop, flip, filter and resample it and make it periodic;
//! [`AreaParameters`] are those of ISO 25178-2.
//!
//! [`spectrum`] reads surfaces that are given by their Fourier coefficients instead.
//!
//! Besides the command line, this is the only crate that knows metres: a file carries units, and
//! [`HeightMap::in_metres`] applies them once. Row `iy` of a file is row `iy` of the field; a missing point is `NaN`.
//!
//! No input makes a reader panic or take more memory than the file accounts for: what a header promises is compared
//! with the bytes that are there before memory is taken. `tests/it/robustness.rs` shows it on arbitrary and on mutated
//! files.
//!
//! ```
//! use rc_heights::{AreaParameters, Format, Level, Scales, Treatment, apply, parse};
//!
//! // 4 x 3 points 2 µm apart, on a slope, one of them not measured.
//! let file = "aISO-1.0\nNumPoints = 4\nNumProfiles = 3\nXscale = 2e-6\nYscale = 2e-6\nZscale = 1e-9\nDataType = 7\n*\n\
//!             0 10 20 30  1 10 BAD 31  0 11 20 30\n*\n";
//! let map = parse(file.as_bytes(), Format::Sdf)?.in_metres(Scales::default())?;
//! assert_eq!((map.sides, map.missing()), (Some([8e-6, 6e-6]), 1));
//!
//! let (map, effects) = apply(map, &[Treatment::Fill(rc_heights::Fill::Laplace), Treatment::Level(Level::Plane)])?;
//! assert_eq!(effects[0].missing, 0);
//! assert!(AreaParameters::of(&map.heights, [8e-6, 6e-6]).sq < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod error;
mod formats;
mod map;
mod parameters;
pub mod spectrum;
mod statistics;
mod treat;
mod units;

pub use error::{FormatError, ReadError};
pub use formats::{
    ChannelInfo, Format, Layout, LayoutError, MatArray, ReadParams, channels, channels_of, format_of, mat_arrays,
    may_have_sides, npy, parse, parse_with, read, read_with, text,
};
pub use map::{BorderStep, HeightMap};
pub use parameters::AreaParameters;
pub use statistics::MapStatistics;
pub use treat::{
    Crop, Edges, Effect, Fill, Flip, Level, MOST_COPIES, Periodic, Repeat, SAME_LENGTH, TreatError, Treatment, apply,
    grids_after, hann,
};
pub use units::{LengthUnit, LengthUnitError, Scales, Unit};
