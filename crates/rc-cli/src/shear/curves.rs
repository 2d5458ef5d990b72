//! Load curves of a sweep, and the shear that their contacts allow.

use std::path::Path;

use rc_solver::{Feature, ShearParams};
use rc_theory::partial_slip::{FEWEST_LOADS, LoadCurve, LoadPoint};
use serde_json::Value;

use crate::curves::columns::PRESSURE;
use crate::curves::table::{Row, SweepTable};
use crate::error::CliError;
use crate::scene::features;
use crate::scene::keys::ContactKeys;
use crate::scene::resolve::shear::Coupling;

/// The load curve of one surface.
pub(super) struct SurfaceCurve<'a> {
    pub(super) rows: &'a [Row],
    /// Ratio of tangential to normal compliance.
    pub(super) compliance_ratio: f64,
    /// Poisson's ratio in that ratio.
    pub(super) poisson: f64,
    /// What the ratio neglects.
    pub(super) note: Option<String>,
}

impl<'a> SurfaceCurve<'a> {
    /// The load curves of `table`, which was read from `path`.
    ///
    /// # Errors
    /// [`CliError::Input`] for a sweep over anything but loads, and for contacts that no shear curve is known for.
    pub(super) fn all(path: &Path, table: &'a SweepTable, poisson: Option<f64>) -> Result<Vec<Self>, CliError> {
        if table.against != PRESSURE {
            let message = format_args!("its rows differ in {}, and a load curve in the load", table.against.words);
            return Err(CliError::in_file(path, message));
        }
        table.surfaces().into_iter().map(|rows| Self::of(path, rows, table.settings.as_ref(), poisson)).collect()
    }

    fn of(path: &Path, rows: &'a [Row], settings: Option<&Value>, poisson: Option<f64>) -> Result<Self, CliError> {
        let first = &rows[0];
        let surface = settings.zip(first.place.as_ref()).map(|(settings, place)| &settings["surfaces"][place.surface]);
        let keys = surface.and_then(|surface| keys_of(&surface["contact"]));
        check_contact(path, rows, keys.as_ref())?;
        let is_line = surface.is_some_and(|surface| surface["surface"]["line"] == true);
        let coupling = keys.as_ref().map_or(Coupling { poisson: 0.0, beta: None }, Coupling::of);
        let used = poisson.unwrap_or(coupling.poisson);
        let params = ShearParams { poisson: used, ..ShearParams::new(1.0, 1.0) };
        let compliance_ratio = if is_line { 1.0 } else { params.compliance_ratio() };
        let note = note(&coupling, (used, poisson.is_some()), is_line);
        Ok(Self { rows, compliance_ratio, poisson: used, note })
    }

    /// The load curves up to each load, or up to the largest one alone, with the row of that load.
    ///
    /// # Errors
    /// [`CliError::Input`] if the rows are not a load curve.
    pub(super) fn loads(&self, path: &Path, every_load: bool) -> Result<Vec<(&'a Row, LoadCurve)>, CliError> {
        let point = |row: &Row| LoadPoint {
            load: row.number("mean_pressure").unwrap_or(f64::NAN),
            penetration: row.number("penetration").unwrap_or(f64::NAN),
            stiffness: row.number("contact_stiffness"),
            area: row.number("area_fraction").unwrap_or(f64::NAN),
        };
        let points: Vec<LoadPoint> = self.rows.iter().map(point).collect();
        let surface = self.rows[0].surface();
        let which = if surface.is_empty() { String::new() } else { format!(" ({surface})") };
        let curve = |n: usize| {
            LoadCurve::new(&points[..n])
                .map_err(|cause| CliError::in_file(path, format_args!("not a load curve{which}: {cause}")))
        };
        let n = points.len();
        // The whole curve first, since its errors are those of all.
        let whole = curve(n)?;
        let before = if every_load { FEWEST_LOADS..n } else { n..n };
        let mut curves = before.map(|n| Ok((&self.rows[n - 1], curve(n)?))).collect::<Result<Vec<_>, CliError>>()?;
        curves.push((&self.rows[n - 1], whole));
        Ok(curves)
    }
}

/// The keys of a contact that have a value.
fn keys_of(contact: &Value) -> Option<ContactKeys> {
    let given = contact.as_object()?.iter().filter(|(_, value)| !value.is_null());
    let given: serde_json::Map<_, _> = given.map(|(key, value)| (key.clone(), value.clone())).collect();
    serde_json::from_value(given.into()).ok()
}

/// Refuses rows that did not converge, and contacts whose shear is not a difference of loads.
fn check_contact(path: &Path, rows: &[Row], keys: Option<&ContactKeys>) -> Result<(), CliError> {
    if let Some(row) = rows.iter().find(|row| row.status == "not_converged") {
        let message = format_args!("the row at {} did not converge; solve it again", row.load_in_words());
        return Err(CliError::in_file(path, message));
    }
    let mut found = keys.map(features::of_contact).unwrap_or_default();
    let has = |key: &str| rows.iter().any(|row| row.number(key).is_some_and(|value| value > 0.0));
    let of_columns = [(Feature::Hardness, "hardness"), (Feature::Sliding, "friction")];
    found.extend(of_columns.into_iter().filter_map(|(feature, key)| has(key).then_some(feature)));
    found.push(Feature::Shear);
    features::check_all(&found, None)
}

/// What a shear curve of these bodies neglects; `None` if nothing.
fn note(coupling: &Coupling, (poisson, is_given): (f64, bool), is_line: bool) -> Option<String> {
    if is_line {
        return Some("a profile is sheared along it, in plane strain, as stiff as under pressure".to_owned());
    }
    let ratio = || {
        format!(
            "displacements have Mindlin's ratio of compliances for ν = {poisson}, an approximation where the contact slips"
        )
    };
    let coupled = coupling.beta.filter(|beta| !is_given && beta.abs() > 1e-9);
    let coupled = coupled
        .map(|beta| format!("that unlike bodies couple pressure and traction (Dundurs' β = {beta:.3}) is neglected"));
    match (poisson == 0.0, coupled) {
        (true, _) if coupling.beta.is_none() && !is_given => {
            Some("Poisson's ratio is not known and taken as 0; give --poisson for another".to_owned())
        }
        (true, coupled) => coupled,
        (false, None) => Some(ratio()),
        (false, Some(coupled)) => Some(format!("{}; {coupled}", ratio())),
    }
}
