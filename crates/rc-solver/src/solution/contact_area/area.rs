//! The contact area, its edges and its error.

use std::f64::consts::{PI, SQRT_2};

use crate::solution::contact_area::edge_sums::EdgeSums;
use crate::solution::contact_area::sliding_edges::SlidingEdges;
use rayon::prelude::*;
use rc_core::{Boundary, EdgeBias, Field, Grid};

/// Contact area relative to the nominal area, with its edges and its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactArea {
    /// Fraction of elements with p > 0.
    ///
    /// It converges only at first order in the element size, from above.
    pub cells: f64,
    /// Number of edges of smallest elements between elements in and out of contact.
    pub perimeter_edges: usize,
    /// Length of the edges of all contacts, in λ, along the edges located between the centres of elements.
    ///
    /// The error is at most 0.3 % for a straight edge on squares, in any direction.
    pub perimeter: f64,
    /// Number of contacts minus the number of holes in them.
    ///
    /// Where elements touch only across a corner, half of them count as joined.
    pub euler_number: f64,
    /// Sum over edges of the deviation from the law of an edge.
    ///
    /// [`EdgeBias::per_deviation`] defines the deviation, which is that of the gap outside.
    pub gap_deviation: f64,
    /// Part of ⟨p²⟩ that the mean over elements misses, in E*².
    ///
    /// It is the sum of the parts at edges ([`EdgeBias::per_square`]) and inside contacts
    /// ([`EdgeBias::per_difference`]), and of a part of elastic rims that are thinner than an element.
    pub missing_square: f64,
    /// Best estimate of the area, from the edges between the centres of elements.
    pub fraction: f64,
    /// Estimated error of `fraction`. The true error is smaller in 95 % of scenes.
    ///
    /// `cargo xtask accuracy` measures this. The estimate comes from the number of edges that differ, their directions,
    /// gaps beside them and places that elements may hide. It does not cover slopes that jump, see `docs/accuracy.md`.
    pub error: f64,
    /// Sums at edges for the error bars of pressure and gap.
    pub(crate) rim: Rim,
}

/// Sums over the elements of contacts for error bars of pressure and gap. Areas are relative to the nominal area.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Rim {
    /// Σ over edges of the area of an element.
    pub(crate) area: f64,
    /// The same over edges where the pressure is a square root of the distance.
    pub(crate) smooth: f64,
    /// Area of the cell, in λ².
    pub(crate) cell: f64,
    /// Σ over smooth edges of an element's area times the squared pressure inside, in E*².
    pub(crate) squares: f64,
    /// The same squares in the mean over positions of the edges between elements, at least [`Rim::squares`].
    pub(crate) typical_squares: f64,
    /// The same over elements without a neighbour in contact along an axis.
    pub(crate) lone_squares: f64,
    /// Σ over elements in thin elastic rims of their area times p (H - p), in E*².
    pub(crate) thin_rims: f64,
    /// Scatter of [`Rim::thin_rims`]: the root of the sum of the squares of its terms, relative to H.
    pub(crate) scatter_of_thin: f64,
    /// Part of the edges that belong to plastic elements or to thin elastic rims.
    pub(crate) part_of_thin: f64,
    /// Part of the edges that belong to plastic elements.
    pub(crate) part_of_sharp: f64,
    /// Part of [`ContactArea::missing_square`] inside contacts, and its 95 % error.
    pub(crate) missing_inside: [f64; 2],
    /// Size of [`EdgeBias::per_square`].
    pub(crate) per_square: f64,
    /// [`EdgeBias::gap_errors`].
    pub(crate) gap_errors: [f64; 2],
    /// 95 % error of the mean gap from places that elements may hide, in λ.
    pub(crate) hidden_gap: f64,
    /// Number of edges that scatter independently, and number of smooth ones among them.
    ///
    /// Edges in a row with the same place between elements count as one, and so do those of identical asperities.
    pub(crate) independent_edges: f64,
    pub(crate) independent_smooth: f64,
    /// 95 % error of the penetration from the scatter of sharp edges, in λ.
    pub(crate) scatter_of_sharp: f64,
    /// Side of the smallest elements, in λ.
    pub(crate) side: f64,
    /// Loss tangent of the shortest wave, under a sliding surface.
    pub(crate) loss: f64,
    /// Squared pressure at free borders, in E*² λ.
    ///
    /// It is the sum of p² a s over elements along a border, with their area a and their side s across the border. The
    /// sum is zero where contact does not reach a free border.
    pub(crate) at_border: f64,
    /// The same at edges where heights jump.
    pub(crate) at_jumps: f64,
    /// Part of the edges where heights jump.
    pub(crate) part_of_jumps: f64,
}

