//! Means over the seeds of a scene, with their errors.

use super::columns::Quantity;
use super::table::Row;

/// A mean over seeds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mean {
    pub(crate) value: f64,
    /// Standard error of the mean; `None` of a single seed.
    pub(crate) standard_error: Option<f64>,
    /// Mean of the error bars of the mesh, which do not become smaller with more seeds.
    bar: f64,
}

impl Mean {
    /// The mean of values with their bars; `None` of none.
    pub(crate) fn of(values: &[[f64; 2]]) -> Option<Self> {
        let n = values.len() as f64;
        let [value, bar] = [0, 1].map(|i| values.iter().map(|one| one[i]).sum::<f64>() / n);
        let squares: f64 = values.iter().map(|one| (one[0] - value).powi(2)).sum();
        let standard_error = (values.len() > 1).then(|| (squares / (n * (n - 1.0))).sqrt());
        (!values.is_empty()).then_some(Self { value, standard_error, bar })
    }

    /// Error of the mean: root of the sum of the squares of standard error and bar of the mesh.
    pub(crate) fn error(&self) -> f64 {
        self.standard_error.unwrap_or(0.0).hypot(self.bar)
    }
}

/// The rows of a scene under one load.
#[derive(Clone, Debug)]
pub(crate) struct AtLoad<'a> {
    /// The load of the rows.
    pub(crate) load: f64,
    /// A row for each seed.
    pub(crate) rows: Vec<&'a Row>,
}

impl<'a> AtLoad<'a> {
    /// The loads of the rows of a scene, from the smallest.
    pub(crate) fn all(scene: &'a [Row]) -> Vec<Self> {
        let mut loads: Vec<f64> = scene.iter().map(|row| row.load).collect();
        loads.sort_by(f64::total_cmp);
        loads.dedup();
        let at = |load: f64| {
            let rows = scene.iter().filter(|row| row.load.total_cmp(&load).is_eq()).collect();
            Self { load, rows }
        };
        loads.into_iter().map(at).collect()
    }

    /// The loads that all seeds of the scene have.
    ///
    /// A mean over a part of the seeds would jump where the curve of a seed ends.
    pub(crate) fn of_all_seeds(scene: &'a [Row]) -> Vec<Self> {
        let n_seeds = scene.chunk_by(|a, b| a.seed == b.seed).count();
        let mut all = Self::all(scene);
        all.retain(|at| at.rows.len() == n_seeds);
        all
    }

    /// The mean of `value`, which gives value and bar of a row; `None` if a row has no value.
    pub(crate) fn mean_of(&self, value: impl Fn(&Row) -> Option<[f64; 2]>) -> Option<Mean> {
        Mean::of(&self.rows.iter().map(|row| value(row)).collect::<Option<Vec<_>>>()?)
    }

    /// The mean of a quantity.
    pub(crate) fn mean(&self, quantity: Quantity) -> Option<Mean> {
        self.mean_of(|row| quantity.of(&row.cells))
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::curves::columns::QUANTITIES;

    #[test]
    fn means_are_over_seeds_under_equal_loads() {
        let row = |seed, load: f64, area: f64| {
            let cells = json!({ "area_fraction": area, "area_fraction_error": 0.03, "contact_stiffness": (seed == 1).then_some(3.0) });
            let cells = cells.as_object().expect("an object").clone();
            Row { seed: Some(seed), load, cells, ..Row::default() }
        };
        let rows = [row(1, 1.0, 0.1), row(1, 2.0, 0.2), row(2, 1.0, 0.3), row(2, 2.0, 0.6)];
        let [area, stiffness] = [QUANTITIES[0], QUANTITIES[3]];
        let means: Vec<Mean> = AtLoad::of_all_seeds(&rows).iter().filter_map(|at| at.mean(area)).collect();
        assert_eq!(means.len(), 2);
        // The deviations are 0.1 and 0.2, so the standard errors are √(2 d²/2).
        for (mean, (value, error)) in means.iter().zip([(0.2, 0.1), (0.4, 0.2)]) {
            let standard = mean.standard_error.expect("two seeds");
            assert!((mean.value - value).abs() < 1e-15 && (standard - error).abs() < 1e-15, "{mean:?}");
            assert!((mean.error() - f64::hypot(error, 0.03)).abs() < 1e-15, "{mean:?}");
        }
        let first = &AtLoad::all(&rows)[0];
        assert_eq!(first.mean(stiffness), None, "a seed is in full contact");
        // One seed does not have the second load, so there is no mean at that load.
        let part = [row(1, 1.0, 0.1), row(1, 2.0, 0.2), row(2, 1.0, 0.3)];
        assert_eq!((AtLoad::all(&part).len(), AtLoad::of_all_seeds(&part).len()), (2, 1));
        let single = AtLoad::all(&part[..1])[0].mean(area).expect("a value");
        assert_eq!((single.standard_error, single.error()), (None, 0.03));
    }
}
