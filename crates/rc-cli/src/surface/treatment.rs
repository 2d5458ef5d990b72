//! Flags that treat a measured map, in the order in which they are applied.

use clap::{Args, FromArgMatches as _, ValueEnum};
use rc_core::{Grid, GridError};
use rc_heights::{Crop, Fill, Flip, Level, Periodic, Repeat, Treatment};

use crate::error::CliError;
use crate::scene::quantity::length;
use crate::scene::values::GridSpec;

/// Robust deviations of a spike, if none are given.
pub(crate) const DESPIKE: f64 = 8.0;

/// Fraction of a side that a window fades at each end, if none is given.
const TAPER: f64 = 0.1;

/// What is done to a height map before it is written.
#[derive(Args, Clone, Debug, Default, PartialEq)]
#[command(next_help_heading = "Treatment of a height map, in this order")]
pub(crate) struct TreatmentKeys {
    /// Keep a part: measured, square (the largest in the middle), 512, 512x256, or 512x256+100+50
    ///
    /// measured cuts border rows and columns with more missing than measured points. 512x256+100+50 keeps 512 x 256 points, from point 100 along x and point 50 along y. If neither
    /// the file nor --cell-y gives the side along y, all treatments assume equal spacings along x and y.
    #[arg(long, value_name = "PART")]
    pub(crate) crop: Option<Crop>,
    /// Mirror along axes: x, y, z (peaks become valleys, for replicas), or x,z
    #[arg(long, value_name = "AXES", value_delimiter = ',')]
    pub(crate) flip: Vec<Flip>,
    /// Replace isolated points farther than this many robust deviations from their neighbours [8, if omitted]
    ///
    /// A membrane through the points around takes their place. The deviation is that of all points from the median of
    /// their eight neighbours.
    #[arg(long, value_name = "SIGMA", num_args = 0..=1, default_missing_value = "8")]
    pub(crate) despike: Option<f64>,
    /// Subtract a form, fitted to measured points by least squares: mean, plane or quadratic
    #[arg(long, value_name = "FORM")]
    pub(crate) level: Option<Level>,
    /// Fill missing points: laplace (a membrane through measured points), nearest, or lowest
    #[arg(long, value_name = "HOW")]
    pub(crate) fill: Option<Fill>,
    /// Gaussian filter (L-filter of ISO 25178-3) that halves waves of this length (m) and removes longer ones
    #[arg(long, value_name = "LENGTH", value_parser = length::parse, allow_hyphen_values = true)]
    pub(crate) high_pass: Option<f64>,
    /// Make opposite borders meet: mirror (twice the side), window, or as-is (they meet already)
    ///
    /// mirror has four times the points on twice the side; slopes change sign at the seams. With window, heights fade
    /// to the lowest one towards the borders, where nothing touches.
    #[arg(long, value_name = "HOW", hide_possible_values = true)]
    pub(crate) periodic: Option<PeriodicName>,
    /// Fraction of a side that --periodic window fades, at each of its ends
    #[arg(long, value_name = "PART", default_value_t = TAPER, allow_hyphen_values = true)]
    pub(crate) taper: f64,
    /// Gaussian filter (ISO 16610-61) that halves waves of this length (m)
    ///
    /// Shorter waves lose more. The length is four points or more.
    #[arg(long, value_name = "LENGTH", value_parser = length::parse, allow_hyphen_values = true)]
    pub(crate) low_pass: Option<f64>,
    /// Fewer points (means) or more (cubic) on the same area: 512, or 512x256
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub(crate) resample: Option<GridSpec>,
    /// Copies of a periodic map side by side: 3x4, or square (makes the cell a square)
    ///
    /// square is for programs that need a square cell. In rc, only the method gauss-seidel needs one.
    #[arg(long, value_name = "COPIES")]
    pub(crate) repeat: Option<Repeat>,
}

/// Names of ways to make a map periodic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PeriodicName {
    /// With its mirror images.
    Mirror,
    /// By a window.
    Window,
    /// It is.
    AsIs,
}

/// The treatments that flags of `rc surface` name, in the order of their application.
///
/// An example of `words` is `["--level", "plane"]`.
///
/// # Errors
/// [`CliError::Input`] for words that are not such flags.
pub fn treatments(words: &[String]) -> Result<Vec<Treatment>, CliError> {
    let command = TreatmentKeys::augment_args(clap::Command::new("treatments").no_binary_name(true));
    let matches = command.try_get_matches_from(words).map_err(|error| CliError::from(&error))?;
    let keys = TreatmentKeys::from_arg_matches(&matches).map_err(|error| CliError::from(&error))?;
    keys.treatments().map_err(|cause| CliError::input(format_args!("resample: {cause}")))
}

impl TreatmentKeys {
    /// The flags that give these keys: ` --crop square --level plane`.
    pub(crate) fn flags(&self) -> String {
        let flips = self.flip.iter().map(ToString::to_string).collect::<Vec<_>>().join(",");
        let periodic = self.periodic.and_then(|name| Some(name.to_possible_value()?.get_name().to_owned()));
        let length = |value: Option<f64>| value.map(|value| format!("{value:e}"));
        let given = [
            ("crop", self.crop.map(|crop| crop.to_string())),
            ("flip", (!flips.is_empty()).then_some(flips)),
            ("despike", self.despike.map(|sigma| sigma.to_string())),
            ("level", self.level.map(|form| form.to_string())),
            ("fill", self.fill.map(|how| how.to_string())),
            ("high-pass", length(self.high_pass)),
            ("periodic", periodic),
            ("taper", self.tapers().then(|| self.taper.to_string())),
            ("low-pass", length(self.low_pass)),
            ("resample", self.resample.map(|grid| grid.to_string())),
            ("repeat", self.repeat.map(|copies| copies.to_string())),
        ];
        given.into_iter().filter_map(|(name, value)| Some(format!(" --{name} {}", value?))).collect()
    }

    /// Whether the width of the window is not the default.
    fn tapers(&self) -> bool {
        self.taper.total_cmp(&TAPER).is_ne()
    }

    /// The treatments in the order of their application.
    ///
    /// # Errors
    /// When `resample` is not a grid.
    pub(crate) fn treatments(&self) -> Result<Vec<Treatment>, GridError> {
        let periodic = |name| match name {
            PeriodicName::Mirror => Periodic::Mirror,
            PeriodicName::Window => Periodic::Window { taper: self.taper },
            PeriodicName::AsIs => Periodic::AsIs,
        };
        let resample = self.resample.map(|spec| Grid::new(spec.nx, spec.ny)).transpose()?;
        let mut treatments = Vec::new();
        treatments.extend(self.crop.map(Treatment::Crop));
        treatments.extend(self.flip.iter().copied().map(Treatment::Flip));
        treatments.extend(self.despike.map(|sigma| Treatment::Despike { sigma }));
        // The form is that of the measured points alone. Filled points then follow it.
        treatments.extend(self.level.map(Treatment::Level));
        treatments.extend(self.fill.map(Treatment::Fill));
        treatments.extend(self.high_pass.map(|wavelength| Treatment::HighPass { wavelength }));
        treatments.extend(self.periodic.map(periodic).map(Treatment::Periodic));
        treatments.extend(self.low_pass.map(|wavelength| Treatment::LowPass { wavelength }));
        treatments.extend(resample.map(Treatment::Resample));
        treatments.extend(self.repeat.map(Treatment::Repeat));
        Ok(treatments)
    }
}
