//! Journals of sweeps, from which `rc sweep --resume` goes on.

use rc_sweep::finished_rows;

pub(crate) fn run(data: &[u8]) {
    match finished_rows(data) {
        Ok(rows) => assert!(rows <= data.len()),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
