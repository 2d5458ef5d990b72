//! docs/gfmd.md and docs/challenge.md, with numbers from the archived runs.
//!
//! People write the text around the blocks of [`crate::blocks`]. `cargo xtask gfmd --archive` and
//! `cargo xtask challenge --archive` write the blocks, and `cargo xtask tidy` compares them.

use anyhow::Result;
use rc_core::quantity::digits;
use toml::Table as Toml;

use crate::blocks;
use crate::repository::Sources;

/// Path of a document, and the command that archives its run.
const DOCUMENTS: [(&str, &str); 2] = [("docs/gfmd.md", "gfmd"), ("docs/challenge.md", "challenge")];

/// Rewrites the numbers of the documents from the archived runs.
///
/// # Errors
/// When a number is missing in an archived run, or a document cannot be written.
pub(crate) fn update() -> Result<()> {
    blocks::rewrite(DOCUMENTS.map(|(document, _)| document), render)
}

/// Complaints about documents whose numbers differ from their archived run.
#[must_use]
pub fn check(sources: &Sources) -> Vec<String> {
    let complaint = |(document, command): (&str, &str)| {
        let cure = format!("data/runs/{command}/; run `cargo xtask {command} --archive`, and review what changed");
        blocks::complaint(document, sources, render(document, sources), &cure)
    };
    DOCUMENTS.into_iter().filter_map(complaint).collect()
}

fn render(document: &str, sources: &Sources) -> Result<String, String> {
    blocks::fill(document, sources, |name| {
        let (command, what) = name.split_once('-').unwrap_or((name, ""));
        let archived = if what == "large" { "large.csv" } else { "run.toml" };
        if !sources.contains_key(&format!("data/runs/{command}/{archived}")) {
            let flag = if what == "large" { " --large" } else { "" };
            return Ok(format!("No run is archived yet: `cargo xtask {command}{flag} --archive` makes one.\n"));
        }
        match what {
            "run" => run_line(command, sources),
            "picture" => Ok(format!("![What was computed](images/{command}.png)\n")),
            "areas" => areas(sources),
            _ => {
                let shown = SHOWN.iter().find(|shown| shown.block == name);
                let shown = shown.ok_or_else(|| format!("{document}: no numbers are called `{name}`"))?;
                Csv::read(shown.path, sources)?.markdown(shown.columns)
            }
        }
    })
}

/// A column of a table in a document: archived name, title, factor, and digits.
///
/// Zero digits leave the text as it is.
type Column = (&'static str, &'static str, f64, usize);

/// A table of a document that repeats an archived table with other titles.
struct Shown {
    block: &'static str,
    path: &'static str,
    columns: &'static [Column],
}

