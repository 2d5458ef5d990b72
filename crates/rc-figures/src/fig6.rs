//! Fig. 6: contact spots of the paper's surface with 64 and 128 waves under one load.
//!
//! The paper shows one realisation of each surface. So its areas are compared within the scatter between realisations,
//! which is 5 %. Both surfaces here have one seed and share their long waves. The paper's two maps seem to do so as
//! well.

use std::f64::consts::TAU;

use anyhow::Result;
use plotters::prelude::DrawingBackend;
use rc_core::{Field, Grid, HeightField as _};
use rc_fractal::{SpectrumParams, Surface};
use rc_plot::{Area, Map, Picture, PictureError, Shade, draw_map};
use rc_solver::{Control, SolveParams, connected_elements, solve};

use crate::table::{quantity, summary};
use crate::{Figure, Preset, Rule, Table, paper};

/// Side of a map, in pixels. The space around it and the size of the text follow.
const PANEL: u32 = 1024;
const MARGIN: u32 = 32;
const TEXT: u32 = 28;
/// Blocks per side of the coarse table of contact fractions.
const N_BLOCKS: usize = 32;

/// Parameters of Fig. 6.
#[derive(Clone, Debug)]
pub struct Params {
    /// Mean pressure σ0/E*.
    mean_pressure: f64,
    /// Seed of the phases.
    seed: u64,
    /// Relative tolerance of the solves.
    tolerance: f64,
    /// The surfaces.
    cases: Vec<Case>,
}

/// One surface and its grid.
#[derive(Clone, Debug)]
struct Case {
    /// Number of waves N.
    waves: usize,
    /// Elements per side.
    grid: usize,
    /// A/A0 in the paper, if the paper has this N.
    paper_area: Option<f64>,
}

/// The contact of one surface, in units of λ and E*.
#[derive(Clone, Debug)]
struct Contact {
    case: Case,
    pressure: Field,
    area_cells: f64,
    area: f64,
    perimeter: f64,
    n_spots: usize,
    rms_slope: f64,
    /// κ = (A/A0) √⟨|∇h|²⟩ / (σ0/E*).
    kappa: f64,
    /// Ratio of Δ to the maximum height above the mean plane.
    penetration: f64,
    rms_pressure: f64,
}

/// The two contact maps with their numbers.
#[derive(Clone, Debug)]
pub struct Fig6 {
    contacts: Vec<Contact>,
    /// Side of the cell (m), for the scale bar.
    cell: f64,
}

impl Figure for Fig6 {
    const NAME: &'static str = "fig6";
    type Params = Params;

    /// 32 elements per shortest wave, twice as many as the paper's (full).
    ///
    /// The quick preset has fewer waves with 32 and 16 elements.
    fn params(preset: Preset) -> Result<Params> {
        let case = |name: &str, grid| -> Result<Case> {
            let waves = paper::value(&format!("waves_{name}"))? as usize;
            Ok(Case { waves, grid, paper_area: Some(paper::value(&format!("area_fraction_{name}"))?) })
        };
        let cases = match preset {
            Preset::Full => vec![case("a", 2048)?, case("b", 4096)?],
            Preset::Quick => [8, 16].map(|waves| Case { waves, grid: 256, paper_area: None }).into(),
        };
        let tolerance = match preset {
            Preset::Full => 1e-6,
            Preset::Quick => 1e-8,
        };
        Ok(Params { mean_pressure: paper::value("load")?, seed: 1, tolerance, cases })
    }

    fn compute(params: &Params) -> Result<Self> {
        let contacts = params.cases.iter().map(|case| contact(case, params)).collect::<Result<_>>()?;
        Ok(Self { contacts, cell: TAU / paper::value("q0")? })
    }

    fn tables(&self) -> Vec<Table> {
        vec![self.summary(), self.blocks()]
    }
}

impl Picture for Fig6 {
    fn size(&self) -> (u32, u32) {
        let n_panels = self.contacts.len() as u32;
        (n_panels * (PANEL + MARGIN) + MARGIN, PANEL + 2 * MARGIN + 4 * TEXT)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        for (i, contact) in (0_u32..).zip(&self.contacts) {
            let corner = ((MARGIN + i * (PANEL + MARGIN)) as i32, MARGIN as i32);
            let panel = area.clone().shrink(corner, (PANEL, PANEL + 4 * TEXT));
            let title = format!("N = {}, A/A0 = {:.4}", contact.case.waves, contact.area);
            let map = Map { title: &title, field: &contact.pressure, shade: Shade::Contact, side: self.cell };
            draw_map(&panel, &map, f64::from(TEXT))?;
        }
        Ok(())
    }
}

