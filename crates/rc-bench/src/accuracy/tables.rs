//! The tables of `cargo xtask accuracy`.

use rc_figures::numeric::median;
use rc_figures::{Table, number};

use super::case::{Case, of_mesh, of_set, rms};
use super::scenes::Set;

/// Errors of the area and coverage of its bars by set, kernel and mesh.
///
/// The columns are the rms error of each estimator of the area, and the fraction of the scenes whose bars cover the
/// error.
pub(super) fn summary(cases: &[Case], meshes: &[usize]) -> Table {
    let header = [
        "set",
        "kernel",
        "elements_per_wave",
        "scenes",
        "area_counted_rms_percent",
        "area_published_rms_percent",
        "area_of_pressure_rms_percent",
        "area_rms_percent",
        "area_mean_percent",
        "area_worst_percent",
        "area_bar_percent",
        "area_covered_percent",
        "rms_pressure_median_percent",
        "rms_pressure_corrected_median_percent",
        "rms_pressure_covered_percent",
        "mean_gap_covered_percent",
        "stress_distance_mean_percent",
        "stress_first_bin_mean_percent",
        "stress_first_bin_of_limit_mean_percent",
    ];
    let kernels =
        [Set::Test, Set::Calibration].into_iter().flat_map(|set| ["love", "spectral"].map(|kernel| (set, kernel)));
    let rows = kernels.flat_map(|(set, kernel)| {
        meshes.iter().map(move |&mesh| {
            let cases: Vec<&Case> = of_mesh(cases, set, kernel, mesh).collect();
            let names = [set.name().to_owned(), kernel.to_owned(), mesh.to_string(), cases.len().to_string()];
            names.into_iter().chain(statistics(&cases).into_iter().map(number)).collect()
        })
    });
    Table::new("summary", &header, rows)
}

/// The numbers of one line of [`summary`], in the order of its header.
fn statistics(cases: &[&Case]) -> Vec<f64> {
    let percent =
        |values: &dyn Fn(&Case) -> f64| -> Vec<f64> { cases.iter().map(|case| 100.0 * values(case)).collect() };
    let mean = |values: &dyn Fn(&Case) -> f64| percent(values).iter().sum::<f64>() / cases.len() as f64;
    let median_size = |values: &dyn Fn(&Case) -> f64| median(percent(&|case| values(case).abs()));
    let rms_error = |estimator: usize| rms(percent(&|case| case.area_errors()[estimator]).into_iter());
    // The fraction is of the scenes that have a bar.
    let covered = |quantity: usize| {
        let ratios = cases.iter().map(|case| case.over_bars()[quantity]).filter(|ratio| !ratio.is_nan());
        let ratios: Vec<f64> = ratios.collect();
        100.0 * ratios.iter().filter(|ratio| ratio.abs() <= 1.0).count() as f64 / ratios.len() as f64
    };
    let mut numbers: Vec<f64> = (0..4).map(rms_error).collect();
    numbers.extend([
        mean(&|case| case.area_errors()[3]),
        percent(&|case| case.area_errors()[3].abs()).into_iter().fold(0.0, f64::max),
        mean(&|case| case.found.area.error / case.found.area.fraction),
        covered(0),
        median_size(&|case| case.found.rms_pressure / case.limit.rms_pressure - 1.0),
        median_size(&|case| case.found.rms_pressure_corrected / case.limit.rms_pressure - 1.0),
        covered(1),
        covered(2),
        mean(&|case| case.distribution.distance),
        mean(&|case| case.distribution.first_bin),
        mean(&|case| case.distribution.first_bin_of_limit),
    ]);
    numbers
}

