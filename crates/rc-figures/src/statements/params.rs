//! Parameters of the statements.

/// Parameters of all statements.
#[derive(Clone, Debug)]
pub struct Params {
    /// Mean pressure σ0/E*.
    pub(super) load: f64,
    /// Relative tolerance of the solves.
    pub(super) tolerance: f64,
    /// Numbers of waves N for area and energy. Elements per shortest wave and the realisations follow.
    pub(super) waves: Vec<usize>,
    pub(super) elements_per_wave: usize,
    pub(super) seeds: Vec<u64>,
    /// Number of waves N for the convergence. The elements per shortest wave of each mesh follow.
    pub(super) converged_waves: usize,
    pub(super) meshes: Vec<usize>,
    /// Number of realisations of the heights.
    pub(super) height_seeds: u64,
}
