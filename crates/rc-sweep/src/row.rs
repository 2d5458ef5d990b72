//! The interface that rows of sweeps and of ensembles share.

/// One load on one surface.
pub trait Row: Sync {
    /// Pressure (Pa) or penetration (m).
    fn load(&self) -> f64;

    /// Number of the surface, if other rows share it. Rows with the same number have the same surface.
    fn shared_surface(&self) -> Option<usize>;
}
