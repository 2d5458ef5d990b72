//! Quantities that users compute from a solution: area, pressure, gap, energy.

use rc_core::{Boundary, EdgeBias};

use crate::descent::info::GridSolution;
use crate::descent::info::SolveInfo;
use crate::parallel;
use crate::solution::contact_area::area::{ContactArea, Rim};
use crate::solution::contact_area::plastic::PlasticContact;
use crate::solution::contact_area::plastic::PlasticEdges;
use crate::solution::contact_area::sliding_edges::SlidingEdges;

/// Observables of a solution, in units of λ and E*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observables {
    /// Contact area.
    pub area: ContactArea,
    /// Root mean square pressure of the elements, over the cell.
    pub rms_pressure: f64,
    /// Root mean square pressure over the cell, corrected: the best estimate.
    ///
    /// The correction adds the part of ⟨p²⟩ that elements miss ([`ContactArea::missing_square`]): at contact edges,
    /// inside contacts, and in elastic rims thinner than an element.
    pub rms_pressure_corrected: f64,
    /// Estimated discretisation error of `rms_pressure_corrected`.
    ///
    /// `None` where contact reaches a free border, and where heights jump at its edges, because the rms of the singular
    /// pressure there has no limit. With a
    /// kernel without an error inside contacts, it is `None` in full contact without a coarser level to compare with.
    pub rms_pressure_error: Option<f64>,
    /// Maximum pressure.
    pub max_pressure: f64,
    /// Mean gap, h_max - mean(h) - Δ.
    ///
    /// With a hardness, the overlap that plastic flow has removed is added.
    pub mean_gap: f64,
    /// Estimated discretisation error of `mean_gap`.
    pub mean_gap_error: f64,
    /// Elastic energy per nominal area, ½ mean(p v).
    pub elastic_energy: f64,
    /// The plastic part of the contact. `None` without a hardness.
    pub plastic: Option<PlasticContact>,
}

impl Observables {
    /// Evaluates the observables of a solution.
    ///
    /// It passes over the fields once, or twice with a hardness. `bias` shifts the edges of contacts. The pressure is
    /// at most the `hardness`.
    ///
    /// `sliding` has the edges under a sliding surface.
    pub(crate) fn of(
        solution: &GridSolution,
        hardness: f64,
        bias: EdgeBias,
        boundary: Boundary,
        sliding: Option<SlidingEdges>,
    ) -> Self {
        let fields = [&solution.pressure, &solution.gap];
        let area = match sliding {
            None => ContactArea::of_hard(fields, hardness, bias, boundary),
            Some(edges) => {
                ContactArea::of_sliding(&edges, |moduli| ContactArea::with_moduli(fields, hardness, bias, moduli))
            }
        };
        let plastic = hardness.is_finite().then(|| PlasticEdges::of(fields, hardness, bias, boundary));
        let pressure = &solution.pressure;
        let rms = parallel::rms(pressure.values(), pressure.grid().nx());
        Self::new(&solution.info, (area, plastic), hardness, [rms, parallel::maximum(pressure.values(), 0.0)])
    }

