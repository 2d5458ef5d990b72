//! The two parts of a gap where a hardness limits the pressure.

use rc_core::Field;

/// A part of the gap `v - h` of an element.
///
/// v is the elastic displacement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum GapPart {
    /// The open gap. It is zero where plastic flow has removed an overlap, and where the tolerance has left one.
    Open,
    /// The open one out of contact. It is exactly zero where there is a pressure.
    Free,
    /// The overlap that plastic flow has removed, positive.
    Plastic,
    /// The open one less the plastic one: negative where the overlap was removed.
    Both,
}

impl GapPart {
    /// Whether this part of a contact with this hardness depends on the pressure.
    pub(crate) fn needs_pressure(self, hardness: f64) -> bool {
        hardness.is_finite() || self == Self::Free
    }

    /// This part of `gap` where the pressure is `pressure`, of at most the `hardness`.
    pub(crate) fn of(self, gap: f64, pressure: f64, hardness: f64) -> f64 {
        match (self, pressure >= hardness) {
            (Self::Free, _) if pressure > 0.0 => 0.0,
            (Self::Open | Self::Free, _) => gap.max(0.0),
            (Self::Both, _) => gap,
            (Self::Plastic, true) => (-gap).max(0.0),
            (Self::Plastic, false) => 0.0,
        }
    }

    /// Hands out this part of a gap, row by row.
    ///
    /// The pressure is at most the `hardness`. Stops at the first error.
    pub(crate) fn rows<E>(
        self,
        (gap, pressure): (&Field, &Field),
        hardness: f64,
        mut take: impl FnMut(usize, &[f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        for iy in 0..gap.grid().ny() {
            let pairs = gap.row(iy).iter().zip(pressure.row(iy));
            let values: Vec<f64> = pairs.map(|(g, p)| self.of(*g, *p, hardness)).collect();
            take(iy, &values)?;
        }
        Ok(())
    }
}
