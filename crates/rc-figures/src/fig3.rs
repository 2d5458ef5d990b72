//! Fig. 3: elements against penetration for the three meshes, from touch to full contact.
//!
//! The meshes are counted on sets of the smallest elements of all three meshes. A tolerance of 1e-5 of the height of
//! the surface is enough for the picture, since only elements at edges of contact can still change. The test
//! `a_tolerance_of_1e_5_is_enough_for_counts` shows on the quick figure that this change is not visible. Counts on
//! another processor are the same within [`NOISE`].

use std::f64::consts::TAU;

use anyhow::{Context, Result, ensure};
use plotters::prelude::DrawingBackend;
use plotters::style::{BLACK, RGBColor};
use rc_core::{Field, Grid, HeightField as _};
use rc_fractal::{SpectrumParams, Surface};
use rc_plot::{Area, Picture, PictureError};
use rc_quadtree::paper::{Mask, MeshKind, MeshParams, count};
use rc_solver::{Control, Method, SolveParams, Status, solve};

use crate::chart::{BLUE, GREEN, Mark, Panel, Pen, RED, Side, draw_panels};
use crate::table::Rows;
use crate::{Figure, Preset, Rule, Table, paper};

/// Kind, name in the paper, name in tables, and colour of each mesh.
///
/// The mesh with most elements is first.
const MESHES: [(MeshKind, &str, &str, RGBColor); 3] = [
    (MeshKind::Uniform, "uniform grid", "uniform", BLUE),
    (MeshKind::AdaptiveUniform, "adaptive uniform grid", "adaptive_uniform", GREEN),
    (MeshKind::Adaptive, "adaptive non-uniform grid", "adaptive", RED),
];
/// Mean pressures, divided by E* and the rms slope of the surface.
///
/// In these units the contact fraction depends little on the surface.
const LOADS: [f64; 14] = [4e-4, 2e-3, 8e-3, 0.025, 0.06, 0.12, 0.2, 0.28, 0.36, 0.42, 0.48, 0.6, 0.8, 1.1];
/// A mean pressure, in E*, that closes all gaps if slopes are far below 1.
const CRUSHING: f64 = 1.0;
/// Smallest elements per side in the paper. There are 4.2 million in all.
const PAPER_GRID: usize = 2048;
/// Contact fraction at which the meshes are compared.
const TWO_THIRDS: f64 = 2.0 / 3.0;
/// Allowed relative difference of counts between processors.
///
/// Within the tolerance some elements at edges of contact may be in or out of contact.
const NOISE: f64 = 5e-4;
const MICRO: f64 = 1e6;
const MILLION: f64 = 1e6;

/// Parameters of Fig. 3.
#[derive(Clone, Debug)]
pub struct Params {
    /// Number of waves N.
    waves: usize,
    /// Smallest elements per side.
    grid: usize,
    /// Seed of the phases.
    seed: u64,
    /// Relative tolerance of the solves.
    tolerance: f64,
    /// Side λ of the cell (m).
    cell: f64,
}

/// The contact at one load.
#[derive(Clone, Copy, Debug)]
struct State {
    /// σ0/E*.
    mean_pressure: f64,
    /// Δ (m).
    penetration: f64,
    /// Fraction of the smallest elements in contact.
    fraction: f64,
    /// Numbers of elements of the meshes, in the order of [`MESHES`].
    elements: [f64; 3],
    /// Elements of the adaptive mesh under a stricter rule.
    ///
    /// A coarse element then needs two rings of its size around it in contact.
    two_rings: f64,
}

/// The numbers of elements that the paper prints.
#[derive(Clone, Copy, Debug)]
struct Printed {
    penetration: f64,
    elements: [f64; 3],
}

/// The contacts from touch to full contact, by increasing load.
#[derive(Clone, Debug)]
pub struct Fig3 {
    params: Params,
    states: Vec<State>,
    /// h_max above the mean plane (m).
    h_max: f64,
    printed: Printed,
}

impl Figure for Fig3 {
    const NAME: &'static str = "fig3";
    type Params = Params;

    /// The paper's surface on 2048² elements, 16 for a shortest wave (full).
    ///
    /// The quick preset has 16 waves on as many elements for a shortest wave.
    fn params(preset: Preset) -> Result<Params> {
        let (waves, grid, tolerance) = match preset {
            Preset::Full => (paper::value("waves_b")? as usize, 2048, 1e-5),
            Preset::Quick => (16, 256, 1e-8),
        };
        Ok(Params { waves, grid, seed: 1, tolerance, cell: TAU / paper::value("q0")? })
    }