    /// Observables from the contact area and the pressures of the elements.
    ///
    /// The error bars include the remaining error of the iteration.
    pub(crate) fn new(
        info: &SolveInfo,
        (area, plastic): (ContactArea, Option<PlasticEdges>),
        hardness: f64,
        [rms_pressure, max_pressure]: [f64; 2],
    ) -> Self {
        // Where the pressure leaves q = H - p to the hardness, edges of q are like other edges. p² is H² - 2 H q + q².
        let rest = plastic.map(|edges| edges.rest).filter(|rest| rest.perimeter_edges > 0);
        let of_rest = |of_area: &dyn Fn(&ContactArea) -> f64| rest.as_ref().map_or(0.0, of_area);
        // Differences of p are also those of q.
        let missing_square = area.missing_square
            + of_rest(&|rest| rest.missing_square - rest.rim.missing_inside[0])
            + of_thin_rims(&area, plastic.as_ref());
        let area = ContactArea { missing_square, ..area };
        let flow = plastic.map_or(0.0, |edges| edges.contact.mean_gap);
        // The contact carries at most the hardness, and the plastic part is in it.
        let least = plastic.map_or(0.0, |edges| edges.contact.fraction.max(info.mean_pressure / hardness).min(1.0));
        let area = ContactArea { fraction: area.fraction.max(least), ..area };
        let bars = plastic.map(|edges| edges.contact.with_wider_bars(area));
        let observables = Self {
            area: bars.map_or(area, |(area, _)| area),
            rms_pressure,
            // Pressures are at most the hardness, so ⟨p²⟩ is at most σ0 H.
            rms_pressure_corrected: corrected(rms_pressure, &area)
                .min((info.mean_pressure * hardness).sqrt().max(rms_pressure)),
            rms_pressure_error: rms_pressure_error(info, (&area, rest.as_ref()), [rms_pressure, max_pressure]),
            max_pressure,
            mean_gap: (info.mean_gap() + flow).max(0.0),
            mean_gap_error: mean_gap_error(info, &area, rms_pressure)
                .hypot(of_rest(&|rest| mean_gap_error(info, rest, rms_pressure))),
            elastic_energy: info.elastic_energy,
            plastic: bars.map(|(_, plastic)| plastic),
        };
        observables.with_energy_error(info.iteration_error)
    }

    /// Adds to the error bars what follows from the relative error of the load under a given penetration.
    ///
    /// Contacts grow with the load as [`ContactArea::growth`] says, and ⟨p²⟩ in proportion to it. `gap` is the error of
    /// the penetration. In full contact the stiffness is infinite, and nothing is known of the load.
    pub(crate) fn with_load_error(self, load: f64, gap: f64) -> Self {
        if !load.is_finite() {
            return self;
        }
        let grown = load * self.area.growth();
        let area = ContactArea { error: self.area.error.hypot(grown).min(1.0), ..self.area };
        Self {
            area,
            rms_pressure_error: self.rms_pressure_error.map(|bar| bar.hypot(0.5 * load * self.rms_pressure_corrected)),
            mean_gap_error: self.mean_gap_error.hypot(gap),
            plastic: self.plastic.map(|plastic| PlasticContact { error: plastic.error.hypot(grown), ..plastic }),
            ..self
        }
    }

    /// The part of the error of the penetration at a free border that is none of the mean gap.
    ///
    /// In contact, the patch is displaced with the penetration, so that only the gap beside contacts has the error.
    pub(crate) fn hidden_depth_error(&self, info: &SolveInfo) -> f64 {
        depth_error_at_border(info, &self.area) * (1.0 - gap_per_depth(&self.area).powi(2)).sqrt()
    }

    /// Adds to the error bars the errors from the tolerance of the solve.
    ///
    /// `energy_error` is √(G/U), the relative error of the pressure in the energy norm. Observables have errors of its
    /// square.
    fn with_energy_error(self, energy_error: f64) -> Self {
        let with = |bar: f64, value: f64| bar.hypot(energy_error.powi(2) * value);
        Self {
            area: self.area.with_energy_error(energy_error),
            rms_pressure_error: self
                .rms_pressure_error
                .map(|bar| with(bar, PRESSURE_OF_SOLVE * self.rms_pressure_corrected)),
            mean_gap_error: with(self.mean_gap_error, GAP_OF_SOLVE * self.mean_gap),
            // Where the edge of the plastic part moves, the edge of the contact moves too.
            plastic: self
                .plastic
                .map(|plastic| PlasticContact { error: with(plastic.error, self.area.fraction), ..plastic }),
            ..self
        }
    }
}

/// The rms pressure, corrected for the error of Σ p² at edges of contacts.
fn corrected(rms_pressure: f64, area: &ContactArea) -> f64 {
    rms_pressure.mul_add(rms_pressure, area.missing_square).max(0.0).sqrt()
}

/// Errors of rms pressure and mean gap from the tolerance of the solve.
///
/// They are relative to the values, and to the square of the energy error.
const PRESSURE_OF_SOLVE: f64 = 1.0;
const GAP_OF_SOLVE: f64 = 0.5;

/// 95 % error of the squared pressure at one independent edge. The mean over few edges scatters.
const SQUARE_SCATTER: f64 = 0.39;

