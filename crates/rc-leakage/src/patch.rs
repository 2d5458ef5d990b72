//! The flow between opposite borders of a patch.

use rc_core::{DVec2, Field, Grid};

use crate::constriction::Constriction;
use crate::error::LeakageError;
use crate::flow::{Flow, Leakage, LeakageParams, leakage, percolates};
use crate::flux::Flux;

/// The flow through `gap` (in λ; 0 in contact) of a patch, along x and along y.
///
/// The pressure is constant on each of the two borders across the flow and falls by ΔP between them. Nothing flows
/// through the other two. Beside its mirror images in both directions, the patch is a periodic cell whose pressure is
/// constant on the planes of symmetry across the flow and whose flux is zero through those along it. So the permeance
/// is that of the cell of four images, which is solved. *Cost*: that of four times the elements.
///
/// # Errors
/// As [`leakage`], and as [`images`].
pub fn leakage_of_patch(gap: &Field, params: &LeakageParams) -> Result<Leakage, LeakageError> {
    let Leakage { flows, flux } = leakage(&mirrored(gap)?, params)?;
    Ok(Leakage {
        flows: flows.map(|flow| of_patch(flow, gap.grid())),
        flux: flux.map(|flux| quarter(&flux, gap.grid())),
    })
}

/// Whether the film in `gap` (0 in contact) of a patch connects its borders across x, and those across y.
///
/// # Errors
/// As [`images`].
pub fn patch_percolates(gap: &Field) -> Result<[bool; 2], LeakageError> {
    Ok(percolates(&mirrored(gap)?))
}

/// The grid of a patch of `grid` elements beside its mirror images.
///
/// # Errors
/// [`LeakageError::Images`] when a side of the patch has more than half of [`Grid::MAX_SIDE`].
pub fn images(grid: Grid) -> Result<Grid, LeakageError> {
    Grid::in_cell(2 * grid.nx(), 2 * grid.ny(), grid.cell_ratio()).map_err(|_| LeakageError::Images { grid })
}

/// The patch beside its mirror images, in units of twice its side.
fn mirrored(gap: &Field) -> Result<Field, LeakageError> {
    let grid = gap.grid();
    let ny = grid.ny();
    let image = images(grid)?;
    let mut values = Vec::with_capacity(image.len());
    for iy in (0..ny).chain((0..ny).rev()) {
        let row = gap.row(iy).iter().map(|gap| 0.5 * gap);
        values.extend(row.clone().chain(row.rev()));
    }
    Ok(Field::new(image, values).expect("a value for each element"))
}

/// The flow of four images, in units of the side of the patch.
fn of_patch(flow: Flow, grid: Grid) -> Flow {
    let cube = |value: f64| 8.0 * value;
    let fold = |at: f64, side: f64| if at > side { 2.0 * side - at } else { at };
    let constriction = flow.constriction.map(|Constriction { gap, at }| Constriction {
        gap: 2.0 * gap,
        at: DVec2::new(fold(2.0 * at.x, 1.0), fold(2.0 * at.y, grid.cell_ratio())),
    });
    let (permeance, permeance_error) = (cube(flow.permeance), flow.permeance_error.map(cube));
    Flow { permeance, permeance_error, constriction, ..flow }
}

/// The flux in the patch itself, for a pressure that falls by 1 across it and not across two images.
fn quarter(flux: &Flux, grid: Grid) -> Flux {
    // A flux per length has the unit λ², which is four times as large for the images.
    let part = |field: &Field| {
        let rows = (0..grid.ny()).flat_map(|iy| field.row(iy)[..grid.nx()].iter().map(|value| 8.0 * value));
        Field::new(grid, rows.collect()).expect("a value for each element")
    };
    Flux { x: part(&flux.x), y: part(&flux.y) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two channels along x beside a wall, and a step in one of them: resistances in series and in parallel.
    #[test]
    fn channels_between_borders_are_resistances() {
        let (nx, ny) = (24, 10);
        let grid = Grid::in_cell(nx, ny, 0.4).expect("a grid");
        let at = |ix: usize, iy: usize| match iy {
            0..=2 => 0.02,
            4..=7 if ix < 8 => 0.03,
            4..=7 => 0.01,
            _ => 0.0,
        };
        let gap = Field::new(grid, (0..nx * ny).map(|i| at(i % nx, i / nx)).collect()).expect("a field");
        let solved = leakage_of_patch(&gap, &LeakageParams::default()).expect("a flow");
        let width = grid.spacing().y;
        let (plain, step) = (0.02_f64.powi(3) * 3.0 * width, 4.0 * width / (1.0 / 3.0 / 2.7e-5 + 2.0 / 3.0 / 1e-6));
        let [x, y] = solved.flows;
        // The film of the second channel does not spread at the step, so its resistances are in series.
        assert!((x.permeance / (plain + step) - 1.0).abs() < 1e-9, "{}, exact {}", x.permeance, plain + step);
        assert!(x.percolates && !y.percolates && y.permeance <= 0.0);
        let critical = x.constriction.expect("a path");
        assert!((critical.gap - 0.02).abs() < 1e-15 && critical.at.y < 3.0 * width, "{critical:?}");
        let flux = solved.flux.expect("a flux");
        for ix in 0..nx {
            let through: f64 = (0..ny).map(|iy| flux.x.at(ix, iy) * width).sum();
            // The relative error of a flux is the square root of that of the permeance.
            assert!((through / x.permeance - 1.0).abs() < 1e-4, "column {ix}: {through}");
        }
    }

    /// A path that is open only around the cell does not connect opposite borders.
    #[test]
    fn a_patch_is_not_periodic() {
        let grid = Grid::square(12).expect("a grid");
        // A diagonal channel meets itself around the cell along both axes. In the patch it joins neighbouring borders.
        let open = |i: usize| if (i % 12 + i / 12) % 12 < 4 { 0.01 } else { 0.0 };
        let gap = Field::new(grid, (0..144).map(open).collect()).expect("a field");
        let cell = leakage(&gap, &LeakageParams::default()).expect("a flow");
        assert!(cell.flows.iter().all(|flow| flow.percolates));
        let patch = leakage_of_patch(&gap, &LeakageParams::default()).expect("a flow");
        assert!(patch.flows.iter().all(|flow| !flow.percolates));
        assert_eq!((percolates(&gap), patch_percolates(&gap)), ([true; 2], Ok([false; 2])));
    }

    #[test]
    fn a_patch_whose_images_are_no_grid_is_refused() {
        let gap = Field::zeros(Grid::in_cell(Grid::MAX_SIDE, 1, 1e-4).expect("a grid"));
        let refused = Err(LeakageError::Images { grid: gap.grid() });
        assert_eq!(patch_percolates(&gap), refused);
        assert_eq!(leakage_of_patch(&gap, &LeakageParams::default()).map(|_| [false; 2]), refused);
    }
}
