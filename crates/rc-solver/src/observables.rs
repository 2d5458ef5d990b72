//! What users compute from a solution: area, pressure, gap, energy, stiffness.

use rayon::prelude::*;
use rc_core::{Field, Kernel};

use crate::stiffness::contact_stiffness;
use crate::{Solution, Status};

/// Contact area relative to the nominal area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactArea {
    /// Fraction of elements with p > 0. Converges at first order in the element size only, from above.
    pub cells: f64,
    /// Number of edges between elements in and out of contact.
    pub perimeter_edges: usize,
    /// Best estimate: `cells` less c · `perimeter_edges` · (element area), with [`Kernel::perimeter_constant`] as c
    /// (Yastrebov, Anciaux, Molinari, *Tribol. Int.* 114 (2017) 161).
    pub fraction: f64,
    /// Estimated error of `fraction`: a tenth of the perimeter term, which is how far the term was off, at worst, on rough
    /// surfaces with at least eight elements per shortest wave.
    pub error: f64,
}

/// Relative error of the perimeter term.
const PERIMETER_TERM_ERROR: f64 = 0.1;

impl ContactArea {
    /// The contact area of `pressure`; `perimeter_constant` is that of the kernel it was found with.
    #[must_use]
    pub fn of(pressure: &Field, perimeter_constant: f64) -> Self {
        let (nx, ny) = (pressure.grid().nx(), pressure.grid().ny());
        let count_row = |iy: usize| {
            let (row, next) = (pressure.row(iy), pressure.row((iy + 1) % ny));
            let in_contact = row.iter().filter(|&&p| p > 0.0).count();
            let along_y = row.iter().zip(next).filter(|&(&a, &b)| (a > 0.0) != (b > 0.0)).count();
            let along_x = (0..nx).filter(|&ix| (row[ix] > 0.0) != (row[(ix + 1) % nx] > 0.0)).count();
            (in_contact, along_x + along_y)
        };
        let add = |a: (usize, usize), b: (usize, usize)| (a.0 + b.0, a.1 + b.1);
        let (in_contact, perimeter_edges) = (0..ny).into_par_iter().map(count_row).reduce(|| (0, 0), add);
        Self::from_counts(in_contact, perimeter_edges, pressure.grid().len(), perimeter_constant)
    }

    /// From the number of elements in contact and of contact edges, on a grid of `n` elements.
    pub(crate) fn from_counts(in_contact: usize, perimeter_edges: usize, n: usize, perimeter_constant: f64) -> Self {
        let n = n as f64;
        let (cells, perimeter_term) = (in_contact as f64 / n, perimeter_constant * perimeter_edges as f64 / n);
        Self { cells, perimeter_edges, fraction: cells - perimeter_term, error: PERIMETER_TERM_ERROR * perimeter_term }
    }
}

/// Observables of a solution, in units of λ and E*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observables {
    /// Contact area.
    pub area: ContactArea,
    /// Root mean square pressure over the cell.
    pub rms_pressure: f64,
    /// Greatest pressure.
    pub max_pressure: f64,
    /// Mean gap, h_max - mean(h) - Δ.
    pub mean_gap: f64,
    /// Elastic energy per nominal area, ½ mean(p v).
    pub elastic_energy: f64,
    /// Contact stiffness dσ0/dΔ at fixed contact area, to 1e-3 relative; infinite in full contact.
    pub contact_stiffness: f64,
}

impl Observables {
    /// Evaluates the observables of `solution`, which was found with `kernel`. The stiffness takes a few applications of
    /// L, the rest one pass over the fields.
    #[must_use]
    pub fn of(solution: &Solution, kernel: &dyn Kernel) -> Self {
        let info = &solution.info;
        Self {
            area: ContactArea::of(&solution.pressure, kernel.perimeter_constant()),
            rms_pressure: solution.pressure.rms(),
            max_pressure: solution.pressure.max(),
            mean_gap: info.penetration_full_contact - info.penetration,
            elastic_energy: info.elastic_energy,
            contact_stiffness: match solution.status {
                Status::FullContact => f64::INFINITY,
                Status::Converged => contact_stiffness(&solution.pressure, kernel),
            },
        }
    }
}
