//! The methods.

use std::fmt;

/// How a contact problem is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Method {
    /// Preconditioned conjugate gradients on elements near contact only.
    ///
    /// Work and memory grow with the contact area, not with the area of the cell.
    Adaptive,
    /// Preconditioned conjugate gradients on all elements of the grid.
    Uniform,
    /// The procedure of the paper (Sec. 2): Gauss-Seidel on an adaptive mesh.
    ///
    /// Its work and memory are those of a dense matrix.
    GaussSeidel,
}

impl Method {
    /// Name as in scene files and summaries: `adaptive`, `uniform`, `gauss-seidel`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Adaptive => "adaptive",
            Self::Uniform => "uniform",
            Self::GaussSeidel => "gauss-seidel",
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
