//! L on a uniform grid, by direct summation: the slow reference.

use rc_core::{Boundary, Grid, Kernel, Operator};

/// The operator L (Eq. 4) on a uniform grid, summed product by product.
///
/// The coefficients come from a plain trigonometric sum over the symbol. The work is O(n²), so this is for tests.
pub struct DirectSum {
    grid: Grid,
    boundary: Boundary,
    /// Coefficients of L between element (0, 0) and element (ix, iy).
    coefficients: Vec<f64>,
}

impl std::fmt::Debug for DirectSum {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("DirectSum").field("grid", &self.grid).finish_non_exhaustive()
    }
}

impl DirectSum {
    /// The operator of `kernel` on `grid`.
    #[must_use]
    pub fn new(grid: Grid, kernel: &dyn Kernel) -> Self {
        let (nx, ny) = (grid.nx(), grid.ny());
        if let Some(response) = kernel.free_response(grid) {
            let coefficients = (0..grid.len()).map(|i| response(i % nx, i / nx)).collect();
            return Self { grid, boundary: Boundary::Free, coefficients };
        }
        let symbol = kernel.symbol(grid);
        let uniform = kernel.uniform_displacement().unwrap_or(0.0);
        let turns = |n: usize| (0..n).map(|i| (std::f64::consts::TAU * i as f64 / n as f64).cos()).collect::<Vec<_>>();
        let (cos_x, cos_y) = (turns(nx), turns(ny));
        let coefficient = |ix: usize, iy: usize| {
            let mut sum = uniform;
            for ky in 0..ny {
                for kx in 0..nx {
                    // The symbol is even in kx and in ky, so sines cancel.
                    let wave = cos_x[kx * ix % nx] * cos_y[ky * iy % ny];
                    sum += symbol(kx.min(nx - kx), ky.min(ny - ky)) * wave;
                }
            }
            sum / grid.len() as f64
        };
        let coefficients = (0..grid.len()).map(|i| coefficient(i % nx, i / nx)).collect();
        Self { grid, boundary: Boundary::Periodic, coefficients }
    }

    /// `L_ij` between target `i` and source `j`, indices of elements.
    ///
    /// # Panics
    /// When an index is outside the grid.
    #[must_use]
    pub fn coefficient(&self, i: usize, j: usize) -> f64 {
        let (nx, ny) = (self.grid.nx(), self.grid.ny());
        let (ix, iy, jx, jy) = (i % nx, i / nx, j % nx, j / nx);
        let [dx, dy] = match self.boundary {
            Boundary::Periodic => [(ix + nx - jx) % nx, (iy + ny - jy) % ny],
            Boundary::Free => [ix.abs_diff(jx), iy.abs_diff(jy)],
        };
        self.coefficients[self.grid.index(dx, dy)]
    }
}

impl Operator for DirectSum {
    fn n_elements(&self) -> usize {
        self.grid.len()
    }

    fn scratch_len(&self) -> usize {
        0
    }

    /// `v_i = Σ_j L_ij p_j`, Eq. (4).
    fn apply(&self, pressure: &[f64], displacement: &mut [f64], _scratch: &mut [f64]) {
        assert_eq!(pressure.len(), self.grid.len(), "length of the pressure");
        assert_eq!(displacement.len(), self.grid.len(), "length of the displacement");
        for (i, v) in displacement.iter_mut().enumerate() {
            *v = pressure.iter().enumerate().map(|(j, p)| self.coefficient(i, j) * p).sum();
        }
    }
}
