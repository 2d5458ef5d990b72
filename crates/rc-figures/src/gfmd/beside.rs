//! Energy, mean gap and stress beside the files of the published reference.

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use rc_heights::{MatArray, mat_arrays};

use super::{Gfmd, Point};
use crate::{Table, number};

/// The longest wavelength of the reference (m). Its energies are in N/m for E* = 1 Pa.
const LONGEST: f64 = TAU * 1e-4;

/// Loads with a file of the stress distribution, and the names of the arrays.
const STRESSES: [(f64, &str); 3] = [(0.025, "0_025"), (0.113, "0_113"), (0.24, "0_24")];

/// Tables of our results beside the files in `folder`.
///
/// `folder` is a copy of the folder `Data` of the published reference.
///
/// # Errors
/// When a file is missing or does not have the expected arrays.
pub fn beside(figure: &Gfmd, folder: &Path) -> Result<Vec<Table>> {
    Ok(vec![energies(figure, folder)?, gaps(figure, folder)?, stresses(figure, folder)?])
}

/// The arrays of one file.
struct Data(Vec<MatArray>);

impl Data {
    fn read(folder: &Path, name: &str) -> Result<Self> {
        let path = folder.join(name);
        let bytes = fs::read(&path).with_context(|| {
            format!("could not read {}; --data is the folder Data of the published files", path.display())
        })?;
        Ok(Self(mat_arrays(&bytes).with_context(|| path.display().to_string())?))
    }

    fn array(&self, name: &str) -> Result<&MatArray> {
        self.0.iter().find(|array| array.name == name).with_context(|| format!("no array {name}"))
    }
}

/// Our result at a load of the reference.
fn point(figure: &Gfmd, load: f64) -> Option<&Point> {
    figure.points.iter().find(|point| (point.load / load - 1.0).abs() < 1e-9)
}

fn row(numbers: &[f64]) -> Vec<String> {
    numbers.iter().copied().map(number).collect()
}

fn energies(figure: &Gfmd, folder: &Path) -> Result<Table> {
    let data = Data::read(folder, "Uel_GFMD_Zhou.mat")?;
    let [loads, means, deviations] = ["p_bar", "Uel_mean", "Uel_std"].map(|name| data.array(name));
    let (loads, means, deviations) = (loads?, means?, deviations?);
    let unit = figure.full_energy * figure.params.longest as f64;
    let rows = loads.values.iter().zip(&means.values).zip(&deviations.values);
    let rows = rows.filter_map(|((&load, &mean), &deviation)| {
        let ours = point(figure, load)?.energy * unit;
        Some(row(&[load, mean / LONGEST, deviation / LONGEST, ours, ours / (mean / LONGEST) - 1.0]))
    });
    let header = ["mean_pressure_over_e_star", "published", "published_deviation", "energy", "difference"];
    Ok(Table::new("beside-energy", &header, rows))
}

/// Table of mean gaps from histograms of the gap over the rms height.
///
/// The files do not say whether a gap is the middle of its bin or its lower end, so both means are given. The second is
/// half a bin larger.
fn gaps(figure: &Gfmd, folder: &Path) -> Result<Table> {
    let mut rows = Vec::new();
    for part in ["low", "high"] {
        let data = Data::read(folder, &format!("GFMD_final_results_{part}_from_Zhou.mat"))?;
        let loads = data.array(&format!("p_bar_{part}"))?;
        let densities = data.array(&format!("PDF_GFMD_{part}"))?.columns();
        let gaps = data.array(&format!("gap_GFMD_{part}"))?.columns();
        for ((&load, density), gap) in loads.values.iter().zip(densities).zip(gaps) {
            let Some((ours, error)) = point(figure, load).map(|point| point.mean_gap) else { continue };
            let total: f64 = density.iter().sum();
            let mean = density.iter().zip(gap).map(|(density, gap)| density * gap).sum::<f64>() / total;
            let half_bin = gap.windows(2).next().map_or(0.0, |two| 0.5 * (two[1] - two[0]));
            rows.push(row(&[load, mean, mean + half_bin, ours, error]));
        }
    }
    let header =
        ["mean_pressure_over_e_star", "published_if_middles", "published_if_lower_ends", "mean_gap", "mean_gap_error"];
    Ok(Table::new("beside-gap", &header, rows))
}

