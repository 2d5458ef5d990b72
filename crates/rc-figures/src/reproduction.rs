//! docs/reproduction.md, with numbers from the archived run.
//!
//! People write the text around blocks between `<!-- numbers: fig5 -->` and `<!-- end of numbers -->`. This module
//! makes the blocks from `data/runs/paper/` and `data/paper.csv`. `cargo xtask figures --archive` and
//! `cargo xtask reproduction` write them, and `cargo xtask tidy` compares them.

mod rows;

use anyhow::Result;
use rc_core::quantity::digits;
use rows::{FIG5, ROWS, Row};
use toml::Table as Toml;

use crate::blocks;
use crate::repository::Sources;

const DOCUMENT: &str = "docs/reproduction.md";
const RUN: &str = "data/runs/paper/";
const PAPER: &str = "data/paper.csv";

/// Rewrites the numbers of docs/reproduction.md from the archived run.
///
/// # Errors
/// When a number is missing in the archived run, or the document cannot be written.
pub fn update() -> Result<()> {
    blocks::rewrite([DOCUMENT], |_, sources| render(sources))
}

/// Complaints if the numbers of the document differ from the archived run.
#[must_use]
pub fn check(sources: &Sources) -> Vec<String> {
    let cure = format!("{RUN}; run `cargo xtask reproduction`, and review what changed");
    blocks::complaint(DOCUMENT, sources, render(sources), &cure).into_iter().collect()
}

/// The text of the document with its blocks filled in.
fn render(sources: &Sources) -> Result<String, String> {
    blocks::fill(DOCUMENT, sources, |name| if name == "run" { run_block(sources) } else { figure_block(name, sources) })
}

/// Version, times and memory of the run.
fn run_block(sources: &Sources) -> Result<String, String> {
    let path = format!("{RUN}run.toml");
    let text =
        sources.get(&path).ok_or_else(|| format!("{path} is missing; `cargo xtask figures --archive` makes it"))?;
    let run: Toml = text.parse().map_err(|error| format!("{path}: {error}"))?;
    let cell = |key: &str| run.get(key).map_or_else(|| "?".to_owned(), |value| value.to_string().replace('"', ""));
    let head = format!(
        "Version {} on {} threads of a shared machine took {} s, {} s of processor time and at most {} MB.\n\n| figure | seconds |\n|---|---|\n",
        cell("version"),
        cell("threads"),
        cell("seconds"),
        cell("processor_seconds"),
        cell("peak_memory_megabytes")
    );
    let figures = run.get("figures").and_then(|figures| figures.as_table());
    let line = |(name, figure): (&String, &toml::Value)| {
        let seconds = figure.get("seconds").map_or_else(|| "?".to_owned(), ToString::to_string);
        format!("| {name} | {seconds} |\n")
    };
    Ok([head].into_iter().chain(figures.into_iter().flatten().map(line)).collect())
}

/// The table of one figure.
fn figure_block(name: &str, sources: &Sources) -> Result<String, String> {
    let mut block = "| quantity | the paper | here | difference |\n|---|---|---|---|\n".to_owned();
    let mut rows = ROWS.iter().filter(|row| row.figure == name).peekable();
    if rows.peek().is_none() {
        return Err(format!(
            "{DOCUMENT}: no numbers are called `{name}`; add rows in crates/rc-figures/src/reproduction/rows.rs"
        ));
    }
    for row in rows {
        block.push_str(&line(row, sources)?);
    }
    Ok(block)
}

fn line(row: &Row, sources: &Sources) -> Result<String, String> {
    let printed = row.paper.map(|name| published(name, sources)).transpose()?;
    let (value, error) = ours(row, sources)?;
    let show = |value: f64| digits(row.factor * value, row.digits);
    let here = match error {
        Some(error) if row.unit.is_empty() => format!("{} ± {}", show(value), digits(row.factor * error, 2)),
        Some(error) => format!("({} ± {}){}", show(value), digits(row.factor * error, 2), row.unit),
        None => show(value) + row.unit,
    };
    let scatter =
        row.one.map(|first| ours(&Row { table: FIG5, first, column: "value", ..*row }, sources)).transpose()?;
    let difference = printed.map_or_else(String::new, |printed| {
        let percent = format!("{:+.1} %", 100.0 * (value / printed - 1.0)).replace('-', "\u{2212}");
        match scatter {
            Some((scatter, _)) => format!("{percent}, {:.1} s.d.", (value - printed).abs() / scatter),
            None => percent,
        }
    });
    Ok(format!(
        "| {} | {} | {here} | {difference} |\n",
        row.what,
        printed.map_or_else(String::new, |value| show(value) + row.unit)
    ))
}

/// The value of a number that the paper prints.
fn published(name: &str, sources: &Sources) -> Result<f64, String> {
    let text = sources.get(PAPER).ok_or_else(|| format!("{PAPER} is missing; restore it from history"))?;
    let row = text.lines().map(|line| line.split(',').collect::<Vec<_>>()).find(|cells| cells[0] == name);
    let cell = row.and_then(|cells| cells.get(1)?.parse().ok());
    cell.ok_or_else(|| format!("{PAPER} has no number called `{name}`; add the line"))
}

