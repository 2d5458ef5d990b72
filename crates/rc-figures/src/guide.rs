//! The pictures of the guide that the paper does not have.
//!
//! They show the mesh, the kernel split, the levels of the operator and the start of a level. The crates of the solver
//! compute them. [`write_all`] draws them, and puts them where the guide has them.

mod levels;
mod mesh;
mod split;
mod start;
mod transfer;

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use rc_plot::{Picture, save_png, save_small_png, save_svg};

use crate::{Preset, repository};

/// Draws every picture of the guide into `folder`.
///
/// At full size they replace the pictures in `docs/images/`.
///
/// # Errors
/// When a picture cannot be computed, or a file cannot be written.
pub fn write_all(preset: Preset, folder: &Path) -> Result<()> {
    let places = Places { preset, folder };
    fs::create_dir_all(folder).with_context(|| format!("could not make {}; give another --out", folder.display()))?;
    places.write("guide-mesh", &mesh::Mesh::compute(&mesh::Params::of(preset)?)?)?;
    places.write("guide-split", &split::Split::compute(preset))?;
    places.write("guide-levels", &levels::Levels::compute(&levels::Params::of(preset)?)?)?;
    places.write("guide-start", &start::Start::compute()?)
}

/// Where the pictures go.
struct Places<'a> {
    preset: Preset,
    folder: &'a Path,
}

impl Places<'_> {
    #[expect(clippy::print_stdout, reason = "the result of the command")]
    fn write(&self, name: &str, picture: &impl Picture) -> Result<()> {
        let [svg, png] = ["svg", "png"].map(|extension| self.folder.join(format!("{name}.{extension}")));
        save_svg(picture, &svg)
            .and_then(|()| save_png(picture, &png))
            .with_context(|| format!("could not draw {}", png.display()))?;
        println!("{}\n{}", svg.display(), png.display());
        if self.preset == Preset::Full {
            let path = repository::root().join("docs/images").join(format!("{name}.png"));
            save_small_png(picture, &path).with_context(|| format!("could not draw {}", path.display()))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quick_pictures_of_the_guide_can_be_drawn() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        write_all(Preset::Quick, folder.path()).expect("four pictures");
        for file in fs::read_dir(folder.path()).expect("the folder") {
            let file = file.expect("a file");
            assert!(file.metadata().expect("its size").len() > 4096, "{}", file.path().display());
        }
        assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), 8);
    }
}
