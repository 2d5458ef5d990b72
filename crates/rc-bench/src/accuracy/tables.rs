//! The numbers as tables.

use rc_figures::numeric::median;
use rc_figures::{Table, number};

use super::scenes::Set;
use super::{Accuracy, Case, rms};

/// For each set, kernel and mesh: rms error of each estimator of the area, and the part of the scenes whose bars hold the error.
pub(super) fn summary(accuracy: &Accuracy) -> Table {
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
        accuracy.meshes.iter().map(move |&mesh| {
            let cases: Vec<&Case> = accuracy.of(set, kernel, mesh).collect();
            let n = cases.len() as f64;
            let of = |estimator: usize| rms(cases.iter().map(|case| 100.0 * case.area_errors()[estimator]));
            let mean = cases.iter().map(|case| 100.0 * case.area_errors()[3]).sum::<f64>() / n;
            let worst = cases.iter().map(|case| 100.0 * case.area_errors()[3].abs()).fold(0.0, f64::max);
            let bar =
                cases.iter().map(|case| 100.0 * case.found.area.error / case.found.area.fraction).sum::<f64>() / n;
            // Of the scenes that have a bar.
            let covered = |quantity: usize| {
                let ratios = cases.iter().map(|case| case.over_bars()[quantity]).filter(|ratio| !ratio.is_nan());
                let ratios: Vec<f64> = ratios.collect();
                100.0 * ratios.iter().filter(|ratio| ratio.abs() <= 1.0).count() as f64 / ratios.len() as f64
            };
            let mean_of = |value: fn(&Case) -> f64| 100.0 * cases.iter().map(|case| value(case)).sum::<f64>() / n;
            let median_of =
                |value: fn(&Case) -> f64| 100.0 * median(cases.iter().map(|case| value(case).abs()).collect());
            let plain = median_of(|case| case.found.rms_pressure / case.limit.rms_pressure - 1.0);
            let corrected = median_of(|case| case.found.rms_pressure_corrected / case.limit.rms_pressure - 1.0);
            let stress = [
                mean_of(|case| case.distribution.distance),
                mean_of(|case| case.distribution.first_bin),
                mean_of(|case| case.distribution.first_bin_of_limit),
            ]
            .map(number);
            let numbers =
                [of(0), of(1), of(2), of(3), mean, worst, bar, covered(0), plain, corrected, covered(1), covered(2)]
                    .map(number);
            [set.name().to_owned(), kernel.to_owned(), mesh.to_string(), cases.len().to_string()]
                .into_iter()
                .chain(numbers)
                .chain(stress)
                .collect()
        })
    });
    Table::new("summary", &header, rows)
}

/// Every scene on every mesh.
pub(super) fn cases(accuracy: &Accuracy) -> Table {
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
    let rows = accuracy.cases.iter().map(|case| {
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
            found.mean_gap_error.map_or(f64::NAN, |bar| bar / limit.mean_gap),
            area.error,
        ];
        let first =
            [scene.set.name().to_owned(), case.kernel.to_owned(), case.mesh.to_string(), scene.waves.to_string()];
        let first = first.into_iter().chain([number(scene.hurst), scene.seed.to_string()]);
        first.chain(numbers.chain(rest).chain(stress).map(number)).collect()
    });
    Table::new("cases", &header, rows)
}

/// For each kernel, the change of [`rc_core::EdgeBias`] that would fit the scenes for calibration best: in the least-squares sense,
/// and in the median of the scenes for the squares.
pub(super) fn calibration(accuracy: &Accuracy) -> Table {
    let rows = ["love", "spectral"].into_iter().map(|kernel| {
        // Normal equations of (area - limit) n = a edges + b contacts + c deviation, each scene weighed by its edges.
        let mut equations = [[0.0; 4]; 3];
        for case in accuracy.of_set(Set::Calibration).filter(|case| case.kernel == kernel) {
            let area = &case.found.area;
            let error = (area.fraction - case.limit.area) * (case.side * case.side) as f64;
            let terms = [area.perimeter_edges as f64, area.euler_number, area.gap_deviation, error];
            for (equation, term) in equations.iter_mut().zip(terms) {
                for (sum, other) in equation.iter_mut().zip(terms) {
                    *sum += term * other / terms[0].max(1.0);
                }
            }
        }
        let of_kernel = accuracy.of_set(Set::Calibration).filter(|case| case.kernel == kernel);
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

/// Solves three linear equations, the last column being the right-hand side, by elimination; they are symmetric and definite.
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
