//! Contact spots: the connected parts of the contact. Their areas are resolved below the element.

use rc_core::{Boundary, EdgeBias, Field, Grid};

use crate::solution::contact_area::area::ContactArea;
use crate::solution::contact_area::area::{SMALLEST, around, distance};
use crate::solution::contact_area::edge_sums::EdgeSums;

/// One connected part of the contact.
///
/// Elements are connected across their edges and across the sides of a periodic cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSpot {
    /// Number of its elements.
    pub elements: usize,
    /// Ratio of its area to the area of the cell.
    ///
    /// Edges are located between the centres of elements, as for [`ContactArea::fraction`]. The areas of all spots add
    /// up to the contact area. Each is at least a tenth of its elements if the contact area allows it, and above zero if
    /// that is. The area of a spot of one element may be wrong by half an element.
    pub area_fraction: f64,
    /// Length of its edge, in λ ([`ContactArea::perimeter`]).
    pub perimeter: f64,
    /// 1 minus the number of its holes.
    pub euler_number: f64,
    /// Its share of the mean pressure, in E*.
    pub mean_pressure: f64,
}

impl ContactSpot {
    /// The spots of a contact, largest first.
    ///
    /// Of equal spots, the one that begins in an earlier row comes first. `pressure`, `gap` and `bias` are those of
    /// [`ContactArea::of`].
    ///
    /// # Panics
    /// When `pressure` and `gap` are not on the same grid.
    #[must_use]
    pub fn all(pressure: &Field, gap: &Field, bias: EdgeBias) -> Vec<Self> {
        Self::with_boundary(pressure, gap, bias, Boundary::Periodic)
    }

    /// The spots of a contact, as [`ContactSpot::all`], for heights with this `boundary`.
    ///
    /// Spots are not connected across free borders.
    ///
    /// # Panics
    /// As [`ContactSpot::all`].
    #[must_use]
    pub fn with_boundary(pressure: &Field, gap: &Field, bias: EdgeBias, boundary: Boundary) -> Vec<Self> {
        Self::with_hardness([pressure, gap], f64::INFINITY, bias, boundary)
    }

    /// The spots of a contact whose pressures are at most `hardness` (in E*).
    ///
    /// Edges of plastic elements are located as for the contact area. The gap of plastic elements is that of contact
    /// minus the overlap that plastic flow has removed.
    ///
    /// # Panics
    /// As [`ContactSpot::all`].
    #[must_use]
    pub fn with_hardness(fields: [&Field; 2], hardness: f64, bias: EdgeBias, boundary: Boundary) -> Vec<Self> {
        Self::located(fields, hardness, bias, boundary, None)
    }

    /// The spots, as [`ContactSpot::with_hardness`], of a solution with the contact area `area_fraction`.
    ///
    /// Their areas add up to it. It differs from the area on the fields where these are means over the elements of the
    /// solution, or where the mesh was not the grid.
    ///
    /// # Panics
    /// As [`ContactSpot::all`].
    #[must_use]
    pub fn with_area(
        fields: [&Field; 2],
        hardness: f64,
        bias: EdgeBias,
        boundary: Boundary,
        area_fraction: f64,
    ) -> Vec<Self> {
        Self::located(fields, hardness, bias, boundary, Some(area_fraction))
    }

    /// The spots with this contact area, or with that of the fields.
    fn located(
        [pressure, gap]: [&Field; 2],
        hardness: f64,
        bias: EdgeBias,
        boundary: Boundary,
        area_fraction: Option<f64>,
    ) -> Vec<Self> {
        assert_eq!(pressure.grid(), gap.grid(), "pressure and gap on the same grid");
        let grid = pressure.grid();
        let (nx, ny) = (grid.nx(), grid.ny());
        let sides = grid.spacing().into();
        let spot = |elements: Vec<usize>| {
            let (mut sums, mut load) = (EdgeSums::default(), 0.0);
            for &element in &elements {
                load += pressure.values()[element];
                let at = [element % nx, element / nx];
                let around = around([pressure.values(), gap.values()], [nx, ny], at, boundary);
                sums.add(sides, hardness, &around, &distance([nx, ny], at, boundary));
            }
            let area = ContactArea::from_sums(&[sums], grid, bias);
            Self {
                elements: elements.len(),
                area_fraction: area.fraction,
                perimeter: area.perimeter,
                euler_number: area.euler_number,
                mean_pressure: load / grid.len() as f64,
            }
        };
        let mut spots: Vec<Self> = connected(pressure, boundary).into_iter().map(spot).collect();
        let area = || ContactArea::of_hard([pressure, gap], hardness, bias, boundary).fraction;
        share(&mut spots, area_fraction.unwrap_or_else(area), grid);
        spots.sort_by(|a, b| b.area_fraction.total_cmp(&a.area_fraction));
        spots
    }
}

