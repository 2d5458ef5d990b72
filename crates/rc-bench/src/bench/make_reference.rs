//! `cargo xtask bench --make-reference`: the reference values, from meshes much finer than the meshes under comparison.
//!
//! Areas are counted with `love` on elements of down to 1/16384 of the cell at the edges of contacts. Rms pressure and
//! mean gap converge fastest with `spectral` on uniform grids. All values are found again with the other kernel on
//! uniform grids.

use anyhow::Result;
use rc_figures::repository;
use rc_solver::Tolerance;

use super::extrapolation::{Counted, Limit, area_limit, richardson};
use super::measure::{Solved, solve};
use super::readings::CALIBRATED;
use super::record::{from_csv, rounded, to_csv, write};
use super::reference::{Quantity, REFERENCE, ReferenceRow};
use super::scenes::{SCENES, Scene};
use super::setting::{KernelName, Setting};

/// Elements per side of the uniform grids.
const SIDES: [usize; 3] = [1024, 2048, 4096];

/// Elements per side of the grid that is refined at edges, and the border levels.
///
/// Refinement halves the elements, so that the smallest are 2048 to 16384 along a side.
const BORDER: (usize, [usize; 4]) = (1024, [1, 2, 3, 4]);

/// Tolerance on uniform grids, far below the wanted error of rms pressure and gap.
const TOLERANCE: Tolerance = Tolerance::Relative(1e-8);

/// Tolerance of the areas. It moves edges by at most a tenth of the smallest element, in either direction.
const AREA_TOLERANCE: Tolerance = Tolerance::Relative(3e-7);

/// Computes the reference values of `scenes` and puts them into `data/bench/reference.csv`.
///
/// The values of other scenes stay.
///
/// # Errors
/// When a solve fails or the file cannot be written.
pub fn run(scenes: &[Scene]) -> Result<()> {
    for scene in scenes {
        let made = rows(scene)?;
        let path = repository::root().join(REFERENCE);
        let text = std::fs::read_to_string(&path).unwrap_or_default();
        let mut all: Vec<ReferenceRow> = from_csv(&text, REFERENCE)?;
        all.retain(|row| row.scene != scene.name);
        all.extend(made);
        all.sort_by_key(|row| (SCENES.iter().position(|scene| scene.name == row.scene), row.quantity));
        write(&path, &to_csv(&all)?)?;
    }
    Ok(())
}

/// Perimeter correction of `love`; [`CALIBRATED`] is the one of `spectral`.
const LOVE_PERIMETER: f64 = 0.0872;

fn rows(scene: &Scene) -> Result<Vec<ReferenceRow>> {
    let uniform = |kernel| {
        let setting = |elements: f64| Setting::uniform(kernel, elements, TOLERANCE);
        SIDES.into_iter().map(|side| on(scene, side, setting)).collect::<Result<Vec<_>>>()
    };
    let (spectral, love) = (uniform(KernelName::Spectral)?, uniform(KernelName::Love)?);
    let (side, levels) = BORDER;
    let deep = levels.iter().map(|&level| on(scene, side, |m| Setting::adaptive(level, m, AREA_TOLERANCE)));
    let deep = deep.collect::<Result<Vec<_>>>()?;
    let deep: Vec<Counted> = deep.iter().zip(levels).map(|(solved, level)| counted(solved, side << level)).collect();
    let counts: Vec<Counted> = spectral.iter().zip(SIDES).map(|(solved, side)| counted(solved, side)).collect();
    let area = (area_limit(&deep, LOVE_PERIMETER), area_limit(&counts, CALIBRATED));
    let both = |of: fn(&Solved) -> f64| -> Result<(Limit, Limit)> { Ok((limit(&spectral, of)?, limit(&love, of)?)) };
    let rms_pressure = both(|solved| solved.observables.rms_pressure)?;
    let mean_gap = both(|solved| solved.observables.mean_gap)?;
    let limits = [area, rms_pressure, mean_gap];
    Ok(Quantity::ALL.into_iter().zip(limits).map(|(quantity, limits)| row(scene, quantity, limits)).collect())
}

/// One line of the file. Its numbers have all significant digits, and a few more.
fn row(scene: &Scene, quantity: Quantity, (limit, check): (Limit, Limit)) -> ReferenceRow {
    ReferenceRow {
        scene: scene.name.to_owned(),
        quantity,
        value: rounded(limit.value, 10),
        uncertainty: rounded(limit.uncertainty, 2),
        other_kernel: rounded(check.value, 10),
        other_uncertainty: rounded(check.uncertainty, 2),
    }
}

#[expect(clippy::print_stdout, reason = "it takes minutes")]
fn on(scene: &Scene, side: usize, setting: impl Fn(f64) -> Setting) -> Result<Solved> {
    let setting = setting((side / scene.waves) as f64);
    println!("{}: {setting}", scene.name);
    solve(scene, &setting)
}

fn counted(solved: &Solved, side: usize) -> Counted {
    let area = &solved.observables.area;
    Counted { area: area.cells, n_edges: area.perimeter_edges, side }
}

/// The limit of a quantity from the two finest grids.
fn limit(solved: &[Solved], of: fn(&Solved) -> f64) -> Result<Limit> {
    let [.., coarse, fine] = solved else { anyhow::bail!("a limit needs two grids") };
    Ok(richardson(of(coarse), of(fine)))
}
