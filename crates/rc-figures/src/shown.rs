//! Tables of archived runs as Markdown, by the name of their block in a page.

use rc_core::quantity::digits;
use toml::Table as Toml;

use crate::repository::Sources;

/// What a column of a page shows of an archived table.
#[derive(Clone, Copy, Debug)]
enum Shown {
    /// The text of this column.
    Text(&'static str),
    /// The number in this column times a factor, with so many significant digits.
    Number(&'static str, f64, usize),
    /// The number in the first column over that in the second, minus 1.
    Difference(&'static str, &'static str),
}

use Shown::{Difference, Number, Text};

/// The title of a column and what it shows.
type Column = (&'static str, Shown);

const SUMMARY: &[Column] = &[
    ("quantity", Text("quantity")),
    ("N", Text("waves")),
    ("the paper", Number("paper", 1.0, 4)),
    ("here", Number("value", 1.0, 5)),
    ("±", Number("standard_error", 1.0, 2)),
    ("difference", Difference("value", "paper")),
];
const FIG3: &[Column] = &[
    ("quantity", Text("quantity")),
    ("unit", Text("unit")),
    ("the paper", Number("printed", 1.0, 4)),
    ("here", Number("at_printed_fraction", 1.0, 4)),
    ("difference", Difference("at_printed_fraction", "printed")),
];
const FIG4: &[Column] = &[
    ("quantity", Text("quantity")),
    ("unit", Text("unit")),
    ("here", Number("numeric", 1.0, 5)),
    ("Hertz in the cell", Number("periodic_hertz", 1.0, 5)),
    ("relative difference", Number("relative_difference", 1.0, 2)),
];
const CUTOFF: &[Column] = &[
    ("N", Text("waves")),
    ("area over that of N = 8", Number("area_over_first", 1.0, 4)),
    ("κ", Number("kappa", 1.0, 4)),
    ("energy over that of N = 8", Number("energy_over_first", 1.0, 4)),
    ("Δ/h_max", Number("penetration_over_h_max", 1.0, 4)),
];
/// An archived table in a page: its name, its columns, and the first cells of its rows (none for all rows).
type Block = (&'static str, &'static [Column], &'static [&'static str]);

const BLOCKS: [Block; 7] = [
    (
        "fig3-summary",
        FIG3,
        &[
            "contact fraction",
            "penetration",
            "elements uniform",
            "elements adaptive uniform",
            "elements adaptive",
            "elements adaptive with two rings",
        ],
    ),
    ("fig4-summary", FIG4, &["contact radius", "load", "peak pressure"]),
    (
        "fig5-summary",
        SUMMARY,
        &[
            "area fraction",
            "area fraction by counting",
            "area fraction of all realisations",
            "scatter of the area fraction",
            "kappa of the line",
            "R squared",
            "ratio of areas",
            "scatter of the ratio of areas",
            "greatest relative difference of areas by the paper's procedure",
        ],
    ),
    ("fig6-summary", SUMMARY, &["area fraction", "contact spots"]),
    (
        "fig7-summary",
        SUMMARY,
        &[
            "d log10(load) / d(penetration/h_max) of realisations",
            "R squared of averages",
            "u0",
            "gamma that u0 stands for",
            "greatest difference of penetration/h_max between surfaces",
        ],
    ),
    (
        "fig8-summary",
        SUMMARY,
        &[
            "integral of P",
            "erf(load/2 sqrt(Lambda)) of the fit",
            "fitted Lambda",
            "fitted Lambda over slope^2/8",
            "first bin over peak",
            "slope from 0.01 to 0.1 of the peak stress",
        ],
    ),
    ("statements-cutoff", CUTOFF, &[]),
];

/// The text of the block `name`. A block `NAME-run` describes the run in `data/runs/NAME/`.
pub(crate) fn block(name: &str, sources: &Sources) -> Result<String, String> {
    if let Some(run) = name.strip_suffix("-run") {
        return run_line(&format!("data/runs/{run}/run.toml"), sources);
    }
    let known = BLOCKS.iter().find(|block| block.0 == name);
    markdown(
        known
            .ok_or_else(|| format!("no numbers are called `{name}`; add a table in crates/rc-figures/src/shown.rs"))?,
        sources,
    )
}

/// Path of an archived table.
fn path_of(name: &str) -> String {
    let run = if name.starts_with("challenge") { "challenge" } else { "paper" };
    format!("data/runs/{run}/{name}.csv")
}

fn markdown(&(name, columns, rows): &Block, sources: &Sources) -> Result<String, String> {
    let path = path_of(name);
    let table = Csv::read(&path, sources)?;
    if let Some(row) = rows.iter().find(|row| !table.rows.iter().any(|of_table| of_table[0] == **row)) {
        return Err(format!("{path} has no row `{row}` for the block {name}; correct crates/rc-figures/src/shown.rs"));
    }
    // Not every archived table has all columns.
    let is_shown = |column: &Column| {
        let (Text(name) | Number(name, ..) | Difference(_, name)) = column.1;
        table.header.contains(&name)
    };
    let columns: Vec<Column> = columns.iter().copied().filter(is_shown).collect();
    let titles: Vec<&str> = columns.iter().map(|column| column.0).collect();
    let mut text = format!("| {} |\n|{}\n", titles.join(" | "), "---|".repeat(titles.len()));
    for row in table.rows.iter().filter(|row| rows.is_empty() || rows.contains(&row[0])) {
        let cells = columns.iter().map(|column| table.cell(row, column.1)).collect::<Result<Vec<_>, _>>()?;
        text.extend(["| ", &cells.join(" | "), " |\n"]);
    }
    Ok(text)
}

/// An archived table.
struct Csv<'a> {
    path: &'a str,
    header: Vec<&'a str>,
    rows: Vec<Vec<&'a str>>,
}

impl<'a> Csv<'a> {
    fn read(path: &'a str, sources: &'a Sources) -> Result<Self, String> {
        let text = sources.get(path).ok_or_else(|| format!("{path} is missing; `--archive` makes it"))?;
        let mut rows = text.lines().map(|line| line.split(',').collect());
        Ok(Self { path, header: rows.next().unwrap_or_default(), rows: rows.collect() })
    }

