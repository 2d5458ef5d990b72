//! Fig. 3: elements against penetration for the three meshes, from touch to full contact.
//!
//! The meshes are counted on sets of the smallest elements of all three meshes. A tolerance of 1e-5 of the height of
//! the surface is enough for the picture, since only elements at edges of contact can still change. The test
//! `a_tolerance_of_1e_5_is_enough_for_counts` shows on the quick figure that this change is not visible. Counts on
//! another processor are the same within [`NOISE`].

use std::f64::consts::TAU;

use anyhow::{Context, Result, ensure};
use plotters::prelude::{Circle, DrawingBackend, EmptyElement, LineSeries, Rectangle};
use plotters::style::{BLACK, Color, RGBColor, WHITE};
use rc_core::{Field, Grid, HeightField as _};
use rc_fractal::{SpectrumParams, Surface};
use rc_plot::{Area, Picture, PictureError};
use rc_quadtree::paper::{Mask, MeshKind, MeshParams, count};
use rc_solver::{Control, Method, SolveParams, Status, solve};

use crate::chart::{Axes, BLUE, Chart, Drawn, GREEN, RED, Side, write};
use crate::{Figure, Preset, Rule, Table, number, paper};

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
    rms_height: f64,
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
            rms_height: params.cell * moments.rms_height,
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

    fn caption(&self) -> Option<String> {
        self.at_fraction(TWO_THIRDS).map(|state| self.caption_of(&state))
    }
}

impl Picture for Fig3 {
    fn size(&self) -> (u32, u32) {
        (2300, 1080)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let panels = area.split_evenly((1, 2));
        self.draw_penetration(&panels[0]).map_err(PictureError::new)?;
        self.draw_fraction(&panels[1]).map_err(PictureError::new)
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
        let header = ["quantity", "unit", "at_two_thirds", "at_printed_fraction", "printed"];
        let at = [self.at_fraction(TWO_THIRDS), self.at_fraction(self.printed_fraction())];
        let row = |quantity: &str, unit: &str, printed: Option<f64>, of: &dyn Fn(&State) -> f64| {
            let values = at.iter().map(|state| state.as_ref().map_or_else(String::new, |state| number(of(state))));
            let cells = [quantity.to_owned(), unit.to_owned()].into_iter().chain(values);
            cells.chain([printed.map_or_else(String::new, number)]).collect::<Vec<_>>()
        };
        let [uniform, adaptive_uniform, adaptive] = self.printed.elements;
        let rows = [
            row("contact fraction", "1", Some(self.printed_fraction()), &|state| state.fraction),
            row("mean pressure", "E*", None, &|state| state.mean_pressure),
            row("penetration", "um", Some(MICRO * self.printed.penetration), &|state| MICRO * state.penetration),
            row("penetration", "h_max", None, &|state| state.penetration / self.h_max),
            row("h_max", "um", None, &|_| MICRO * self.h_max),
            row("elements uniform", "1", Some(uniform), &|state| state.elements[0]),
            row("elements adaptive uniform", "1", Some(adaptive_uniform), &|state| state.elements[1]),
            row("elements adaptive", "1", Some(adaptive), &|state| state.elements[2]),
            row("elements adaptive with two rings", "1", Some(adaptive), &|state| state.two_rings),
            row("uniform to adaptive", "1", Some(uniform / adaptive), &|state| state.elements[0] / state.elements[2]),
            row("adaptive uniform to adaptive", "1", Some(adaptive_uniform / adaptive), &|state| {
                state.elements[1] / state.elements[2]
            }),
        ];
        Table::new("summary", &header, rows).rest(Rule::relative(NOISE))
    }

    fn counts(&self) -> Table {
        let [uniform, adaptive_uniform, adaptive] = MESHES.map(|mesh| mesh.2);
        let header = [
            "mean_pressure_over_e_star",
            "penetration_um",
            "penetration_over_h_max",
            "contact_fraction",
            uniform,
            adaptive_uniform,
            adaptive,
            "adaptive_two_rings",
        ];
        let rows = self.states.iter().map(|state| {
            let lengths = [MICRO * state.penetration, state.penetration / self.h_max];
            let numbers = [state.mean_pressure].into_iter().chain(lengths).chain([state.fraction]);
            numbers.chain(state.elements).chain([state.two_rings]).map(number).collect()
        });
        Table::new("counts", &header, rows).rest(Rule::of_scale(NOISE))
    }