    fn compute(params: &Params) -> Result<Self> {
        let surface = Surface::new(&SpectrumParams::paper(params.waves, params.seed))?;
        let heights = surface.sample(Grid::square(params.grid)?);
        let moments = surface.moments();
        let partial = LOADS.iter().map(|load| partial_contact(params, &surface, load * moments.rms_slope));
        let full = std::iter::once_with(|| full_contact(params, &heights));
        Ok(Self {
            params: params.clone(),
            states: std::iter::once(Ok(State::touch(params))).chain(partial).chain(full).collect::<Result<_>>()?,
            h_max: params.cell * (heights.max() - heights.mean()),
            printed: Printed {
                penetration: paper::value("fig3_penetration")?,
                elements: [
                    paper::value("fig3_elements_uniform")?,
                    paper::value("fig3_elements_adaptive_uniform")?,
                    paper::value("fig3_elements_adaptive")?,
                ],
            },
        })
    }

    fn tables(&self) -> Vec<Table> {
        vec![self.summary(), self.counts()]
    }
}

impl Picture for Fig3 {
    fn size(&self) -> (u32, u32) {
        (2300, 1080)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        draw_panels(area, (1, 2), &[self.penetration_panel(), self.fraction_panel()])
    }
}

fn partial_contact(params: &Params, surface: &Surface, mean_pressure: f64) -> Result<State> {
    let (heights, load) = (surface.on(Grid::square(params.grid)?), Control::MeanPressure(mean_pressure));
    let solution = solve(heights, load, &SolveParams::to_tolerance(params.tolerance))
        .with_context(|| format!("at σ0/E* = {mean_pressure:.3e}"))?;
    State::of(params, solution.pressure(), solution.info().penetration, mean_pressure)
}

/// The contact at the smallest load of full contact.
///
/// A larger load only adds a constant to the pressure. So the smallest load is any load of full contact minus the
/// minimum of its pressure.
fn full_contact(params: &Params, heights: &Field) -> Result<State> {
    let control = Control::MeanPressure(CRUSHING);
    let solution = solve(heights, control, &SolveParams::default().by(Method::Uniform))?;
    ensure!(solution.status() == Status::FullContact, "σ0 = {CRUSHING} E* leaves gaps; the surface is too steep");
    State::of(params, solution.pressure(), solution.info().penetration, CRUSHING - solution.pressure().min())
}

impl State {
    /// The state in which only the highest peak touches.
    fn touch(params: &Params) -> Self {
        let elements = [(params.grid * params.grid) as f64, 0.0, 0.0];
        Self { mean_pressure: 0.0, penetration: 0.0, fraction: 0.0, elements, two_rings: 0.0 }
    }

    fn of(params: &Params, pressure: &Field, penetration: f64, mean_pressure: f64) -> Result<Self> {
        let mask = Mask::positive(pressure)?;
        let of =
            |kind, mesh: &MeshParams| -> Result<f64> { Ok(count(&mask, kind, mesh)?.iter().sum::<usize>() as f64) };
        let mut elements = [0.0; 3];
        for (elements, (kind, ..)) in elements.iter_mut().zip(MESHES) {
            *elements = of(kind, &MeshParams::default())?;
        }
        Ok(Self {
            mean_pressure,
            penetration: params.cell * penetration,
            fraction: mask.count() as f64 / mask.cells().len() as f64,
            elements,
            two_rings: of(MeshKind::Adaptive, &MeshParams { ring: 2, ..MeshParams::default() })?,
        })
    }

    /// Linear interpolation from this state to `other`, at the fraction `part` of the way.
    fn towards(&self, other: &Self, part: f64) -> Self {
        let mix = |a: f64, b: f64| a + part * (b - a);
        Self {
            mean_pressure: mix(self.mean_pressure, other.mean_pressure),
            penetration: mix(self.penetration, other.penetration),
            fraction: mix(self.fraction, other.fraction),
            elements: std::array::from_fn(|mesh| mix(self.elements[mesh], other.elements[mesh])),
            two_rings: mix(self.two_rings, other.two_rings),
        }
    }
}

/// Name, unit, printed value and our value of a quantity.
type Row<'a> = (&'static str, &'static str, Option<f64>, &'a dyn Fn(&State) -> f64);

impl Fig3 {
    /// The contact with this fraction, interpolated between two computed contacts.
    ///
    /// `None` outside their range.
    fn at_fraction(&self, fraction: f64) -> Option<State> {
        let mut pairs = self.states.windows(2);
        let pair = pairs.find(|pair| (pair[0].fraction..=pair[1].fraction).contains(&fraction))?;
        let part = (fraction - pair[0].fraction) / (pair[1].fraction - pair[0].fraction);
        Some(pair[0].towards(&pair[1], part))
    }

    /// The contact fraction of the printed numbers.
    ///
    /// The number of elements of the adaptive uniform mesh is the number of elements in contact, out of 2048².
    fn printed_fraction(&self) -> f64 {
        self.printed.elements[1] / (PAPER_GRID * PAPER_GRID) as f64
    }

