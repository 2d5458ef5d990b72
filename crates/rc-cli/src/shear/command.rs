//! The command, with what it prints.

use std::path::Path;

use rc_sweep::to_json;
use rc_theory::partial_slip::Friction;

use super::args::ShearArgs;
use super::curve::ShearCurve;
use super::curves::SurfaceCurve;
use super::means;
use super::record::ShearRecord;
use crate::curves::table::SweepTable;
use crate::error::CliError;
use crate::files::kind::Kind;
use crate::report::quoted;
use crate::scene::resolve::shear::check_friction;
use crate::{terminal, text};

/// Runs `rc shear`.
///
/// # Errors
/// [`CliError`].
pub(crate) fn run(args: &ShearArgs) -> Result<(), CliError> {
    let ShearArgs { friction, poisson, .. } = *args;
    check_friction(friction)?;
    if let Some(poisson) = poisson.filter(|poisson| !(*poisson > -1.0 && *poisson <= 0.5)) {
        return Err(CliError::input(format_args!("poisson: must be above -1 and at most 0.5, not {poisson}")));
    }
    Kind::Shear.check_out(&args.out)?;
    let record = record(args)?;
    record.write(&args.out)?;
    if !args.quiet {
        for note in &record.notes {
            terminal::tell(&format!("note: {note}"));
        }
    }
    match (args.json, args.quiet) {
        (true, _) => terminal::print(&to_json(&record)),
        (false, true) => Ok(()),
        (false, false) => terminal::print(&(record.text() + &text::written(Some(&args.out)))),
    }
}

fn record(args: &ShearArgs) -> Result<ShearRecord, CliError> {
    let path = &args.curve;
    let table = SweepTable::read(path)?;
    let mut record =
        ShearRecord { command: command(args), friction: args.friction, notes: vec![], curves: vec![], means: vec![] };
    for surface in SurfaceCurve::all(path, &table, args.poisson)? {
        let friction = Friction { coefficient: args.friction, compliance_ratio: surface.compliance_ratio };
        for (row, curve) in surface.loads(path, args.every_load)? {
            record.curves.push(ShearCurve::new((&row.label, row.seed), surface.poisson, (&curve, friction)));
        }
        record.notes.extend(surface.note.filter(|note| !record.notes.contains(note)));
    }
    record.means = means::of(&record.curves);
    Ok(record)
}

/// The command line of `args`.
fn command(args: &ShearArgs) -> String {
    let word = |path: &Path| quoted(&path.display().to_string());
    let poisson = args.poisson.map_or_else(String::new, |poisson| format!(" --poisson {poisson}"));
    let every = if args.every_load { " --every-load" } else { "" };
    format!("rc shear {} --friction {}{poisson}{every} --out {}", word(&args.curve), args.friction, word(&args.out))
}