const SHOWN: [Shown; 5] = [
    Shown {
        block: "gfmd-surface",
        path: "data/runs/gfmd/gfmd-surface.csv",
        columns: &[("quantity", "quantity", 1.0, 0), ("value", "value", 1.0, 5), ("unit", "unit", 1.0, 0)],
    },
    Shown {
        block: "gfmd-curve",
        path: "data/runs/gfmd/gfmd-curve.csv",
        columns: &[
            ("mean_pressure_over_e_star", "σ0/E*", 1.0, 3),
            ("kappa", "κ", 1.0, 4),
            ("mean_gap_over_rms_height", "ū/h_rms", 1.0, 4),
            ("mean_gap_error", "±", 1.0, 1),
            ("energy_over_full_contact", "U/U_full", 1.0, 4),
        ],
    },
    Shown {
        block: "challenge-surface",
        path: "data/runs/challenge/challenge-surface.csv",
        columns: &[("quantity", "quantity", 1.0, 0), ("value", "value", 1.0, 5), ("unit", "unit", 1.0, 0)],
    },
    Shown {
        block: "challenge-curve",
        path: "data/runs/challenge/challenge-curve.csv",
        columns: &[
            ("mean_pressure_mpa", "σ0 (MPa)", 1.0, 3),
            ("area_fraction", "A/A0 (%)", 100.0, 4),
            ("area_error", "±", 100.0, 1),
            ("area_fraction_by_counting", "counted (%)", 100.0, 4),
            ("mean_gap_um", "mean gap (µm)", 1.0, 4),
            ("mean_gap_error_um", "±", 1.0, 1),
            ("stiffness_mpa_per_um", "stiffness (MPa/µm)", 1.0, 4),
            ("patches", "patches", 1.0, 6),
            ("largest_patch_fraction", "largest patch (% of A)", 100.0, 3),
            ("elements_in_contact", "elements in contact", 1.0, 3),
        ],
    },
    Shown {
        block: "challenge-large",
        path: "data/runs/challenge/large.csv",
        columns: &[
            ("side", "grid side", 1.0, 6),
            ("mean_pressure_mpa", "σ0 (MPa)", 1.0, 3),
            ("area_fraction", "A/A0 (%)", 100.0, 5),
            ("area_error", "±", 100.0, 1),
            ("area_fraction_by_counting", "counted (%)", 100.0, 5),
            ("mean_gap_um", "mean gap (µm)", 1.0, 5),
            ("mean_gap_error_um", "±", 1.0, 1),
            ("stiffness_mpa_per_um", "stiffness (MPa/µm)", 1.0, 4),
            ("elements_in_contact", "elements in contact", 1.0, 4),
            ("seconds", "s", 1.0, 3),
            ("peak_memory_megabytes", "memory (MB)", 1.0, 6),
        ],
    },
];

/// An archived table.
struct Csv<'a> {
    path: &'a str,
    rows: Vec<Vec<&'a str>>,
}

impl<'a> Csv<'a> {
    fn read(path: &'a str, sources: &'a Sources) -> Result<Self, String> {
        let text = sources.get(path).ok_or_else(|| format!("{path} is missing; `--archive` makes it"))?;
        Ok(Self { path, rows: text.lines().map(|line| line.split(',').collect()).collect() })
    }

    fn column(&self, name: &str) -> Result<usize, String> {
        let at = self.rows.first().and_then(|header| header.iter().position(|cell| *cell == name));
        at.ok_or_else(|| format!("{} has no column {name}", self.path))
    }

    fn markdown(&self, columns: &[Column]) -> Result<String, String> {
        let indices = columns.iter().map(|(name, ..)| self.column(name)).collect::<Result<Vec<_>, _>>()?;
        let cell = |row: &[&str], at: usize, factor: f64, n: usize| match row
            .get(at)
            .map(|cell| (cell, cell.parse::<f64>()))
        {
            Some((_, Ok(value))) if n > 0 => digits(factor * value, n),
            Some((cell, _)) => (*cell).to_owned(),
            None => String::new(),
        };
        let titles: Vec<&str> = columns.iter().map(|(_, title, ..)| *title).collect();
        let head = format!("| {} |\n|{}\n", titles.join(" | "), "---|".repeat(titles.len()));
        let line = |row: &Vec<&str>| {
            let cells = columns.iter().zip(&indices).map(|((_, _, factor, n), at)| cell(row, *at, *factor, *n));
            ["| ", &cells.collect::<Vec<_>>().join(" | "), " |\n"].concat()
        };
        Ok(head + &self.rows.iter().skip(1).map(line).collect::<String>())
    }
}

