//! The figures of the paper: numbers first, then a picture of these numbers.

pub(crate) mod all;
pub(crate) mod archive;
mod chart;
mod contact_map;
pub(crate) mod fig1;
pub(crate) mod fig2;
pub(crate) mod fig3;
pub(crate) mod fig4;
pub(crate) mod fig5;
pub(crate) mod fig6;
pub(crate) mod fig7;
pub(crate) mod fig8;
mod fit;
mod marks;
mod paper;
mod solve;
mod sweep;
mod table;

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use rc_plot::{Picture, save_png, save_svg};

use crate::repository;
pub(crate) use solve::pressure_field;
pub(crate) use table::{Table, number};

/// How large a figure is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Preset {
    /// The size that the paper's statement needs; minutes at most.
    Full,
    /// A small version of the same, as the tests run it; seconds.
    Quick,
}

/// A figure: plain data that knows its tables and, as a [`Picture`], how to draw itself.
///
/// All functions are pure; `write` does the files.
pub(crate) trait Figure: Picture + Sized {
    /// File name, as in the paper.
    const NAME: &'static str;
    /// What it is computed from.
    type Params: std::fmt::Debug;

    /// The parameters of a preset.
    fn params(preset: Preset) -> Result<Self::Params>;
    /// The figure's numbers.
    fn compute(params: &Self::Params) -> Result<Self>;
    /// The numbers as tables.
    fn tables(&self) -> Vec<Table>;
    /// What the picture shows, in Markdown, for figures that a title cannot explain.
    fn caption(&self) -> Option<String> {
        None
    }
}

/// Where and how large; the same for every figure.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Folder for the tables (CSV) and pictures (SVG, PNG).
    #[arg(long, value_name = "DIR", default_value_os_t = repository::root().join("figures"), hide_default_value = true)]
    pub(crate) out: PathBuf,
    /// Small surfaces, as the tests compute them, instead of the paper's.
    #[arg(long)]
    quick: bool,
}

impl Args {
    /// The size that is asked for.
    pub(crate) fn preset(&self) -> Preset {
        if self.quick { Preset::Quick } else { Preset::Full }
    }
}

/// Computes one figure and writes it.
pub(crate) fn run<F: Figure>(args: &Args) -> Result<()> {
    let params = F::params(args.preset())?;
    let figure = F::compute(&params).with_context(|| format!("{} with {params:?}", F::NAME))?;
    report(&figure, &write(&figure, &args.out)?);
    Ok(())
}

#[expect(clippy::print_stdout, reason = "the result of the command")]
fn report(figure: &impl Figure, files: &[PathBuf]) {
    for table in figure.tables().iter().filter(|table| table.csv.lines().count() < 40) {
        println!("{}", table.aligned());
    }
    for file in files {
        println!("{}", file.display());
    }
}

/// Writes the tables, the caption and both pictures of a figure into `folder`; returns the files.
pub(crate) fn write<F: Figure>(figure: &F, folder: &Path) -> Result<Vec<PathBuf>> {
    fs::create_dir_all(folder).with_context(|| format!("could not make {}; give another --out", folder.display()))?;
    let mut files = Vec::new();
    for table in figure.tables() {
        let path = folder.join(format!("{}-{}.csv", F::NAME, table.name));
        fs::write(&path, &table.csv).with_context(|| format!("could not write {}", path.display()))?;
        files.push(path);
    }
    if let Some(caption) = figure.caption() {
        let path = folder.join(format!("{}.md", F::NAME));
        fs::write(&path, caption).with_context(|| format!("could not write {}", path.display()))?;
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
mod tests {
    use super::*;

    /// Writes `figure` into a temporary folder and checks that every file is what its name says.
    pub(super) fn assert_written<F: Figure>(figure: &F) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let files = write(figure, folder.path()).expect("the figure is written");
        let n_captions = usize::from(figure.caption().is_some());
        assert_eq!(files.len(), figure.tables().len() + n_captions + 2, "{files:?}");
        for file in files {
            let bytes = fs::read(&file).expect("a written file");
            let (start, least): (&[u8], usize) = match file.extension().and_then(|extension| extension.to_str()) {
                Some("png") => (b"\x89PNG\r\n\x1a\n", 4096),
                Some("svg") => (b"<svg", 4096),
                _ => (b"", 32),
            };
            assert!(bytes.starts_with(start), "{} starts with {:?}", file.display(), &bytes[..bytes.len().min(16)]);
            assert!(bytes.len() >= least, "{} has only {} bytes", file.display(), bytes.len());
        }
    }
}