/// Changes the areas of `spots` on `grid` so that they add up to `area`.
///
/// All edges are moved by the same distance. No spot becomes smaller than [`SMALLEST`], unless `area` is too small for
/// that.
fn share(spots: &mut [ContactSpot], area: f64, grid: Grid) {
    let smallest = |spot: &ContactSpot| SMALLEST * spot.elements as f64 / grid.len() as f64;
    let moved =
        |spot: &ContactSpot, distance: f64| (spot.area_fraction + distance * spot.perimeter).max(smallest(spot));
    let total = |distance: f64| spots.iter().map(|spot| moved(spot, distance)).sum::<f64>();
    let edges: f64 = spots.iter().map(|spot| spot.perimeter).sum();
    // All spots are the smallest at the first distance, and too large at the second.
    let most_inward = |spot: &ContactSpot| (smallest(spot) - spot.area_fraction) / spot.perimeter;
    let with_edges = spots.iter().filter(|spot| spot.perimeter > 0.0);
    let mut low = with_edges.map(most_inward).fold(0.0, f64::min);
    let all: f64 = spots.iter().map(|spot| spot.area_fraction).sum();
    let mut high = if edges > 0.0 { ((area - all) / edges).max(low) } else { low };
    if total(low) < area {
        // Halvings of an interval end when its ends are neighbours.
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if total(middle) < area { low = middle } else { high = middle }
        }
    }
    let distance = low;
    // What rounding leaves, or the whole difference where there are no edges to move.
    let found = total(distance);
    let factor = if area > 0.0 && found > 0.0 { area / found } else { 1.0 };
    for spot in spots {
        spot.area_fraction = factor * moved(spot, distance);
    }
}

/// Number of halvings of the distance by which edges move.
const BISECTIONS: usize = 60;

/// The elements in contact of each spot, in the order in which spots begin.
///
/// They are connected across their edges and the sides of the cell.
#[must_use]
pub fn connected_elements(pressure: &Field) -> Vec<Vec<usize>> {
    connected(pressure, Boundary::Periodic)
}

/// The elements of each spot on heights with this boundary.
fn connected(pressure: &Field, boundary: Boundary) -> Vec<Vec<usize>> {
    let grid = pressure.grid();
    let mut waiting: Vec<bool> = pressure.values().iter().map(|p| *p > 0.0).collect();
    let mut spots = Vec::new();
    for start in 0..grid.len() {
        if !std::mem::take(&mut waiting[start]) {
            continue;
        }
        let (mut spot, mut next) = (vec![start], 0);
        while let Some(&element) = spot.get(next) {
            next += 1;
            let beside = neighbours(grid, [element % grid.nx(), element / grid.nx()], boundary);
            spot.extend(beside.into_iter().filter(|&place| std::mem::take(&mut waiting[place])));
        }
        spots.push(spot);
    }
    spots
}

/// The elements across the four edges of one element, around the periodic cell.
///
/// Across a free border it is the element itself.
fn neighbours(grid: Grid, [ix, iy]: [usize; 2], boundary: Boundary) -> [usize; 4] {
    let beside = |i: usize, n: usize| match boundary {
        Boundary::Periodic => [(i + 1) % n, (i + n - 1) % n],
        Boundary::Free => [(i + 1).min(n - 1), i.saturating_sub(1)],
    };
    let ([right, left], [above, below]) = (beside(ix, grid.nx()), beside(iy, grid.ny()));
    [grid.index(right, iy), grid.index(left, iy), grid.index(ix, above), grid.index(ix, below)]
}

#[cfg(test)]
mod tests {
    use rc_core::testing::quasi_random;
    use rc_core::{DVec2, Kernel as _};
    use rc_kernel::Love;