    fn text<'r>(&self, row: &[&'r str], name: &str) -> Result<&'r str, String> {
        let at = self.header.iter().position(|cell| *cell == name);
        let cell = at.and_then(|at| row.get(at)).copied();
        cell.ok_or_else(|| format!("{} has no column {name}; correct crates/rc-figures/src/shown.rs", self.path))
    }

    /// The number in a column; `None` where the cell is empty.
    fn number(&self, row: &[&str], name: &str) -> Result<Option<f64>, String> {
        let text = self.text(row, name)?;
        let number = (!text.is_empty()).then(|| text.parse()).transpose();
        number.map_err(|_| format!("{}: `{text}` in column {name} is no number", self.path))
    }

    fn cell(&self, row: &[&str], shown: Shown) -> Result<String, String> {
        let text = match shown {
            Text(name) => Some(self.text(row, name)?.to_owned()),
            Number(name, factor, n) => self.number(row, name)?.map(|value| digits(factor * value, n)),
            Difference(a, b) => {
                let ratio = self.number(row, a)?.zip(self.number(row, b)?).map(|(a, b)| a / b);
                ratio.map(|ratio| format!("{:+.2} %", 100.0 * (ratio - 1.0)).replace('-', "\u{2212}"))
            }
        };
        Ok(text.unwrap_or_default())
    }
}

