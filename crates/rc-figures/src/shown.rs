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
const SURFACE: &[Column] =
    &[("quantity", Text("quantity")), ("value", Number("value", 1.0, 5)), ("unit", Text("unit"))];
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
const CONVERGENCE: &[Column] = &[
    ("elements per λ_min", Text("elements_per_wave")),
    ("area by counting", Number("counting_error", 1.0, 2)),
    ("area with edges located", Number("area_error", 1.0, 2)),
    ("rms pressure", Number("rms_pressure_error", 1.0, 2)),
    ("Δ", Number("penetration_error", 1.0, 2)),
];
const MOMENTS: &[Column] = &[
    ("quantity", Text("quantity")),
    ("here", Number("value", 1.0, 3)),
    ("s.d. of one", Number("standard_deviation_of_one", 1.0, 2)),
    ("Gaussian", Number("gaussian", 1.0, 3)),
];
const AREAS: &[Column] = &[
    ("σ0/E*", Number("mean_pressure_over_e_star", 1.0, 3)),
    ("located", Number("area_fraction", 1.0, 5)),
    ("±", Number("area_error", 1.0, 1)),
    ("second set", Number("published_second", 1.0, 5)),
    ("difference", Difference("area_fraction", "published_second")),
    ("counted", Number("area_fraction_by_counting", 1.0, 5)),
    ("first set", Number("published_first", 1.0, 5)),
    ("its s.d.", Number("published_deviation", 1.0, 2)),
    ("difference", Difference("area_fraction_by_counting", "published_first")),
];
const CHALLENGE: &[Column] = &[
    ("side", Text("side")),
    ("σ0 (MPa)", Number("mean_pressure_mpa", 1.0, 3)),
    ("A/A0 (%)", Number("area_fraction", 100.0, 5)),
    ("±", Number("area_error", 100.0, 1)),
    ("counted (%)", Number("area_fraction_by_counting", 100.0, 5)),
    ("mean gap (µm)", Number("mean_gap_um", 1.0, 5)),
    ("±", Number("mean_gap_error_um", 1.0, 1)),
    ("stiffness (MPa/µm)", Number("stiffness_mpa_per_um", 1.0, 4)),
    ("patches", Text("patches")),
    ("s", Number("seconds", 1.0, 3)),
    ("MB", Number("peak_memory_megabytes", 1.0, 4)),
];

/// An archived table in a page: its name, its columns, and the first cells of its rows (none for all rows).
type Block = (&'static str, &'static [Column], &'static [&'static str]);

const BLOCKS: [Block; 14] = [
    ("fig1-summary", SURFACE, &["contact area", "penetration", "greatest displacement", "mean displacement"]),
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
            "area fraction",
            "integral of P",
            "erf(load/2 sqrt(Lambda)) of the fit",
            "fitted Lambda",
            "fitted Lambda over slope^2/8",
            "first bin over peak",
            "slope from 0.01 to 0.1 of the peak stress",
        ],
    ),
    ("statements-cutoff", CUTOFF, &[]),
    ("statements-convergence", CONVERGENCE, &["8", "16", "32"]),
    (
        "statements-moments",
        MOMENTS,
        &["excess kurtosis", "excess kurtosis of all phases", "part beyond 2 rms heights", "part beyond 3 rms heights"],
    ),
    ("gfmd-areas", AREAS, &[]),
    ("challenge-surface", SURFACE, &[]),
    ("challenge-curve", CHALLENGE, &[]),
    ("challenge-large", CHALLENGE, &[]),
];

/// Blocks that leave out some of their columns, because the archived table does not have them.
const LEFT_OUT: [(&str, &[&str]); 4] = [
    ("fig6-summary", &["standard_error"]),
    ("fig7-summary", &["paper"]),
    ("challenge-curve", &["side", "seconds", "peak_memory_megabytes"]),
    ("challenge-large", &["patches"]),
];

/// The text of the block `name`; `None` if it shows no archived table.
///
/// A block `NAME-run` describes the run in `data/runs/NAME/`.
pub(crate) fn block(name: &str, sources: &Sources) -> Option<Result<String, String>> {
    if let Some(run) = name.strip_suffix("-run") {
        return Some(run_line(&format!("data/runs/{run}/run.toml"), sources));
    }
    BLOCKS.iter().find(|block| block.0 == name).map(|block| markdown(block, sources))
}

