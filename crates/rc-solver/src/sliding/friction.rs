//! Friction of a sliding contact, from its pressure and heights.

use rayon::prelude::*;
use rc_core::{DVec2, Field, Grid, Kernel};
use rc_fft::half_plane_values;

use crate::descent::info::{Friction, GridSolution, SolveInfo, Status};
use crate::sliding::newton::Work;

/// 95 % error of a friction coefficient, for each unit of its difference to that of the displacement, where there is no
/// coarser grid to compare with.
const ALONE: f64 = 5.0;

/// 95 % error of a friction coefficient, for each unit of its change by losses as on a grid twice as fine.
///
/// Elements of uniform pressure have steps, whose waves lose more than those of a smooth pressure. For lags below an
/// element this is an error of the first order in their size, so that twice the change is expected.
const OF_FINER: f64 = 2.5;

/// Sums over waves, per nominal area and in E*.
#[derive(Clone, Copy, Default)]
pub(crate) struct Sums {
    /// -⟨p ∂h⟩ along the velocity and across.
    pub(crate) of_heights: [f64; 2],
    /// -⟨p ∂u⟩ along the velocity.
    pub(crate) of_displacement: f64,
    /// ⟨∂h S⁻¹ ∂h⟩ along the velocity, with the symmetric part S of L.
    pub(crate) slope: f64,
    /// Part of the friction of full contact that elements miss: their symbol is smaller by (q h)²/24.
    pub(crate) missed: f64,
    /// What the loss of waves on this grid has beyond their loss on one twice as fine, times q |p|².
    pub(crate) of_finer: f64,
    /// Maximum of |Im L|/Re L.
    pub(crate) loss_tangent: f64,
}

impl Sums {
    fn plus(self, other: Self) -> Self {
        Self {
            of_heights: std::array::from_fn(|i| self.of_heights[i] + other.of_heights[i]),
            of_displacement: self.of_displacement + other.of_displacement,
            slope: self.slope + other.slope,
            missed: self.missed + other.missed,
            of_finer: self.of_finer + other.of_finer,
            loss_tangent: self.loss_tangent.max(other.loss_tangent),
        }
    }
}

/// Friction coefficient of a pressure, -⟨p ∂h⟩/σ0 along the velocity.
pub(crate) fn coefficient(pressure: &Field, heights: &Field, kernel: &dyn Kernel) -> Option<f64> {
    let sums = sums(pressure, heights, kernel)?;
    Some(sums.of_heights[0] / pressure.mean())
}

/// Friction of `solution`. `None` if nothing slides.
///
/// The force along the velocity is -⟨p ∂h⟩. In contact the slope of the displacement u = L p is that of the heights, so
/// -⟨p ∂u⟩ is the same in the limit of small elements. On a grid the two differ, mostly by more than either is wrong.
pub(crate) fn friction(solution: &GridSolution, heights: &Field, kernel: &dyn Kernel, work: Work) -> Option<Friction> {
    let sums = sums(&solution.pressure, heights, kernel)?;
    Some(finished(
        (&solution.info, solution.status, is_exact(kernel, heights.grid())),
        &sums,
        kernel.sliding_velocity()?,
        work,
    ))
}

/// Whether `kernel` is one of waves, without an error inside contacts.
fn is_exact(kernel: &dyn Kernel, grid: Grid) -> bool {
    kernel.edge_bias(grid).per_difference == 0.0
}