/// Version, threads, time and memory of a run.
fn run_line(path: &str, sources: &Sources) -> Result<String, String> {
    let text = sources.get(path).ok_or_else(|| format!("{path} is missing; `--archive` makes it"))?;
    let run: Toml = text.parse().map_err(|error| format!("{path}: {error}"))?;
    let cell = |key: &str| run.get(key).map_or_else(|| "?".to_owned(), |value| value.to_string().replace('"', ""));
    Ok(format!(
        "Version {}, {} threads: {} s on a shared machine, {} s of processor time, {} MB at most.\n",
        cell("version"),
        cell("threads"),
        cell("seconds"),
        cell("processor_seconds"),
        cell("peak_memory_megabytes")
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{paper, repository};

    #[test]
    fn numbers_come_from_the_archived_tables() {
        let fig6 = "quantity,unit,waves,value,paper\narea fraction,A0,64,0.07,0.0673\nkappa,1,64,2.0,\n\
                    contact spots,1,64,12,\n";
        let fig7 = fig6.replace("area fraction", "R squared");
        let files = [
            ("data/runs/gfmd/run.toml", "version = \"0.1.0\"\nthreads = 2\nseconds = 5.0\n"),
            ("data/runs/paper/fig6-summary.csv", fig6),
            ("data/runs/paper/fig7-summary.csv", &fig7),
        ];
        let sources = files.map(|(path, text)| (path.to_owned(), text.to_owned())).into();
        let text = |name: &str| block(name, &sources).unwrap_or_else(|error| error);
        assert!(
            text("fig6-summary").contains("|---|\n| area fraction | 64 | 0.0673 | 0.07 | +4.01 % |\n| contact spots"),
            "{}",
            text("fig6-summary")
        );
        assert!(
            text("fig7-summary")
                .contains("no row `d log10(load) / d(penetration/h_max) of realisations` for the block")
        );
        assert!(text("gfmd-run").contains("2 threads: 5.0 s"));
        assert!(text("fig5-summary").contains("fig5-summary.csv is missing"));
        assert!(text("nothing").contains("no numbers are called `nothing`"));
    }

    /// Claims about the archived runs. Snapshots of the reduced set and `--check` allow small changes, these assertions
    /// do not.
    #[test]
    fn the_archived_runs_keep_their_promises() {
        let sources = repository::read_sources(&repository::root()).expect("the repository");
        let number = |name: &str, (first, waves): (&str, &str), column: &str| {
            let path = path_of(name);
            let table = Csv::read(&path, &sources).expect("an archived table");
            let is_it = |row: &&Vec<&str>| row[0] == first && (waves.is_empty() || row[1..3].contains(&waves));
            let row = table.rows.iter().find(is_it).unwrap_or_else(|| panic!("no row {first}"));
            table.number(row, column).expect("a column").expect("a number")
        };
        let (fig5, fig8) = ("fig5-summary", "fig8-summary");
        for (waves, name) in [("64", "area_fraction_a"), ("128", "area_fraction_b")] {
            let of = |path: &str, first: &str| number(path, (first, waves), "value");
            assert!(of(fig5, "R squared") > 0.9999, "N = {waves}");
            assert!(of(fig8, "first bin over peak") < 0.05, "N = {waves}");
            let slope = of(fig8, "slope from 0.01 to 0.1 of the peak stress");
            assert!((slope - 1.0).abs() < 0.1, "N = {waves}: {slope}");
            let of_fit = of(fig8, "erf(load/2 sqrt(Lambda)) of the fit") / of(fig8, "area fraction");
            assert!((of_fit - 1.0).abs() < 0.02, "N = {waves}: {of_fit}");
            // The two areas of the paper are those of single maps.
            let (mean, scatter) =
                (of(fig5, "area fraction of all realisations"), of(fig5, "scatter of the area fraction"));
            let printed = number(fig5, ("area fraction", waves), "paper");
            assert!((mean - printed).abs() < scatter, "N = {waves}: {mean} and {printed}, one {scatter}");
            assert!(paper::value(name).is_ok_and(|value| (value - printed).abs() < 1e-12), "{name}: {printed}");
        }
        let run: Toml = sources["data/runs/paper/run.toml"].parse().expect("run.toml");
        let limit = |key: &str| run[key].as_float().or_else(|| run[key].as_integer().map(|n| n as f64));
        assert!(limit("seconds").is_some_and(|seconds| seconds < 600.0));
        assert!(limit("peak_memory_megabytes").is_some_and(|megabytes| megabytes < 2000.0));
        // The error bars of the Challenge's curve contain the result on the reference's grid.
        let (curve, large) = ("challenge-curve", "challenge-large");
        for (column, error) in [("area_fraction", "area_error"), ("mean_gap_um", "mean_gap_error_um")] {
            let of_curve = |column| number(curve, ("2.500000e-1", ""), column);
            let of_large = |side, column| number(large, ("generated", side), column);
            let difference = of_curve(column) - of_large("65536", column);
            assert!(difference.abs() < of_curve(error), "{column} differs by {difference:e}");
            let difference = of_large("65536", column) - of_large("131072", column);
            assert!(difference.abs() < of_large("65536", error), "{column} differs by {difference:e}");
        }
    }
}
