//! The vector work of the iteration on one block.
//!
//! It returns the sums that decide the next step. Functions that write or read the block of an operator pass the
//! vectors through the cache once. Sums are in double precision and in a fixed order: element by element in a block,
//! then block by block. The overlap of the heights with the rigid plane, h - c, is computed first. A constant in the
//! heights, however large, then cancels before anything is added to it.

use crate::descent::sums::GapSums;

/// Heights, pressure and gap of the elements of a block.
pub(crate) struct ElementValues<'a> {
    pub(crate) heights: &'a [f64],
    pub(crate) pressure: &'a mut [f64],
    pub(crate) gap: &'a mut [f64],
}

impl ElementValues<'_> {
    /// Writes `g = L p - h + c` from a fresh `displacement = L p`, where c is `offset`.
    pub(crate) fn fresh_gap(self, displacement: &[f64], offset: f64, mut sums: GapSums) -> GapSums {
        for (((&v, &h), &mut p), g) in displacement.iter().zip(self.heights).zip(self.pressure).zip(self.gap) {
            let overlap = h - offset;
            *g = v - overlap;
            sums.add_element(p, *g, overlap);
        }
        sums
    }

    /// Multiplies the pressure by `scale`. The gap follows, since v is linear in p.
    pub(crate) fn rescale(self, scale: f64, offset: f64, mut sums: GapSums) -> GapSums {
        for ((&h, p), g) in self.heights.iter().zip(self.pressure).zip(self.gap) {
            let overlap = h - offset;
            *p *= scale;
            *g = scale * (*g + overlap) - overlap;
            sums.add_element(*p, *g, overlap);
        }
        sums
    }

    /// Adds the displacement of the pressures that clipping has added, then scales the pressure.
    ///
    /// The displacement is in units of `range`. The factor on the pressure is `scale`.
    pub(crate) fn add_clipped(
        self,
        displacement: &[f32],
        range: f64,
        scale: f64,
        offset: f64,
        mut sums: GapSums,
    ) -> GapSums {
        for (((&v, &h), p), g) in displacement.iter().zip(self.heights).zip(self.pressure).zip(self.gap) {
            let overlap = h - offset;
            *p *= scale;
            *g = scale * (*g + range * f64::from(v) + overlap) - overlap;
            sums.add_element(*p, *g, overlap);
        }
        sums
    }

    /// Writes the residual of the active elements.
    ///
    /// If they are `chosen`, they are those of `active`. Otherwise they are those that press or penetrate. Returns
    /// their number, and the sum of the last `direction` over them.
    pub(crate) fn first_residual(
        self,
        gradient: &Gradient,
        direction: &[f32],
        (active, chosen): (&mut [bool], bool),
        residual: &mut [f32],
    ) -> [f64; 2] {
        let (mut count, mut sum) = (0_u32, 0.0);
        let elements = self.pressure.iter().zip(self.gap.iter()).zip(direction);
        for (((&p, &g), &t), (active, residual)) in elements.zip(active.iter_mut().zip(residual)) {
            let may_leave = if p >= gradient.hardness { gradient.of_gap(g) > 0.0 } else { gradient.of_gap(g) < 0.0 };
            *active = p > 0.0 && p < gradient.hardness || if chosen { *active } else { may_leave };
            *residual = if *active { gradient.residual(g) } else { 0.0 };
            if *active {
                count += 1;
                sum += f64::from(t);
            }
        }
        [f64::from(count), sum]
    }

    /// Takes the step `length` along a direction and writes the residual on the same elements.
    pub(crate) fn next_residual(
        self,
        length: f64,
        step: &ConjugateStep<'_>,
        gradient: &Gradient,
        residual: &mut [f32],
    ) {
        let along = step.direction.iter().zip(step.displacement).zip(step.active);
        for ((p, g), (((&t, &u), &active), residual)) in self.pressure.iter_mut().zip(self.gap).zip(along.zip(residual))
        {
            *p += length * f64::from(t);
            *g += length * f64::from(u);
            *residual = if active { gradient.residual(*g) } else { 0.0 };
        }
    }

    /// Takes the step `length` along a direction, and clips pressures to 0 and to the hardness.
    ///
    /// Writes the pressures that clipping has added, in units of `1 / unit`. Returns the number of pressures that
    /// clipping or joining changed.
    ///
    /// The next active elements are chosen before clipping. They are elements between both bounds, elements outside
    /// that penetrate, and plastic elements with a gap. Those that penetrate get `joining` times their overlap as a
    /// pressure. Plastic elements lose as much.
    pub(crate) fn clip(&mut self, length: f64, joining: f64, step: &mut ClippedStep<'_>, gradient: &Gradient) -> u32 {
        // Two functions are compiled. That for surfaces without a hardness has no comparison with it.
        if gradient.hardness.is_finite() {
            self.clip_to::<true>(length, joining, step, gradient)
        } else {
            self.clip_to::<false>(length, joining, step, gradient)
        }
    }

    fn clip_to<const HARDNESS: bool>(
        &mut self,
        length: f64,
        joining: f64,
        step: &mut ClippedStep<'_>,
        gradient: &Gradient,
    ) -> u32 {
        let ClippedStep { direction, displacement, active, added } = step;
        let hardness = gradient.hardness;
        let within = |p: f64| if HARDNESS { p.max(0.0).min(hardness) } else { p.max(0.0) };
        let mut clipped = 0;
        let along = direction.iter().zip(*displacement).zip(active.iter_mut());
        for ((p, g), (((&t, &u), active), added)) in
            self.pressure.iter_mut().zip(self.gap.iter_mut()).zip(along.zip(added.iter_mut()))
        {
            let stepped = *p + length * f64::from(t);
            *g += length * f64::from(u);
            *p = within(stepped);
            let (gap, is_plastic) = (gradient.of_gap(*g), HARDNESS && stepped >= hardness);
            // If the step did not change an element, it has just become active, and stays so.
            let at_bound = stepped == 0.0 || is_plastic && stepped <= hardness;
            let joins = (!*active || at_bound) && if is_plastic { gap > 0.0 } else { gap < 0.0 };
            if joining > 0.0 && joins && at_bound {
                *p = within(*p - joining * gap);
            }
            *active = stepped > 0.0 && !is_plastic || joins;
            *added = ((*p - stepped) * gradient.unit) as f32;
            clipped += u32::from((*p - stepped).abs() > 0.0);
        }
        clipped
    }
}

