//! The interface between an iteration and its mesh.
//!
//! It applies L and its approximate inverse to vectors.

use crate::descent::layout::BlockLayout;
use crate::parallel::Tasks;

/// L on the vectors of one mesh, in values of type `T`.
///
/// Vectors pass block by block, so that the caller's vector work is done while a block is in cache. The caller writes
/// the pressures, L is applied, and the caller reads the displacements. [`write_blocks`] and [`read_blocks`] give each
/// block its part of the caller's own vectors.
pub(crate) trait BlockOperator<T> {
    /// The division of vectors into blocks.
    fn layout(&self) -> BlockLayout;

    /// Calls `write` once for each block, with its index and the pressures to fill in.
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
    /// Whether the inverse extends residuals between contacts.
    fn extends(&self) -> bool {
        true
    }

    /// Whether rounds keep their number of steps, and may raise the energy for a while.
    ///
    /// On profiles, steps in long waves make many elements touch that the next step parts again. Rounds of single
    /// steps, or of parts of steps, then hardly change the contact.
    fn keeps_steps(&self) -> bool {
        false
    }

    /// Sets the elements that the approximate inverse is for from now on.
    fn set_active(&mut self, active: &[bool]);

    /// Applies the approximate inverse of L among the `active` elements, which were set before.
    ///
    /// `values` are displacements that are zero elsewhere. They become pressures on the active elements. Elsewhere they
    /// may be anything.
    fn precondition(&mut self, active: &[bool], values: &mut [f32]);

    /// Sets the eigenvalue of the approximate inverse for constant vectors.
    fn set_mean(&mut self, eigenvalue: f64);
}

/// L on one level, in two precisions.
pub(crate) struct LevelOperators<'a> {
    /// Operator for corrections, in single precision.
    pub(crate) corrections: Box<dyn PreconditionedOperator + 'a>,
    /// Operator for fresh gaps, in double precision.
    pub(crate) fresh: Box<dyn BlockOperator<f64> + 'a>,
}

/// Writes the pressures. `work` gets one of `items` for each block.
///
/// Returns its results in the order of blocks.
pub(crate) fn write_blocks<T, S: Send, R: Send>(
    operator: &mut (impl BlockOperator<T> + ?Sized),
    items: impl Iterator<Item = S>,
    work: impl Fn(S, &mut [T]) -> R + Sync,
) -> Vec<R> {
    let tasks = Tasks::new(items);
    operator.write(&|i, values| tasks.run(i, |item| work(item, values)));
    tasks.into_results()
}

/// Reads the displacements. `work` gets one of `items` for each block.
///
/// Returns its results in the order of blocks.
pub(crate) fn read_blocks<T, S: Send, R: Send>(
    operator: &(impl BlockOperator<T> + ?Sized),
    items: impl Iterator<Item = S>,
    work: impl Fn(S, &[T]) -> R + Sync,
) -> Vec<R> {
    let tasks = Tasks::new(items);
    operator.read(&|i, values| tasks.run(i, |item| work(item, values)));
    tasks.into_results()
}