fn contact(case: &Case, params: &Params) -> Result<Contact> {
    let surface = Surface::new(&SpectrumParams::paper(case.waves, params.seed))?;
    let (heights, load) = (surface.on(Grid::square(case.grid)?), Control::MeanPressure(params.mean_pressure));
    let solution = solve(heights, load, &SolveParams::to_tolerance(params.tolerance))?;
    let area = solution.area();
    let rms_slope = surface.moments().rms_slope;
    Ok(Contact {
        case: case.clone(),
        area_cells: area.cells,
        area: area.fraction,
        perimeter: area.perimeter,
        n_spots: connected_elements(solution.pressure()).len(),
        rms_slope,
        kappa: area.fraction * rms_slope / params.mean_pressure,
        penetration: solution.info().penetration / solution.info().penetration_full_contact,
        rms_pressure: solution.pressure().rms(),
        pressure: solution.pressure().clone(),
    })
}

impl Fig6 {
    fn summary(&self) -> Table {
        let quantities = self.contacts.iter().flat_map(|contact| {
            let paper = contact.case.paper_area;
            let quantities = [
                quantity("area fraction", "A0", contact.area).paper(paper),
                quantity("area fraction by counting", "A0", contact.area_cells).paper(paper),
                quantity("perimeter", "cell side", contact.perimeter),
                quantity("contact spots", "1", contact.n_spots as f64),
                quantity("rms slope", "1", contact.rms_slope),
                quantity("kappa", "1", contact.kappa),
                quantity("penetration", "h_max", contact.penetration),
                quantity("rms pressure", "E*", contact.rms_pressure),
            ];
            quantities.map(|one| one.waves(contact.case.waves))
        });
        // A spot of one element may appear or vanish.
        summary(quantities, &["waves", "paper"])
            .column("value", Rule::relative(1e-4))
            .row("contact spots", Rule::count(0.0))
    }

    /// Table of the fractions in contact of `N_BLOCKS` × `N_BLOCKS` blocks.
    ///
    /// A line is a row of blocks. The lines of the first surface come first.
    fn blocks(&self) -> Table {
        let columns: Vec<String> = (0..N_BLOCKS).map(|column| format!("x{column}")).collect();
        let header: Vec<&str> = ["waves"].into_iter().chain(columns.iter().map(String::as_str)).collect();
        let rows = self.contacts.iter().flat_map(|contact| {
            let fractions = block_fractions(&contact.pressure, N_BLOCKS);
            let row = |fractions: &[f64]| {
                let cells = fractions.iter().map(|fraction| format!("{fraction:.4}"));
                [contact.case.waves.to_string()].into_iter().chain(cells).collect::<Vec<_>>()
            };
            fractions.chunks_exact(N_BLOCKS).map(row).collect::<Vec<_>>()
        });
        // One or two elements of a block of 64² may be in or out of contact.
        Table::new("blocks", &header, rows).rest(Rule::absolute(5e-4))
    }
}

/// Fraction in contact of each of `m` × `m` equal blocks of a square grid, row by row.
///
/// `m` must divide the side of the grid.
fn block_fractions(pressure: &Field, m: usize) -> Vec<f64> {
    let block = pressure.grid().nx() / m;
    let mut fractions = vec![0.0; m * m];
    for (i, _) in pressure.values().iter().enumerate().filter(|(_, p)| **p > 0.0) {
        let (row, column) = (i / pressure.grid().nx(), i % pressure.grid().nx());
        fractions[(row / block) * m + column / block] += ((block * block) as f64).recip();
    }
    fractions
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::tests::{assert_reviewed, assert_written};

    #[test]
    fn blocks_keep_the_area() {
        let rows = ["##..", "##.#", "....", "#..."];
        let values = rows.iter().flat_map(|row| row.bytes()).map(|byte| if byte == b'#' { 1.0 } else { 0.0 });
        let map = Field::new(Grid::square(4).expect("small grid"), values.collect()).expect("square map");
        assert_eq!(block_fractions(&map, 2), vec![1.0, 0.25, 0.25, 0.0]);
    }

    #[test]
    fn quick_figure_6_is_as_reviewed_and_can_be_drawn() {
        let params = Fig6::params(Preset::Quick).expect("paper values");
        let figure = Fig6::compute(&params).expect("the quick figure is solved");
        assert_reviewed(&figure, &params, &["fig6-summary", "fig6-blocks"]);
        assert_written(&figure);
    }
}
