//! The adaptive method on many levels and on elements of several sizes.
//!
//! Its solutions are audited on the whole grid of the smallest elements.

use std::f64::consts::TAU;
use std::ops::Range;

use anyhow::Result;
use rc_core::{Boundary, DVec2, Field, Grid, HeightSource, Kernel, Operator, Silent};
use rc_figures::Preset;
use rc_fractal::{SpectrumParams, Surface};
use rc_kernel::{FreeLove, Love};
use rc_solver::{ContactElement, ContactProblem, Control, Method, Solution, SolveParams, UniformOperator};

use super::audit::{Audit, gaps};
use super::heights::shapes;
use super::row::{Row, Rows, guarded};
use super::scene::TOLERANCE;

/// Documented error of the heights that the adaptive method interpolates, relative to the rms height.
const HEIGHT_ERROR: f64 = 1e-9;

/// Rounding of the audit's transform and sums, relative to the peak-to-valley height. The measured value is below
/// 1e-14.
const ROUNDING: f64 = 1e-13;

/// Allowed error of the height of a larger element, relative to the peak-to-valley height.
///
/// The interpolation omits fourth derivatives.
const SAME_HEIGHT: f64 = 1e-5;

/// Allowed relative difference between σ0 or Δ and its value by the audit.
const SAME_CONTROL: f64 = 1e-6;

/// Heights on which a mesh is made.
#[derive(Debug)]
enum Relief {
    /// The paper's surface with this many waves and Hurst exponent.
    Waves(usize, f64),
    /// Independent values on all elements.
    Noise,
    /// Alternating high and low elements, like a chequerboard.
    Chequered,
    /// A few waves, on a map with these numbers of elements along x and y.
    Map([usize; 2]),
}

/// A contact problem for the adaptive method.
struct MeshScene {
    relief: Relief,
    /// Elements of the base grid per side; 0 if the method chooses.
    base: usize,
    side: usize,
    border_level: usize,
    /// Mean pressure in E*.
    load: f64,
    tolerance: f64,
    boundary: Boundary,
}

impl MeshScene {
    /// The paper's surface with about 5 % in contact.
    const fn waves(waves: usize, base: usize, side: usize, border_level: usize) -> Self {
        let (relief, boundary) = (Relief::Waves(waves, 0.8), Boundary::Periodic);
        Self { relief, base, side, border_level, load: 1e-3, tolerance: TOLERANCE, boundary }
    }

    /// A map whose base grid the method chooses.
    const fn map(sides: [usize; 2], load: f64) -> Self {
        Self { relief: Relief::Map(sides), load, ..Self::waves(0, 0, sides[0], 0) }
    }

    /// The same heights as a patch with free borders.
    const fn free(self) -> Self {
        Self { boundary: Boundary::Free, ..self }
    }

    fn kernel(&self) -> &'static dyn Kernel {
        match self.boundary {
            Boundary::Periodic => &Love,
            Boundary::Free => &FreeLove,
        }
    }

    fn name(&self) -> String {
        let Self { relief, base, side, border_level, load, tolerance, boundary } = self;
        let cell = if *boundary == Boundary::Free { "patch: " } else { "" };
        format!(
            "{cell}{relief:?} base {base} side {side} border level {border_level} load {load:.0e} to {tolerance:.0e}"
        )
    }
}

/// The scenes of the reduced set.
///
/// They have three and four levels above the base grid, border levels 1 to 3, and maps like noise.
fn reduced() -> Vec<MeshScene> {
    let waves = MeshScene::waves;
    vec![
        waves(16, 64, 512, 0),
        waves(8, 64, 1024, 0),
        waves(16, 64, 128, 1),
        waves(16, 64, 128, 2),
        MeshScene { load: 1e-2, ..waves(16, 64, 128, 3) },
        MeshScene { load: 1e-5, ..waves(16, 64, 256, 2) },
        MeshScene { relief: Relief::Waves(16, 0.2), load: 1e-2, ..waves(16, 64, 256, 2) },
        MeshScene { relief: Relief::Noise, ..waves(0, 32, 256, 0) },
        MeshScene { relief: Relief::Chequered, load: 1e-2, ..waves(0, 32, 256, 0) },
        MeshScene { tolerance: 1e-8, ..waves(16, 64, 256, 0) },
        MeshScene::map([256, 64], 1e-3),
        MeshScene::map([300, 207], 1e-2),
        MeshScene { tolerance: 1e-8, ..MeshScene::map([251, 251], 1e-2) },
        waves(16, 64, 512, 0).free(),
        MeshScene { load: 1e-5, ..waves(16, 64, 256, 2) }.free(),
        MeshScene { relief: Relief::Noise, ..waves(0, 32, 256, 0) }.free(),
        MeshScene { tolerance: 1e-8, ..waves(16, 64, 256, 0) }.free(),
        MeshScene::map([256, 64], 1e-3).free(),
        MeshScene::map([300, 207], 1e-2).free(),
    ]
}