/// The value of a number in the archived run, with its standard error.
///
/// The error is `None` if the table does not have one.
fn ours(row: &Row, sources: &Sources) -> Result<(f64, Option<f64>), String> {
    let path = format!("{RUN}{}.csv", row.table);
    let text =
        sources.get(&path).ok_or_else(|| format!("{path} is missing; `cargo xtask figures --archive` makes it"))?;
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().unwrap_or_default();
    let column = |name: &str| header.iter().position(|cell| *cell == name);
    let has = |cells: &[&str], name: &str, wanted: &str| {
        wanted.is_empty() || column(name).and_then(|column| cells.get(column)) == Some(&wanted)
    };
    let found = lines.find(|cells| {
        cells.first() == Some(&row.first) && has(cells, "waves", row.waves) && has(cells, "unit", row.in_unit)
    });
    let number = |name: &str| found.as_ref().and_then(|cells| cells.get(column(name)?)?.parse::<f64>().ok());
    let value = number(row.column).ok_or_else(|| {
        format!(
            "{path} has no `{}` in column `{}`; correct crates/rc-figures/src/reproduction/rows.rs",
            row.first, row.column
        )
    })?;
    Ok((value, number("standard_error")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blocks::{BEGIN, END};
    use crate::repository;

    fn sources(document: &str) -> Sources {
        let files = [
            (DOCUMENT, document),
            (PAPER, "name,value\narea_fraction_a,0.0673\narea_fraction_b,0.0588\n"),
            (
                "data/runs/paper/fig5-summary.csv",
                "quantity,unit,waves,value\nscatter of the area fraction,A0,64,0.0027\n\
                 scatter of the area fraction,A0,128,0.0024\n",
            ),
            (
                "data/runs/paper/fig6-summary.csv",
                "quantity,unit,waves,value\narea fraction,A0,64,0.07\narea fraction,A0,128,0.0588\n\
                 contact spots,1,64,500\ncontact spots,1,128,900\n",
            ),
        ];
        files.map(|(path, text)| (path.to_owned(), text.to_owned())).into()
    }

    #[test]
    fn numbers_come_from_the_tables() {
        let document = format!("before\n{BEGIN}fig6 -->stale{END}\nafter\n");
        let text = render(&sources(&document)).expect("both tables are there");
        assert!(text.starts_with("before\n") && text.ends_with("after\n") && !text.contains("stale"), "{text}");
        assert!(text.contains("| 0.0673 | 0.07 | +4.0 %, 1.0 s.d. |"), "{text}");
        assert_eq!(render(&sources(&text)).expect("its own output"), text);
        assert_eq!((check(&sources(&text)).len(), check(&sources(&document)).len()), (0, 1));
    }

    /// Claims about the archived run. Snapshots of the reduced set and `--check` allow small changes, these assertions
    /// do not.
    #[test]
    fn the_archived_run_keeps_its_promises() {
        let sources = repository::read_sources(&repository::root()).expect("the repository");
        let number = |what: &str| {
            let row = ROWS.iter().find(|row| row.what == what).unwrap_or_else(|| panic!("no row {what}"));
            ours(row, &sources).unwrap_or_else(|error| panic!("{what}: {error}"))
        };
        for waves in ["64", "128"] {
            let of = |what: &str| number(&format!("{what}, N = {waves}")).0;
            assert!(of("R² of the fitted line (the paper: above 0.9999)") > 0.9999, "N = {waves}");
            assert!(of("ratio of the first bin (width 2e-4 E*) to the peak of P") < 0.05, "N = {waves}");
            let slope = of("d log P/d log σ, 0.01 to 0.1 of the peak stress");
            assert!((slope - 1.0).abs() < 0.1, "N = {waves}: {slope}");
            let of_fit =
                ROWS.iter().find(|row| row.figure == "fig8" && row.what.starts_with("erf") && row.waves == waves);
            let area =
                ROWS.iter().find(|row| row.figure == "fig8" && row.what.starts_with("A/A0") && row.waves == waves);
            let [of_fit, area] = [of_fit, area].map(|row| ours(row.expect("a row"), &sources).expect("a number").0);
            assert!((of_fit / area - 1.0).abs() < 0.02, "N = {waves}: {of_fit} and {area}");
        }
        // The two areas of the paper are those of single maps.
        for (waves, printed) in [("64", 0.0673), ("128", 0.0588)] {
            let (mean, _) = number(&format!("A/A0 at σ0/E* = 8.9e-4, mean of 28 realisations, N = {waves}"));
            let (scatter, _) = number(&format!("standard deviation of A/A0 of one realisation, N = {waves}"));
            assert!((mean - printed).abs() < 2.0 * scatter, "N = {waves}: {mean}, one {scatter}");
        }
        let run: Toml = sources["data/runs/paper/run.toml"].parse().expect("run.toml");
        let limit = |key: &str| run[key].as_float().or_else(|| run[key].as_integer().map(|n| n as f64));
        assert!(limit("seconds").is_some_and(|seconds| seconds < 600.0));
        assert!(limit("peak_memory_megabytes").is_some_and(|megabytes| megabytes < 2000.0));
    }

    #[test]
    fn what_is_missing_is_named() {
        let unknown = check(&sources(&format!("{BEGIN}fig9 -->{END}")));
        assert!(unknown[0].contains("`fig9`"), "{unknown:?}");
        let open = check(&sources(&format!("{BEGIN}fig6 -->")));
        assert!(open[0].contains(END), "{open:?}");
        let run = check(&sources(&format!("{BEGIN}run -->{END}")));
        assert!(run[0].contains("run.toml"), "{run:?}");
    }
}
