//! `rc inspect` of a profile: parameters of ISO 21920-2 and ISO 4287, and spectra.

use std::path::Path;

use rc_core::quantity::{digits, engineering};
use rc_fractal::{LEAST_POINTS, gaussian_mean_line, spectra_of_profile};
use rc_heights::{ProfileParameters, ReadNote, mean_width_of_elements, pairs};
use rc_sweep::files::Staged;
use rc_sweep::{Warning, files, to_json};
use serde::Serialize;

use super::args::InspectArgs;
use super::profile_pictures;
use super::profile_row::ProfileRow;
use crate::error::CliError;
use crate::scene::profile::Profile;
use crate::text::{aligned, written};
use crate::warnings;
use crate::warnings::shown::{refuse, tell};
use crate::warnings::surface::Shape;

/// File of the isotropic spectrum in the folder of the pictures.
const PSD_FILE: &str = "psd.csv";

/// Titles of that file.
const PSD_TITLES: &str = "q (rad/m), C (m^4): isotropic surface with the spectrum of the profile";

/// Statistics of a profile. Lengths are in m.
#[derive(Clone, Debug, Serialize)]
pub(super) struct ProfileRecord {
    points: usize,
    missing: usize,
    length: f64,
    spacing: f64,
    mean: f64,
    h_min: f64,
    h_max: f64,
    rms_slope: f64,
    lambda_s: Option<f64>,
    lambda_c: Option<f64>,
    /// Part of the length that the parameters R are of.
    evaluation_length: f64,
    /// Number of sections of that part, each a λc long.
    sections: usize,
    #[serde(flatten)]
    filtered: Filtered,
    #[serde(flatten)]
    unfiltered: Unfiltered,
    spectrum: Vec<ProfileRow>,
    notes: Vec<String>,
    warnings: Vec<Warning>,
}

/// The parameters after the filters, if they are given.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "PascalCase")]
struct Filtered {
    ra: f64,
    rq: f64,
    rz: f64,
    rsk: f64,
    rku: f64,
    rp: f64,
    rv: f64,
    rt: f64,
    /// Mean width of the elements; `None` if there is no whole one.
    #[serde(rename = "RSm")]
    rsm: Option<f64>,
}

/// The parameters without a filter.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "PascalCase")]
struct Unfiltered {
    pa: f64,
    pq: f64,
    pz: f64,
    psk: f64,
    pku: f64,
    pp: f64,
    pv: f64,
    pt: f64,
    #[serde(rename = "PSm")]
    psm: Option<f64>,
}

impl Filtered {
    fn new(of: ProfileParameters, rsm: Option<f64>) -> Self {
        let ProfileParameters { a, q, sk, ku, p, v, z, t } = of;
        Self { ra: a, rq: q, rz: z, rsk: sk, rku: ku, rp: p, rv: v, rt: t, rsm }
    }
}

impl Unfiltered {
    fn new(of: ProfileParameters, psm: Option<f64>) -> Self {
        let ProfileParameters { a, q, sk, ku, p, v, z, t } = of;
        Self { pa: a, pq: q, pz: z, psk: sk, pku: ku, pp: p, pv: v, pt: t, psm }
    }
}

/// The text about a profile. Its files are written, and its warnings told.
///
/// # Errors
/// [`CliError`].
pub(super) fn shown(args: &InspectArgs, profile: &Profile) -> Result<String, CliError> {
    let record = ProfileRecord::of(args, profile)?;
    refuse(&record.warnings, args.strict, "; nothing was written")?;
    tell(&record.warnings, &args.run_keys());
    if let Some(path) = &args.psd_out {
        if record.spectrum.is_empty() {
            let message = format_args!("a profile of {} points has no spectrum; omit --psd-out", record.points);
            return Err(CliError::in_file(&args.file, message));
        }
        write_psd(path, &record)?;
    }
    if let Some(folder) = &args.out {
        files::check_folder(folder)?;
        let mut staged = Staged::new(folder)?;
        profile_pictures::add(&mut staged, (&profile.heights, profile.spacing), &record.spectrum)?;
        if !record.spectrum.is_empty() {
            staged.add(PSD_FILE, |path| pairs::write(path, PSD_TITLES, &record.psd()))?;
        }
        staged.commit()?;
    }
    Ok(if args.json { to_json(&record) } else { record.text() + &written(args.out.as_deref()) })
}

/// The text of RSm or PSm.
fn width_of_elements(value: Option<f64>) -> String {
    value.map_or_else(
        || "not defined: there is no whole element of a hill and a dale".to_owned(),
        |width| format!("{}, mean width of elements", engineering(width, "m")),
    )
}

/// Writes the spectrum of the isotropic surface.
fn write_psd(path: &Path, record: &ProfileRecord) -> Result<(), CliError> {
    pairs::write(path, PSD_TITLES, &record.psd())
        .map_err(|cause| CliError::Write(format!("{}: cannot write: {cause}", path.display())))
}