/// Every scene on every mesh.
pub(super) fn cases(cases: &[Case]) -> Table {
    let header = [
        "set",
        "kernel",
        "elements_per_wave",
        "waves",
        "hurst",
        "seed",
        "mean_pressure_over_e_star",
        "area_limit",
        "area_counted",
        "area_published",
        "area_of_pressure",
        "area",
        "area_error_over_bar",
        "rms_pressure_error_over_bar",
        "mean_gap_error_over_bar",
        "perimeter_edges",
        "euler_number",
        "rms_pressure_relative_error",
        "rms_pressure_corrected_relative_error",
        "rms_pressure_relative_bar",
        "mean_gap_relative_error",
        "mean_gap_relative_bar",
        "area_bar",
        "stress_distance",
        "stress_first_bin",
    ];
    Table::new("cases", &header, cases.iter().map(line))
}

/// One line of [`cases`].
fn line(case: &Case) -> Vec<String> {
    let scene = case.scene;
    let numbers = [scene.mean_pressure, case.limit.area].into_iter().chain(case.areas()).chain(case.over_bars());
    let area = &case.found.area;
    let stress = [case.distribution.distance, case.distribution.first_bin];
    let (found, limit) = (&case.found, case.limit);
    let rest = [
        area.perimeter_edges as f64,
        area.euler_number,
        found.rms_pressure / limit.rms_pressure - 1.0,
        found.rms_pressure_corrected / limit.rms_pressure - 1.0,
        found.rms_pressure_error.map_or(f64::NAN, |bar| bar / limit.rms_pressure),
        found.mean_gap / limit.mean_gap - 1.0,
        found.mean_gap_error / limit.mean_gap,
        area.error,
    ];
    let first = [scene.set.name().to_owned(), case.kernel.to_owned(), case.mesh.to_string(), scene.waves.to_string()];
    let first = first.into_iter().chain([number(scene.hurst), scene.seed.to_string()]);
    first.chain(numbers.chain(rest).chain(stress).map(number)).collect()
}

/// One line for each kernel: changes of [`rc_core::EdgeBias`] that fit the calibration scenes best.
///
/// Edges, contacts and deviation are fitted by least squares. The change for the squares is the median over the scenes.
pub(super) fn calibration(cases: &[Case]) -> Table {
    let rows = ["love", "spectral"].into_iter().map(|kernel| {
        // Normal equations of (area - limit) n = a edges + b contacts + c deviation. Each scene has its number of edges
        // as its weight.
        let mut equations = [[0.0; 4]; 3];
        for case in of_set(cases, Set::Calibration).filter(|case| case.kernel == kernel) {
            let area = &case.found.area;
            let error = (area.fraction - case.limit.area) * (case.side * case.side) as f64;
            let terms = [area.perimeter_edges as f64, area.euler_number, area.gap_deviation, error];
            for (equation, term) in equations.iter_mut().zip(terms) {
                for (sum, other) in equation.iter_mut().zip(terms) {
                    *sum += term * other / terms[0].max(1.0);
                }
            }
        }
        let of_kernel = of_set(cases, Set::Calibration).filter(|case| case.kernel == kernel);
        let per_square = of_kernel.map(Case::more_per_square).filter(|more| more.is_finite());
        let median = median(per_square.collect());
        [kernel.to_owned()].into_iter().chain(solve(equations).into_iter().chain([median]).map(number)).collect()
    });
    Table::new(
        "calibration",
        &["kernel", "more_per_edge", "more_per_contact", "more_per_deviation", "more_per_square"],
        rows,
    )
}

/// Solves three linear equations by elimination.
///
/// The last column is the right-hand side. The matrix is symmetric and positive definite.
fn solve(mut equations: [[f64; 4]; 3]) -> [f64; 3] {
    for pivot in 0..3 {
        for row in (0..3).filter(|&row| row != pivot) {
            let factor = equations[row][pivot] / equations[pivot][pivot];
            let subtracted = equations[pivot].map(|value| factor * value);
            equations[row].iter_mut().zip(subtracted).for_each(|(value, subtracted)| *value -= subtracted);
        }
    }
    std::array::from_fn(|i| equations[i][3] / equations[i][i])
}
