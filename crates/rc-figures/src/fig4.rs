//! Fig. 4: a rigid sphere on the half-space, compared with Hertz's theory.
//!
//! It shows the contact circle and three sections of the pressure. The paper gives the penetration Δ = 25 µm, but not
//! the cell. In a periodic cell displacements have zero mean, so the same Δ is another contact than on an infinite
//! half-space. The difference is 4.6 % in radius at λ = 1 cm. The comparison is therefore with Hertz's solution in the
//! periodic cell. The infinite half-space is in the table too.

use std::ops::Range;

use anyhow::Result;
use plotters::prelude::{BLACK, DrawingBackend, RGBColor};
use rc_core::{DVec2, Elasticity, Field, Grid, PeriodicCell};
use rc_plot::{Area, Picture, PictureError};
use rc_solver::{Control, Method, Solution, SolveParams, solve};
use rc_theory::hertz::{Hertz, PeriodicHertz};

use crate::chart::{BLUE, Mark, Panel, Pen, RED, draw_panels};
use crate::table::Rows;
use crate::{Figure, Preset, Rule, Table, paper};

/// Distances of the three sections from the centre, in contact radii.
///
/// The sections are the rows nearest to these distances.
const SECTIONS: [f64; 3] = [0.0, 1.0 / 3.0, 2.0 / 3.0];
/// Colour of elements in contact.
const SHADE: RGBColor = RGBColor(205, 215, 225);
/// Half-width of the drawn region, in contact radii.
const VIEW: f64 = 1.25;

/// Parameters of Fig. 4, in SI units.
#[derive(Clone, Debug)]
pub struct Params {
    /// Radius R (m).
    radius: f64,
    /// Penetration Δ (m).
    penetration: f64,
    /// E* (Pa).
    e_star: f64,
    /// Side λ of the cell (m). The periodic formula needs a contact radius below a tenth of it.
    cell: f64,
    /// Elements per side.
    grid: usize,
    /// Tolerance relative to the height of the sphere within the cell. This height is a hundred times Δ.
    tolerance: f64,
}

/// Contact radius, load, peak pressure and penetration of one solution, in SI units.
#[derive(Clone, Copy, Debug)]
struct Contact {
    radius: f64,
    load: f64,
    peak: f64,
    penetration: f64,
}

/// The pressure along one row of elements.
#[derive(Clone, Debug)]
struct Section {
    /// Distance of the row from the centre (m).
    y: f64,
    /// x (m), pressure (Pa), and pressure of theory (Pa).
    points: Vec<[f64; 3]>,
}

/// The sphere's contact and its theory, in SI units.
#[derive(Clone, Debug)]
pub struct Fig4 {
    numeric: Contact,
    /// Hertz's contact in the periodic cell, at the same Δ.
    periodic: Contact,
    /// Hertz's contact on the infinite half-space, at the same Δ.
    infinite: Contact,
    sections: Vec<Section>,
    /// Runs of elements in contact: their row, and the range of their columns.
    runs: Vec<(usize, Range<usize>)>,
    /// Side of an element (m).
    side: f64,
    /// Index of the element under the apex, the same in x and in y.
    apex: usize,
}

impl Figure for Fig4 {
    const NAME: &'static str = "fig4";
    type Params = Params;

    /// 107 elements per contact radius (full) and 13 (quick), in a cell of 1 cm.
    ///
    /// The cell is that of the paper's rough surfaces.
    fn params(preset: Preset) -> Result<Params> {
        let elasticity = Elasticity::from_young_poisson(paper::value("young")?, paper::value("poisson")?)?;
        Ok(Params {
            radius: paper::value("sphere_radius")?,
            penetration: paper::value("sphere_penetration")?,
            e_star: elasticity.e_star(),
            cell: 1e-2,
            grid: match preset {
                Preset::Full => 2048,
                Preset::Quick => 256,
            },
            tolerance: 1e-9,
        })
    }

    fn compute(params: &Params) -> Result<Self> {
        let (heights, apex) = sphere(params)?;
        let control = Control::Penetration(params.penetration / params.cell);
        let solution = solve(&heights, control, &SolveParams::to_tolerance(params.tolerance).by(Method::Adaptive))?;
        let (periodic, infinite) = theory(params)?;
        let side = params.cell / params.grid as f64;
        Ok(Self {
            numeric: measure(params, &solution)?,
            sections: SECTIONS.map(|y| section(params, &solution, &periodic, apex, y)).into(),
            runs: runs(solution.pressure()),
            periodic,
            infinite,
            side,
            apex,
        })
    }