    fn summary(&self) -> Table {
        let at = [self.at_fraction(TWO_THIRDS), self.at_fraction(self.printed_fraction())];
        let [uniform, adaptive_uniform, adaptive] = self.printed.elements;
        let rows: [Row<'_>; 11] = [
            ("contact fraction", "1", Some(self.printed_fraction()), &|state| state.fraction),
            ("mean pressure", "E*", None, &|state| state.mean_pressure),
            ("penetration", "um", Some(MICRO * self.printed.penetration), &|state| MICRO * state.penetration),
            ("penetration", "h_max", None, &|state| state.penetration / self.h_max),
            ("h_max", "um", None, &|_| MICRO * self.h_max),
            ("elements uniform", "1", Some(uniform), &|state| state.elements[0]),
            ("elements adaptive uniform", "1", Some(adaptive_uniform), &|state| state.elements[1]),
            ("elements adaptive", "1", Some(adaptive), &|state| state.elements[2]),
            ("elements adaptive with two rings", "1", Some(adaptive), &|state| state.two_rings),
            ("uniform to adaptive", "1", Some(uniform / adaptive), &|state| state.elements[0] / state.elements[2]),
            ("adaptive uniform to adaptive", "1", Some(adaptive_uniform / adaptive), &|state| {
                state.elements[1] / state.elements[2]
            }),
        ];
        Rows::of(rows)
            .column("quantity", |row| row.0.to_owned())
            .column("unit", |row| row.1.to_owned())
            .column("at_two_thirds", |row| at[0].as_ref().map(row.3))
            .column("at_printed_fraction", |row| at[1].as_ref().map(row.3))
            .column("printed", |row| row.2)
            .table("summary")
            .rest(Rule::relative(NOISE))
    }

    fn counts(&self) -> Table {
        let rows = Rows::of(&self.states)
            .column("mean_pressure_over_e_star", |state| state.mean_pressure)
            .column("penetration_um", |state| MICRO * state.penetration)
            .column("penetration_over_h_max", |state| state.penetration / self.h_max)
            .column("contact_fraction", |state| state.fraction);
        let meshes = MESHES.iter().enumerate();
        let rows = meshes.fold(rows, |rows, (i, mesh)| rows.column(mesh.2, |state| state.elements[i]));
        rows.column("adaptive_two_rings", |state| state.two_rings).table("counts").rest(Rule::of_scale(NOISE))
    }

    /// Unit of the numbers of elements: a million, or a thousand when there are fewer.
    fn unit(&self) -> f64 {
        if self.params.grid > 1000 { MILLION } else { 1e3 }
    }

    /// Elements against Δ, with a scale in µm below and one in h_max above.
    fn penetration_panel(&self) -> Panel {
        let h_max = MICRO * self.h_max;
        let panel = self.panel(("penetration Δ (µm)", (0.0, 1.03 * h_max)), |state| MICRO * state.penetration);
        panel.with_top(h_max.recip(), "Δ / h_max")
    }

    /// Elements against the contact fraction, with the printed numbers.
    fn fraction_panel(&self) -> Panel {
        // An empty second scale gives both panels the same height.
        let x = ("contact fraction A/A0", (0.0, 1.03));
        let mut panel = self.panel(x, |state| state.fraction).with_top(1.0, "");
        let uniform = self.states.last().map_or(0.0, |state| state.elements[0] / self.unit());
        let places = [
            ((0.02, uniform), Side::RightAbove),
            ((0.52, 0.44 * uniform), Side::Right),
            ((0.3, 0.05 * uniform), Side::Right),
        ];
        for ((_, name, _, colour), (at, side)) in MESHES.into_iter().zip(places) {
            panel.text(at, side, name, colour);
        }
        // The printed numbers are for 128 waves on 2048² elements.
        if self.params.grid == PAPER_GRID {
            for (elements, (.., colour)) in self.printed.elements.into_iter().zip(MESHES) {
                panel.marks([(self.printed_fraction(), elements / self.unit())], Mark::square(colour));
            }
            panel.text((0.66, 0.88 * uniform), Side::Left, "squares: the paper's numbers", BLACK);
        }
        panel
    }

    /// The curves of the meshes, with space above them for a name.
    fn panel(&self, x: (&'static str, (f64, f64)), at: impl Fn(&State) -> f64) -> Panel {
        let y_label = if self.params.grid > 1000 { "elements (millions)" } else { "elements (thousands)" };
        let top = 1.16 * (self.params.grid * self.params.grid) as f64 / self.unit();
        let mut panel = Panel::new(x, (y_label, (0.0, top))).ticks(7, 6);
        for (mesh, (.., colour)) in MESHES.into_iter().enumerate() {
            let points = || self.states.iter().map(|state| (at(state), state.elements[mesh] / self.unit()));
            panel.line(points(), Pen::new(colour, 3));
            panel.marks(points(), Mark::dot(colour, 6));
        }
        panel
    }
}

#[cfg(test)]
mod tests;
