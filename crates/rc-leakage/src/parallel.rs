//! Work on blocks of rows, in parallel; sums are over blocks in their order, so that no result depends on the number of
//! threads.

use rayon::prelude::*;

/// Elements in a block of rows where nothing else decides.
const BLOCK: usize = 1 << 16;

/// Rows in a block of a grid with rows of `nx` elements; the grid alone decides.
pub(crate) fn rows_per_block(nx: usize) -> usize {
    (BLOCK / nx).max(1)
}

/// Calls `work` once for each of `items`, in any order.
pub(crate) fn for_each<S: Send>(items: Vec<S>, work: impl Fn(S) + Sync + Send) {
    items.into_par_iter().for_each(work);
}

/// What `work` makes of each of `items`, in their order.
pub(crate) fn map<S: Send, R: Send>(items: Vec<S>, work: impl Fn(S) -> R + Sync + Send) -> Vec<R> {
    items.into_par_iter().map(work).collect()
}

/// Sum of what `work` makes of each of `items`, in their order.
pub(crate) fn sum<S: Send>(items: Vec<S>, work: impl Fn(S) -> f64 + Sync + Send) -> f64 {
    map(items, work).into_iter().sum()
}