    fn caption_of(&self, state: &State) -> String {
        let millions = |elements: [f64; 3]| {
            let [uniform, adaptive_uniform, adaptive] = elements.map(|n| n / MILLION);
            format!("{adaptive:.3} : {adaptive_uniform:.3} : {uniform:.3}")
        };
        let Params { waves, grid, seed, cell, .. } = self.params;
        let printed_state = self.at_fraction(self.printed_fraction());
        let short_of_full = printed_state.map_or(0.0, |state| self.h_max - state.penetration);
        let um = |length: f64| format!("{:.3} µm", MICRO * length);
        format!(
            "**Fig. 3.** Elements of the three meshes against penetration Δ (left) and contact fraction (right), for one \
             realisation (seed {seed}) of the paper's surface: H = 0.8, rms height {rms:.0} µm, N = {waves}, λ = {mm:.0} mm, \
             from touch to full contact. The smallest element has side λ/{grid} = λ_min/{per_wave}. The step λ_min/32 in \
             the text is its half side, as d in Eq. 5, because 4.2 million elements are 2048². At two-thirds contact the \
             meshes adaptive : adaptive uniform : uniform have {ours} million elements. The paper prints {theirs} \
             (squares).\n\n\
             The paper prints these numbers at \"Δ = 400 µm\". No contact has that Δ. Since v has zero mean and equals \
             h − h_max + Δ in contact, full contact is reached at Δ = h_max. Here h_max is {h_max} = {h_over_rms:.2} rms \
             heights, and 400 µm would be {printed_over_rms:.0} rms heights. If 40 µm is meant, the realisation needs an h_max \
             of at least 40 µm = 3.1 rms heights. The adaptive uniform mesh has only the elements in contact, so the numbers \
             give the contact fraction, 2.75e6 / 2048² = {fraction:.3}. The squares are drawn there. At that fraction Δ is \
             within {short} of h_max, where the counts change much within a fraction of a micrometre. The fraction therefore \
             determines the numbers, and Δ does not.\n\n\
             In full contact no border is left, and the rule gives one element for the whole cell.\n",
            rms = MICRO * self.rms_height,
            mm = 1e3 * cell,
            per_wave = grid / waves,
            ours = millions(state.elements),
            theirs = millions(self.printed.elements),
            h_max = um(self.h_max),
            h_over_rms = self.h_max / self.rms_height,
            printed_over_rms = self.printed.penetration / self.rms_height,
            fraction = self.printed_fraction(),
            short = um(short_of_full),
        )
    }

    /// Range of the axes of elements, with space for a name.
    fn y(&self) -> (f64, f64) {
        (0.0, 1.16 * (self.params.grid * self.params.grid) as f64 / self.unit())
    }

    /// Unit of the numbers of elements: a million, or a thousand when there are fewer.
    fn unit(&self) -> f64 {
        if self.params.grid > 1000 { MILLION } else { 1e3 }
    }

    /// Draws elements against Δ, with a scale in µm below and one in h_max above.
    fn draw_penetration<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let h_max = MICRO * self.h_max;
        let axes = self.axes((0.0, 1.03 * h_max), "penetration Δ (µm)");
        let mut chart = axes.with_top(area, h_max.recip(), "Δ / h_max")?;
        self.draw_curves(&mut chart, |state| MICRO * state.penetration)
    }

    /// Draws elements against the contact fraction, with the printed numbers.
    fn draw_fraction<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        // An empty second scale gives both panels the same height.
        let mut chart = self.axes((0.0, 1.03), "contact fraction A/A0").with_top(area, 1.0, "")?;
        self.draw_curves(&mut chart, |state| state.fraction)?;
        let uniform = self.states.last().map_or(0.0, |state| state.elements[0] / self.unit());
        let places = [
            ((0.02, uniform), Side::RightAbove),
            ((0.52, 0.44 * uniform), Side::Right),
            ((0.3, 0.05 * uniform), Side::Right),
        ];
        for ((_, name, _, colour), (at, side)) in MESHES.into_iter().zip(places) {
            write(&mut chart, at, side, name, colour)?;
        }
        // The printed numbers are for 128 waves on 2048² elements.
        if self.params.grid == PAPER_GRID {
            let printed = self.printed.elements.map(|elements| (self.printed_fraction(), elements / self.unit()));
            chart.draw_series(printed.into_iter().zip(MESHES).map(|(at, (.., colour))| {
                let square = |half: i32, fill: RGBColor| Rectangle::new([(-half, -half), (half, half)], fill.filled());
                EmptyElement::at(at) + square(13, colour) + square(9, WHITE)
            }))?;
            write(&mut chart, (0.66, 0.88 * uniform), Side::Left, "squares: the paper's numbers", BLACK)?;
        }
        Ok(())
    }

    fn axes<'a>(&self, x: (f64, f64), x_label: &'a str) -> Axes<'a> {
        let y_label = if self.params.grid > 1000 { "elements (millions)" } else { "elements (thousands)" };
        Axes { x, y: self.y(), x_label, y_label, n_labels: (7, 6) }
    }

    fn draw_curves<B: DrawingBackend>(&self, chart: &mut Chart<'_, B>, x: impl Fn(&State) -> f64) -> Drawn<(), B> {
        for (mesh, (.., colour)) in MESHES.iter().enumerate() {
            let points: Vec<(f64, f64)> = self.states.iter().map(|s| (x(s), s.elements[mesh] / self.unit())).collect();
            chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(3)))?;
            chart.draw_series(points.iter().map(|&at| Circle::new(at, 6, colour.filled())))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