/// The further scenes of the full set: N = 128 and 512, five levels, border level 4, other tolerances.
fn further() -> Vec<MeshScene> {
    let waves = MeshScene::waves;
    let mut scenes = vec![
        waves(512, 2048, 8192, 0),
        waves(128, 512, 4096, 0),
        waves(64, 256, 2048, 1),
        waves(64, 256, 1024, 2),
        waves(64, 256, 512, 3),
        waves(64, 256, 512, 4),
        waves(16, 64, 2048, 0),
        waves(16, 64, 256, 4),
        MeshScene::map([640, 480], 1e-3),
        MeshScene::map([860, 634], 1e-3),
        MeshScene::map([1001, 1001], 1e-3),
        MeshScene::map([130, 520], 1e-2),
        waves(128, 512, 4096, 0).free(),
        MeshScene::map([640, 480], 1e-3).free(),
        MeshScene::map([1001, 1001], 1e-3).free(),
    ];
    for load in [1e-6, 1e-4, 1e-2] {
        scenes.extend([0, 2].map(|border| MeshScene { load, ..waves(16, 64, 256, border) }.free()));
        scenes.extend([0, 2, 4].map(|border| MeshScene { load, ..waves(16, 64, 256, border) }));
        scenes.extend([0.1, 0.4].map(|hurst| MeshScene {
            relief: Relief::Waves(32, hurst),
            load,
            ..waves(32, 128, 1024, 0)
        }));
        scenes.push(MeshScene { relief: Relief::Noise, load, ..waves(0, 64, 1024, 0) });
        scenes.push(MeshScene { relief: Relief::Chequered, load, ..waves(0, 64, 1024, 0) });
    }
    for tolerance in [1e-5, 1e-7] {
        scenes.extend([0, 2].map(|border| MeshScene { tolerance, ..waves(16, 64, 256, border) }));
    }
    scenes
}

#[expect(clippy::unnecessary_wraps, reason = "as the other groups")]
pub(crate) fn rows(preset: Preset) -> Result<Vec<Row>> {
    let mut rows = Rows::of("meshes");
    let further = if preset == Preset::Full { further() } else { Vec::new() };
    for scene in reduced().into_iter().chain(further) {
        let name = scene.name();
        if let Err(error) = guarded(|| check(&scene, &name, &mut rows)) {
            rows.holds(&name, "solved and audited", "converged", format!("{error:#}"), false);
        }
    }
    Ok(rows.finish())
}

fn check(scene: &MeshScene, name: &str, rows: &mut Rows) -> Result<()> {
    let finest = Grid::square(scene.side << scene.border_level)?;
    match scene.relief {
        Relief::Map(sides) => {
            let heights = waves_on(sides)?;
            check_solution(scene, (name, HeightSource::Map(&heights)), &heights, rows)
        }
        Relief::Waves(waves, hurst) => {
            let surface = Surface::new(&SpectrumParams { hurst, ..SpectrumParams::paper(waves, 31) })?;
            let source = HeightSource::Surface { surface: &surface, grid: Grid::square(scene.side)? };
            let heights = surface.sample_on(finest)?;
            check_solution(scene, (name, source), &heights, rows)
        }
        Relief::Noise | Relief::Chequered => {
            let wanted = if matches!(scene.relief, Relief::Noise) { "white noise" } else { "chequered" };
            let heights = shapes(scene.side)?.into_iter().find(|shape| shape.name == wanted).map(|shape| shape.heights);
            let heights = heights.unwrap_or_else(|| Field::zeros(finest));
            check_solution(scene, (name, HeightSource::Map(&heights)), &heights, rows)
        }
    }
}