/// 95 % error of the area, in elements, for one independent edge.
///
/// It grows with the root of the number of independent edges, and is the same on every mesh.
const SCATTER: f64 = 0.165;

/// The same for an edge where heights jump. It is anywhere between two centres.
const SCATTER_OF_JUMP: f64 = 0.57;

/// 95 % error of the bias, in elements, for each unit of [`ContactArea::gap_deviation`].
///
/// Gaps deviate where the mesh is coarse for the curvature of edges and for the distance between contacts.
const ERROR_OF_DEVIATION: f64 = 0.018;

/// 95 % error of the bias, relative to (count - `fraction`)² / `fraction`.
///
/// It is of second order.
const ERROR_OF_TERM: f64 = 0.3;

/// 95 % error for each diagonal above or below the expected number [`DIAGONALS`].
///
/// The bias is subtracted as for edges in all directions.
const ERROR_OF_DIRECTIONS: f64 = 0.1;

/// 95 % error of the bias, in elements, for each edge of elements that are not squares.
///
/// Its unit is the logarithm of the ratio of their sides.
const ERROR_OF_OBLONG: f64 = 0.04;

/// 95 % error, in elements, for each element that may hide a place out of contact.
const ERROR_OF_HIDDEN: f64 = 1.0;

/// Neighbours across a corner for each edge, in the mean over the directions of edges.
///
/// There are two where an edge is along the elements, and one where it is at 45 degrees to them.
const DIAGONALS: f64 = SQRT_2;

/// 95 % error of the penetration from sharp edges, in steps of the heights from element to element.
///
/// It is the error for one independent edge, and that of a height at a random place between two heights is uniform over
/// their step.
const SCATTER_OF_SHARP: f64 = 0.5;

/// Shift of the area by the singular pressure at a free border, and its 95 % error.
///
/// Elements make the patch narrower, so that the contact is pressed deeper ([`Rim::at_border`]). Their unit is the
/// change of the area with this depth ([`ContactArea::per_depth`]).
const SHIFT_AT_BORDER: [f64; 2] = [0.3, 0.5];

/// Error of the stiffness of a contact that reaches a free border, in its [`ContactArea::relative_error_at_border`].
///
/// That of a square flat punch is 0.29, on every mesh (test `the_bar_of_a_punch_holds_its_conductance`).
const STIFFNESS_AT_BORDER: f64 = 0.4;

/// 95 % error of the missing squares inside contacts from waves that the mesh hardly resolves.
///
/// It is relative to [`EdgeBias::per_difference`]. The ratio of squared second differences to squared differences is at
/// most 1.5 for waves of four elements and longer.
const ERROR_OF_SHORT_WAVES: f64 = 1.2;
const LONGEST_SHORT_WAVE: f64 = 1.5;

/// 95 % error of the place of an edge for a conducting spot, in elements, at edges where the pressure vanishes and at
/// edges of plastic elements.
///
/// Elements at the former edges are in contact if a part of them is, which is what a solve needs. The latter are in
/// contact if their centre is, which makes spots narrower.
const WIDTH_AT_EDGE: f64 = 0.03;
const WIDTH_AT_SHARP_EDGE: f64 = 0.16;

