//! One line of the stress table: what was expected of a scene, what came out, and whether that passes.

use std::panic::{AssertUnwindSafe, catch_unwind};

use anyhow::{Result, anyhow};

/// A property of a scene, checked.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub(crate) group: &'static str,
    pub(crate) scene: String,
    pub(crate) property: &'static str,
    pub(crate) expected: String,
    pub(crate) obtained: String,
    /// The value over its bound, where the property is a bound: 1 is as bad as is allowed.
    pub(crate) use_of_bound: Option<f64>,
    pub(crate) passed: bool,
}

/// The lines of one group, in the making.
pub(crate) struct Rows {
    group: &'static str,
    rows: Vec<Row>,
}

impl Rows {
    pub(crate) fn of(group: &'static str) -> Self {
        Self { group, rows: Vec::new() }
    }

    /// A value that must not be above a bound; NaN is.
    pub(crate) fn at_most(&mut self, scene: &str, property: &'static str, value: f64, bound: f64) {
        self.rows.push(Row {
            group: self.group,
            scene: cell(scene),
            property,
            expected: format!("<= {bound:.3e}"),
            obtained: format!("{value:.3e}"),
            use_of_bound: (bound > 0.0).then_some(value / bound),
            passed: value <= bound,
        });
    }

    /// Something that holds or does not; `obtained` says what was found.
    pub(crate) fn holds(
        &mut self,
        scene: &str,
        property: &'static str,
        expected: &str,
        obtained: impl AsRef<str>,
        passed: bool,
    ) {
        self.rows.push(Row {
            group: self.group,
            scene: cell(scene),
            property,
            expected: cell(expected),
            obtained: cell(obtained.as_ref()),
            use_of_bound: None,
            passed,
        });
    }

    pub(crate) fn finish(self) -> Vec<Row> {
        self.rows
    }
}

/// Text that fits into a cell of a table: one line, no commas.
fn cell(text: &str) -> String {
    text.replace(['\n', '\r'], " ").replace(',', ";")
}

/// What `work` returns; a panic in it is an error that says so.
pub(crate) fn guarded<T>(work: impl FnOnce() -> Result<T>) -> Result<T> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("without a message");
        Err(anyhow!("panic: {text}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_is_above_every_bound_and_cells_hold_no_commas() {
        let mut rows = Rows::of("g");
        rows.at_most("a, b", "p", f64::NAN, 1.0);
        rows.at_most("a", "p", 0.5, 1.0);
        let rows = rows.finish();
        assert!(!rows[0].passed && rows[1].passed, "{rows:?}");
        assert_eq!((rows[0].scene.as_str(), rows[1].use_of_bound), ("a; b", Some(0.5)));
    }

    #[test]
    fn a_panic_becomes_an_error() {
        let error = guarded(|| -> Result<()> { panic!("index {}", 7) }).expect_err("it panics");
        assert_eq!(error.to_string(), "panic: index 7");
    }
}