    fn tables(&self) -> Vec<Table> {
        vec![self.summary(), self.section_table()]
    }
}

impl Picture for Fig4 {
    fn size(&self) -> (u32, u32) {
        (1700, 900)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        // The space beside the axes is wider than the space above and below them, and the circle must be round.
        let (width, height) = Panel::plotting_size((self.size().1, self.size().1));
        let (left, right) = area.split_horizontally(self.size().1 + (height - width) as u32);
        self.map_panel().draw(&left)?;
        let sections: Vec<Panel> = self.sections.iter().map(|section| self.section_panel(section)).collect();
        draw_panels(&right, (SECTIONS.len(), 1), &sections)
    }
}

/// The paraboloid of Hertz's theory, h = -r²/2R in units of λ, and its apex.
///
/// r is the distance to the nearest image of the apex. The apex is the centre of the element with the returned index,
/// which is the same in x and y. So the maximum of the sampled heights is the apex, from which Δ is counted.
fn sphere(params: &Params) -> Result<(Field, usize)> {
    let grid = Grid::square(params.grid)?;
    let apex = params.grid / 2;
    let centre = grid.centre(apex, apex).x;
    let to_image = |x: f64| (x - centre) - (x - centre).round();
    let curvature = params.cell / params.radius;
    Ok((Field::from_fn(grid, |DVec2 { x, y }| -0.5 * curvature * to_image(x).hypot(to_image(y)).powi(2)), apex))
}

/// Hertz's contacts at the given Δ, in the periodic cell and on the infinite half-space.
fn theory(params: &Params) -> Result<(Contact, Contact)> {
    let Params { cell, e_star, .. } = *params;
    let (radius, penetration) = (params.radius / cell, params.penetration / cell);
    let to_si = |radius: f64, load: f64, peak: f64| Contact {
        radius: radius * cell,
        load: load * e_star * cell * cell,
        peak: peak * e_star,
        penetration: params.penetration,
    };
    let periodic = PeriodicHertz { radius }.at_penetration(penetration)?;
    let hertz = Hertz { radius };
    let a = hertz.contact_radius(penetration);
    Ok((
        to_si(periodic.contact_radius, periodic.load, periodic.peak_pressure),
        to_si(a, hertz.load(a), hertz.peak_pressure(a)),
    ))
}

/// The computed contact.
///
/// Its radius is from the area, and its load from the mean pressure.
fn measure(params: &Params, solution: &Solution<'_>) -> Result<Contact> {
    let area = solution.area();
    let nominal_area = PeriodicCell::new(params.cell)?.nominal_area();
    Ok(Contact {
        radius: (area.fraction * nominal_area / std::f64::consts::PI).sqrt(),
        load: solution.info().mean_pressure * params.e_star * nominal_area,
        peak: solution.pressure().max() * params.e_star,
        penetration: solution.info().penetration * params.cell,
    })
}

/// The section along the row nearest to `y_over_a` contact radii from the centre.
fn section(params: &Params, solution: &Solution<'_>, theory: &Contact, apex: usize, y_over_a: f64) -> Section {
    let side = params.cell / params.grid as f64;
    let row = apex + (y_over_a * theory.radius / side).round() as usize;
    let distance = |i: usize| (i as f64 - apex as f64) * side;
    let y = distance(row);
    let pressures = solution.pressure().row(row).iter().enumerate();
    let points = pressures.map(|(ix, pressure)| {
        let x = distance(ix);
        [x, pressure * params.e_star, theory.pressure(x.hypot(y))]
    });
    Section { y, points: points.filter(|[x, _, _]| x.abs() <= VIEW * theory.radius).collect() }
}

/// Maximal runs of elements in contact, row by row.
fn runs(pressure: &Field) -> Vec<(usize, Range<usize>)> {
    let mut runs = Vec::new();
    for row in 0..pressure.grid().ny() {
        let mut from = 0;
        for run in pressure.row(row).chunk_by(|a, b| (*a > 0.0) == (*b > 0.0)) {
            if run[0] > 0.0 {
                runs.push((row, from..from + run.len()));
            }
            from += run.len();
        }
    }
    runs
}

/// Name, unit and value of a quantity.
type Row = (&'static str, &'static str, fn(&Contact) -> f64);

impl Contact {
    /// Hertz's pressure at distance `r` from the centre, p0 √(1 - r²/a²).
    fn pressure(&self, r: f64) -> f64 {
        self.peak * (1.0 - (r / self.radius).powi(2)).max(0.0).sqrt()
    }
}