/// Multiplies some pressures by `share`, and returns Σ p.
///
/// `written` gets the change of the pressures, in units of `1 / unit`, plus the pressures that clipping has `added`.
pub(crate) fn share(pressure: &mut [f64], share: f64, unit: f64, added: &[f32], written: &mut [f32]) -> f64 {
    let mut sum = 0.0;
    for ((p, added), written) in pressure.iter_mut().zip(added).zip(written) {
        *written = ((share - 1.0) * *p * unit) as f32 + added;
        *p *= share;
        sum += *p;
    }
    sum
}

/// A direction and its displacement for a step that is clipped.
pub(crate) struct ClippedStep<'a> {
    pub(crate) direction: &'a [f32],
    pub(crate) displacement: &'a [f32],
    /// The elements that the step changes, and later the next active elements.
    pub(crate) active: &'a mut [bool],
    /// Room for the pressures that clipping adds.
    pub(crate) added: &'a mut [f32],
}

/// A direction, its displacement, and the elements it changes.
pub(crate) struct ConjugateStep<'a> {
    pub(crate) direction: &'a [f32],
    pub(crate) displacement: &'a [f32],
    pub(crate) active: &'a [bool],
}

impl ConjugateStep<'_> {
    /// Takes the step `length`: updates the residual on active elements, and writes it.
    pub(crate) fn update_residual(&self, length: f32, residual: &mut [f32], written: &mut [f32]) {
        for (((r, &u), &active), written) in residual.iter_mut().zip(self.displacement).zip(self.active).zip(written) {
            *r = if active { *r + length * u } else { 0.0 };
            *written = *r;
        }
    }
}

/// The gradient of the energy: the gap minus the gap of elements in contact.
#[derive(Clone, Copy)]
pub(crate) struct Gradient {
    pub(crate) zero_gap: f64,
    /// Factor on residuals: 1/H.
    pub(crate) unit: f64,
    /// The maximum pressure.
    pub(crate) hardness: f64,
}

impl Gradient {
    pub(crate) fn of_gap(&self, gap: f64) -> f64 {
        gap - self.zero_gap
    }

    fn residual(&self, gap: f64) -> f32 {
        (self.of_gap(gap) * self.unit) as f32
    }
}

