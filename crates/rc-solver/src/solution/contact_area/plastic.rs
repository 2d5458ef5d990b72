//! The plastic part of the contact, where the pressure is the hardness H.
//!
//! The rest q = H - p is zero there. Beyond the edge of the plastic part, q is the square root of the distance. Inside,
//! the overlap that plastic flow removes grows as the gap does outside a contact. The area where q > 0 is therefore
//! computed like a contact area, with -g as its gap. Its error is estimated in the same way.

use rc_core::{Boundary, EdgeBias, Field, Grid};

use crate::solution::contact_area::area::{ContactArea, around, sums_of_rows};
use crate::solution::contact_area::edge_sums::EdgeSums;

/// The plastic part of a contact with a hardness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlasticContact {
    /// Fraction of elements whose pressure equals the hardness.
    ///
    /// It converges only at first order in the element size.
    pub cells: f64,
    /// Plastic area relative to the nominal area: the best estimate.
    pub fraction: f64,
    /// Estimated error of `fraction`, in the sense of [`ContactArea::error`].
    pub error: f64,
    /// Mean over the cell of the overlap that plastic flow has removed, in λ.
    pub mean_gap: f64,
}

/// Coefficients of wider error bars, here for the contact area.
///
/// Those for its plastic part are below. With the plastic part x of the contact area, the bar of the area is 1 +
/// `WIDER_CONTACT` x² times that of an elastic contact. The bar of the plastic part is a linear function of x times its
/// own. The elastic rim of a plastic contact may be thinner than an element. Its edges are then located less
/// accurately. `docs/other-solids.md` has the measurements.
const WIDER_CONTACT: f64 = 1.8;
const WIDER_PLASTIC: [f64; 2] = [1.2, 3.3];

impl PlasticContact {
    /// The contact `area` and this plastic part, both with the wider bars.
    pub(crate) fn with_wider_bars(self, area: ContactArea) -> (ContactArea, Self) {
        let part = if area.fraction > 0.0 { (self.fraction / area.fraction).clamp(0.0, 1.0) } else { 0.0 };
        let [least, slope] = WIDER_PLASTIC;
        let error = ((least + slope * part) * self.error).min(1.0);
        let wider = (1.0 + WIDER_CONTACT * part.powi(2)) * area.error;
        (ContactArea { error: wider.min(1.0), ..area }, Self { error, ..self })
    }
}

/// The edges of the plastic part of a contact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlasticEdges {
    pub(crate) contact: PlasticContact,
    /// The rest of the cell, as if it were the area of a contact.
    pub(crate) rest: ContactArea,
}

impl PlasticEdges {
    /// The edges from pressure and gap on a uniform grid. The gap is zero in elastic contact.
    pub(crate) fn of([pressure, gap]: [&Field; 2], hardness: f64, bias: EdgeBias, boundary: Boundary) -> Self {
        let grid = pressure.grid();
        let values = [pressure.values(), gap.values()];
        let at = |place: [usize; 2]| {
            let at = around(values, [grid.nx(), grid.ny()], place, boundary);
            move |dx: isize, dy: isize| left(at(dx, dy), hardness)
        };
        let sums = sums_of_rows((grid, boundary), hardness, |i| values[0][i] < hardness, at);
        let pairs = pressure.values().iter().zip(gap.values());
        let flow: f64 = pairs.filter(|(p, _)| **p >= hardness).map(|(_, g)| (-g).max(0.0)).sum();
        Self::from_sums(&[sums], grid, bias, flow / grid.len() as f64)
    }

    /// The edges from sums of q and -g over elements of one size each.
    ///
    /// The sizes are those of [`ContactArea::from_sums`]. Area without an element is in the count of the smallest.
    pub(crate) fn from_sums(sums: &[EdgeSums], finest: Grid, bias: EdgeBias, mean_gap: f64) -> Self {
        let (rest, scatter) = ContactArea::with_scatter(sums, finest, bias);
        let (cells, fraction) = (1.0 - rest.cells, 1.0 - rest.fraction);
        let error = scatter.error(cells - fraction, fraction.max(0.1 * cells));
        Self { contact: PlasticContact { cells, fraction, error, mean_gap }, rest: ContactArea { error, ..rest } }
    }
}

/// The rest q that a pressure leaves to the hardness, and its gap.
pub(crate) fn left([pressure, gap]: [f64; 2], hardness: f64) -> [f64; 2] {
    [hardness - pressure, -gap]
}