/// Table of our areas beside the published ones.
fn areas(sources: &Sources) -> Result<String, String> {
    let csv = Csv::read("data/runs/gfmd/gfmd-areas.csv", sources)?;
    let names = [
        "mean_pressure_over_e_star",
        "area_fraction",
        "area_error",
        "published_second",
        "area_fraction_by_counting",
        "published_first",
        "published_deviation",
        "theory",
    ];
    let columns = names.iter().map(|name| csv.column(name)).collect::<Result<Vec<_>, _>>()?;
    let mut text =
        "| σ0/E* | located | ± | second set | difference | counted | first set | its s.d. | difference | Persson |\n\
                    |---|---|---|---|---|---|---|---|---|---|\n"
            .to_owned();
    for row in csv.rows.iter().skip(1) {
        let number = |i: usize| row.get(columns[i]).and_then(|cell| cell.parse::<f64>().ok());
        let show = |i: usize, n: usize| number(i).map_or_else(String::new, |value| digits(value, n));
        let difference = |a: usize, b: usize| match (number(a), number(b)) {
            (Some(a), Some(b)) => format!("{:+.2} %", 100.0 * (a / b - 1.0)).replace('-', "\u{2212}"),
            _ => String::new(),
        };
        let cells = [
            show(0, 3),
            show(1, 5),
            show(2, 1),
            show(3, 5),
            difference(1, 3),
            show(4, 5),
            show(5, 5),
            show(6, 2),
            difference(4, 5),
            show(7, 4),
        ];
        text.extend(["| ", &cells.join(" | "), " |\n"]);
    }
    Ok(text)
}

/// Version, threads, time and memory of a run.
fn run_line(command: &str, sources: &Sources) -> Result<String, String> {
    let path = format!("data/runs/{command}/run.toml");
    let text =
        sources.get(&path).ok_or_else(|| format!("{path} is missing; `cargo xtask {command} --archive` makes it"))?;
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
    use crate::blocks::{BEGIN, END};

    #[test]
    fn numbers_come_from_the_archived_tables() {
        let areas = "mean_pressure_over_e_star,area_fraction,area_error,area_fraction_by_counting,published_first,\
                     published_deviation,published_second,theory\n1e-2,0.075,1e-4,0.077,0.078,5e-4,0.0744,0.06\n0.3,0.97,1e-4,0.98,0.98,1e-4,,0.9\n";
        let run = "version = \"0.1.0\"\nthreads = 2\nseconds = 5.0\n";
        let surface = "quantity,unit,value\nrms slope,1,2.751280e-1\n";
        let blocks = ["gfmd-run", "gfmd-areas", "gfmd-surface"].map(|name| format!("{BEGIN}{name} -->stale{END}\n"));
        let mut sources: Sources = [
            ("docs/gfmd.md", blocks.concat().as_str()),
            ("docs/challenge.md", "no numbers"),
            ("data/runs/gfmd/run.toml", run),
            ("data/runs/gfmd/gfmd-areas.csv", areas),
            ("data/runs/gfmd/gfmd-surface.csv", surface),
        ]
        .map(|(path, text)| (path.to_owned(), text.to_owned()))
        .into();
        assert_eq!(check(&sources).len(), 1);
        let text = render("docs/gfmd.md", &sources).expect("all tables");
        assert!(
            text.contains(
                "| 0.01 | 0.075 | 0.0001 | 0.0744 | +0.81 % | 0.077 | 0.078 | 0.0005 | \u{2212}1.28 % | 0.06 |"
            ),
            "{text}"
        );
        assert!(
            text.contains("| 0.3 | 0.97 | 0.0001 |  |  |") && text.contains("| rms slope | 0.27513 | 1 |"),
            "{text}"
        );
        assert!(text.contains("2 threads: 5.0 s") && !text.contains("stale"), "{text}");
        sources.insert("docs/gfmd.md".to_owned(), text);
        assert_eq!(check(&sources), Vec::<String>::new());
        sources.remove("data/runs/gfmd/gfmd-areas.csv");
        assert!(check(&sources)[0].contains("gfmd-areas.csv is missing"));
        sources.insert("docs/gfmd.md".to_owned(), format!("{BEGIN}gfmd-nothing -->{END}"));
        assert!(check(&sources)[0].contains("`gfmd-nothing`"));
        let text = format!("{BEGIN}challenge-large -->{END} {BEGIN}gfmd-picture -->{END}");
        sources.insert("docs/gfmd.md".to_owned(), text);
        let text = render("docs/gfmd.md", &sources).expect("nothing is needed");
        assert!(text.contains("challenge --large --archive") && text.contains("(images/gfmd.png)"), "{text}");
    }
}
