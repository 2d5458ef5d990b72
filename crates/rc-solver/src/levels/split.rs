//! A quick check, before a solve, that a kernel and its split by scale are one solid.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use rc_core::{DVec2, Grid, Kernel, Sliding, SlidingModes, SplitByScale};
use rc_kernel::{FreeLove, Love};

use crate::problem::contract::{FEWEST_WAVES, places};
use crate::problem::error::ProblemError;
use crate::tiles::solid::largest_unresolved;

/// Relative difference that quadrature may leave between a symbol and that of its split.
const DIFFERENCE: f64 = 1e-8;

/// Refuses a `split` that is not of the solid of its `kernel`, or whose bounds do not hold.
///
/// The symbols on `grid` are compared, or the responses where borders are free. The longest waves and a sample of each
/// octave are checked. Aliases of the deviation are left out, because the base grid resolves it.
pub(crate) fn check_split(kernel: &dyn Kernel, split: &dyn SplitByScale, grid: Grid) -> Result<(), ProblemError> {
    let check = Check::new(kernel, split, grid);
    if let (Some(own), Some(of_split)) = (kernel.free_response(grid), FreeLove.free_response(grid)) {
        let mut distances = octaves([grid.nx(), grid.ny()]);
        return distances.try_for_each(|at| check.same("free response", at, own(at.0, at.1), of_split(at.0, at.1)));
    }
    let (own, half_space) = (kernel.symbol(grid), Love.symbol(grid));
    let waves = octaves([grid.nx() / 2 + 1, grid.ny() / 2 + 1]);
    waves.filter(|&wave| wave != (0, 0)).try_for_each(|wave| {
        let deviation = check.deviation(wave)?;
        check.same("symbol", wave, own(wave.0, wave.1), half_space(wave.0, wave.1) + deviation)
    })
}

/// Refuses `modes` that are not those of the symbol of their kernel under a sliding surface.
///
/// The symbols on `grid` are compared, as those of the solid at rest are.
pub(crate) fn check_modes(
    kernel: &dyn Kernel,
    split: &dyn SplitByScale,
    modes: &SlidingModes,
    grid: Grid,
) -> Result<(), ProblemError> {
    let (check, compliance) = (Check::new(kernel, split, grid), modes.compliance.clone());
    let sliding = Sliding::new(DVec2::X, Arc::new(move |q| compliance.at(q)));
    let (Some(own), half_space) = (kernel.sliding_symbol(grid), Love.symbol_while(&sliding, grid)) else {
        return Ok(());
    };
    let waves = octaves([grid.nx() / 2 + 1, grid.ny() / 2 + 1]);
    waves.filter(|&wave| wave != (0, 0)).try_for_each(|wave| {
        let (kx, ky) = (wave.0 as i64, wave.1 as i64);
        let deviation = check.deviation(wave)? * sliding.compliance(grid.angular_wave(kx, ky));
        let (own, of_split) = (own(kx, ky), half_space(kx, ky) + deviation);
        let is_same = (of_split - own).norm() <= DIFFERENCE * own.norm();
        let fault =
            || check.fault("symbol under a sliding surface", wave, of_split.re, (own.re, ", as the kernel's own"));
        if is_same { Ok(()) } else { Err(fault()) }
    })
}

/// As many waves or distances of each half, quarter, ... of these.
///
/// A sample of all has hardly any of the long waves, at which solids differ.
fn octaves([columns, rows]: [usize; 2]) -> impl Iterator<Item = (usize, usize)> {
    let halvings = 0..=columns.max(rows).ilog2();
    halvings.flat_map(move |n| places([columns, rows].map(|side| (side >> n).max(1)), FEWEST_WAVES))
}

/// A split that is checked.
struct Check<'a> {
    kernel: &'static str,
    split: &'a dyn SplitByScale,
    /// Bound of the curvature, and the wave from which on deviations are not resolved.
    curvature: f64,
    below: f64,
    grid: Grid,
}

impl<'a> Check<'a> {
    fn new(kernel: &dyn Kernel, split: &'a dyn SplitByScale, grid: Grid) -> Self {
        let (curvature, below) = (split.curvature(), split.deviates_below(largest_unresolved()));
        Self { kernel: kernel.name(), split, curvature, below, grid }
    }