/// Sums over the active elements of the preconditioned residual z: Σ z, Σ z u and Σ u.
///
/// u is the displacement of the last direction.
pub(crate) fn sums_of_preconditioned(preconditioned: &[f32], displacement: &[f32], active: &[bool]) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for ((&z, &u), &active) in preconditioned.iter().zip(displacement).zip(active) {
        if active {
            let (z, u) = (f64::from(z), f64::from(u));
            sums[0] += z;
            sums[1] += z * u;
            sums[2] += u;
        }
    }
    sums
}

/// Keeps the displacement u of the direction t.
///
/// Returns Σ t u, Σ t (gradient) and Σ u over the active elements.
pub(crate) fn keep_displacement(
    read: &[f32],
    direction: &[f32],
    gradient: impl Iterator<Item = f64>,
    active: &[bool],
    kept: &mut [f32],
) -> [f64; 3] {
    let mut sums = [0.0; 3];
    kept.copy_from_slice(read);
    for (((&u, &t), gradient), &active) in read.iter().zip(direction).zip(gradient).zip(active) {
        if active {
            let (u, t) = (f64::from(u), f64::from(t));
            sums[0] += t * u;
            sums[1] += gradient * t;
            sums[2] += u;
        }
    }
    sums
}

/// Products with the `direction` d of each pressure: Σ d, Σ d g and Σ d u.
///
/// u is the `displacement` of d.
pub(crate) fn products(
    pressure: &[f64],
    gap: &[f64],
    displacement: &[f32],
    direction: impl Fn(f64) -> f64,
) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for ((&p, g), &u) in pressure.iter().zip(gap).zip(displacement) {
        let d = direction(p);
        sums[0] += d;
        sums[1] += d * g;
        sums[2] += d * f64::from(u);
    }
    sums
}

/// Moves on to the next direction, `t = -z + β t + shift` on the active elements, zero elsewhere.
pub(crate) fn next_direction(
    preconditioned: &[f32],
    [beta, shift]: [f32; 2],
    active: &[bool],
    direction: &mut [f32],
    written: &mut [f32],
) {
    for (((&z, &active), t), written) in preconditioned.iter().zip(active).zip(direction).zip(written) {
        *t = if active { beta * *t - z + shift } else { 0.0 };
        *written = *t;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Five elements after a step of length 1.
    ///
    /// One element stays, one turns tensile, one comes to penetrate, one does not, and one stops penetrating. Returns
    /// pressures, active elements, added pressures, and the number of changes.
    fn clipped(joining: f64, hardness: f64) -> ([f64; 5], [bool; 5], [f32; 5], u32) {
        let (mut pressure, mut gap) = ([2.0, 1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.5, 0.5, -0.5]);
        let (mut active, mut added) = ([true, true, false, false, true], [0.0; 5]);
        let direction = [1.0, -3.0, 0.0, 0.0, 0.0];
        let displacement = [0.0, 0.25, -1.0, 0.25, 1.0];
        let mut step =
            ClippedStep { direction: &direction, displacement: &displacement, active: &mut active, added: &mut added };
        let mut elements = ElementValues { heights: &[0.0; 5], pressure: &mut pressure, gap: &mut gap };
        let changed = elements.clip(1.0, joining, &mut step, &Gradient { zero_gap: 0.0, unit: 1.0, hardness });
        (pressure, active, added, changed)
    }

    #[test]
    fn what_joins_the_contact_gets_a_pressure_in_proportion_to_its_overlap() {
        let (pressure, active, added, changed) = clipped(0.0, f64::INFINITY);
        assert_eq!((pressure, active), ([3.0, 0.0, 0.0, 0.0, 0.0], [true, false, true, false, false]));
        assert_eq!((added, changed), ([0.0, 2.0, 0.0, 0.0, 0.0], 1));
        let (pressure, active, added, changed) = clipped(4.0, f64::INFINITY);
        assert_eq!((pressure, active), ([3.0, 0.0, 2.0, 0.0, 0.0], [true, false, true, false, false]));
        assert_eq!((added, changed), ([0.0, 2.0, 2.0, 0.0, 0.0], 2));
    }

    #[test]
    fn a_share_of_the_load_is_written_as_a_change_of_the_pressures() {
        let (mut pressure, mut written) = ([1.0, 2.0, 0.0], [0.0; 3]);
        let sum = share(&mut pressure, 0.75, 4.0, &[0.5, 0.0, 1.0], &mut written);
        // What is written is four times the changes -0.25, -0.5 and 0, plus what clipping has added.
        assert_eq!((pressure, sum, written), ([0.75, 1.5, 0.0], 2.25, [-0.5, -2.0, 1.0]));
    }
}