impl Fig4 {
    fn summary(&self) -> Table {
        let rows: [Row; 4] = [
            ("contact radius", "m", |contact| contact.radius),
            ("load", "N", |contact| contact.load),
            ("peak pressure", "Pa", |contact| contact.peak),
            ("penetration (given)", "m", |contact| contact.penetration),
        ];
        Rows::of(rows)
            .column("quantity", |row| row.0.to_owned())
            .column("unit", |row| row.1.to_owned())
            .within("numeric", Rule::relative(1e-5), |row| row.2(&self.numeric))
            .column("periodic_hertz", |row| row.2(&self.periodic))
            .within("relative_difference", Rule::absolute(1e-5), |row| {
                row.2(&self.numeric) / row.2(&self.periodic) - 1.0
            })
            .column("infinite_hertz", |row| row.2(&self.infinite))
            .table("summary")
    }

    fn section_table(&self) -> Table {
        let (a, p0) = (self.periodic.radius, self.periodic.peak);
        let points =
            self.sections.iter().flat_map(|section| section.points.iter().map(move |point| (section.y, point)));
        // Positions of zero have errors relative to the radius.
        Rows::of(points)
            .column("y_over_a", |(y, _)| y / a)
            .within("x_over_a", Rule::of_scale(1e-6), |(_, point)| point[0] / a)
            .within("pressure_over_p0", Rule::of_scale(1e-5), |(_, point)| point[1] / p0)
            .column("theory_over_p0", |(_, point)| point[2] / p0)
            .table("sections")
    }

    /// The elements in contact, the circle of theory, and the lines of the sections.
    fn map_panel(&self) -> Panel {
        let a = self.periodic.radius;
        let mut panel = Panel::new(("x / a", (-VIEW, VIEW)), ("y / a", (-VIEW, VIEW))).ticks(5, 5);
        let edge = |i: usize| (i as f64 - self.apex as f64 - 0.5) * self.side / a;
        for (row, Range { start, end }) in self.runs.iter().cloned() {
            let (left, right, low, high) = (edge(start), edge(end), edge(row), edge(row + 1));
            panel.body([(left, low), (right, low), (right, high), (left, high)], SHADE);
        }
        let circle = (0..=360).map(|degree| f64::from(degree).to_radians()).map(|angle| (angle.cos(), angle.sin()));
        panel.line(circle, Pen::new(BLUE, 2));
        for section in &self.sections {
            panel.line([-VIEW, VIEW].map(|x| (x, section.y / a)), Pen::new(BLACK, 1).dashed(8, 6));
        }
        panel.note((-VIEW, 1.15), "shaded: elements in contact, line: circle of theory");
        panel
    }

    /// The pressure of one section as in the paper: computed values and the line of theory.
    fn section_panel(&self, section: &Section) -> Panel {
        let (a, to_mpa) = (self.periodic.radius, 1e-6);
        let top = 1.3 * to_mpa * self.periodic.peak;
        let mut panel = Panel::new(("x / a", (-VIEW, VIEW)), ("p (MPa)", (0.0, top))).ticks(5, 5);
        let theory = (-500..=500).map(|i| VIEW * f64::from(i) / 500.0);
        let theory = theory.map(|x| (x, to_mpa * self.periodic.pressure((x * a).hypot(section.y))));
        panel.line(theory, Pen::new(BLUE, 2));
        // More dots would hide the line.
        let stride = section.points.len().div_ceil(64);
        let dots = section.points.iter().step_by(stride).filter(|[_, pressure, _]| *pressure > 0.0);
        panel.marks(dots.map(|&[x, pressure, _]| (x / a, to_mpa * pressure)), Mark::dot(RED, 4));
        panel.note((-VIEW, 0.9 * top), format!("y = {:.2} a: line Hertz, dots rc", section.y / a));
        panel
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::tests::{assert_reviewed, assert_written};

    #[test]
    fn the_apex_of_the_sphere_is_sampled() {
        let params = Params { grid: 64, ..Fig4::params(Preset::Quick).expect("paper values") };
        let (heights, apex) = sphere(&params).expect("a sphere");
        assert_eq!((heights.max(), heights.at(apex, apex)), (0.0, 0.0));
    }

    #[test]
    fn quick_figure_4_is_as_reviewed_and_can_be_drawn() {
        let params = Fig4::params(Preset::Quick).expect("paper values");
        let figure = Fig4::compute(&params).expect("the quick figure is solved");
        assert_reviewed(&figure, &params, &["fig4-summary", "fig4-sections"]);
        assert_written(&figure);
    }
}
