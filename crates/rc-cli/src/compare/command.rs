//! Runs `rc compare`.

use std::path::Path;

use rc_core::quantity::engineering;
use rc_plot::save_png;
use rc_sweep::files::{self, Staged};
use rc_sweep::to_json;
use serde::Serialize;

use super::args::CompareArgs;
use super::fields::{Difference, Differences, Numbers};
use super::numbers::{self, Compared};
use super::scenes::{self, OtherKey};
use crate::curves::folder::Rows;
use crate::curves::text::aligned;
use crate::error::CliError;
use crate::files::names::{COMPARISON_FILE, DIFFERENCE_FILE};
use crate::files::result::ResultFolder;
use crate::terminal;

/// Heads of the table.
const HEADS: [&str; 6] = ["", "A", "B", "B - A", "of A", "in bars"];

/// The comparison of two results.
#[derive(Clone, Debug, Serialize)]
struct Comparison {
    /// The folders.
    a: String,
    b: String,
    /// Keys of the scenes that differ.
    scenes: Vec<OtherKey>,
    numbers: Vec<Compared>,
    /// Difference of the pressures (Pa), or null.
    pressure: Option<Numbers>,
    /// Difference of the gaps (m), or null.
    gap: Option<Numbers>,
    /// Why there is no difference of the fields, or null.
    no_picture: Option<String>,
}

/// Runs `rc compare`.
///
/// # Errors
/// [`CliError`].
pub(crate) fn run(args: &CompareArgs) -> Result<(), CliError> {
    let [a, b] = [result(&args.a)?, result(&args.b)?];
    let differences = Differences::of(&a, &b);
    let numbers = |of: fn(&Differences) -> &Difference| differences.as_ref().ok().map(|all| of(all).numbers());
    let comparison = Comparison {
        a: args.a.display().to_string(),
        b: args.b.display().to_string(),
        scenes: scenes::differences(&args.a, &args.b)?,
        numbers: numbers::all(&a.summary, &b.summary),
        pressure: numbers(|all| &all.pressure),
        gap: numbers(|all| &all.gap),
        no_picture: differences.as_ref().err().cloned(),
    };
    if let Some(out) = &args.out {
        write(out, &comparison, differences.ok().as_ref())?;
    }
    match (args.quiet, args.json) {
        (true, _) => Ok(()),
        (false, true) => terminal::print(&to_json(&comparison)),
        (false, false) => terminal::print(&(comparison.text() + &crate::text::written(args.out.as_deref()))),
    }
}

/// The result in `folder`.
fn result(folder: &Path) -> Result<ResultFolder, CliError> {
    if Rows::of(folder)?.is_some() {
        let message =
            "has several results; rc compare takes two folders of one each, such as rows/0001 of a sweep with --fields";
        return Err(CliError::in_file(folder, message));
    }
    ResultFolder::read_finite(folder)
}

fn write(out: &Path, comparison: &Comparison, picture: Option<&Differences>) -> Result<(), CliError> {
    files::check_folder(out)?;
    let mut staged = Staged::new(out)?;
    staged.add_text(COMPARISON_FILE, &to_json(comparison))?;
    if let Some(picture) = picture {
        staged.add(DIFFERENCE_FILE, |path| save_png(picture, path))?;
    }
    Ok(staged.commit()?)
}

impl Comparison {
    fn text(&self) -> String {
        let head = format!("A: {}\nB: {}\n", self.a, self.b);
        let scenes = scenes::line(&self.scenes).unwrap_or_else(|| "the scenes are equal".to_owned());
        let heads = vec![HEADS.map(str::to_owned).to_vec()];
        let lines: Vec<Vec<String>> = heads.into_iter().chain(self.numbers.iter().map(Compared::line)).collect();
        format!("{head}{scenes}\n\n{}\n{}\n", aligned(&lines), self.fields())
    }

    /// A line about the difference of the fields.
    fn fields(&self) -> String {
        let of = |numbers: &Numbers, unit| {
            format!("rms {}, at most {}", engineering(numbers.rms, unit), engineering(numbers.max, unit))
        };
        match (&self.pressure, &self.gap, &self.no_picture) {
            (Some(pressure), Some(gap), _) => {
                format!("difference of the pressure: {}; of the gap: {}", of(pressure, "Pa"), of(gap, "m"))
            }
            (_, _, reason) => format!("no difference of the fields: {}", reason.as_deref().unwrap_or("unknown")),
        }
    }
}
