//! What an iteration needs to know of the mesh: how L and its approximate inverse are applied to a vector.

use super::layout::BlockLayout;
use crate::parallel::Tasks;

/// L on the vectors of one mesh, in values of type `T`. They pass block by block, so that the caller's vector work
/// rides along while a block is in cache: the caller writes the pressures, L is applied, the caller reads the
/// displacements. [`write_blocks`] and [`read_blocks`] hand each block its part of the caller's own vectors.
pub(crate) trait BlockOperator<T> {
    /// How vectors are divided.
    fn layout(&self) -> BlockLayout;

    /// Calls `write` once for each block, with its index and the pressures to be filled in.
    fn write(&mut self, write: &(dyn Fn(usize, &mut [T]) + Sync));

    /// Applies L.
    fn apply(&mut self);

    /// Calls `read` once for each block, with its index and the displacements.
    fn read(&self, read: &(dyn Fn(usize, &[T]) + Sync));

    /// Frees memory that the next [`BlockOperator::write`] takes again.
    fn release(&mut self) {}
}

/// L for corrections of a pressure, with an approximate inverse of it.
pub(crate) trait PreconditionedOperator: BlockOperator<f32> {
    /// Whether it extends residuals between contacts.
    fn extends(&self) -> bool {
        true
    }

    /// The elements that the approximate inverse is for from now on.
    fn set_active(&mut self, active: &[bool]);

    /// Applies the approximate inverse of L among the `active` elements, which were set before, to displacements that
    /// are zero elsewhere: what is left in their places is a pressure. Elsewhere it leaves anything.
    fn precondition(&mut self, active: &[bool], values: &mut [f32]);

    /// Sets the eigenvalue of the approximate inverse for constant vectors.
    fn set_mean(&mut self, eigenvalue: f64);
}

/// L on one level.
pub(crate) struct LevelOperators<'a> {
    /// For corrections, in single precision.
    pub(crate) corrections: Box<dyn PreconditionedOperator + 'a>,
    /// For fresh gaps, in double precision.
    pub(crate) fresh: Box<dyn BlockOperator<f64> + 'a>,
}

/// Writes the pressures: `work` gets one of `items` for each block, and what it returns is collected in the order of
/// blocks.
pub(crate) fn write_blocks<T, S: Send, R: Send>(
    operator: &mut (impl BlockOperator<T> + ?Sized),
    items: impl Iterator<Item = S>,
    work: impl Fn(S, &mut [T]) -> R + Sync,
) -> Vec<R> {
    let tasks = Tasks::new(items);
    operator.write(&|i, values| tasks.run(i, |item| work(item, values)));
    tasks.into_results()
}

/// Reads the displacements, in the same way.
pub(crate) fn read_blocks<T, S: Send, R: Send>(
    operator: &(impl BlockOperator<T> + ?Sized),
    items: impl Iterator<Item = S>,
    work: impl Fn(S, &[T]) -> R + Sync,
) -> Vec<R> {
    let tasks = Tasks::new(items);
    operator.read(&|i, values| tasks.run(i, |item| work(item, values)));
    tasks.into_results()
}