/// 95 % errors of the parts of [`ContactArea::missing_square`], relative to them.
///
/// They are the parts of edges, of elements in lone rows, as a multiple of their squares, and of thin rims.
const ERROR_OF_SQUARES: f64 = 0.6;
const ERROR_OF_LONE: f64 = 0.8;
const ERROR_OF_THIN_RIMS: f64 = 0.2;

/// 95 % error of [`Rim::thin_rims`] in units of [`Rim::scatter_of_thin`].
const SCATTER_OF_THIN: f64 = 1.4;

/// Part of [`Rim::thin_rims`] that ⟨p²⟩ misses if all edges are thin and almost all of the contact is plastic.
///
/// The pressure of an element in such a rim is a part of the hardness on a part of the element. Where the mesh resolves
/// most rims, the last element of a rim is an edge like others.
const OF_THIN_RIMS: f64 = 0.85;

/// Part of ⟨p²⟩ that elements in thin elastic rims miss.
fn of_thin_rims(area: &ContactArea, plastic: Option<&PlasticEdges>) -> f64 {
    let of_contact = plastic.map_or(0.0, |edges| per_contact_area(edges.contact.fraction, area));
    let part = of_contact.clamp(0.0, 1.0) * area.rim.part_of_thin;
    OF_THIN_RIMS * part.powf(1.5) * area.rim.thin_rims
}

/// Ratio of the error of the rms pressure in full contact to its last change.
///
/// That is the change by the last halving of the elements. There are no edges, and the error is of second order, so a
/// third is expected.
const OF_CHANGE: f64 = 0.4;

/// Part of edges where heights jump, and the pressure is singular, above which the rms pressure has no limit.
const MANY_JUMPS: f64 = 0.25;

/// Estimated error of the rms pressure, see [`Observables::rms_pressure_error`].
fn rms_pressure_error(
    info: &SolveInfo,
    (area, rest): (&ContactArea, Option<&ContactArea>),
    [rms_pressure, max_pressure]: [f64; 2],
) -> Option<f64> {
    if area.rim.at_border > 0.0 || area.rim.part_of_jumps > MANY_JUMPS {
        return None;
    }
    let rest = rest.filter(|rest| rest.perimeter_edges > 0);
    if area.perimeter_edges == 0 && rest.is_none() && area.rim.missing_inside[0] == 0.0 {
        return info.coarser.map(|coarser| OF_CHANGE * (rms_pressure - coarser.rms_pressure).abs());
    }
    let (rim, of_rest) = (&area.rim, rest.map_or(0.0, |rest| error_of_squares(&rest.rim)));
    // Beside a thin rim, the pressure is the hardness.
    let of_thin_rims = (ERROR_OF_THIN_RIMS * rim.thin_rims).hypot(SCATTER_OF_THIN * max_pressure * rim.scatter_of_thin);
    let parts = [error_of_squares(rim), of_rest, of_thin_rims, rim.missing_inside[1]];
    Some(0.5 * parts.into_iter().fold(0.0, f64::hypot) / rms_pressure)
}

/// Widening of the error of ⟨p²⟩ at edges with the loss tangent of the shortest wave, under a sliding surface.
///
/// The modulus changes within an element of the edge, and the pressure is no square root there. Without it, the bars of
/// 74 to 94 % of 300 rough scenes held.
const OF_LOSS: f64 = 2.0;

/// Estimated error of ⟨p²⟩ at edges, but for thin rims.
fn error_of_squares(rim: &Rim) -> f64 {
    let scatter = SQUARE_SCATTER * rim.typical_squares / rim.independent_smooth.max(1.0).sqrt();
    let (edges, lone) = (ERROR_OF_SQUARES * rim.per_square * rim.squares, ERROR_OF_LONE * rim.lone_squares);
    (1.0 + OF_LOSS * rim.loss) * scatter.hypot(edges).hypot(lone)
}

/// 95 % error of the mean gap, relative to the penetration and to the square of the relative error of the area.
///
/// It matters for contacts of a few elements.
const GAP_OVER_AREA: f64 = 3.0;

/// 95 % error of the mean gap from singular pressure at free borders.
///
/// Its unit is the ratio of `Rim::at_border` to the mean pressure. The second number is multiplied by the part of the
/// patch in contact: errors of edges inside the patch have the other sign. The measured values are in docs/constants.md.
const GAP_AT_BORDER: [f64; 2] = [0.4, 0.3];

