//! One line of the stress table: the expected and the obtained result of a scene.

use std::panic::{AssertUnwindSafe, catch_unwind};

use anyhow::{Result, anyhow};

/// A checked property of a scene.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub(crate) group: &'static str,
    pub(crate) scene: String,
    pub(crate) property: &'static str,
    pub(crate) expected: String,
    pub(crate) obtained: String,
    pub(crate) passed: bool,
}

/// The lines of one group while they are collected.
pub(crate) struct Rows {
    group: &'static str,
    rows: Vec<Row>,
}

impl Rows {
    pub(crate) fn of(group: &'static str) -> Self {
        Self { group, rows: Vec::new() }
    }

    /// Adds a value that must not exceed a bound. A NaN fails.
    pub(crate) fn at_most(&mut self, scene: &str, property: &'static str, value: f64, bound: f64) {
        self.holds(scene, property, &format!("<= {bound:.3e}"), format!("{value:.3e}"), value <= bound);
    }

    /// Adds a property that holds or not; `obtained` says what was found.
    pub(crate) fn holds(
        &mut self,
        scene: &str,
        property: &'static str,
        expected: &str,
        obtained: impl AsRef<str>,
        passed: bool,
    ) {
        let [scene, expected, obtained] = [scene, expected, obtained.as_ref()].map(cell);
        self.rows.push(Row { group: self.group, scene, property, expected, obtained, passed });
    }

    pub(crate) fn finish(self) -> Vec<Row> {
        self.rows
    }
}

/// Text for a cell of a table, without commas and line breaks.
fn cell(text: &str) -> String {
    text.replace(['\n', '\r'], " ").replace(',', ";")
}

/// The result of `work`; a panic becomes an error.
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
    fn a_panic_becomes_an_error_and_cells_hold_no_commas() {
        let error = guarded(|| -> Result<()> { panic!("index {}", 7) }).expect_err("it panics");
        assert_eq!(error.to_string(), "panic: index 7");
        assert_eq!(cell("a, b\nc"), "a; b c");
    }
}
