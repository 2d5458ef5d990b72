//! Arguments of `rc prepare`.

use std::path::{Path, PathBuf};

use clap::{Arg, Args};
use rc_heights::{Crop, Fill, HeightMap, Level, Treatment};

use crate::error::CliError;
use crate::scene::keys::{RunKeys, SurfaceKeys};
use crate::surface::treatment::{DESPIKE, PeriodicName, TreatmentKeys};

/// Arguments of `rc prepare`.
#[derive(Args, Clone, Debug)]
#[command(after_help = PREPARE_HELP)]
#[command(mut_args(without_generated))]
#[command(mut_arg("out", |out| out.required(true).help("Folder for the prepared map")))]
pub(crate) struct PrepareArgs {
    /// Height map: a file of an instrument or a program, or a folder of rc surface
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// How the file is read.
    #[command(flatten)]
    pub(crate) surface: SurfaceKeys,
    /// The treatments.
    #[command(flatten)]
    pub(crate) steps: Steps,
    /// Threads and output.
    #[command(flatten)]
    pub(crate) run: RunKeys,
}

/// The usual treatments, as flags change them.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct Steps {
    /// What is done instead of the usual treatments, or besides.
    #[command(flatten)]
    treatment: TreatmentKeys,
    /// What is not done.
    #[command(flatten)]
    without: Without,
}

/// The usual treatments that are left out.
#[derive(Args, Clone, Copy, Debug, Default)]
#[command(next_help_heading = "Usual treatments to leave out")]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag")]
pub(crate) struct Without {
    /// Keep border rows and columns that are not measured
    #[arg(long, conflicts_with = "crop")]
    no_crop: bool,
    /// Keep spikes
    #[arg(long, conflicts_with = "despike")]
    no_despike: bool,
    /// Keep the tilt
    #[arg(long, conflicts_with = "level")]
    no_level: bool,
    /// Do not fill missing points (a map with holes can be neither mirrored nor solved)
    #[arg(long, conflicts_with = "fill")]
    no_fill: bool,
    /// Do not mirror the map, as for --boundary free
    #[arg(long, conflicts_with = "periodic")]
    no_periodic: bool,
}

impl Steps {
    /// The steps for a patch with free borders, which is not made periodic unless a flag says so.
    pub(crate) fn for_patch(mut self) -> Self {
        self.without.no_periodic |= self.treatment.periodic.is_none();
        self
    }

    /// The flags that give these steps: ` --level quadratic --no-fill`.
    pub(crate) fn flags(&self) -> String {
        let Without { no_crop, no_despike, no_level, no_fill, no_periodic } = self.without;
        let left_out = [
            ("crop", no_crop),
            ("despike", no_despike),
            ("level", no_level),
            ("fill", no_fill),
            ("periodic", no_periodic),
        ];
        let left_out = left_out.iter().filter(|(_, given)| *given).map(|(name, _)| format!(" --no-{name}"));
        self.treatment.flags() + &left_out.collect::<String>()
    }

    /// The usual treatments, with those that are given instead of them or besides.
    pub(crate) fn keys(&self) -> TreatmentKeys {
        let (given, without) = (&self.treatment, self.without);
        TreatmentKeys {
            crop: given.crop.or((!without.no_crop).then_some(Crop::Measured)),
            despike: given.despike.or((!without.no_despike).then_some(DESPIKE)),
            level: given.level.or((!without.no_level).then_some(Level::Plane)),
            fill: given.fill.or((!without.no_fill).then_some(Fill::Laplace)),
            periodic: given.periodic.or((!without.no_periodic).then_some(PeriodicName::Mirror)),
            ..given.clone()
        }
    }
}

/// The treatments of `keys` for a map as read, in the order of their application.
///
/// # Errors
/// [`CliError::Input`] when `resample` is not a grid.
pub(crate) fn treatments(keys: &TreatmentKeys) -> Result<Vec<Treatment>, CliError> {
    let mut treatments = keys.treatments().map_err(|cause| CliError::input(format_args!("resample: {cause}")))?;
    if keys.crop == Some(Crop::Square) {
        // The square is one of measured points. Numbers of points are those of the file.
        treatments.insert(0, Treatment::Crop(Crop::Measured));
    }
    Ok(treatments)
}

/// Refuses a map with holes that are not filled, which no later step takes. `cropped` is the map after its first crops.
///
/// # Errors
/// [`CliError::Input`] with the number of missing points, and what to give.
pub(crate) fn check_filled(path: &Path, keys: &TreatmentKeys, cropped: &HeightMap) -> Result<(), CliError> {
    let missing = cropped.missing();
    if keys.fill.is_some() || missing == 0 {
        return Ok(());
    }
    let message = format_args!(
        "no_fill: {missing} of {} points are missing, and a map with holes can be neither mirrored nor solved; omit \
         --no-fill, give --fill nearest or --fill lowest, or a --crop without holes",
        cropped.heights.grid().len()
    );
    Err(CliError::in_file(path, message))
}

/// The place behind the crops at the beginning.
pub(crate) fn after_crops(treatments: &[Treatment]) -> usize {
    treatments.iter().take_while(|treatment| matches!(treatment, Treatment::Crop(_))).count()
}

/// Hides the keys of generated surfaces, and those that the file or the treatments determine.
pub(crate) fn without_generated(arg: Arg) -> Arg {
    const HIDDEN: [&str; 19] = [
        "heights",
        "spectrum",
        "psd",
        "psd_convention",
        "like",
        "heights_like",
        "waves",
        "hurst",
        "rms",
        "rms_slope",
        "c0",
        "seed",
        "truncation",
        "roll_off",
        "low_cut",
        "amplitudes",
        "grid",
        "time_limit",
        "repeat",
    ];
    let is_hidden = HIDDEN.contains(&arg.get_id().as_str());
    if is_hidden { arg.hide(true) } else { arg }
}

const PREPARE_HELP: &str = "\
The usual treatments, in this order: --crop measured, --despike 8, --level plane, --fill laplace, --periodic mirror. A flag of a \
treatment replaces the usual one, or adds one. --crop square takes the largest square of the measured rectangle.

DIR receives heights.npy (m) and scene.toml, so that rc solve DIR solves it, prepare.json with every step, surface.json, and the \
pictures before.png, despiked.png and surface.png.";