/// 95 % error of the penetration from singular pressure at free borders.
fn depth_error_at_border(info: &SolveInfo, area: &ContactArea) -> f64 {
    let part = GAP_AT_BORDER[0] + GAP_AT_BORDER[1] * area.fraction;
    part * area.rim.at_border / info.mean_pressure.max(f64::MIN_POSITIVE)
}

/// Largest change of the mean gap with the penetration where contact reaches a free border.
fn gap_per_depth(area: &ContactArea) -> f64 {
    (1.0 - area.fraction).clamp(0.0, 1.0)
}

/// Estimated error of the mean gap. It is 0 without contact.
fn mean_gap_error(info: &SolveInfo, area: &ContactArea, rms_pressure: f64) -> f64 {
    let (rim, mean_pressure) = (area.rim, info.mean_pressure.max(f64::MIN_POSITIVE));
    let of_element = rim.side * rms_pressure * rms_pressure / mean_pressure;
    let [common, scatter] = rim.gap_errors;
    let scatter = common.hypot(scatter / rim.independent_edges.max(1.0).sqrt());
    let parts = [
        of_element * rim.area / area.cells.max(f64::MIN_POSITIVE) * scatter,
        rim.scatter_of_sharp,
        rim.hidden_gap,
        GAP_OVER_AREA * area.relative_error().min(1.0).powi(2) * info.penetration.abs(),
        gap_per_depth(area) * depth_error_at_border(info, area),
        (GAP_AT_BORDER[0] + GAP_AT_BORDER[1] * area.fraction) * rim.at_jumps / mean_pressure,
        // The overlap that the certificate has found.
        info.certificate.penetration * info.penetration_full_contact,
    ];
    parts.into_iter().fold(0.0, f64::hypot)
}

/// `value` relative to the contact area, and 0 without contact.
fn per_contact_area(value: f64, area: &ContactArea) -> f64 {
    if area.fraction > 0.0 { value / area.fraction } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use rc_core::{DVec2, Field, Grid, Silent};

    use crate::problem::contact_problem::ContactProblem;
    use crate::problem::control::Control;
    use crate::problem::method::Method;
    use crate::solve::params::SolveParams;

    /// A sphere at loose tolerances, with energy errors up to a fifth. Their bars alone hold the change to the exact
    /// solution.
    #[test]
    fn the_energy_error_holds_what_a_loose_tolerance_changes() {
        let n = 128;
        let place = DVec2::new(0.503, 0.497);
        let heights = Field::from_fn(Grid::square(n).expect("grid"), |at| -(at - place).length_squared());
        let range = heights.max() - heights.min();
        let mean_pressure = 2e-3;
        let solve = |tolerance: f64| {
            let params = SolveParams::to_tolerance(tolerance).by(Method::Uniform);
            let problem = ContactProblem::new(&heights, Control::MeanPressure(mean_pressure));
            problem.solve(&params, &Silent).expect("solvable")
        };
        let exact = *solve(1e-11).observables();
        for tolerance in [1e-3, 1e-4, 1e-5] {
            let solution = solve(tolerance);
            let found = *solution.observables();
            let gap = solution.info().certificate.complementarity * range;
            let energy_error = (gap * mean_pressure / found.elastic_energy).sqrt();
            let mut bare = found;
            bare.area.error = 0.0;
            (bare.rms_pressure_error, bare.mean_gap_error) = (Some(0.0), 0.0);
            let bars = bare.with_energy_error(energy_error);
            assert!((found.area.fraction - exact.area.fraction).abs() <= bars.area.error, "{tolerance:e}: {bars:?}");
            let change = (found.rms_pressure_corrected - exact.rms_pressure_corrected).abs();
            assert!(change <= bars.rms_pressure_error.expect("a bar"), "{tolerance:e}: {change:e}, {bars:?}");
            let change = (found.mean_gap - exact.mean_gap).abs();
            assert!(change <= bars.mean_gap_error, "{tolerance:e}: {change:e}, {bars:?}");
            assert_eq!(found.with_energy_error(0.0), found);
        }
    }
}