/// Ratio of the 95 % error of this width to that of the area.
const WIDTH_OF_AREA: f64 = 1.6;

/// Part of the squares of lone elements that they miss.
///
/// It is a mean over contacts of 0.3 to 0.8 elements in radius.
const OF_LONE_SQUARES: f64 = 0.25;

/// Smallest area of a contact, in the area of its elements. It carries load, so it has an area.
pub(crate) const SMALLEST: f64 = 0.1;

/// 95 % error of the area from the tolerance of the solve.
///
/// It is relative to the area and to the square of the energy error.
const ERROR_OF_SOLVE: f64 = 1.0;

/// Excess of the length along edges that are not sharp, relative to it, in the mean over directions.
///
/// Their positions have errors that depend on the place between two centres, so that a straight edge is found with
/// bends. The excess is 0 along the elements and at 45 degrees to them, and at most 0.005 at 18 to 27 degrees, for any
/// size of the elements.
const EXCESS_LENGTH: f64 = 0.0021;

/// 95 % error of the area under a sliding surface, for each unit of its change by other moduli at edges.
///
/// With [`OF_HIDDEN_LAG`], the bars of 98 % of 1299 areas held (440 rough scenes, both kernels, 4 to 16 elements a wave).
const MODULI: f64 = 2.5;

/// Part of [`SlidingEdges::hidden_lag`] that is missing from contacts, and its 95 % error.
///
/// In 300 rough scenes (both kernels, 4 to 16 elements a wave) it was 0.3 to 1.2 for lags of 0.1 to 1 elements.
const OF_HIDDEN_LAG: [f64; 2] = [0.7, 0.6];

impl ContactArea {
    /// The contact area of `pressure` and `gap` on a uniform grid.
    ///
    /// E* = 1 and λ = 1. The gap is zero in contact. `bias` is that of the kernel of the solution. The function makes
    /// one pass, and takes time only for elements in contact.
    ///
    /// # Panics
    /// When `pressure` and `gap` are not on the same grid.
    #[must_use]
    pub fn of(pressure: &Field, gap: &Field, bias: EdgeBias) -> Self {
        assert_eq!(pressure.grid(), gap.grid(), "pressure and gap on the same grid");
        Self::with_boundary(pressure, gap, bias, Boundary::Periodic)
    }

    /// The contact area, as [`ContactArea::of`], for heights with this `boundary`.
    ///
    /// The heights end at a free border. The border is not counted as an edge of the contact where contact reaches it.
    ///
    /// # Panics
    /// As [`ContactArea::of`].
    #[must_use]
    pub fn with_boundary(pressure: &Field, gap: &Field, bias: EdgeBias, boundary: Boundary) -> Self {
        assert_eq!(pressure.grid(), gap.grid(), "pressure and gap on the same grid");
        Self::of_hard([pressure, gap], f64::INFINITY, bias, boundary)
    }

    /// The contact area where pressures are at most the `hardness`.
    ///
    /// The gap of plastic elements is below the gap of contact.
    pub(crate) fn of_hard([pressure, gap]: [&Field; 2], hardness: f64, bias: EdgeBias, boundary: Boundary) -> Self {
        let grid = pressure.grid();
        let values = [pressure.values(), gap.values()];
        let at = |place: [usize; 2]| around(values, [grid.nx(), grid.ny()], place, boundary);
        let mut sums = sums_of_rows((grid, boundary), hardness, |i| values[0][i] > 0.0, at);
        if boundary == Boundary::Free {
            add_borders(&mut sums, pressure, hardness);
        }
        Self::from_sums(&[sums], grid, bias)
    }

