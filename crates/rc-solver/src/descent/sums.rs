//! Sums over pressure and gap. They scale the pressure and measure its error.

use crate::descent::layout::BlockLayout;
use crate::problem::bounds::Bounds;
use crate::problem::checked::Problem;
use crate::problem::control::Control;

/// Maximum factor by which a round scales the pressure under penetration control.
const MAXIMUM_SCALING: f64 = 4.0;

/// Sums over elements in contact or at risk.
///
/// The iteration needs them after a change of the pressure.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GapSums {
    /// Σ p
    pub(crate) pressure: f64,
    /// Σ p g
    pub(crate) pressure_gap: f64,
    /// Σ p (h - c), with the constant c of `g = L p - h + c`
    pub(crate) pressure_overlap: f64,
    /// min g
    pub(crate) min_gap: f64,
    /// Σ g over p > 0
    pub(crate) contact_gap: f64,
    /// Σ 1 over p > 0
    pub(crate) n_contact: f64,
    /// max p
    pub(crate) max_pressure: f64,
    /// max g over p > `pressed`
    pub(crate) max_pressed_gap: f64,
    /// Pressure above which elements are well inside contact.
    pub(crate) pressed: f64,
    /// The maximum pressure.
    ///
    /// Of the sums above, elements at this pressure enter only `max_pressure`.
    pub(crate) hardness: f64,
    pub(crate) plastic: PlasticSums,
}

/// Sums over plastic elements, whose pressure is the hardness.
///
/// A plastic element must not have a gap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlasticSums {
    /// Σ 1
    pub(crate) n: f64,
    /// Σ g
    pub(crate) gap: f64,
    /// Σ (h - c)
    pub(crate) overlap: f64,
    /// max g
    pub(crate) max_gap: f64,
}

impl PlasticSums {
    const NONE: Self = Self { n: 0.0, gap: 0.0, overlap: 0.0, max_gap: f64::NEG_INFINITY };

    fn add(&mut self, g: f64, overlap: f64) {
        self.n += 1.0;
        self.gap += g;
        self.overlap += overlap;
        self.max_gap = -smaller(-self.max_gap, -g);
    }

    /// Adds the sums of a block whose elements have this area.
    fn plus(self, block: Self, area: f64) -> Self {
        Self {
            n: self.n + area * block.n,
            gap: self.gap + area * block.gap,
            overlap: self.overlap + area * block.overlap,
            max_gap: -smaller(-self.max_gap, -block.max_gap),
        }
    }
}

/// Part of the maximum pressure above which elements are well inside contact.
///
/// The number below is the part of their largest gap that counts as an overlap.
const PRESSED: f64 = 0.1;
const OPEN: f64 = 0.1;

impl GapSums {
    /// Sums over no elements, with pressures of at most `hardness`.
    ///
    /// The limit `pressed` follows from other sums ([`GapSums::next_pressed`]). If it is infinite, no element is well
    /// inside contact.
    pub(crate) fn empty(pressed: f64, hardness: f64) -> Self {
        Self {
            pressure: 0.0,
            pressure_gap: 0.0,
            pressure_overlap: 0.0,
            min_gap: f64::INFINITY,
            contact_gap: 0.0,
            n_contact: 0.0,
            max_pressure: 0.0,
            max_pressed_gap: f64::NEG_INFINITY,
            pressed,
            hardness,
            plastic: PlasticSums::NONE,
        }
    }

    /// The pressure above which elements of the next sums are well inside contact.
    pub(crate) fn next_pressed(&self) -> f64 {
        PRESSED * self.max_pressure
    }

    pub(crate) fn add_element(&mut self, p: f64, g: f64, overlap: f64) {
        if p > 0.0 {
            if p >= self.hardness {
                self.plastic.add(g, overlap);
                self.max_pressure = self.max_pressure.max(p);
                return;
            }
            self.pressure += p;
            self.pressure_gap += p * g;
            self.pressure_overlap += p * overlap;
            self.contact_gap += g;
            self.n_contact += 1.0;
            self.max_pressure = self.max_pressure.max(p);
            if p > self.pressed {
                self.max_pressed_gap = self.max_pressed_gap.max(g);
            }
        }
        self.min_gap = smaller(self.min_gap, g);
    }

    /// Adds the sums of blocks in their order, weighted by the area of their elements.
    pub(crate) fn total(layout: &BlockLayout, sums: Vec<Self>) -> Self {
        let empty = sums
            .first()
            .map_or(Self::empty(f64::INFINITY, f64::INFINITY), |block| Self::empty(block.pressed, block.hardness));
        let total = layout.ranks().fold(empty.to_values(), |so_far| {
            let first = empty.with_values(so_far);
            sums.into_iter().enumerate().fold(first, |sum, (i, block)| sum.plus(&block, layout.area(i))).to_values()
        });
        empty.with_values(total)
    }

