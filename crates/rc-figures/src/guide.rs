//! The figures of the guide that the paper does not have.
//!
//! They show the mesh, the kernel split, the levels of the operator and the start of a level. The crates of the solver
//! compute them. [`write_all`] writes them, and puts the pictures where the guide has them.

mod levels;
mod mesh;
mod split;
mod start;
mod transfer;

use std::path::Path;

use anyhow::{Context, Result};
use rc_plot::save_small_png;

pub use levels::Levels;
pub use mesh::Mesh;
pub use split::Split;
pub use start::Start;

use crate::figure::{report, write};
use crate::{Figure, Preset, repository};

/// Computes every figure of the guide and writes it into `folder`.
///
/// At full size it replaces the pictures in `docs/images/`.
///
/// # Errors
/// When a figure cannot be computed, or a file cannot be written.
pub fn write_all(preset: Preset, folder: &Path) -> Result<()> {
    write_one::<Mesh>(preset, folder)?;
    write_one::<Split>(preset, folder)?;
    write_one::<Levels>(preset, folder)?;
    write_one::<Start>(preset, folder)
}

fn write_one<F: Figure>(preset: Preset, folder: &Path) -> Result<()> {
    let figure = F::compute(&F::params(preset)?).with_context(|| F::NAME)?;
    report(&figure, &write(&figure, folder)?);
    if preset == Preset::Full {
        let path = repository::root().join("docs/images").join(format!("{}.png", F::NAME));
        save_small_png(&figure, &path).with_context(|| format!("could not draw {}", path.display()))?;
    }
    Ok(())
}
