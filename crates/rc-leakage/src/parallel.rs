//! Parallel work on blocks of rows.
//!
//! Sums are over blocks in their order, so results do not depend on the number of threads.

use rayon::prelude::*;

use crate::real::Real;

/// Default number of elements in a block of rows.
const BLOCK: usize = 1 << 16;

/// Number of rows in a block, for rows of `nx` elements. It depends on the grid only.
pub(crate) fn rows_per_block(nx: usize) -> usize {
    (BLOCK / nx).max(1)
}

/// Calls `work` once for each of `items`, in any order.
pub(crate) fn for_each<S: Send>(items: Vec<S>, work: impl Fn(S) + Sync + Send) {
    items.into_par_iter().for_each(work);
}

/// The results of `work` for each of `items`, in their order.
pub(crate) fn map<S: Send, R: Send>(items: Vec<S>, work: impl Fn(S) -> R + Sync + Send) -> Vec<R> {
    items.into_par_iter().map(work).collect()
}

/// The sum of the results of `work` over `items`, in their order.
pub(crate) fn sum<S: Send>(items: Vec<S>, work: impl Fn(S) -> f64 + Sync + Send) -> f64 {
    map(items, work).into_iter().sum()
}

/// Zeros that are in memory.
///
/// Zeros from the allocator have no memory before they are written. If they are read first, each page of them is
/// fetched twice, and the second time stops all threads.
pub(crate) fn zeros<T: Real>(n: usize) -> Vec<T> {
    rayon::iter::repeat_n(T::ZERO, n).collect()
}
