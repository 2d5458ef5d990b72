//! Work on the blocks of vectors, in parallel.
//!
//! Iterators of rayon are generic over everything they pass on, and are compiled anew for each combination. Four
//! hundred combinations took most of the time to compile this crate. Here rayon is compiled once. Each block costs a
//! dynamic call and a lock without contention.

use std::mem;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

use rayon::prelude::*;

/// Values in a block, unless something else decides.
pub(crate) const BLOCK: usize = 4096;

/// The result of `work`, which runs in a thread of the pool, unless other work came first.
///
/// A thread outside the pool hands over each pass and sleeps until it ends. On 64² elements, most of the time of a solve
/// went there: from inside, it takes a third. There is one such work at a time, because a thread that waits inside it for
/// another one may take up whatever the pool is given: a second solve would stand on the stack of the first, and so on.
pub(crate) fn in_pool<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    if rayon::current_thread_index().is_some() || IS_TAKEN.swap(true, Ordering::Acquire) {
        return work();
    }
    let _taken = Taken;
    rayon::scope(|_| work())
}

/// Whether a work is in the pool.
static IS_TAKEN: AtomicBool = AtomicBool::new(false);

/// Its end, also by a panic, which lets the next one in.
struct Taken;

impl Drop for Taken {
    fn drop(&mut self) {
        IS_TAKEN.store(false, Ordering::Release);
    }
}

/// Calls `work` once for each index below `n`, in any order.
pub(crate) fn for_each_index(n: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..n).into_par_iter().for_each(work);
}

/// Calls `work` once for each of `items`, in any order.
pub(crate) fn for_each<S: Send>(items: impl Iterator<Item = S>, work: impl Fn(S) + Sync) {
    map(items, work);
}

/// The results of `work` for each of `items`, in their order.
pub(crate) fn map<S: Send, R: Send>(items: impl Iterator<Item = S>, work: impl Fn(S) -> R + Sync) -> Vec<R> {
    let tasks = Tasks::new(items);
    for_each_index(tasks.slots.len(), &|i| tasks.run(i, &work));
    tasks.into_results()
}

/// Maximum of `values`, but not less than `at_least`. NaN is passed over.
pub(crate) fn maximum(values: &[f64], at_least: f64) -> f64 {
    let blocks = map(values.chunks(BLOCK), |block| block.iter().copied().fold(at_least, f64::max));
    blocks.into_iter().fold(at_least, f64::max)
}

/// Minimum of `values`. NaN is passed over.
pub(crate) fn minimum(values: &[f64]) -> f64 {
    let blocks = map(values.chunks(BLOCK), |block| block.iter().copied().fold(f64::INFINITY, f64::min));
    blocks.into_iter().fold(f64::INFINITY, f64::min)
}

/// Changes each of `values`.
pub(crate) fn update(values: &mut [f64], change: impl Fn(&mut f64) + Sync) {
    for_each(values.chunks_mut(BLOCK), |block| block.iter_mut().for_each(&change));
}

/// Root mean square of values that are summed in pieces of `len`.
pub(crate) fn rms(values: &[f64], len: usize) -> f64 {
    let pieces = map(values.chunks(len), |piece| piece.iter().map(|v| v * v).sum::<f64>());
    (pieces.into_iter().sum::<f64>() / values.len() as f64).sqrt()
}

/// Zeros, in memory that is written at once.
///
/// Memory of `vec!` is mapped page by page when it is first read. It is mapped again, in all threads, when it is
/// written.
pub(crate) fn zeros<T: Copy + Default + Send>(n: usize) -> Vec<T> {
    let mut values = vec![T::default(); n];
    for_each(values.chunks_mut(BLOCK), |block| block.fill(T::default()));
    values
}

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

/// One item for each block, and its result.
pub(crate) struct Tasks<S, R> {
    slots: Vec<Mutex<Slot<S, R>>>,
}

enum Slot<S, R> {
    Waiting(S),
    Running,
    Done(R),
}

impl<S: Send, R: Send> Tasks<S, R> {
    pub(crate) fn new(items: impl Iterator<Item = S>) -> Self {
        Self { slots: items.map(|item| Mutex::new(Slot::Waiting(item))).collect() }
    }

    /// Works on item `i`.
    ///
    /// # Panics
    /// When item `i` was worked on before.
    pub(crate) fn run(&self, i: usize, work: impl FnOnce(S) -> R) {
        let mut slot = self.slots[i].lock().unwrap_or_else(PoisonError::into_inner);
        let Slot::Waiting(item) = mem::replace(&mut *slot, Slot::Running) else {
            panic!("block {i} is worked on twice");
        };
        *slot = Slot::Done(work(item));
    }

    /// The results, in the order of items.
    ///
    /// # Panics
    /// When a result is missing.
    pub(crate) fn into_results(self) -> Vec<R> {
        let results = self.slots.into_iter().enumerate().map(|(i, slot)| {
            match slot.into_inner().unwrap_or_else(PoisonError::into_inner) {
                Slot::Done(result) => result,
                Slot::Waiting(_) | Slot::Running => panic!("nothing has worked on block {i}"),
            }
        });
        results.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_the_order_of_items() {
        let mut values = vec![0_usize; 1000];
        let sums = map(values.chunks_mut(7).enumerate(), |(i, block)| {
            block.fill(i);
            block.iter().sum::<usize>()
        });
        assert_eq!(sums.len(), 143);
        assert!(values.iter().enumerate().all(|(i, &value)| value == i / 7));
        assert!(sums[..142].iter().enumerate().all(|(i, &sum)| sum == 7 * i));
    }

    #[test]
    fn a_second_work_stays_outside_the_pool() {
        let is_inside = || rayon::current_thread_index().is_some();
        let second = || std::thread::scope(|s| s.spawn(|| in_pool(is_inside)).join().expect("it ends"));
        // Another test may be in the pool, and end at any time.
        let [first, second] = in_pool(|| [is_inside(), second()]);
        assert!(!(first && second));
    }

    #[test]
    fn extremes_are_over_all_blocks() {
        let values: Vec<f64> = (0..10_000).map(|i| f64::from((i * 7919) % 10_007)).collect();
        assert_eq!(maximum(&values, 0.0).to_bits(), values.iter().copied().fold(0.0, f64::max).to_bits());
        assert_eq!(minimum(&values).to_bits(), values.iter().copied().fold(f64::INFINITY, f64::min).to_bits());
    }
}
