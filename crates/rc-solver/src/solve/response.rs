//! What a solution on a grid needs of its half-space after the solve. It may outlive the caller's.

use rc_core::{EdgeBias, Field, Grid, Kernel, Operator, Symbol};

use crate::operator::{UniformOperator, stiffness_with_operator};
use crate::solution::GridSolution;
use crate::stiffness::contact_stiffness;

/// The half-space that a solution on a grid was found with.
pub(super) enum Response<'a> {
    /// A kernel.
    Kernel(KernelOfGrid<'a>),
    /// The caller's operator.
    Operator(&'a dyn Operator),
    /// An operator that the solution has outlived, and what it was needed for.
    Outlived {
        /// dσ0/dΔ, in E*/λ.
        stiffness: f64,
        /// v = L p, in λ.
        displacement: Field,
    },
}

impl Response<'_> {
    /// The half-space without a borrow, for one solution. What an operator is needed for is computed now.
    pub(super) fn into_owned(self, solution: &GridSolution) -> Response<'static> {
        match self {
            Self::Kernel(kernel) => Response::Kernel(kernel.into_owned(solution.pressure.grid())),
            Self::Operator(_) => Response::Outlived {
                // Operators have no hardness.
                stiffness: self.stiffness(solution, f64::INFINITY),
                displacement: self.displacement(&solution.pressure),
            },
            Self::Outlived { stiffness, displacement } => Response::Outlived { stiffness, displacement },
        }
    }

    /// The shift of contact edges; for an operator the default one.
    pub(super) fn edge_bias(&self) -> EdgeBias {
        match self {
            Self::Kernel(kernel) => kernel.edge_bias(),
            Self::Operator(_) | Self::Outlived { .. } => EdgeBias::default(),
        }
    }

    /// dσ0/dΔ under the contact of `solution`, in E*/λ.
    pub(super) fn stiffness(&self, solution: &GridSolution, hardness: f64) -> f64 {
        match self {
            Self::Kernel(kernel) => contact_stiffness(&solution.pressure, hardness, kernel),
            Self::Operator(operator) => stiffness_with_operator(&solution.pressure, *operator),
            Self::Outlived { stiffness, .. } => *stiffness,
        }
    }

    /// v = L p, in λ.
    pub(super) fn displacement(&self, pressure: &Field) -> Field {
        let apply = |operator: &dyn Operator| {
            let (mut displacement, mut scratch) = (Field::zeros(pressure.grid()), vec![0.0; operator.scratch_len()]);
            operator.apply(pressure.values(), displacement.values_mut(), &mut scratch);
            displacement
        };
        match self {
            Self::Kernel(kernel) => apply(&UniformOperator::new(pressure.grid(), kernel)),
            Self::Operator(operator) => apply(*operator),
            Self::Outlived { displacement, .. } => displacement.clone(),
        }
    }
}

/// The kernel that a solution on a uniform grid was found with.
pub(super) enum KernelOfGrid<'a> {
    /// The caller's.
    Borrowed(&'a dyn Kernel),
    /// Its symbol on the grid of the solution.
    Tabulated(TabulatedKernel),
}

/// A kernel that is known on one grid.
pub(super) struct TabulatedKernel {
    name: &'static str,
    bias: EdgeBias,
    grid: Grid,
    /// Eigenvalues for 0 ≤ kx ≤ nx/2, then 0 ≤ ky ≤ ny/2, columns of constant kx contiguous.
    values: Vec<f64>,
}

impl KernelOfGrid<'_> {
    /// The kernel without a borrow, for `grid` alone.
    pub(super) fn into_owned(self, grid: Grid) -> KernelOfGrid<'static> {
        KernelOfGrid::Tabulated(match self {
            Self::Borrowed(kernel) => TabulatedKernel::new(kernel, grid),
            Self::Tabulated(kernel) => kernel,
        })
    }

    fn get(&self) -> &dyn Kernel {
        match self {
            Self::Borrowed(kernel) => *kernel,
            Self::Tabulated(kernel) => kernel,
        }
    }
}

impl TabulatedKernel {
    fn new(kernel: &dyn Kernel, grid: Grid) -> Self {
        let symbol = kernel.symbol(grid);
        let columns = 0..=grid.nx() / 2;
        let values = columns.flat_map(|kx| (0..=grid.ny() / 2).map(move |ky| (kx, ky))).map(|(kx, ky)| symbol(kx, ky));
        Self { name: kernel.name(), bias: kernel.edge_bias(), grid, values: values.collect() }
    }
}

impl Kernel for TabulatedKernel {
    fn name(&self) -> &'static str {
        self.name
    }

    fn symbol(&self, grid: Grid) -> Symbol<'_> {
        assert_eq!(grid, self.grid, "a tabulated kernel is asked for the grid of its solution only");
        Box::new(|kx, ky| self.values[kx * (self.grid.ny() / 2 + 1) + ky])
    }

    fn edge_bias(&self) -> EdgeBias {
        self.bias
    }
}

impl Kernel for KernelOfGrid<'_> {
    fn name(&self) -> &'static str {
        self.get().name()
    }

    fn symbol(&self, grid: Grid) -> Symbol<'_> {
        self.get().symbol(grid)
    }

    fn edge_bias(&self) -> EdgeBias {
        self.get().edge_bias()
    }
}