    /// Adds a block whose elements have this area.
    fn plus(self, block: &Self, area: f64) -> Self {
        Self {
            pressure: self.pressure + area * block.pressure,
            pressure_gap: self.pressure_gap + area * block.pressure_gap,
            pressure_overlap: self.pressure_overlap + area * block.pressure_overlap,
            min_gap: smaller(self.min_gap, block.min_gap),
            contact_gap: self.contact_gap + area * block.contact_gap,
            n_contact: self.n_contact + area * block.n_contact,
            max_pressure: self.max_pressure.max(block.max_pressure),
            max_pressed_gap: self.max_pressed_gap.max(block.max_pressed_gap),
            plastic: self.plastic.plus(block.plastic, area),
            ..self
        }
    }

    /// The sums as ranks exchange them.
    fn to_values(self) -> [f64; 12] {
        let Self { pressure, pressure_gap, pressure_overlap, min_gap, contact_gap, n_contact, .. } = self;
        let Self { max_pressure, max_pressed_gap, plastic, .. } = self;
        let PlasticSums { n, gap, overlap, max_gap } = plastic;
        let first = [pressure, pressure_gap, pressure_overlap, min_gap, contact_gap, n_contact];
        let rest = [max_pressure, max_pressed_gap, n, gap, overlap, max_gap];
        std::array::from_fn(|i| if i < 6 { first[i] } else { rest[i - 6] })
    }

    /// These sums from [`GapSums::to_values`].
    fn with_values(self, values: [f64; 12]) -> Self {
        let [pressure, pressure_gap, pressure_overlap, min_gap, contact_gap, n_contact, rest @ ..] = values;
        let [max_pressure, max_pressed_gap, n, gap, overlap, max_gap] = rest;
        Self {
            pressure,
            pressure_gap,
            pressure_overlap,
            min_gap,
            contact_gap,
            n_contact,
            max_pressure,
            max_pressed_gap,
            plastic: PlasticSums { n, gap, overlap, max_gap },
            ..self
        }
    }

    /// Pressure-weighted mean of the gap, over elements that are not plastic. `None` where none of them presses.
    pub(crate) fn mean_gap(&self) -> Option<f64> {
        // NaN is a number here, since it must not pass for nothing.
        (self.pressure > 0.0 || self.pressure.is_nan()).then(|| self.pressure_gap / self.pressure)
    }

    /// The multiplier: the gap of contact, from which gaps and overlaps count.
    ///
    /// It is the mean gap. Where only plastic elements press, any value between their gaps and the gaps of the other
    /// elements is possible. It is zero, the exact value, where the penetration is prescribed and elements are plastic:
    /// no scaling of the pressure could close the mean gap of the other elements there.
    pub(crate) fn multiplier(&self, bounds: Bounds) -> f64 {
        let [inside, outside] = [self.plastic.max_gap, self.min_gap];
        match (bounds.control, self.mean_gap()) {
            (Control::Penetration(_), _) if !self.may_scale() => 0.0,
            (_, Some(mean)) => mean,
            _ if !self.has_plastic() => 0.0,
            _ if outside.is_finite() => 0.5 * (inside + outside),
            _ => inside,
        }
    }

    /// Whether any element is plastic.
    pub(crate) fn has_plastic(&self) -> bool {
        self.plastic.n > 0.0
    }

    /// The part of a sum over pressures that plastic elements add.
    ///
    /// `sum` is their sum without the factor of the pressure.
    fn of_plastic(&self, sum: f64) -> f64 {
        // The hardness may be infinite.
        if self.has_plastic() { self.hardness * sum } else { 0.0 }
    }

    /// Σ p over all elements.
    pub(crate) fn load(&self) -> f64 {
        self.pressure + self.of_plastic(self.plastic.n)
    }

    /// The energy ½⟨p, L p⟩ - ⟨p, h - c⟩, summed over elements.
    pub(crate) fn energy(&self) -> f64 {
        0.5 * (self.pressure_gap - self.pressure_overlap + self.of_plastic(self.plastic.gap - self.plastic.overlap))
    }

    /// Number of elements in contact.
    pub(crate) fn n_in_contact(&self) -> f64 {
        self.n_contact + self.plastic.n
    }

    /// Σ p v
    pub(crate) fn work(&self) -> f64 {
        self.pressure_gap + self.pressure_overlap + self.of_plastic(self.plastic.gap + self.plastic.overlap)
    }

    /// Maximum gap of plastic elements minus the gap of contact, at least 0.
    pub(crate) fn plastic_gap(&self, contact_gap: f64) -> f64 {
        let gap = self.plastic.max_gap - contact_gap;
        // NaN stays.
        if gap < 0.0 { 0.0 } else { gap }
    }

    /// Whether no pressure is the hardness, even after scaling closes the mean gap.
    pub(crate) fn may_scale(&self) -> bool {
        // An infinite hardness allows everything.
        !self.has_plastic() && self.scale_to_no_gap().is_none_or(|scale| scale * self.max_pressure <= self.hardness)
    }