    /// [`ContactArea::of_hard`] on a periodic cell, with moduli M of edges across x and across y in place of E* = 1.
    pub(crate) fn with_moduli(fields: [&Field; 2], hardness: f64, bias: EdgeBias, moduli: [f64; 2]) -> Self {
        let grid = fields[0].grid();
        let values = fields.map(Field::values);
        let between = (moduli[0] * moduli[1]).sqrt();
        let at = |place: [usize; 2]| {
            let around = around(values, [grid.nx(), grid.ny()], place, Boundary::Periodic);
            move |dx: isize, dy: isize| {
                let [pressure, gap] = around(dx, dy);
                let modulus = match (dx, dy) {
                    (_, 0) => moduli[0],
                    (0, _) => moduli[1],
                    _ => between,
                };
                [pressure, modulus * gap]
            }
        };
        let sums = sums_of_rows((grid, Boundary::Periodic), hardness, |i| values[0][i] > 0.0, at);
        Self::from_sums(&[sums], grid, bias)
    }

    /// The area under a sliding surface, from `area` for each of the moduli of the edges.
    pub(crate) fn of_sliding(edges: &SlidingEdges, area: impl Fn([f64; 2]) -> Self) -> Self {
        let [best, others @ ..] = edges.moduli.map(area);
        let off = others.iter().map(|other| (other.fraction - best.fraction).abs()).fold(0.0, f64::max);
        let [shift, error] = OF_HIDDEN_LAG.map(|part| part * edges.hidden_lag);
        Self {
            fraction: (best.fraction - shift).max(SMALLEST * best.cells),
            error: best.error.hypot(MODULI * off).hypot(error).min(1.0),
            rim: Rim { loss: edges.loss, ..best.rim },
            ..best
        }
    }

    /// The contact area from sums over elements of one size each.
    ///
    /// The smallest elements, those of the grid `finest`, come first. Then come those twice as large, and so on.
    pub(crate) fn from_sums(sums: &[EdgeSums], finest: Grid, bias: EdgeBias) -> Self {
        let (area, scatter) = Self::with_scatter(sums, finest, bias);
        let mean_pressure = size_of_elements(finest, sums).map(|(size, sums)| size * sums.pressure).sum();
        let [shift, error] = SHIFT_AT_BORDER.map(|part| part * area.change_by_border(mean_pressure));
        let error = scatter.error(area.cells - area.fraction, area.fraction.max(0.1 * area.cells)).hypot(error);
        Self { fraction: (area.fraction - shift).max(SMALLEST * area.cells), error: error.min(1.0), ..area }
    }

    /// The area without its error, and the data that the error follows from.
    pub(crate) fn with_scatter(sums: &[EdgeSums], finest: Grid, bias: EdgeBias) -> (Self, Scatter) {
        let sides: [f64; 2] = finest.spacing().into();
        let mut area = Self {
            cells: 0.0,
            perimeter_edges: 0,
            perimeter: 0.0,
            euler_number: 0.0,
            gap_deviation: 0.0,
            missing_square: 0.0,
            fraction: 0.0,
            error: 0.0,
            rim: Rim::of(sums, finest, bias),
        };
        let mut scatter = Scatter::default();
        for (coarser, (size, sums)) in size_of_elements(finest, sums).enumerate() {
            let (edges, contacts) = (sums.edges as f64, 0.25 * sums.turns as f64);
            let counted = sums.n_contact as f64;
            let [shift, deviation] = sums.of_all();
            // The biases are those of edges at which the pressure is a square root.
            let (smooth, of_contacts) = (sums.smooth() as f64, contacts * sums.smooth() as f64 / edges.max(1.0));
            let shift =
                0.5 * shift - bias.per_edge * smooth - bias.per_contact * of_contacts - bias.per_deviation * deviation;
            area.cells += size * counted;
            area.fraction += size * (counted + shift);
            area.euler_number += contacts;
            area.gap_deviation += deviation;
            area.perimeter_edges += sums.edges << coarser;
            area.perimeter += sums.length * (1.0 - EXCESS_LENGTH * smooth / edges.max(1.0));
            let of_bias = bias.per_edge_error.hypot(ERROR_OF_OBLONG * (sides[0] / sides[1]).ln());
            scatter.add(size, sums, [deviation, of_bias * smooth]);
        }
        let rim = &area.rim;
        area.missing_square =
            bias.per_square * rim.squares + OF_LONE_SQUARES * rim.lone_squares + rim.missing_inside[0];
        area.fraction = area.fraction.clamp(0.0, 1.0);
        (area, scatter)
    }

