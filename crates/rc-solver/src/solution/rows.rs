//! The rows of a field, which are handed out one after the other.

use rc_comm::Ranks;

/// The receiver of the rows of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Receiver {
    /// Rank 0 gets all rows. Without other ranks it is the only one.
    First,
    /// Each rank gets some rows that follow each other.
    Each,
}

/// The rows of a field that are handed out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rows {
    /// Whether they are rows of the grid of the smallest elements. Ranks do not share these.
    pub(crate) finest: bool,
    pub(crate) receiver: Receiver,
}

impl Rows {
    /// Rows of the grid on which the solution is a mean.
    pub(crate) fn on_grid(receiver: Receiver) -> Self {
        Self { finest: false, receiver }
    }

    /// Rows of the grid of the smallest elements.
    pub(crate) fn finest() -> Self {
        Self { finest: true, receiver: Receiver::First }
    }
}

/// The end of a field before its last row, at the wish of the receiver.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Halted;

/// What gets the rows: one or more consecutive rows in one slice, and the index of the first of them.
pub(crate) type TakeRows<'t> = &'t mut dyn FnMut(usize, &[f64]) -> Result<(), Halted>;

/// Hands rows to `take`, which may fail with an error of its own. It gets no more rows then.
pub(crate) fn hand_out<E>(
    ranks: &Ranks,
    mut take: impl FnMut(usize, &[f64]) -> Result<(), E>,
    rows: impl FnOnce(TakeRows<'_>) -> Result<(), Halted>,
) -> Result<(), E> {
    let mut taken = Ok(());
    let _ = rows(&mut |first, rows| {
        if taken.is_ok() {
            taken = take(first, rows);
        }
        // Other ranks hand out the rest all the same.
        if taken.is_ok() || ranks.size() > 1 { Ok(()) } else { Err(Halted) }
    });
    taken
}