fn stresses(figure: &Gfmd, folder: &Path) -> Result<Table> {
    let mut rows = Vec::new();
    for (load, name) in STRESSES {
        let Some(ours) = figure.distributions.iter().find(|one| (one.load / load - 1.0).abs() < 1e-9) else { continue };
        let data = Data::read(folder, &format!("PDF{name}_GFMD_Zhou.mat"))?;
        let [stress, mean, deviation] =
            ["p_bin".to_owned(), format!("PDF{name}_mean"), format!("PDF{name}_std")].map(|name| data.array(&name));
        let (stress, mean, deviation) = (stress?, mean?, deviation?);
        for ((&stress, &mean), &deviation) in stress.values.iter().zip(&mean.values).zip(&deviation.values) {
            let found = density_at(&ours.stress.edges, &ours.stress.density, stress).filter(|_| mean.is_finite());
            rows.extend(found.map(|density| row(&[load, stress, mean, deviation, density, density / mean - 1.0])));
        }
    }
    let header = [
        "mean_pressure_over_e_star",
        "stress_over_e_star",
        "published",
        "published_deviation",
        "density",
        "difference",
    ];
    Ok(Table::new("beside-stress", &header, rows))
}

/// The density at `stress`, interpolated between the middles of bins.
fn density_at(edges: &[f64], density: &[f64], stress: f64) -> Option<f64> {
    let middles: Vec<f64> = edges.windows(2).map(|edge| 0.5 * (edge[0] + edge[1])).collect();
    let above = middles.partition_point(|middle| *middle < stress);
    let below = above.checked_sub(1)?;
    let (from, to) = (middles.get(below)?, middles.get(above)?);
    let part = (stress - from) / (to - from);
    Some(density[below] + part * (density[above] - density[below]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gfmd::mat_file::file;
    use crate::{Figure as _, Preset};

    #[test]
    fn files_are_compared_load_by_load() {
        let params = Gfmd::params(Preset::Quick).expect("published loads");
        let figure = Gfmd::compute(&params).expect("the quick figure is solved");
        let folder = tempfile::tempdir().expect("a temporary folder");
        let energy = figure.points[1].energy * figure.full_energy * figure.params.longest as f64 * LONGEST;
        let write = |name: &str, arrays: &[(&str, usize, &[f64])]| {
            fs::write(folder.path().join(name), file(arrays)).expect("a file");
        };
        write(
            "Uel_GFMD_Zhou.mat",
            &[("p_bar", 2, &[0.025, 0.2]), ("Uel_mean", 2, &[energy / 2.0, 1.0]), ("Uel_std", 2, &[0.0; 2])],
        );
        let histogram = |part: &str, load: f64| {
            let [loads, densities, gaps] = ["p_bar", "PDF_GFMD", "gap_GFMD"].map(|name| format!("{name}_{part}"));
            let arrays: [(&str, usize, &[f64]); 3] =
                [(&loads, 1, &[load]), (&densities, 2, &[1.0, 3.0]), (&gaps, 2, &[0.0, 1.0])];
            write(&format!("GFMD_final_results_{part}_from_Zhou.mat"), &arrays);
        };
        histogram("low", 1e-3);
        histogram("high", 0.7);
        assert!(format!("{:#}", beside(&figure, folder.path()).expect_err("no stresses")).contains("PDF0_025"));
        for name in ["0_025", "0_113"] {
            let [mean, deviation] = ["mean", "std"].map(|end| format!("PDF{name}_{end}"));
            write(
                &format!("PDF{name}_GFMD_Zhou.mat"),
                &[("p_bin", 2, &[0.05, 0.1]), (&mean, 2, &[f64::NAN, 1.0]), (&deviation, 2, &[0.0; 2])],
            );
        }
        let tables = beside(&figure, folder.path()).expect("all files");
        let cells = |table: usize| -> Vec<Vec<f64>> {
            let rows = tables[table]
                .csv
                .lines()
                .skip(1)
                .map(|line| line.split(',').map(|cell| cell.parse().expect("a number")));
            rows.map(Iterator::collect).collect()
        };
        assert!(cells(0).len() == 1 && (cells(0)[0][4] - 1.0).abs() < 1e-5, "{}", tables[0].csv);
        assert!(
            cells(1).len() == 1 && (cells(1)[0][1] - 0.75).abs() < 1e-6 && (cells(1)[0][2] - 1.25).abs() < 1e-6,
            "{}",
            tables[1].csv
        );
        assert_eq!(cells(2).len(), 2, "{}", tables[2].csv);
    }
}