    /// Change of the area with the depth of the contact, dA/dΔ, in 1/λ. It is 0 without edges.
    ///
    /// Round contacts of the radius a with the pressure c √s at the distance s from their edge. A stamp of this radius
    /// has E* dΔ/(π √(2 a s)), so the edge moves by 2 E* dΔ/(π c √(2 a)).
    fn per_depth(&self) -> f64 {
        let Rim { area, smooth, squares, side, cell, .. } = self.rim;
        if squares == 0.0 || self.fraction == 0.0 {
            return 0.0;
        }
        // On average, the last element of a contact is half an element from the edge.
        let c = (2.0 * squares / (smooth * side)).sqrt();
        let radius = 2.0 * self.fraction * cell / self.perimeter;
        2.0 * self.perimeter * (smooth / area) / (PI * c * (2.0 * radius).sqrt() * cell)
    }

    /// Unit of [`SHIFT_AT_BORDER`].
    fn change_by_border(&self, mean_pressure: f64) -> f64 {
        if self.rim.at_border > 0.0 { self.rim.at_border / mean_pressure * self.per_depth() } else { 0.0 }
    }

    /// Change of the area with the logarithm of the load: A at light loads, and 0 in full contact.
    pub(crate) fn growth(&self) -> f64 {
        self.fraction * (1.0 - self.fraction)
    }

    /// Adds the error that the tolerance of the solve leaves.
    ///
    /// `energy_error` is √(G/U), the relative error of the pressure in the energy norm, below a third. The error of the
    /// area is of its square.
    pub(crate) fn with_energy_error(self, energy_error: f64) -> Self {
        Self { error: self.error.hypot(ERROR_OF_SOLVE * energy_error.powi(2) * self.fraction), ..self }
    }

    /// Relative error of the width of contact spots, which their conductance is proportional to.
    ///
    /// It is the width by which elements miss the edges, in units of the width 2 A/P of the spots and 2 (1 - A)/P of the
    /// places between them, which constrict the current where they are narrow. Where contact reaches a free border, the
    /// current spreads beyond it, and full contact conducts as well as the whole patch.
    pub(crate) fn relative_error_of_width(&self) -> f64 {
        if self.fraction == 0.0 {
            return 0.0;
        }
        let free = if self.rim.at_border > 0.0 { 1.0 } else { (1.0 - self.fraction).max(f64::MIN_POSITIVE) };
        let sharp = self.rim.part_of_sharp;
        let of_edge = WIDTH_AT_EDGE * (1.0 - sharp) + WIDTH_AT_SHARP_EDGE * sharp;
        let edges = of_edge * self.rim.area / (2.0 * self.fraction);
        ((WIDTH_OF_AREA * self.relative_error()).hypot(edges) / free).min(1.0)
    }

    /// Relative error of a `stiffness` (E*/λ) from the singular pressure at a free border, under a mean pressure (E*).
    ///
    /// The depth of the contact has the error [`Rim::at_border`] over the pressure, and the stiffness is a pressure over a
    /// depth.
    pub(crate) fn relative_error_at_border(&self, stiffness: f64, mean_pressure: f64) -> f64 {
        if self.rim.at_border > 0.0 {
            STIFFNESS_AT_BORDER * self.rim.at_border * stiffness / mean_pressure.powi(2)
        } else {
            0.0
        }
    }

