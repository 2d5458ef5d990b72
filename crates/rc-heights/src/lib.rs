//! Readers, treatments and descriptions of measured height maps.
//!
//! [`read`] reads a file of an instrument or another program into a [`HeightMap`]. It recognises the format by the
//! first bytes, or by the extension if the format has no mark:
//!
//! - text as instruments and Gwyddion export it, and lists of `x y z`;
//! - arrays: `.npy`, `.mat`, `.h5`, `.nc`, as maps or as points;
//! - files of programs and standards: Gwyddion `.gwy` and `.gsf`, Surfer `.grd`, Igor `.ibw`, ISO 25178-71 `.sdf`, ISO
//!   5436-2 `.x3p`;
//! - files of instruments: Digital Surf `.sur`, Nanoscope `.spm`, Wyko `.opd`, MetroPro `.dat`, Alicona `.al3d`,
//!   Sensofar `.plu` and `.plux`, Keyence `.vk4` and `.vk6`, Nanosurf `.nid`, WSxM `.stp`, Park `.tiff`, Bruker `.opdx`,
//!   FRT `.frt`, SPIP `.bcrf`;
//! - grayscale PNG and TIFF;
//! - any of these compressed with gzip.
//!
//! If a file has several [`channels`], [`read`] takes the first with heights, and [`read_with`] takes a given one.
//! [`Treatment`]s level, fill, crop, flip, filter and resample a map and make it periodic. [`AreaParameters`] are those
//! of ISO 25178-2. Module [`spectrum`] reads surfaces that are given by Fourier coefficients instead, and
//! module [`pairs`] tables of spectra and profiles.
//!
//! This crate passes on the units of a file, and [`HeightMap::in_metres`] applies them once. Row 0 of a field is the
//! lowest, so rows are reversed where the first row of a file is the top of its picture
//! ([`Format::first_row_is_top`]). A missing point is `NaN`. [`gsf::write`] and [`netcdf::write`] write maps with their
//! size.
//!
//! A reader neither panics nor takes more memory than the bytes of the file justify, for any input. It compares the
//! sizes in a header with the available bytes before it takes memory, and what a file unpacks to with
//! [`ReadParams::max_bytes`]. `tests/it/robustness.rs` tests this with arbitrary and with mutated files, and
//! `tests/it/bombs.rs` with small files that unpack to large ones.
//!
//! ```
//! use rc_heights::{AreaParameters, Format, Level, Scales, Treatment, apply, parse};
//!
//! // A map of 4 x 3 points 2 µm apart, on a slope. One point is not measured.
//! let file = "aISO-1.0\nNumPoints = 4\nNumProfiles = 3\nXscale = 2e-6\nYscale = 2e-6\nZscale = 1e-9\n\
//!             DataType = 7\n*\n\
//!             0 10 20 30  1 10 BAD 31  0 11 20 30\n*\n";
//! let map = parse(file.as_bytes(), Format::Sdf)?.in_metres(Scales::default())?;
//! assert_eq!((map.sides, map.missing()), (Some([8e-6, 6e-6]), 1));
//!
//! let (map, effects) = apply(map, &[Treatment::Fill(rc_heights::Fill::Laplace), Treatment::Level(Level::Plane)])?;
//! assert_eq!(effects[0].missing, 0);
//! assert!(AreaParameters::of(&map.heights, [8e-6, 6e-6]).sq < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bicubic;
mod error;
mod formats;
mod map;
mod material_ratio;
mod note;
pub mod pairs;
mod parameters;
mod profile_elements;
mod profile_parameters;
pub mod spectrum;
mod statistics;
pub mod suspicion;
mod treat;
mod units;

pub use bicubic::Bicubic;
pub use error::{FormatError, ReadError};
pub use formats::nc_writer as netcdf;
pub use formats::{
    ChannelInfo, DEFAULT_MAX_BYTES, Format, Layout, LayoutError, Mask, MaskError, MatArray, ReadParams, channels,
    channels_of, format_of, gsf, has_profile, mat_arrays, may_have_sides, npy, of_points, parse, parse_with, read,
    read_with, text,
};
pub use map::{BorderStep, HeightMap};
pub use material_ratio::{CoreParameters, MaterialRatio};
pub use note::ReadNote;
pub use parameters::AreaParameters;
pub use profile_elements::mean_width_of_elements;
pub use profile_parameters::ProfileParameters;
pub use statistics::MapStatistics;
pub use treat::{
    Crop, Edges, Effect, Fill, Flip, Level, MOST_COPIES, Periodic, Repeat, SAME_LENGTH, TreatError, Treatment, apply,
    grids_after, hann,
};
pub use units::{LengthUnit, LengthUnitError, Scales, Unit};
