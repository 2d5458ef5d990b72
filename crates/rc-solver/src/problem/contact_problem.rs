//! A contact problem: heights, half-space and load.

use std::sync::Arc;

use rc_comm::Ranks;
use rc_core::{Boundary, HeightSource, Kernel};
use rc_kernel::Love;

use crate::problem::bounds::Bounds;
use crate::problem::checkpoint::Checkpoint;
use crate::problem::control::Control;
use crate::problem::kernel::OwnedKernel;
use crate::problem::support::Support;

/// A contact problem: heights, half-space and load.
///
/// ```
/// use rc_core::{Field, Grid};
/// use rc_kernel::Spectral;
/// use rc_solver::{ContactProblem, Control, Method, SolveParams};
///
/// // Westergaard's wave at a quarter of the load of full contact, with a kernel other than the default.
/// let wave = Field::from_fn(Grid::square(64)?, |at| 1e-3 * (std::f64::consts::TAU * at.x).cos());
/// let load = Control::MeanPressure(0.25 * std::f64::consts::PI * 1e-3);
/// let plan = ContactProblem::new(&wave, load).with_kernel(&Spectral).plan(&SolveParams::default())?;
/// assert_eq!(plan.method(), Method::Uniform);
/// let solution = plan.solve(&rc_core::Silent)?;
/// assert!((solution.area().fraction - 1.0 / 3.0).abs() < 0.02);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct ContactProblem<'a> {
    pub(crate) heights: HeightSource<'a>,
    pub(crate) kernel: OwnedKernel<'a>,
    pub(crate) control: Control,
    pub(crate) hardness: f64,
    /// Ranks that share the problem.
    pub(crate) ranks: Ranks,
    /// Storage for the start of each level, if a solve is to be continued.
    pub(crate) checkpoint: Option<Arc<dyn Checkpoint>>,
}

impl<'a> ContactProblem<'a> {
    /// The contact of `heights` (in λ) with the elastic half-space under a load.
    ///
    /// The kernel is [`Love`].
    #[must_use]
    pub fn new(heights: impl Into<HeightSource<'a>>, control: Control) -> Self {
        let (kernel, ranks) = (OwnedKernel::Borrowed(&Love), Ranks::alone());
        Self { heights: heights.into(), kernel, control, hardness: f64::INFINITY, ranks, checkpoint: None }
    }

    /// The same problem with a maximum pressure, the hardness (in E*).
    ///
    /// It is the usual first model of plastic contact. Where the pressure equals the hardness, plastic flow removes the
    /// overlap of the surfaces ([`crate::Solution::plastic_gap`]).
    ///
    /// ```
    /// use rc_core::{Field, Grid};
    /// use rc_solver::{ContactProblem, Control, SolveParams};
    ///
    /// // Half of Westergaard's wave touches when the contact is elastic.
    /// // The mean pressure in contact is then twice the load.
    /// let wave = Field::from_fn(Grid::square(128)?, |at| 1e-3 * (std::f64::consts::TAU * at.x).cos());
    /// let load = 0.5e-3 * std::f64::consts::PI;
    /// let problem = ContactProblem::new(&wave, Control::MeanPressure(load)).with_hardness(2.5 * load);
    /// let solution = problem.solve(&SolveParams::default(), &rc_core::Silent)?;
    /// assert!(solution.pressure().max() <= 2.5 * load);
    /// assert!(solution.area().fraction > 0.5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_hardness(self, hardness: f64) -> Self {
        Self { hardness, ..self }
    }

    /// What is beyond the heights.
    pub(crate) fn boundary(&self) -> Boundary {
        Support::of(self.kernel.get(), self.heights.grid()).boundary
    }

    /// Whether several ranks share the problem.
    pub(crate) fn is_shared(&self) -> bool {
        self.ranks.size() > 1
    }

    pub(crate) fn bounds(&self) -> Bounds {
        Bounds { control: self.control, hardness: self.hardness }
    }

    /// The same problem with another elastic solid or another discretisation.
    #[must_use]
    pub fn with_kernel(self, kernel: &'a dyn Kernel) -> Self {
        Self { kernel: OwnedKernel::Borrowed(kernel), ..self }
    }

    /// The same problem with a kernel that its plans and solutions share.
    ///
    /// None of them borrows the kernel.
    #[must_use]
    pub fn with_shared_kernel(self, kernel: Arc<dyn Kernel + Send + Sync>) -> Self {
        Self { kernel: OwnedKernel::Shared(kernel), ..self }
    }

    /// The same problem, solved jointly by several ranks (threads or MPI processes).
    ///
    /// Each rank has a part of the mesh. All ranks call the same functions in the same order, including those of the
    /// solution. Only the adaptive method works over ranks, without a border level and without a hardness. Along both
    /// sides, the grid must have 2^k times the elements of its base grid. Results are bitwise the same for any number
    /// of ranks.
    ///
    /// ```
    /// use rc_comm::run_threads;
    /// use rc_core::{Field, Grid, Silent};
    /// use rc_solver::{ContactProblem, Control, Method, SolveParams};
    ///
    /// let wave = Field::from_fn(Grid::square(256)?, |at| 1e-3 * (std::f64::consts::TAU * at.x).cos());
    /// let params = SolveParams::default().by(Method::Adaptive);
    /// let area = |ranks| {
    ///     let problem = ContactProblem::new(&wave, Control::MeanPressure(2e-4)).over(ranks);
    ///     problem.solve(&params, &Silent).map(|solution| solution.area().fraction)
    /// };
    /// let alone = area(rc_comm::Ranks::alone())?;
    /// for of_rank in run_threads(2, area)? {
    ///     assert_eq!(of_rank?.to_bits(), alone.to_bits());
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn over(self, ranks: Ranks) -> Self {
        Self { ranks, ..self }
    }

    /// The same problem with a checkpoint.
    ///
    /// The adaptive method solves a coarse base grid first, and then finer levels (meshes of tiles near contacts).
    /// After the base grid and after each level except the finest, it stores the start values of the next level.
    /// Another solve of the same problem continues from the values stored last. It may have any number of ranks, and
    /// its results are bitwise the same. The caller ensures that no other problem uses the checkpoint. The other
    /// methods, and the adaptive method with a border level, store nothing.
    #[must_use]
    pub fn kept_in(self, checkpoint: Arc<dyn Checkpoint>) -> Self {
        Self { checkpoint: Some(checkpoint), ..self }
    }
}

impl std::fmt::Debug for ContactProblem<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut out = f.debug_struct("ContactProblem");
        out.field("heights", &self.heights)
            .field("kernel", &self.kernel.get().name())
            .field("control", &self.control)
            .field("hardness", &self.hardness)
            .field("ranks", &self.ranks)
            .finish()
    }
}