    /// The deviation of the symbol at a wave. Refuses bounds that it exceeds.
    fn deviation(&self, (kx, ky): (usize, usize)) -> Result<f64, ProblemError> {
        let q = TAU * self.grid.waves(kx, ky);
        let Self { curvature, below, .. } = *self;
        let deviation = self.split.deviation(q);
        // The pressure (1 + cos q x)/2 has this second derivative.
        let of_wave = 0.5 * q * q * deviation.abs();
        let is_bounded = of_wave <= curvature;
        if !is_bounded {
            return Err(self.fault("curvature", (kx, ky), curvature, (of_wave, " or more")));
        }
        let is_announced = below >= q || 0.5 * q * deviation.abs() <= largest_unresolved();
        if !is_announced {
            return Err(self.fault("wavenumber of the shortest deviation", (kx, ky), below, (q, " or more")));
        }
        // The pressure of a wave is its mean over each element.
        let mean = |k: usize, n: usize| sinc(PI * k as f64 / n as f64);
        Ok(deviation * mean(kx, self.grid.nx()) * mean(ky, self.grid.ny()))
    }

    /// Refuses a value of the split that is not the kernel's own.
    fn same(&self, what: &'static str, at: (usize, usize), own: f64, of_split: f64) -> Result<(), ProblemError> {
        let is_same = (of_split - own).abs() <= DIFFERENCE * own.abs();
        if is_same { Ok(()) } else { Err(self.fault(what, at, of_split, (own, ", as the kernel's own"))) }
    }

    fn fault(
        &self,
        what: &'static str,
        (kx, ky): (usize, usize),
        value: f64,
        (wanted, relation): (f64, &'static str),
    ) -> ProblemError {
        let Self { kernel, grid, .. } = *self;
        ProblemError::Split { kernel, grid, what, kx, ky, value, wanted, relation }
    }
}

fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sin() / x }
}

#[cfg(test)]
mod tests {
    use rc_kernel::{Relaxation, Viscoelastic};

    use super::*;

    /// Love's squares of a material, with the modes of another velocity.
    struct OtherModes(Viscoelastic<Love>, Viscoelastic<Love>);

    impl Kernel for OtherModes {
        fn name(&self) -> &'static str {
            "other modes"
        }

        fn symbol(&self, grid: Grid) -> rc_core::Symbol<'_> {
            self.0.symbol(grid)
        }

        fn sliding_symbol(&self, grid: Grid) -> Option<rc_core::ComplexSymbol<'_>> {
            self.0.sliding_symbol(grid)
        }

        fn sliding_modes(&self) -> Option<SlidingModes> {
            self.1.sliding_modes()
        }
    }

    #[test]
    fn modes_of_another_velocity_are_found() {
        let rubber = Relaxation::single(10.0, 0.1).expect("a material");
        let at = |velocity: f64| Viscoelastic::new(Love, &rubber, velocity * DVec2::X);
        let check = |kernel: &OtherModes| {
            let (modes, grid) = (kernel.sliding_modes().expect("modes"), Grid::square(64).expect("a grid"));
            check_modes(kernel, &rc_kernel::HalfSpace, &modes, grid)
        };
        check(&OtherModes(at(0.1), at(0.1))).expect("its own");
        assert!(check(&OtherModes(at(0.1), at(-0.1))).is_err() && check(&OtherModes(at(0.1), at(0.10001))).is_err());
    }

    /// A split that deviates at waves of one length only, as its kernel does not.
    struct OneLength(f64);

    impl SplitByScale for OneLength {
        fn deviation(&self, q: f64) -> f64 {
            if (q / (TAU * self.0) - 1.0).abs() < 1e-9 { 1e-3 } else { 0.0 }
        }

        fn deviates_below(&self, _tolerance: f64) -> f64 {
            2.0 * TAU * self.0
        }

        fn curvature(&self) -> f64 {
            f64::MAX
        }
    }

    #[test]
    fn a_deviation_of_long_waves_is_found_on_a_large_grid() {
        let grid = Grid::square(4096).expect("a grid");
        check_split(&Love, &rc_kernel::HalfSpace, grid).expect("its own");
        for waves in 1..=15 {
            assert!(check_split(&Love, &OneLength(f64::from(waves)), grid).is_err(), "{waves} waves");
        }
    }
}
