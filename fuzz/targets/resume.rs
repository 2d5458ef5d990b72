//! Journals of sweeps, from which `rc sweep --resume` goes on.

use rc_sweep::finished_rows;

pub(crate) fn run(data: &[u8]) -> bool {
    match finished_rows(data) {
        Ok(rows) => {
            assert!(rows <= data.len());
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    }
}