    /// Part of the contact edges at which the heights jump, as at the edge of a flat top.
    ///
    /// Such an edge is anywhere between two samples of the heights.
    #[must_use]
    pub fn part_of_jumps(&self) -> f64 {
        self.rim.part_of_jumps
    }

    /// Ratio of `error` to `fraction`. It is 0 without contact.
    #[must_use]
    pub fn relative_error(&self) -> f64 {
        if self.fraction > 0.0 { self.error / self.fraction } else { 0.0 }
    }
}

/// Sums over the elements of a grid that are in contact.
///
/// `at` gives pressure and gap around each place. The gap of contact is subtracted from the gap.
pub(crate) fn sums_of_rows<A: Fn(isize, isize) -> [f64; 2]>(
    (grid, boundary): (Grid, Boundary),
    hardness: f64,
    is_in_contact: impl Fn(usize) -> bool + Sync,
    at: impl Fn([usize; 2]) -> A + Sync,
) -> EdgeSums {
    let (nx, sides) = (grid.nx(), grid.spacing().into());
    let row_sums = |iy: usize| {
        let mut sums = EdgeSums::default();
        for ix in (0..nx).filter(|ix| is_in_contact(iy * nx + ix)) {
            sums.add(sides, hardness, &at([ix, iy]), &distance([nx, grid.ny()], [ix, iy], boundary));
        }
        sums
    };
    let rows: Vec<EdgeSums> = (0..grid.ny()).into_par_iter().map(row_sums).collect();
    rows.into_iter().fold(EdgeSums::default(), |a, b| a + b)
}

/// Adds the pressures along the borders of a grid.
fn add_borders(sums: &mut EdgeSums, pressure: &Field, hardness: f64) {
    let grid = pressure.grid();
    let (extent, sides) = ([grid.nx(), grid.ny()], grid.spacing().into());
    let [nx, ny] = extent;
    let is_border = |iy: usize| iy == 0 || iy + 1 == ny;
    for iy in 0..ny {
        // Of a row inside, only the first and the last element.
        for ix in (0..nx).step_by(if is_border(iy) { 1 } else { (nx - 1).max(1) }) {
            sums.add_at_border(pressure.at(ix, iy), hardness, [[ix, iy], extent], sides);
        }
    }
}

/// Area of the elements of each of the sums, relative to the nominal area.
fn size_of_elements(finest: Grid, sums: &[EdgeSums]) -> impl Iterator<Item = (f64, &EdgeSums)> {
    let smallest = 1.0 / finest.len() as f64;
    sums.iter().enumerate().map(move |(coarser, sums)| (smallest * f64::from(1_u32 << (2 * coarser)), sums))
}

