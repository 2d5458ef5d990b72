//! Values that are made once.

use std::sync::OnceLock;

/// The value of `cell`, made when there is none yet. Not under a lock: threads that wait for each other inside `make`
/// may take up another load, which wants the same value.
pub(crate) fn made<T>(cell: &OnceLock<T>, make: impl FnOnce() -> T) -> &T {
    if let Some(value) = cell.get() {
        return value;
    }
    let value = make();
    cell.get_or_init(|| value)
}
