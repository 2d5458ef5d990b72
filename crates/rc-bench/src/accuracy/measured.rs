//! Errors and error bars of a scene.

use anyhow::Result;
use rc_core::{Field, Grid, HeightSource, Silent};
use rc_figures::{Table, number};
use rc_solver::{ContactProblem, Control, Method, SolveParams};

use crate::accuracy::scene::{Family, Scene, Solid};

/// Tolerance of the limits, relative to the height range.
///
/// The solves under test have the default tolerance.
const LIMIT_TOLERANCE: f64 = 1e-8;

/// The quantities that have error bars.
pub(super) const QUANTITIES: [&str; 4] = ["area", "rms_pressure", "mean_gap", "penetration"];

/// A solved scene: its properties, limits, errors and error bars.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measured {
    pub(super) family: Family,
    pub(super) kind: &'static str,
    pub(super) is_spectral: bool,
    pub(super) border_level: usize,
    pub(super) waves: usize,
    pub(super) elements_per_wave: usize,
    pub(super) hurst: f64,
    /// Radius of small contacts, thickness of a layer, in elements.
    pub(super) size: f64,
    /// Plastic part of the contact.
    pub(super) plastic: f64,
    /// Whether the contact reaches a free border.
    pub(super) is_at_border: bool,
    /// The limits of the [`QUANTITIES`], in units of λ and E*.
    pub(super) limits: [f64; 4],
    pub(super) errors: [f64; 4],
    pub(super) bars: [Option<f64>; 4],
    /// Parts of the bars from the tolerance of the solve.
    pub(super) of_solve: [f64; 4],
    /// Errors of the area by counting elements, and of the rms pressure of the elements.
    pub(super) of_elements: [f64; 2],
}

/// Values of the [`QUANTITIES`], and of area and rms pressure of the elements.
struct Values {
    found: [f64; 4],
    of_elements: [f64; 2],
    bars: [Option<f64>; 4],
    of_solve: [f64; 4],
    plastic: f64,
    excess: f64,
}

impl Scene {
    fn solve(&self, solid: Solid, heights: HeightSource<'_>, params: &SolveParams) -> Result<Values> {
        let kernel = solid.kernel();
        let problem = ContactProblem::new(heights, Control::MeanPressure(self.mean_pressure)).with_kernel(&*kernel);
        let problem = if self.hardness.is_finite() { problem.with_hardness(self.hardness) } else { problem };
        let solution = problem.solve(params, &Silent)?;
        let (found, info) = (solution.observables(), solution.info());
        let values = [found.area.fraction, found.rms_pressure_corrected, found.mean_gap, info.penetration];
        let of_energy = [1.0, 1.0, 0.5].map(|part| part * info.iteration_error.powi(2));
        // The penetration has the error of the mean gap, which contains the overlap of the certificate.
        let mut of_solve = [0, 1, 2, 2].map(|i| of_energy[i] * values[i]);
        for error in &mut of_solve[2..] {
            *error += info.certificate.penetration * info.penetration_full_contact;
        }
        Ok(Values {
            found: values,
            of_elements: [found.area.cells, found.rms_pressure],
            bars: [
                Some(found.area.error),
                found.rms_pressure_error,
                Some(found.mean_gap_error),
                Some(solution.penetration_error()),
            ],
            of_solve,
            plastic: found.plastic.map_or(0.0, |plastic| plastic.fraction / found.area.fraction.max(plastic.fraction)),
            excess: solution.summit_excess(),
        })
    }

    /// Mean height minus that of the samples on a grid.
    ///
    /// A gap is measured from the samples of a map. Their mean is another where the surface has creases, and waves have
    /// the same.
    fn mean_height_missed(&self, grid: Grid) -> Result<f64> {
        let finest = Grid::new(grid.nx() * self.finer, grid.ny() * self.finer)?;
        Ok(self.heights.sample(finest).mean() - self.heights.sample(grid).mean())
    }