fn sums(pressure: &Field, heights: &Field, kernel: &dyn Kernel) -> Option<Sums> {
    let (velocity, grid) = (kernel.sliding_velocity()?, heights.grid());
    let symbol = kernel.sliding_symbol(grid)?;
    // A kernel of waves has the same loss on all grids.
    let finer = grid.with_elements(2 * grid.nx(), 2 * grid.ny()).ok().filter(|_| !is_exact(kernel, grid));
    let finer =
        finer.and_then(|finer| Some((kernel.symbol(grid), kernel.symbol(finer), kernel.sliding_symbol(finer)?)));
    let along = velocity.normalize_or(DVec2::X);
    let (nx, ny) = (grid.nx() as i64, grid.ny() as i64);
    let waves = |field: &Field| half_plane_values(field, field.mean(), |wave| wave);
    let (pressures, heights) = (waves(pressure), waves(heights));
    let (scale, spacing) = ((grid.len() as f64).powi(-2), grid.spacing());
    let of_wave = |place: usize| -> Sums {
        let (kx, row) = (place as i64 / ny, place as i64 % ny);
        let ky = if 2 * row > ny { row - ny } else { row };
        // A wave of half the elements has no slope at their centres.
        let is_half = [2 * kx == nx, 2 * ky == ny];
        if kx == 0 && ky == 0 {
            return Sums::default();
        }
        let whole = grid.angular_wave(kx, ky);
        let mut q = whole;
        (q.x, q.y) = (if is_half[0] { 0.0 } else { q.x }, if is_half[1] { 0.0 } else { q.y });
        let count = if kx == 0 || is_half[0] { 1.0 } else { 2.0 };
        let (p, h, factor) = (pressures[place], heights[place], symbol(kx, ky));
        let [q, across] = [q.dot(along), q.dot(along.perp())];
        let change = finer.as_ref().map_or(0.0, |(rest, rest_of_finer, finer)| {
            let [x, y] = [kx, ky].map(|k| k.unsigned_abs() as usize);
            factor.im - finer(kx, ky).im * rest(x, y) / rest_of_finer(x, y)
        });
        // -Re(conj(p) i q h) = q Im(conj(p) h)
        let product = (p.conj() * h).im;
        Sums {
            of_heights: [q, across].map(|q| scale * count * q * product),
            of_displacement: scale * count * q * factor.im * p.norm_sqr(),
            slope: scale * count * q * q * h.norm_sqr() / factor.re,
            of_finer: scale * count * q * change * p.norm_sqr(),
            missed: scale * count * q * product * (whole * spacing).length_squared() / 24.0,
            loss_tangent: factor.im.abs() / factor.re,
        }
    };
    let columns: Vec<Sums> = (0..pressures.len() / ny as usize)
        .into_par_iter()
        .map(|kx| (kx * ny as usize..(kx + 1) * ny as usize).map(of_wave).fold(Sums::default(), Sums::plus))
        .collect();
    Some(columns.into_iter().fold(Sums::default(), Sums::plus))
}

/// Friction from sums over a solution of this status.
///
/// `is_exact` says that the kernel has no error inside contacts.
pub(crate) fn finished(
    (info, status, is_exact): (&SolveInfo, Status, bool),
    sums: &Sums,
    velocity: DVec2,
    work: Work,
) -> Friction {
    let load = info.mean_pressure;
    let coefficient = sums.of_heights[0] / load;
    let of_displacement = sums.of_displacement / load;
    // ‖p - p*‖² ≤ G = U (√(G/U))².
    let distance = info.certificate.energy * info.elastic_energy.max(0.0).sqrt();
    let bound = distance * sums.slope.sqrt() / load;
    let iteration = info.iteration_error.powi(2) * coefficient.abs();
    // The coarser grid of a small penetration may have no contact, and then no friction coefficient.
    let of_coarser = info.coarser.and_then(|coarser| coarser.friction).filter(|friction| friction.is_finite());
    let of_grid = match (status, of_coarser) {
        // All waves are there, and only the elements matter.
        (Status::FullContact, _) if is_exact => 0.0,
        (Status::FullContact, _) => sums.missed.abs() / load,
        (_, Some(coarser)) => (coefficient - of_displacement).hypot(coefficient - coarser),
        (_, None) => ALONE * (coefficient - of_displacement).abs(),
    };
    let of_grid = of_grid.hypot(OF_FINER * sums.of_finer / load);
    // Full contact is not iterated.
    let error = if status == Status::FullContact { of_grid } else { of_grid.hypot(iteration) };
    Friction {
        coefficient,
        error,
        bound,
        of_displacement,
        lateral: sums.of_heights[1] / load,
        power: velocity.length() * sums.of_heights[0],
        max_loss_tangent: sums.loss_tangent,
        gmres_iterations: work.gmres_iterations,
        storage_rounds: work.storage_rounds,
    }
}
