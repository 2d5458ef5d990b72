//! Values that are made only once.

use std::sync::OnceLock;

/// The value of `cell`, which is made if the cell is empty.
///
/// It is not made under a lock. A thread that waits for others inside `make` may begin to work on another load, which
/// wants the same value.
pub(crate) fn made<T>(cell: &OnceLock<T>, make: impl FnOnce() -> T) -> &T {
    if let Some(value) = cell.get() {
        return value;
    }
    let value = make();
    cell.get_or_init(|| value)
}
