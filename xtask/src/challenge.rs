//! `cargo xtask challenge`: the surface of the Contact-Mechanics Challenge, without adhesion.

use std::path::PathBuf;

use anyhow::{Context, Result};
use rc_figures::challenge::{Large, Params, Source};
use rc_figures::{Challenge, repository, run_one};

use crate::figures;

/// Computes area, gap, stiffness and patches of the Contact-Mechanics Challenge's surface.
///
/// The problem is without adhesion; docs/benchmarks.md explains the results.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    figure: figures::Args,
    /// File of the distributed Fourier coefficients, as text, instead of a generated surface.
    ///
    /// The surface is scaled to an rms slope of 1.
    #[arg(long, value_name = "FILE")]
    spectrum: Option<PathBuf>,
    /// Changes the sign of the distributed heights. The points that touch first must be high.
    #[arg(long, requires = "spectrum")]
    flip: bool,
    /// Solves one load on this many elements per side instead of the curve.
    ///
    /// 65536, as in the published reference, takes minutes and 6 GB. The archive keeps the lines of other numbers.
    #[arg(long, value_name = "SIDE", num_args = 0..=1, default_missing_value = "65536", conflicts_with = "quick")]
    large: Option<usize>,
    /// Archives this run: tables in `data/runs/challenge/`, and the picture in `docs/images/`.
    #[arg(long, conflicts_with_all = ["quick", "spectrum"])]
    archive: bool,
}

#[expect(clippy::print_stdout, reason = "the result of the command")]
pub(crate) fn run(args: &Args) -> Result<()> {
    let (preset, out) = (args.figure.preset(), &args.figure.out);
    let source = args.spectrum.clone().map(|path| Source::File { path, is_flipped: args.flip });
    let params = Params::with_source(preset, source)?;
    let Some(side) = args.large else {
        run_one::<Challenge>(preset, &params, out, args.archive)?;
        return Ok(());
    };
    let table = Large::compute(&params, side)?.table();
    println!("{}", table.aligned());
    let out = if args.archive { &repository::root().join("data/runs/challenge") } else { out };
    std::fs::create_dir_all(out).with_context(|| format!("could not make {}", out.display()))?;
    let path = out.join("challenge-large.csv");
    let before = args.archive && path.exists();
    let before = if before {
        std::fs::read_to_string(&path).with_context(|| path.display().to_string())?
    } else {
        String::new()
    };
    std::fs::write(&path, with_lines_of(&before, &table.csv))
        .with_context(|| format!("could not write {}", path.display()))
}

/// A table with the lines for other surfaces and sides of a table `before`, if it has the same columns.
fn with_lines_of(before: &str, table: &str) -> String {
    let what = |line: &str| line.splitn(3, ',').take(2).map(str::to_owned).collect::<Vec<_>>();
    let (Some(header), new): (_, Vec<_>) = (table.lines().next(), table.lines().skip(1).map(what).collect()) else {
        return table.to_owned();
    };
    let before = before.lines().next().filter(|columns| *columns == header).map_or("", |_| before);
    let kept = before.lines().skip(1).filter(|line| !new.contains(&what(line)));
    let mut lines: Vec<&str> = kept.chain(table.lines().skip(1)).collect();
    lines.sort_by_key(|line| what(line).get(1).and_then(|side| side.parse::<usize>().ok()));
    lines.insert(0, header);
    lines.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_archive_keeps_the_lines_of_other_sides() {
        let of = |lines: &str| with_lines_of("surface,side,area\ng,64,1\ng,128,2\n", lines);
        assert_eq!(of("surface,side,area\ng,64,3\n"), "surface,side,area\ng,64,3\ng,128,2\n");
        assert_eq!(of("surface,side,area\ng,32,3\n"), "surface,side,area\ng,32,3\ng,64,1\ng,128,2\n");
        assert_eq!(of("surface,side,error\ng,64,3\n"), "surface,side,error\ng,64,3\n");
    }
}