/// Path of an archived table.
fn path_of(name: &str) -> String {
    let figure = name.split('-').next().unwrap_or(name);
    let run = if ["gfmd", "challenge"].contains(&figure) { figure } else { "paper" };
    format!("data/runs/{run}/{name}.csv")
}

fn markdown(&(name, columns, rows): &Block, sources: &Sources) -> Result<String, String> {
    let path = path_of(name);
    let table = Csv::read(&path, sources)?;
    if let Some(row) = rows.iter().find(|row| !table.rows.iter().any(|of_table| of_table[0] == **row)) {
        return Err(format!("{path} has no row `{row}` for the block {name}; correct crates/rc-figures/src/shown.rs"));
    }
    let left_out = LEFT_OUT.iter().find(|block| block.0 == name).map_or(&[][..], |block| block.1);
    let is_shown = |column: &Column| {
        let (Text(name) | Number(name, ..) | Difference(_, name)) = column.1;
        !left_out.contains(&name)
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
        let areas = "mean_pressure_over_e_star,area_fraction,area_error,area_fraction_by_counting,published_first,\
                     published_deviation,published_second\n1e-2,0.075,1e-4,0.077,0.078,5e-4,0.0744\n0.3,0.97,1e-4,0.98,0.98,1e-4,\n";
        let fig6 = "quantity,unit,waves,value,paper\narea fraction,A0,64,0.07,0.0673\nkappa,1,64,2.0,\n\
                    contact spots,1,64,12,\n";
        let fig7 = fig6.replace("area fraction", "R squared");
        let curve = "mean_pressure_mpa,area_fraction\n0.25,0.04\n";
        let files = [
            ("data/runs/gfmd/run.toml", "version = \"0.1.0\"\nthreads = 2\nseconds = 5.0\n"),
            ("data/runs/gfmd/gfmd-areas.csv", areas),
            ("data/runs/paper/fig6-summary.csv", fig6),
            ("data/runs/paper/fig7-summary.csv", &fig7),
            ("data/runs/challenge/challenge-curve.csv", curve),
        ];
        let sources = files.map(|(path, text)| (path.to_owned(), text.to_owned())).into();
        let text = |name: &str| block(name, &sources).expect("a block").unwrap_or_else(|error| error);
        let difference = "| 0.01 | 0.075 | 0.0001 | 0.0744 | +0.81 % | 0.077 | 0.078 | 0.0005 | \u{2212}1.28 % |";
        assert!(text("gfmd-areas").contains(difference), "{}", text("gfmd-areas"));
        assert!(text("gfmd-areas").contains("| 0.3 | 0.97 | 0.0001 |  |  |"), "{}", text("gfmd-areas"));
        assert!(
            text("fig6-summary").contains("|---|\n| area fraction | 64 | 0.0673 | 0.07 | +4.01 % |\n| contact spots"),
            "{}",
            text("fig6-summary")
        );
        assert!(
            text("fig7-summary")
                .contains("no row `d log10(load) / d(penetration/h_max) of realisations` for the block")
        );
        assert!(text("challenge-curve").contains("no column area_error"));
        assert!(text("gfmd-run").contains("2 threads: 5.0 s"));
        assert!(text("fig5-summary").contains("fig5-summary.csv is missing") && block("nothing", &sources).is_none());
    }

    /// Claims about the archived runs. Snapshots of the reduced set and `--check` allow small changes, these assertions
    /// do not.
    #[test]
    fn the_archived_runs_keep_their_promises() {
        let sources = repository::read_sources(&repository::root()).expect("the repository");
        let number = |name: &str, (first, waves): (&str, &str), column: &str| {
            let path = path_of(name);
            let table = Csv::read(&path, &sources).expect("an archived table");
            let is_it = |row: &&Vec<&str>| row[0] == first && (waves.is_empty() || row[2] == waves);
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
            let difference = of_curve(column) - number(large, ("generated", ""), column);
            assert!(difference.abs() < of_curve(error), "{column} differs by {difference:e}");
        }
    }
}