/// Waves of many directions on square elements, with up to 19 waves along the longer side.
fn waves_on([nx, ny]: [usize; 2]) -> Result<Field> {
    let ratio = ny as f64 / nx as f64;
    let long = ratio.max(1.0);
    let waves =
        [[1.0, 2.0, 0.1], [-3.0, 2.0, 0.7], [5.0, -4.0, 0.3], [7.0, 9.0, 0.9], [-12.0, 6.0, 0.2], [17.0, 13.0, 0.5]];
    let height = |at: DVec2| {
        let of_wave = |&[kx, ky, phase]: &[f64; 3]| {
            // Numbers of waves are whole along both sides, and about as many per length.
            let [kx, ky] = [(kx / long).round(), (ky * ratio / long).round()];
            let phase = TAU * (kx * at.x + ky * at.y / ratio + phase);
            phase.cos() / (1.0 + kx.hypot(ky / ratio)).powf(1.7)
        };
        waves.iter().map(of_wave).sum::<f64>()
    };
    Ok(Field::from_fn(Grid::in_cell(nx, ny, ratio)?, height))
}

/// Solves a scene and audits it on the whole grid of the smallest elements.
fn check_solution(
    scene: &MeshScene,
    (name, source): (&str, HeightSource<'_>),
    heights: &Field,
    rows: &mut Rows,
) -> Result<()> {
    let params = SolveParams {
        base_side: Some(scene.base).filter(|&base| base > 0),
        border_level: scene.border_level,
        ..SolveParams::to_tolerance(scene.tolerance).by(Method::Adaptive)
    };
    if let Some(ratio) = heights.grid().nx().checked_div(scene.base) {
        let n_levels = ratio.ilog2();
        rows.holds(name, "levels above the base grid", ">= 1", n_levels.to_string(), n_levels >= 1);
    }
    let load = Control::MeanPressure(scene.load);
    let solution = ContactProblem::new(source.clone(), load).with_kernel(scene.kernel()).solve(&params, &Silent)?;
    check_mesh(scene, (name, source.clone()), (heights, load), &solution, rows)?;
    let penetration = Control::Penetration(solution.info().penetration);
    let solution =
        ContactProblem::new(source.clone(), penetration).with_kernel(scene.kernel()).solve(&params, &Silent)?;
    check_mesh(scene, (&format!("{name} by penetration"), source), (heights, penetration), &solution, rows)
}

fn check_mesh(
    scene: &MeshScene,
    (name, source): (&str, HeightSource<'_>),
    (heights, control): (&Field, Control),
    solution: &Solution<'_>,
    rows: &mut Rows,
) -> Result<()> {
    let MeshAudit { audit, outside, means } = of_elements((solution, scene.kernel()), (source, heights), control)?;
    rows.at_most(name, "pressures not finite or negative", audit.n_bad as f64, 0.0);
    let range = heights.max() - heights.min();
    let rounding = HEIGHT_ERROR * heights.rms() / range + ROUNDING;
    let claimed = solution.certificate().penetration;
    // The solve sets the penetration at a gap whose error is within the certificate too.
    let same_control = match control {
        Control::MeanPressure(_) => SAME_CONTROL,
        Control::Penetration(wanted) => (claimed + rounding) * range / wanted,
    };
    rows.at_most(name, "load by audit", audit.load, same_control);
    rows.at_most(name, "penetration by audit", audit.penetration, scene.tolerance + rounding);
    rows.at_most(name, "audit within the certificate", audit.penetration, claimed + rounding);
    rows.at_most(name, "audit outside contact within the certificate", outside, claimed + rounding);
    let claimed = solution.certificate().energy + audit.energy_of(rounding);
    rows.at_most(name, "energy error within the certificate", audit.energy, claimed);
    if scene.border_level > 0 {
        rows.at_most(name, "heights of larger elements against means", means, SAME_HEIGHT);
    }
    Ok(())
}

/// The audit of all elements.
struct MeshAudit {
    audit: Audit,
    /// max(-g) / H over the elements out of contact.
    outside: f64,
    /// Maximum error of the height of a larger element in contact, over H.
    ///
    /// The error is the difference from the mean over the centres of the element's parts.
    means: f64,
}

/// The audit of a mesh on the grid of its smallest elements.
///
/// Each part of an element has the element's pressure, and a transform of the whole grid gives the displacements. Gaps
/// in contact are means over elements. Gaps elsewhere are at the centres of the smallest elements.
fn of_elements(
    (solution, kernel): (&Solution<'_>, &dyn Kernel),
    (source, heights): (HeightSource<'_>, &Field),
    control: Control,
) -> Result<MeshAudit> {
    let (grid, n) = (heights.grid(), heights.grid().nx());
    let elements: Vec<Square> =
        solution.elements().into_iter().flatten().map(|element| Square::new(&element, n)).collect();
    let mut pressure = Field::zeros(grid);
    for element in &elements {
        element.rows(n).for_each(|row| pressure.values_mut()[row].fill(element.pressure));
    }
    let mut v = vec![0.0; grid.len()];
    UniformOperator::new(grid, kernel).apply(pressure.values(), &mut v, &mut []);
    let (mut gaps, range) = (gaps(heights, &v), heights.max() - heights.min());
    drop(v);
    let (levels, mut means) = (LevelHeights::new(&source, n)?, 0.0_f64);
    for element in elements.iter().filter(|element| element.side > 1) {
        let mean = |values: &[f64]| {
            element.rows(n).map(|row| values[row].iter().sum::<f64>()).sum::<f64>() / element.side.pow(2) as f64
        };
        let excess = levels.height(element) - mean(heights.values());
        means = means.max(excess.abs() / range);
        let gap = mean(&gaps) - excess;
        element.rows(n).for_each(|row| gaps[row].fill(gap));
    }
    let audit = Audit::of_gaps(heights, &pressure, &gaps, control);
    // Elements in contact are left out of the minimum.
    let approach = solution.info().penetration;
    gaps.iter_mut().zip(pressure.values()).filter(|(_, p)| **p > 0.0).for_each(|(g, _)| *g = approach);
    let least = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    Ok(MeshAudit { audit, outside: (approach - least) / range, means })
}

/// An element in contact; lengths are in sides of the smallest elements.
struct Square {
    corner: [usize; 2],
    side: usize,
    pressure: f64,
}

impl Square {
    fn new(element: &ContactElement, n: usize) -> Self {
        let n = n as f64;
        let corner = |centre: f64| (n * (centre - 0.5 * element.side)).round() as usize;
        let corner = [corner(element.centre.x), corner(element.centre.y)];
        Self { corner, side: (element.side * n).round() as usize, pressure: element.pressure }
    }

    /// Index ranges of the element's parts on the grid of `n` elements per side.
    ///
    /// There is a range for each row of the grid.
    fn rows(&self, n: usize) -> impl Iterator<Item = Range<usize>> {
        let ([x, y], side) = (self.corner, self.side);
        (y..y + side).map(move |row| row * n + x..row * n + x + side)
    }
}

/// Heights that the adaptive method uses for larger elements.
///
/// The height is the mean over the centres of the smallest elements, to fourth order. It is found from the centre of
/// the element and the centres of its four quarters.
struct LevelHeights {
    /// Heights at the centres of elements of 1, 2, 4, … smallest elements per side.
    levels: Vec<Field>,
}

impl LevelHeights {
    fn new(source: &HeightSource<'_>, n: usize) -> Result<Self> {
        let n_larger = (n / source.grid().nx()).ilog2();
        let Some(surface) = source.surface() else { return Ok(Self { levels: Vec::new() }) };
        let sampled = (0..=n_larger).map(|level| Ok(surface.sample(Grid::square(n >> level)?)));
        Ok(Self { levels: sampled.collect::<Result<_>>()? })
    }

    fn height(&self, element: &Square) -> f64 {
        let (level, [x, y]) = (element.side.ilog2() as usize, element.corner.map(|i| i / element.side));
        let (centre, quarters) = (self.levels[level].at(x, y), &self.levels[level - 1]);
        let quarters = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[dx, dy]| quarters.at(2 * x + dx, 2 * y + dy));
        let ratio = (1.0 - 1.0 / (element.side as f64).powi(2)) / (1.0 - 0.25);
        centre + ratio * (0.25 * quarters.iter().sum::<f64>() - centre)
    }
}
