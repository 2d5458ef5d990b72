//! The interface of all figures: numbers first, then a picture of these numbers.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use rc_plot::{Picture, save_png, save_svg};

use crate::Table;

/// Size of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preset {
    /// The size that the paper's statement needs. It takes minutes at most.
    Full,
    /// A small version of the same, which the tests run in seconds.
    Quick,
}

/// A figure: plain data with tables and a drawing ([`Picture`]).
///
/// All functions are pure; `write` does the files.
pub trait Figure: Picture + Sized {
    /// Name of the files, as in the paper.
    const NAME: &'static str;
    /// Parameters of the computation.
    type Params: std::fmt::Debug;

    /// The parameters of a preset.
    ///
    /// # Errors
    /// When a value of the paper is missing.
    fn params(preset: Preset) -> Result<Self::Params>;
    /// The figure's numbers.
    ///
    /// # Errors
    /// When a contact cannot be solved.
    fn compute(params: &Self::Params) -> Result<Self>;
    /// The numbers as tables.
    fn tables(&self) -> Vec<Table>;
}

/// Computes one figure and writes it into `folder`.
///
/// Prints its short tables and the names of its files.
///
/// # Errors
/// When the figure cannot be computed, or the folder cannot be written.
pub fn run<F: Figure>(preset: Preset, folder: &Path) -> Result<()> {
    let params = F::params(preset)?;
    let figure = F::compute(&params).with_context(|| format!("{} with {params:?}", F::NAME))?;
    report(&figure, &write(&figure, folder)?);
    Ok(())
}

/// Prints the short tables of a figure, and the names of its files.
#[expect(clippy::print_stdout, reason = "the result of the command")]
pub(crate) fn report(figure: &impl Figure, files: &[PathBuf]) {
    for table in figure.tables().iter().filter(|table| table.csv.lines().count() < 40) {
        println!("{}", table.aligned());
    }
    for file in files {
        println!("{}", file.display());
    }
}

/// Writes the tables and both pictures of a figure into `folder`.
///
/// Returns the files.
///
/// # Errors
/// When the folder cannot be made, or a file cannot be written or drawn.
pub fn write<F: Figure>(figure: &F, folder: &Path) -> Result<Vec<PathBuf>> {
    fs::create_dir_all(folder).with_context(|| format!("could not make {}; give another --out", folder.display()))?;
    let mut files = Vec::new();
    for table in figure.tables() {
        let path = folder.join(format!("{}-{}.csv", F::NAME, table.name));
        fs::write(&path, &table.csv).with_context(|| format!("could not write {}", path.display()))?;
        files.push(path);
    }
    let picture = |extension: &str| folder.join(format!("{}.{extension}", F::NAME));
    let (svg, png) = (picture("svg"), picture("png"));
    save_svg(figure, &svg).with_context(|| format!("could not draw {}", svg.display()))?;
    save_png(figure, &png).with_context(|| format!("could not draw {}", png.display()))?;
    files.extend([svg, png]);
    Ok(files)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::comparison::tests::unnoticed;
    use crate::snapshot;

    /// Asserts that the tables of `figure` agree with their snapshots.
    ///
    /// `names` are the names of the tables. The rules of each table must also notice a change.
    pub(crate) fn assert_reviewed<F: Figure>(figure: &F, params: &F::Params, names: &[&str]) {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/snapshots");
        let tables = figure.tables();
        assert_eq!(tables.iter().map(|table| format!("{}-{}", F::NAME, table.name)).collect::<Vec<_>>(), names);
        for (table, name) in tables.iter().zip(names) {
            snapshot::assert_table(&folder, name, table, &format!("{params:?}"));
            assert_eq!(unnoticed(table), None, "goes unnoticed in {name}");
        }
    }

    /// Writes `figure` into a temporary folder and checks the type of every file.
    pub(crate) fn assert_written<F: Figure>(figure: &F) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let files = write(figure, folder.path()).expect("the figure is written");
        assert_eq!(files.len(), figure.tables().len() + 2, "{files:?}");
        for file in files {
            let bytes = fs::read(&file).expect("a written file");
            let (start, min_bytes): (&[u8], usize) = match file.extension().and_then(|extension| extension.to_str()) {
                Some("png") => (b"\x89PNG\r\n\x1a\n", 4096),
                Some("svg") => (b"<svg", 4096),
                _ => (b"", 32),
            };
            assert!(bytes.starts_with(start), "{} starts with {:?}", file.display(), &bytes[..bytes.len().min(16)]);
            assert!(bytes.len() >= min_bytes, "{} has only {} bytes", file.display(), bytes.len());
        }
    }
}
