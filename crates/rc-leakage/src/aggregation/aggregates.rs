//! Aggregates of elements.

/// Mark of an element without a bond, which is not in an aggregate.
pub(super) const ALONE: u32 = u32::MAX;

/// A partition of the elements into aggregates.
#[derive(Debug)]
pub(super) struct Aggregates {
    /// Aggregate of each element, or [`ALONE`].
    pub(super) of: Vec<u32>,
    pub(super) number: usize,
}

impl Aggregates {
    /// Sums of `values` over the members of each aggregate.
    pub(super) fn sums(&self, values: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.number];
        for (value, aggregate) in values.iter().zip(&self.of).filter(|(_, aggregate)| **aggregate != ALONE) {
            sums[*aggregate as usize] += value;
        }
        sums
    }

    /// The members of all aggregates.
    ///
    /// The first list has the index of each aggregate's first member, and at its end the number of members. The second
    /// list has the members.
    pub(super) fn members(&self) -> (Vec<u32>, Vec<u32>) {
        let mut first = vec![0_u32; self.number + 1];
        let together = || self.of.iter().enumerate().filter(|(_, aggregate)| **aggregate != ALONE);
        for (_, aggregate) in together() {
            first[*aggregate as usize + 1] += 1;
        }
        for aggregate in 0..self.number {
            first[aggregate + 1] += first[aggregate];
        }
        let (mut next, mut members) = (first.clone(), vec![0_u32; first[self.number] as usize]);
        for (element, aggregate) in together() {
            let slot = &mut next[*aggregate as usize];
            members[*slot as usize] = element as u32;
            *slot += 1;
        }
        (first, members)
    }
}