/// `heights` with straight lines over missing points, and level lines at the ends.
fn without_holes(heights: &[f64]) -> Vec<f64> {
    let measured: Vec<usize> = (0..heights.len()).filter(|&i| heights[i].is_finite()).collect();
    let value = |i: usize| {
        let after = measured.partition_point(|&at| at < i);
        match (after.checked_sub(1).map(|before| measured[before]), measured.get(after).copied()) {
            (_, Some(at)) if at == i => heights[i],
            (Some(before), Some(at)) => {
                let part = (i - before) as f64 / (at - before) as f64;
                heights[before] + part * (heights[at] - heights[before])
            }
            (Some(near), None) | (None, Some(near)) => heights[near],
            (None, None) => f64::NAN,
        }
    };
    (0..heights.len()).map(value).collect()
}

/// The roughness profile from half a λc on, as many whole sections of λc as there are up to half a λc before its end,
/// and their number.
///
/// Sections end at points, so each is λc long to a step.
fn roughness(
    heights: &[f64],
    spacing: f64,
    [lambda_s, lambda_c]: [Option<f64>; 2],
) -> Result<(Vec<f64>, usize), CliError> {
    let length = heights.len() as f64 * spacing;
    for (key, lambda) in [("lambda_s", lambda_s), ("lambda_c", lambda_c)] {
        let Some(lambda) = lambda else { continue };
        if !(lambda >= 2.0 * spacing && 2.0 * lambda <= length) {
            return Err(CliError::input(format_args!(
                "{key}: must be from two steps of the profile, {}, to half of its length, {}, not {}",
                engineering(2.0 * spacing, "m"),
                engineering(0.5 * length, "m"),
                engineering(lambda, "m")
            )));
        }
    }
    if let (Some(short), Some(long)) = (lambda_s, lambda_c)
        && short >= long
    {
        return Err(CliError::input("lambda_s: must be below lambda_c, usually a hundredth or less of it"));
    }
    let smooth = lambda_s.map_or_else(|| heights.to_vec(), |lambda| gaussian_mean_line(heights, lambda / spacing));
    let Some(lambda) = lambda_c else {
        let end = lambda_s.map_or(0, |lambda| (0.5 * lambda / spacing).ceil() as usize);
        return Ok((smooth[end..smooth.len() - end].to_vec(), 1));
    };
    let waviness = gaussian_mean_line(&smooth, lambda / spacing);
    let end = (0.5 * lambda / spacing * (1.0 - 1e-9)).ceil() as usize;
    let kept: Vec<f64> = smooth.iter().zip(&waviness).map(|(height, line)| height - line).collect();
    let left = &kept[end..kept.len() - end];
    // A whole number of sections may have a rounding error. A rest after the last one is not evaluated.
    let sections = ((left.len() as f64 * spacing / lambda * (1.0 + 1e-9)) as usize).max(1);
    let points = (sections as f64 * lambda / spacing).round() as usize;
    Ok((left[..points.min(left.len())].to_vec(), sections))
}

/// The spectra of a profile; empty for too few points.
fn spectrum(heights: &[f64], spacing: f64) -> Vec<ProfileRow> {
    if heights.len() < LEAST_POINTS {
        return Vec::new();
    }
    let row = |row: &rc_fractal::ProfileSpectrumRow| ProfileRow {
        wavenumber: row.wavenumber,
        psd_profile: row.along,
        psd: row.isotropic,
    };
    spectra_of_profile(heights, spacing).iter().map(row).collect()
}

impl ProfileRecord {
    fn of(args: &InspectArgs, profile: &Profile) -> Result<Self, CliError> {
        let Profile { heights, spacing, notes } = profile;
        let missing = heights.iter().filter(|height| height.is_nan()).count();
        let whole = without_holes(heights);
        let (kept, sections) = roughness(&whole, *spacing, [args.lambda_s, args.lambda_c])?;
        let filtered = match (args.lambda_s, args.lambda_c) {
            (_, Some(_)) => ProfileParameters::about(0.0, &kept, sections),
            (Some(_), None) => ProfileParameters::of(&kept),
            (None, None) => ProfileParameters::of(heights),
        };
        let steps = whole.windows(2).map(|pair| ((pair[1] - pair[0]) / spacing).powi(2));
        let measured = || heights.iter().copied().filter(|height| !height.is_nan());
        let [h_min, h_max] = [measured().fold(f64::INFINITY, f64::min), measured().fold(f64::NEG_INFINITY, f64::max)];
        if h_max <= h_min {
            let message = format_args!("all heights are {}; a flat profile has no statistics", digits(h_max, 6));
            return Err(CliError::in_file(&args.file, message));
        }
        let rms_slope = (steps.sum::<f64>() / (whole.len() - 1) as f64).sqrt();
        let (assumed, told): (Vec<&ReadNote>, Vec<&ReadNote>) = notes.iter().partition(|note| note.is_assumption());
        let assumed: Vec<String> = assumed.into_iter().map(ToString::to_string).collect();
        let mut notes: Vec<String> = told.into_iter().map(ToString::to_string).collect();
        if missing > 0 {
            notes.push("filters and spectra have straight lines over missing points".to_owned());
        }
        let shape = Shape { rms_slope, range: h_max - h_min, sides: [profile.length(); 2] };
        let mut warnings: Vec<Warning> = warnings::surface::assumed(&assumed).into_iter().collect();
        warnings.extend(shape.warnings());
        // Of a profile without filters, missing points are passed over, but an element goes on beyond them.
        let unfiltered = ProfileParameters::of(heights);
        let width = |heights: &[f64], z: f64, sections: usize| {
            let section = heights.len() as f64 / sections as f64;
            mean_width_of_elements(heights, z, section).map(|steps| steps * spacing)
        };
        let filtered = Filtered::new(filtered, width(&kept, filtered.z, sections));
        let unfiltered = Unfiltered::new(unfiltered, width(&whole, unfiltered.z, 1));
        let spectrum = spectrum(&whole, *spacing);
        if spectrum.is_empty() {
            notes.push(format!(
                "{} points have no spectrum, which needs {LEAST_POINTS}; Psk, Pku and the rms slope of so few say little",
                whole.len()
            ));
        }
        Ok(Self {
            points: heights.len(),
            missing,
            length: profile.length(),
            spacing: *spacing,
            mean: measured().sum::<f64>() / (heights.len() - missing) as f64,
            h_min,
            h_max,
            rms_slope,
            lambda_s: args.lambda_s,
            lambda_c: args.lambda_c,
            evaluation_length: kept.len() as f64 * spacing,
            sections,
            filtered,
            unfiltered,
            spectrum,
            notes,
            warnings,
        })
    }

