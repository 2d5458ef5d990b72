//! Parameters of the paper's procedure.

/// Parameters of the paper's procedure alone. The tolerance is [`crate::SolveParams::tolerance`], evaluated at the
/// points of collocation: centres of elements in contact, and all points of the finest grid out of contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussSeidelParams {
    /// Increments in which the penetration is reached.
    pub increments: usize,
    /// Relaxation factor ω in (0, 2). 1 is plain Gauss-Seidel, as in the paper, and also what needs the fewest sweeps:
    /// N = 8 on 128² takes 185 sweeps in all with ω = 1, 246 with 1.2, 536 with 1.6.
    pub relaxation: f64,
    /// Largest number of sweeps for one contact set.
    pub max_sweeps: usize,
    /// Largest number of double checks for one increment.
    pub max_checks: usize,
    /// Blocks of its own size that a coarse element has around it in contact
    /// ([`rc_quadtree::paper::MeshParams::ring`]).
    pub ring: usize,
    /// `false`: the paper's mesh; `true`: all elements in contact of the finest size (after Wriggers).
    pub uniform_elements: bool,
    /// Bytes that tables of coefficients may take; sizes of elements without a table are computed afresh each time.
    pub memory_budget: usize,
    /// Coefficients that one sweep may need, the square of the number of elements in contact.
    pub sweep_budget: usize,
}

impl GaussSeidelParams {
    /// The paper's mesh, within 1 GiB and 4·10⁸ coefficients (20 000 elements) a sweep.
    #[must_use]
    pub fn paper() -> Self {
        Self {
            increments: 4,
            relaxation: 1.0,
            max_sweeps: 2000,
            max_checks: 100,
            ring: 1,
            uniform_elements: false,
            memory_budget: 1 << 30,
            sweep_budget: 400_000_000,
        }
    }
}