    /// The limits of all quantities.
    fn limits(&self) -> Result<[f64; 4]> {
        let params = SolveParams::to_tolerance(LIMIT_TOLERANCE).by(Method::Uniform);
        let side = (self.grid[1] * self.finer) << self.border_level;
        let solve = |solid: Solid, side: usize| -> Result<[f64; 4]> {
            // The true maximum of a surface is known.
            let heights = HeightSource::Surface { surface: self.heights.as_ref(), grid: Grid::square(side)? };
            let Values { found, excess, .. } = self.solve(solid, heights, &params)?;
            Ok([found[0], found[1], found[2], found[3] + excess])
        };
        if self.solid == Solid::Free {
            // Errors at free borders are of first order.
            let (near, far) = (solve(Solid::Free, 2 * side)?, solve(Solid::Free, side)?);
            return Ok(std::array::from_fn(|i| 2.0 * near[i] - far[i]));
        }
        let smooth = solve(self.solid.by(true), side)?;
        if self.solid.is_spectral() {
            let other = solve(self.solid.by(false), side)?;
            return Ok([other[0], smooth[1], smooth[2], smooth[3]]);
        }
        Ok(smooth)
    }
}

impl Measured {
    /// Solves a scene and its limits.
    pub(super) fn of(scene: &Scene) -> Result<Self> {
        let params = SolveParams { border_level: scene.border_level, ..SolveParams::default().by(scene.method) };
        let grid = Grid::new(scene.grid[0], scene.grid[1])?;
        // The adaptive method evaluates heights where it needs them. The other methods get a map, like a measured one.
        let map: Option<Field> = (scene.method != Method::Adaptive).then(|| scene.heights.sample(grid));
        let surface = HeightSource::Surface { surface: scene.heights.as_ref(), grid };
        let found = scene.solve(scene.solid, map.as_ref().map_or(surface, HeightSource::from), &params)?;
        let mut limits = scene.limits()?;
        limits[2] += scene.mean_height_missed(grid)?;
        Ok(Self {
            family: scene.family,
            kind: scene.kind,
            is_spectral: scene.solid.is_spectral(),
            border_level: scene.border_level,
            waves: scene.waves,
            elements_per_wave: scene.elements_per_wave,
            hurst: scene.hurst,
            size: scene.size,
            plastic: found.plastic,
            is_at_border: scene.solid == Solid::Free && found.bars[1].is_none(),
            limits,
            errors: std::array::from_fn(|i| found.found[i] - limits[i]),
            bars: found.bars,
            of_solve: found.of_solve,
            of_elements: [found.of_elements[0] - limits[0], found.of_elements[1] - limits[1]],
        })
    }

    fn cells(&self) -> Vec<String> {
        let Self { kind, border_level, waves, elements_per_wave, hurst, size, plastic, is_at_border, .. } = *self;
        let kernel = if self.is_spectral { "spectral" } else { "love" };
        let mut cells = [self.family.name(), kind, kernel].map(str::to_owned).to_vec();
        cells.extend([border_level, waves, elements_per_wave].map(|n| n.to_string()));
        cells.extend([hurst, size, plastic].map(number));
        cells.push(is_at_border.to_string());
        for i in 0..QUANTITIES.len() {
            cells.extend([self.limits[i], self.errors[i]].map(number));
            cells.push(self.bars[i].map_or(String::new(), number));
        }
        cells
    }

    /// Ratio of the error of a quantity to its bar. `None` without a bar.
    ///
    /// The limits have a tolerance too. It is added to the bar.
    pub(super) fn ratio(&self, quantity: usize) -> Option<f64> {
        let scale = [1.0, self.limits[1], self.limits[3], self.limits[3]][quantity];
        Some(self.errors[quantity].abs() / (self.bars[quantity]? + LIMIT_TOLERANCE * scale))
    }

    /// Whether the mesh, and not the tolerance of the solve, decides on a bar.
    pub(super) fn is_of_mesh(&self, quantity: usize) -> bool {
        self.bars[quantity].is_some_and(|bar| self.of_solve[quantity] < 0.5 * bar)
    }
}

/// One line for each scene.
pub(super) fn as_csv(scenes: &[Measured]) -> String {
    let facts = "family,kind,kernel,border_level,waves,elements_per_wave,hurst,size,plastic_part,at_border";
    let mut header: Vec<String> = facts.split(',').map(str::to_owned).collect();
    header.extend(QUANTITIES.iter().flat_map(|name| ["", "_error", "_bar"].map(|suffix| format!("{name}{suffix}"))));
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    Table::new("scenes", &header, scenes.iter().map(Measured::cells)).csv
}