impl Rim {
    fn of(sums: &[EdgeSums], finest: Grid, bias: EdgeBias) -> Self {
        let area = finest.spacing().x * finest.spacing().y;
        let mut rim = Self {
            per_square: bias.per_square.abs(),
            gap_errors: bias.gap_errors,
            side: area.sqrt(),
            cell: area * finest.len() as f64,
            ..Self::default()
        };
        let (mut scatter_of_thin, mut scatter_of_sharp, mut step) = (0.0_f64, 0.0_f64, [0.0; 2]);
        for (size, sums) in size_of_elements(finest, sums) {
            let (edges, together) = (sums.edges as f64, edges_that_scatter_together(sums));
            let (sharp, smooth) = (sums.sharp as f64, (sums.smooth() - sums.thin) as f64);
            rim.area += size * edges;
            rim.smooth += size * smooth;
            rim.squares += size * sums.squares;
            // Where p² is linear, that of the second element is on average three times that of the first.
            rim.typical_squares += size * sums.squares.max(sums.next_squares / 3.0);
            rim.lone_squares += size * sums.lone_squares;
            rim.hidden_gap += size * (size * rim.cell).sqrt() * sums.hidden_rises;
            rim.thin_rims += size * sums.thin_rims;
            scatter_of_thin += size.powi(2) * sums.thin_rims_squared * together;
            rim.part_of_sharp += size * sharp;
            rim.missing_inside[0] +=
                size * (bias.per_difference * sums.differences + bias.per_second_difference * sums.second_differences);
            let of_short_waves = (sums.second_differences - LONGEST_SHORT_WAVE * sums.differences).max(0.0);
            rim.missing_inside[1] += size
                * (bias.per_difference_error * sums.differences
                    + ERROR_OF_SHORT_WAVES * bias.per_difference.abs() * of_short_waves);
            rim.independent_edges += edges / together;
            rim.independent_smooth += smooth / together;
            rim.at_border += size * sums.at_border;
            rim.at_jumps += size * sums.at_jumps;
            rim.part_of_jumps += size * sums.jumps as f64;
            scatter_of_sharp += size.powi(2) * sharp * together;
            step = [step[0] + size * sums.steps, step[1] + size * sums.known_sharp as f64];
        }
        rim.scatter_of_thin = scatter_of_thin.sqrt();
        if rim.area > 0.0 {
            rim.part_of_jumps /= rim.area;
            // Rounding may leave less than nothing of many elastic edges.
            rim.part_of_thin = (1.0 - rim.smooth / rim.area - rim.part_of_jumps).max(0.0);
            rim.part_of_sharp /= rim.area;
        }
        if step[1] > 0.0 {
            rim.scatter_of_sharp = SCATTER_OF_SHARP * scatter_of_sharp.sqrt() / rim.area * step[0] / step[1];
        }
        rim
    }
}

/// The data that the error of an area follows from.
#[derive(Default)]
pub(crate) struct Scatter {
    /// Sum of squared errors of independent edges.
    edges: f64,
    /// Errors that are common to all edges, each as a sum.
    deviation: f64,
    bias: f64,
    directions: f64,
    hidden: f64,
}

impl Scatter {
    /// Adds elements of one size with these sums of the deviation and of the error of the bias.
    fn add(&mut self, size: f64, sums: &EdgeSums, [deviation, bias]: [f64; 2]) {
        let edges = sums.edges as f64;
        let (jumps, together) = (sums.jumps as f64, edges_that_scatter_together(sums));
        let squares = SCATTER.powi(2) * (edges - jumps) + SCATTER_OF_JUMP.powi(2) * jumps;
        self.edges += size.powi(2) * squares * together;
        self.deviation += ERROR_OF_DEVIATION * size * deviation;
        self.bias += size * bias;
        self.directions += ERROR_OF_DIRECTIONS * size * (sums.diagonals as f64 - DIAGONALS * edges);
        self.hidden += ERROR_OF_HIDDEN * size * sums.hidden as f64;
    }

    /// The error of an area that differs from the count by `term`.
    ///
    /// Contacts of single elements may have no area at all. `size` is therefore not only the area. It is at least a
    /// part of the count.
    pub(crate) fn error(&self, term: f64, size: f64) -> f64 {
        let of_term = ERROR_OF_TERM * term.powi(2) / size.max(f64::MIN_POSITIVE);
        let common = [self.deviation, self.bias, self.directions, self.hidden];
        common.into_iter().fold(self.edges.sqrt().hypot(of_term), f64::hypot).min(1.0)
    }
}

/// Number of edges with about the same place between elements.
///
/// They are edges in a row, or edges of identical asperities ([`EdgeSums::copies`]). It is 1 for edges in all
/// directions. For edges along the elements it is the number of all edges. An edge has two diagonals if its neighbour
/// along the contact is in the same row or column, and one at a step.
fn edges_that_scatter_together(sums: &EdgeSums) -> f64 {
    let edges = sums.edges.max(1) as f64;
    let steps = (2.0 - sums.diagonals as f64 / edges).max(f64::MIN_POSITIVE);
    // Long edges of a small slope are correlated over more than one step.
    let in_rows = ((2.0 - DIAGONALS) / steps).max(1.0).powf(1.5);
    in_rows.max(sums.copies()).min(edges).max(1.0)
}