    use super::*;

    /// Two Hertz-like contacts of radii 0.2 and 0.1, one of them across a corner of the cell.
    #[test]
    fn spots_have_the_areas_of_circles_and_add_up_to_the_contact() {
        let grid = Grid::square(256).expect("a grid");
        let circles = [([0.02, 0.97], 0.2_f64), ([0.47, 0.52], 0.1)];
        let depth = |x: f64, y: f64| {
            let inside = circles.map(|([cx, cy], a)| {
                let wrap = |d: f64| d - d.round();
                a - wrap(x - cx).hypot(wrap(y - cy))
            });
            inside[0].max(inside[1])
        };
        let pressure = Field::from_fn(grid, |DVec2 { x, y }| depth(x, y).max(0.0).sqrt());
        let gap = Field::from_fn(grid, |DVec2 { x, y }| 4.0 / 3.0 * (-depth(x, y)).max(0.0).powf(1.5));
        // Values this exact have no first-order error to subtract.
        let none = EdgeBias::NONE;
        let spots = ContactSpot::all(&pressure, &gap, none);
        assert_eq!(spots.len(), 2);
        for (spot, (_, a)) in spots.iter().zip(circles) {
            let (area, edge) = (std::f64::consts::PI * a * a, std::f64::consts::TAU * a);
            assert!((spot.area_fraction / area - 1.0).abs() < 5e-3, "{spot:?} against {area}");
            assert!((spot.perimeter / edge - 1.0).abs() < 2e-2, "{spot:?} against {edge}");
            assert!((spot.euler_number - 1.0).abs() < 1e-12, "{spot:?}");
        }
        let bias = Love.edge_bias(grid);
        let (spots, all) = (ContactSpot::all(&pressure, &gap, bias), ContactArea::of(&pressure, &gap, bias));
        let sum = |of: fn(&ContactSpot) -> f64| spots.iter().map(of).sum::<f64>();
        assert!((sum(|spot| spot.area_fraction) / all.fraction - 1.0).abs() < 1e-12);
        assert!((sum(|spot| spot.mean_pressure) / pressure.mean() - 1.0).abs() < 1e-12);
    }

    /// Elements that are not squares locate a round contact as well as squares.
    ///
    /// Each edge is located with the side of the element across it. The squares have the same size.
    #[test]
    fn elements_that_are_not_squares_locate_edges_as_well() {
        let none = EdgeBias::NONE;
        let depth = |x: f64, y: f64| 0.23 - (x - 0.501).hypot(y - 0.497);
        let found = |nx: usize, ny: usize| {
            let grid = Grid::new(nx, ny).expect("a grid");
            let pressure = Field::from_fn(grid, |DVec2 { x, y }| depth(x, y).max(0.0).sqrt());
            let gap = Field::from_fn(grid, |DVec2 { x, y }| 4.0 / 3.0 * (-depth(x, y)).max(0.0).powf(1.5));
            ContactArea::of(&pressure, &gap, none)
        };
        let squares = found(256, 256);
        for (nx, ny) in [(256, 128), (128, 256), (512, 128), (128, 512)] {
            let others = found(nx, ny);
            assert!((others.fraction / squares.fraction - 1.0).abs() < 1.5e-3, "{nx} x {ny}: {others:?}, {squares:?}");
            assert!((others.perimeter / squares.perimeter - 1.0).abs() < 5e-3, "{nx} x {ny}: {others:?}, {squares:?}");
        }
    }

    /// The spot of a single contact has its area, also with plastic edges.
    ///
    /// The overlap would end at the middle of a sharp edge.
    #[test]
    fn a_spot_with_plastic_edges_has_the_area_of_the_contact() {
        let (grid, hardness, radius) = (Grid::square(64).expect("a grid"), 1e-2, 0.231);
        let depth = |DVec2 { x, y }| radius - (x - 0.5_f64).hypot(y - 0.5);
        let pressure = Field::from_fn(grid, |at| if depth(at) > 0.0 { hardness } else { 0.0 });
        let gap = Field::from_fn(grid, |at| -depth(at));
        let bias = Love.edge_bias(grid);
        let spots = ContactSpot::with_hardness([&pressure, &gap], hardness, bias, Boundary::Periodic);
        let area = ContactArea::of_hard([&pressure, &gap], hardness, bias, Boundary::Periodic);
        assert_eq!(spots.len(), 1);
        assert!((spots[0].area_fraction / area.fraction - 1.0).abs() < 1e-12, "{spots:?}, {area:?}");
        let exact = std::f64::consts::PI * radius * radius;
        assert!((spots[0].area_fraction / exact - 1.0).abs() < 5e-3, "{spots:?} for {exact}");
        let elastic = ContactSpot::all(&pressure, &gap, bias);
        assert!((elastic[0].area_fraction / exact - 1.0).abs() > 1e-2, "{elastic:?} for {exact}");
    }

