//! The adaptive method on many levels and on elements of several sizes, audited on the whole grid of its smallest elements.

use anyhow::Result;
use rc_core::{Field, Grid, HeightSource, Operator, Silent};
use rc_figures::Preset;
use rc_fractal::{SpectrumParams, Surface};
use rc_kernel::Love;
use rc_solver::{ContactElement, ContactProblem, Control, Method, Solution, SolveParams, UniformOperator};

use super::audit::{Audit, gaps};
use super::heights::shapes;
use super::row::{Row, Rows, guarded};
use super::scene::TOLERANCE;

/// Error of the heights that the adaptive method interpolates, relative to the rms height: its tests state it.
const HEIGHT_ERROR: f64 = 1e-9;

/// Rounding of the audit's transform and sums, relative to the peak-to-valley height. Measured: below 1e-14.
const ROUNDING: f64 = 1e-13;

/// Part of σ0 or Δ by which an audit may find another one.
const SAME_CONTROL: f64 = 1e-6;

/// Heights that a mesh is made on.
enum Relief {
    /// The paper's surface with this many waves and Hurst exponent.
    Waves(usize, f64),
    /// Independent values on all elements.
    Noise,
    /// Elements high and low by turns.
    Chequered,
}

/// A contact problem for the adaptive method.
struct MeshScene {
    relief: Relief,
    base: usize,
    side: usize,
    border_level: usize,
    /// Of the slope or of H, whichever makes a scene of it.
    load: f64,
    tolerance: f64,
}

impl MeshScene {
    /// The paper's surface, about 5 % in contact.
    const fn waves(waves: usize, base: usize, side: usize, border_level: usize) -> Self {
        Self { relief: Relief::Waves(waves, 0.8), base, side, border_level, load: 1e-3, tolerance: TOLERANCE }
    }

    fn name(&self) -> String {
        let Self { base, side, border_level, load, tolerance, .. } = self;
        let relief = match self.relief {
            Relief::Waves(waves, hurst) => format!("N = {waves} H = {hurst}"),
            Relief::Noise => "white noise".to_owned(),
            Relief::Chequered => "chequered".to_owned(),
        };
        format!("{relief} base {base} side {side} border level {border_level} load {load:.0e} to {tolerance:.0e}")
    }
}

/// The reduced set: three and four levels above the base grid, border levels 1 to 3, maps like noise.
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
    ]
}

/// What the full set has besides: N = 128 and 512, five levels, border level 4, other tolerances.
fn further() -> Vec<MeshScene> {
    let waves = MeshScene::waves;
    let mut scenes = vec![
        waves(512, 1152, 9216, 0),
        waves(128, 512, 4096, 0),
        waves(64, 256, 2048, 1),
        waves(64, 256, 1024, 2),
        waves(64, 256, 512, 3),
        waves(64, 256, 512, 4),
        waves(16, 64, 2048, 0),
        waves(16, 64, 256, 4),
    ];
    for load in [1e-6, 1e-4, 1e-2] {
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

/// Solves, and audits on the whole grid of the smallest elements.
fn check_solution(
    scene: &MeshScene,
    (name, source): (&str, HeightSource<'_>),
    heights: &Field,
    rows: &mut Rows,
) -> Result<()> {
    let params = SolveParams {
        base_side: Some(scene.base),
        border_level: scene.border_level,
        ..SolveParams::to_tolerance(scene.tolerance).by(Method::Adaptive)
    };
    let control = Control::MeanPressure(scene.load);
    let solution = ContactProblem::new(source, control).solve(&params, &Silent)?;
    let n_levels = (heights.grid().nx() / scene.base).ilog2();
    rows.holds(name, "levels above the base grid", ">= 1", n_levels.to_string(), n_levels >= 1);
    let audit = of_elements(&solution, heights, control)?;
    rows.at_most(name, "pressures not finite or negative", audit.n_bad as f64, 0.0);
    rows.at_most(name, "load by audit", audit.load, SAME_CONTROL);
    let rounding = HEIGHT_ERROR * heights.rms() / (heights.max() - heights.min()) + ROUNDING;
    let claimed = solution.certificate().penetration;
    rows.at_most(name, "penetration by audit", audit.penetration, scene.tolerance + rounding);
    rows.at_most(name, "audit within the certificate", audit.penetration, claimed + rounding);
    Ok(())
}

/// The audit of a mesh: every element's pressure on its parts, their displacement by a transform of the whole grid, gaps in contact as means
/// over elements, and gaps elsewhere at the centres of the smallest elements.
fn of_elements(solution: &Solution<'_>, heights: &Field, control: Control) -> Result<Audit> {
    let (grid, n) = (heights.grid(), heights.grid().nx());
    let parts = |element: &ContactElement| {
        let ratio = (element.side * n as f64).round() as usize;
        let corner = |centre: f64| (centre * n as f64 - 0.5 * ratio as f64).round() as usize;
        let (x, y) = (corner(element.centre.x), corner(element.centre.y));
        (y..y + ratio).map(move |row| row * n + x..row * n + x + ratio)
    };
    let elements: Vec<ContactElement> = solution.elements().map(Iterator::collect).unwrap_or_default();
    let mut pressure = Field::zeros(grid);
    for element in &elements {
        for row in parts(element) {
            pressure.values_mut()[row].fill(element.pressure);
        }
    }
    let mut v = vec![0.0; grid.len()];
    UniformOperator::new(grid, &Love).apply(pressure.values(), &mut v, &mut []);
    let mut gaps = gaps(heights, &v);
    drop(v);
    for element in &elements {
        let cells: f64 = parts(element).map(|row| row.len() as f64).sum();
        let mean = parts(element).map(|row| gaps[row].iter().sum::<f64>()).sum::<f64>() / cells;
        for row in parts(element) {
            gaps[row].fill(mean);
        }
    }
    Ok(Audit::of_gaps(heights, &pressure, &gaps, control))
}
