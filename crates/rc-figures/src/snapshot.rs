//! Snapshots of numeric tables, compared by the tables' own rules.

use std::path::Path;

use insta::{Comparator, Settings, Snapshot};

use crate::Table;
use crate::comparison::Comparison;

impl Comparator for Comparison {
    fn matches(&self, reference: &Snapshot, test: &Snapshot) -> bool {
        match (reference.as_text(), test.as_text()) {
            (Some(reference), Some(test)) => self.difference(&reference.to_string(), &test.to_string()).is_none(),
            _ => false,
        }
    }

    fn dyn_clone(&self) -> Box<dyn Comparator> {
        Box::new(self.clone())
    }
}

/// Asserts that `table` agrees with the snapshot `name` in `folder`.
///
/// The snapshot also records `parameters`, the origin of the numbers.
///
/// # Panics
/// When the table differs from the snapshot.
pub fn assert_table(folder: &Path, name: &str, table: &Table, parameters: &str) {
    let mut settings = Settings::clone_current();
    settings.set_comparator(Box::new(table.comparison.clone()));
    settings.set_description(parameters);
    settings.set_omit_expression(true);
    settings.set_snapshot_path(folder);
    settings.set_prepend_module_to_snapshot(false);
    settings.bind(|| insta::assert_snapshot!(name, &table.csv));
}