    /// Spots of single elements, pairs and more, with areas below zero by their gaps.
    #[test]
    fn every_spot_has_an_area_and_all_add_up_to_the_contact() {
        let grid = Grid::square(64).expect("a grid");
        for (seed, part) in [(1, 0.02), (2, 0.1), (3, 0.3), (4, 0.7), (5, 1.0)] {
            let noise = |i: usize| quasi_random((i * i + 7919 * seed * i) % 1_000_003);
            let value = |i: usize| if noise(i) < part { 1e-3 * (0.01 + noise(i + 5000)) } else { 0.0 };
            let pressure = Field::new(grid, (0..grid.len()).map(value).collect()).expect("a field");
            let gap =
                pressure.values().iter().enumerate().map(|(i, p)| if *p > 0.0 { 0.0 } else { 1e-4 * noise(i + 9) });
            let gap = Field::new(grid, gap.collect()).expect("a field");
            let bias = Love.edge_bias(grid);
            let of_fields = ContactArea::of(&pressure, &gap, bias).fraction;
            let on_fields = (ContactSpot::all(&pressure, &gap, bias), of_fields);
            let element = 1.0 / grid.len() as f64;
            let given = [0.2 * element, 0.5 * of_fields, 1.05 * of_fields].map(|area| {
                let fields = [&pressure, &gap];
                (ContactSpot::with_area(fields, f64::INFINITY, bias, Boundary::Periodic, area), area)
            });
            for (spots, area) in std::iter::once(on_fields).chain(given).filter(|(_, area)| *area > 0.0) {
                let sum: f64 = spots.iter().map(|spot| spot.area_fraction).sum();
                assert!((sum / area - 1.0).abs() < 1e-12, "{part}: {sum} for {area}");
                assert!(spots.iter().all(|spot| spot.area_fraction > 0.0), "{part}, {area}: {spots:?}");
            }
        }
    }

    #[test]
    fn spots_join_across_edges_and_the_sides_of_the_cell_and_not_across_corners() {
        #[rustfmt::skip]
        let values = vec![
            1.0, 0.0, 0.0, 2.0,
            0.0, 3.0, 0.0, 0.0,
            0.0, 0.0, 0.0, 0.0,
            5.0, 0.0, 0.0, 0.0,
        ];
        let grid = Grid::square(4).expect("a grid");
        let field = Field::new(grid, values).expect("a field");
        let spots = ContactSpot::all(&field, &Field::zeros(grid), Love.edge_bias(grid));
        assert_eq!(spots.iter().map(|spot| spot.elements).collect::<Vec<_>>(), [3, 1]);
        assert!((spots[0].mean_pressure - 0.5).abs() < 1e-15, "{spots:?}");
        assert_eq!(ContactSpot::all(&Field::zeros(grid), &Field::zeros(grid), Love.edge_bias(grid)), []);
    }

    #[test]
    fn the_sides_of_the_cell_join_and_full_contact_is_one() {
        let count = |rows: [&str; 4]| {
            let values = rows.iter().flat_map(|row| row.bytes()).map(|byte| f64::from(u8::from(byte == b'#')));
            let map = Field::new(Grid::square(4).expect("a grid"), values.collect()).expect("16 values");
            connected_elements(&map).len()
        };
        assert_eq!(count(["#..#", "....", "....", "...."]), 1);
        assert_eq!(count(["#...", "....", "....", "#..."]), 1);
        assert_eq!(count(["#...", ".#..", "....", "...."]), 2);
        assert_eq!(count(["....", "....", "....", "...."]), 0);
        assert_eq!(count(["####", "####", "####", "####"]), 1);
    }
}