    /// Bound on G divided by the mean pressure, with G = max ⟨g, p - p*⟩.
    ///
    /// The maximum is over possible pressures p* with the mean of p. The bound is the weighted mean of g - min g, with
    /// min g over elements that could press more. Plastic elements below that minimum could press less, which adds
    /// nothing. The others count with the largest gap of them all.
    pub(crate) fn excess(&self) -> f64 {
        let of_elastic = self.mean_gap().unwrap_or(0.0) - self.min_gap;
        if !self.has_plastic() {
            return of_elastic;
        }
        // If everything is plastic, no other pressure of the same mean is possible.
        if self.min_gap == f64::INFINITY {
            return 0.0;
        }
        let of_plastic = self.of_plastic(self.plastic.n) * self.plastic_gap(self.min_gap);
        let of_elastic = if self.pressure > 0.0 { self.pressure * of_elastic } else { 0.0 };
        (of_elastic + of_plastic) / self.load()
    }

    /// The shift of residuals: the mean gap of elements in contact, or zero where the penetration is prescribed.
    ///
    /// The mean is not weighted. With the weighted one, iterations grow by up to a quarter.
    pub(crate) fn zero_gap(&self, bounds: Bounds) -> f64 {
        match bounds.control {
            Control::MeanPressure(_) if self.n_contact > 0.0 => self.contact_gap / self.n_contact,
            Control::MeanPressure(_) if self.has_plastic() => self.multiplier(bounds),
            Control::MeanPressure(_) => self.min_gap,
            Control::Penetration(_) => 0.0,
        }
    }

    /// The factor on the pressure that brings it to the prescribed penetration.
    ///
    /// It makes the weighted mean gap zero, and is limited by [`MAXIMUM_SCALING`]. `None` under load control, and where
    /// the hardness forbids scaling.
    pub(crate) fn scale_to_penetration(&self, problem: &Problem) -> Option<f64> {
        let Control::Penetration(_) = problem.bounds.control else { return None };
        if !self.may_scale() {
            return None;
        }
        self.scale_to_no_gap().map(|scale| scale.clamp(MAXIMUM_SCALING.recip(), MAXIMUM_SCALING))
    }

    /// The factor on the pressure that makes its weighted mean gap zero.
    pub(crate) fn scale_to_no_gap(&self) -> Option<f64> {
        let scale = self.pressure_overlap / self.work();
        (scale.is_finite() && self.work() > 0.0).then_some(scale)
    }

    /// The error of the pressure, in units of the problem's length.
    ///
    /// It is the maximum of the deepest overlap, a tenth of the largest gap well inside contact, and the largest gap of
    /// a plastic element. Under penetration control, the mean gap is one more. The cell has room for `n_cell` elements.
    pub(crate) fn error(&self, problem: &Problem, n_cell: f64) -> f64 {
        let contact = self.multiplier(problem.bounds);
        let length = problem.reference_length(self.work(), self.load(), n_cell);
        // An exact pressure is exact in any unit, even if it is uniform and U is zero.
        let ratio = |overlap: f64| match overlap {
            ..=0.0 => 0.0,
            _ if length > 0.0 => overlap / length,
            // U of a pressure that is only rounding has no meaning.
            _ => f64::NAN,
        };
        let penetration = ratio(contact - self.min_gap);
        // NaN is passed on in the penetration.
        let plastic = ratio(self.plastic_gap(contact));
        let penetration = if penetration.is_nan() || plastic.is_nan() {
            f64::NAN
        } else {
            penetration.max(ratio(OPEN * (self.max_pressed_gap - contact))).max(plastic)
        };
        positive_part(match (problem.bounds.control, self.mean_gap()) {
            // A NaN of the mean gap is in the penetration too.
            (Control::Penetration(_), Some(mean)) if !penetration.is_nan() => penetration.max(ratio(mean.abs())),
            _ => penetration,
        })
    }
}

/// The smaller of two gaps, or NaN if either is NaN.
///
/// `f64::min` would pass over NaN, which would then pass for contact.
fn smaller(a: f64, b: f64) -> f64 {
    if b < a || b.is_nan() { b } else { a }
}

/// The positive part of an error. NaN stays, since it is not a small error.
pub(crate) fn positive_part(error: f64) -> f64 {
    if error < 0.0 { 0.0 } else { error }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_that_is_not_a_number_stays_one_in_every_order() {
        let block = |gaps: [f64; 2]| {
            let mut sums = GapSums::empty(0.0, f64::INFINITY);
            for gap in gaps {
                sums.add_element(0.0, gap, 0.0);
            }
            sums
        };
        let blocks = [[f64::NAN, 1.0], [1.0, f64::NAN], [1.0, 2.0]].map(block);
        assert!(blocks[0].min_gap.is_nan() && blocks[1].min_gap.is_nan() && !blocks[2].min_gap.is_nan());
        for blocks in [[blocks[0], blocks[2]], [blocks[2], blocks[1]]] {
            assert!(GapSums::total(&BlockLayout::of(2), blocks.to_vec()).min_gap.is_nan());
        }
    }
}
