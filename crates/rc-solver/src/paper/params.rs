//! Parameters of the paper's procedure.

/// Parameters that only the paper's procedure has.
///
/// The tolerance is [`crate::SolveParams::tolerance`]. It applies to the points of collocation: centres of elements in
/// contact, and all points of the finest grid out of contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussSeidelParams {
    /// Number of increments in which the penetration is reached.
    pub increments: usize,
    /// Relaxation factor ω in (0, 2).
    ///
    /// 1 is plain Gauss-Seidel, as in the paper, and needs the smallest number of sweeps. N = 8 on 128² takes 185
    /// sweeps in all with ω = 1, 246 with 1.2 and 536 with 1.6.
    pub relaxation: f64,
    /// Maximum number of sweeps for one contact set.
    pub max_sweeps: usize,
    /// Maximum number of double checks for one increment.
    pub max_checks: usize,
    /// Number of blocks in contact around each coarse element, of the element's size.
    ///
    /// See [`rc_quadtree::paper::MeshParams::ring`].
    pub ring: usize,
    /// Whether all elements in contact have the finest size (after Wriggers).
    ///
    /// `false` gives the paper's mesh.
    pub uniform_elements: bool,
    /// Maximum memory of the tables of coefficients, in bytes.
    ///
    /// Coefficients of element sizes without a table are computed afresh each time.
    pub memory_budget: usize,
    /// Maximum number of coefficients of one sweep.
    ///
    /// The number is the square of the number of elements in contact.
    pub sweep_budget: usize,
}

impl GaussSeidelParams {
    /// The paper's mesh, with at most 1 GiB of tables and 4·10⁸ coefficients a sweep.
    ///
    /// That is enough for 20 000 elements.
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