    /// q and C of the isotropic surface.
    fn psd(&self) -> Vec<[f64; 2]> {
        self.spectrum.iter().map(|row| [row.wavenumber, row.psd]).collect()
    }

    fn text(&self) -> String {
        let metres = |value| engineering(value, "m");
        let Unfiltered { pa, pq, pz, psk, pku, pp, pv, pt, psm } = self.unfiltered;
        let Filtered { ra, rq, rz, rsk, rku, rp, rv, rt, rsm } = self.filtered;
        let heights = |kind: &str, values: [f64; 6]| {
            let named = |(name, value): (char, f64)| format!("{kind}{name} {}", metres(value));
            ['a', 'q', 'p', 'v', 'z', 't'].into_iter().zip(values).map(named).collect::<Vec<_>>().join(", ")
        };
        let missing = if self.missing > 0 { format!(", {} missing", self.missing) } else { String::new() };
        let mut lines = vec![
            (
                "profile",
                format!(
                    "{} points{missing}, step {}, length {}",
                    self.points,
                    metres(self.spacing),
                    metres(self.length)
                ),
            ),
            ("heights", format!("from {} to {}, mean {}", metres(self.h_min), metres(self.h_max), metres(self.mean))),
            ("rms slope", format!("{} (differences of neighbours)", digits(self.rms_slope, 4))),
            ("P parameters", heights("P", [pa, pq, pp, pv, pz, pt])),
            ("Psk, Pku", format!("{}, {}", digits(psk, 4), digits(pku, 4))),
            ("PSm", width_of_elements(psm)),
        ];
        if let Some(filters) = self.filters() {
            lines.push(("filters", filters));
            lines.push(("R parameters", heights("R", [ra, rq, rp, rv, rz, rt])));
            lines.push(("Rsk, Rku", format!("{}, {}", digits(rsk, 4), digits(rku, 4))));
            lines.push(("RSm", width_of_elements(rsm)));
        }
        let note = "\nP: the whole profile about its mean, without a filter (ISO 21920-2). ";
        let more = match self.filters() {
            Some(_) if self.lambda_c.is_some() => {
                "R: after the filters, above the mean line of λc; Rp, Rv and Rz are means over the sections.\n"
            }
            Some(_) => "R: after the filter, about the mean.\n",
            None => "Give --lambda-c (and --lambda-s) for the R parameters of the filtered profile.\n",
        };
        aligned(&lines)
            + note
            + more
            + &self.notes.iter().map(|note| format!("note: {note}\n")).collect::<Vec<_>>().concat()
    }

    /// The filters and what they leave.
    fn filters(&self) -> Option<String> {
        let names = [("λs", self.lambda_s), ("λc", self.lambda_c)];
        let given: Vec<String> =
            names.iter().filter_map(|(name, at)| at.map(|at| format!("{name} {}", engineering(at, "m")))).collect();
        let sections = self.lambda_c.map_or_else(String::new, |lambda| {
            let rest = self.length - lambda - self.evaluation_length;
            let after = format!(" and not on the {} after them", engineering(rest, "m"));
            format!(
                ", {} sections of λc{}",
                self.sections,
                if rest > 3.0 * self.spacing { after } else { String::new() }
            )
        });
        (!given.is_empty()).then(|| {
            format!(
                "Gaussian (ISO 16610-21), {}; evaluated on {}{sections}, without half a cut-off at both ends",
                given.join(", "),
                engineering(self.evaluation_length, "m")
            )
        })
    }
}
