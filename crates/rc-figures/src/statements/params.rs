//! What the statements are computed from.

/// What the statements are computed from.
#[derive(Clone, Debug)]
pub struct Params {
    /// Mean pressure σ0/E*.
    pub(super) load: f64,
    /// Relative tolerance of the solves.
    pub(super) tolerance: f64,
    /// Numbers of waves N, elements per shortest wave, and realisations of the area and energy.
    pub(super) waves: Vec<usize>,
    pub(super) elements_per_wave: usize,
    pub(super) seeds: Vec<u64>,
    /// N, and the elements per shortest wave of each mesh, of the convergence.
    pub(super) converged_waves: usize,
    pub(super) meshes: Vec<usize>,
    /// Number of realisations of the heights.
    pub(super) height_seeds: u64,
}