/// Pressure and gap at places around an element of a grid.
///
/// Beyond a free border they are the values beside the border.
pub(crate) fn around(
    [pressure, gap]: [&[f64]; 2],
    [nx, ny]: [usize; 2],
    [ix, iy]: [usize; 2],
    boundary: Boundary,
) -> impl Fn(isize, isize) -> [f64; 2] {
    let place = move |i: usize, d: isize, n: usize| match boundary {
        // A division for each neighbour would take most of the time of the sums.
        Boundary::Periodic => match (i + n).wrapping_add_signed(d) {
            place if place >= n && place < 2 * n => place - n,
            place => place % n,
        },
        Boundary::Free => i.saturating_add_signed(d).min(n - 1),
    };
    move |dx, dy| {
        let place = place(iy, dy, ny) * nx + place(ix, dx, nx);
        [pressure[place], gap[place]]
    }
}

/// Distance of the places around an element of a grid, in its sides. It is 0 beyond a free border.
pub(crate) fn distance([nx, ny]: [usize; 2], [ix, iy]: [usize; 2], boundary: Boundary) -> impl Fn(isize, isize) -> f64 {
    let is_place = |i: usize, d: isize, n: usize| i.checked_add_signed(d).is_some_and(|i| i < n);
    move |dx, dy| {
        let is_inside = boundary == Boundary::Periodic || (is_place(ix, dx, nx) && is_place(iy, dy, ny));
        f64::from(u8::from(is_inside))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums of the edge of a half plane, in a cell of 64 elements.
    ///
    /// The edge has this slope against the rows. Its positions between elements are not known.
    fn sums_of_edge(slope: f64) -> EdgeSums {
        let mut sums = EdgeSums::default();
        let at = |x: isize, y: isize| if (y as f64) < slope * x as f64 + 0.5 { [1.0, 0.0] } else { [0.0, f64::NAN] };
        for x in 0..64 {
            for y in -2..66 {
                if at(x, y)[0] > 0.0 {
                    sums.add([1.0 / 64.0; 2], f64::INFINITY, &|dx, dy| at(x + dx, y + dy), &|_, _| 1.0);
                }
            }
        }
        sums
    }

    #[test]
    fn edges_along_the_elements_scatter_together_and_oblique_ones_do_not() {
        let along = sums_of_edge(0.0);
        assert_eq!((along.edges, along.diagonals), (64, 128));
        assert!((edges_that_scatter_together(&along) - 64.0).abs() < 1e-9);
        let oblique = sums_of_edge(1.0);
        assert!((edges_that_scatter_together(&oblique) - 1.0).abs() < 1e-9, "{oblique:?}");
        let gentle = edges_that_scatter_together(&sums_of_edge(0.1));
        assert!((2.0..20.0).contains(&gentle), "{gentle}");
        assert!((edges_that_scatter_together(&EdgeSums::default()) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn holes_are_counted_against_contacts() {
        let grid = Grid::square(32).expect("a grid");
        let contacts = |inside: fn(f64, f64) -> bool| {
            let pressure = Field::from_fn(grid, |at| if inside(at.x, at.y) { 1.0 } else { 0.0 });
            ContactArea::of(&pressure, &Field::zeros(grid), EdgeBias::default()).euler_number
        };
        let disc = contacts(|x, y| (x - 0.5).hypot(y - 0.5) < 0.3);
        let ring = contacts(|x, y| (0.15..0.3).contains(&(x - 0.5).hypot(y - 0.5)));
        let pair = contacts(|x, y| ((x - 0.5).abs() - 0.25).hypot(y - 0.5) < 0.15);
        for (name, found, expected) in [("disc", disc, 1.0), ("ring", ring, 0.0), ("pair of discs", pair, 2.0)] {
            assert!((found - expected).abs() < 1e-12, "{name}: {found}");
        }
    }
}
