//! The film on coarser grids and with smaller contacts, for the error bar of its permeance.

use rc_core::Field;

/// Minimum number of elements along a side of a grid that has a coarser one.
const FEWEST: usize = 4;

/// Ratio of the gaps of elements one and two from the edge of a contact.
///
/// The gap opens with the power 3/2 of the distance.
const NEXT_TO_EDGE: f64 = 0.353_553_390_593_273_8;

/// Ratio of the error to the range of the permeances on the grid and on coarser grids.
///
/// The permeance converges at orders between 1 and 2, at which the error is 1 and 1/3 of the difference from a grid of
/// half the resolution.
const SHARE: f64 = 0.5;

/// The film on grids of half the resolution; empty if a side has fewer than four elements.
///
/// The first one is every second element, the second the elements diagonally between them, and the third the mean of
/// each two by two elements. Of an odd number of lines, the last one is left out (the first one, on the second grid).
pub(crate) fn coarser(gap: &Field) -> Vec<Field> {
    let (nx, ny) = (gap.grid().nx(), gap.grid().ny());
    let [mx, my] = [nx / 2, ny / 2];
    let Ok(grid) = gap.grid().with_elements(mx.max(1), my.max(1)) else { return Vec::new() };
    if nx.min(ny) < FEWEST {
        return Vec::new();
    }
    let of = |value: &dyn Fn(usize, usize) -> f64| {
        Field::new(grid, (0..mx * my).map(|i| value(2 * (i % mx), 2 * (i / mx))).collect()).ok()
    };
    let (odd_x, odd_y) = (nx % 2, ny % 2);
    let even = of(&|x, y| gap.at(x, y));
    let between = of(&|x, y| gap.at(x + 1 + odd_x, y + 1 + odd_y));
    let mean = of(&|x, y| 0.25 * (gap.at(x, y) + gap.at(x + 1, y) + gap.at(x, y + 1) + gap.at(x + 1, y + 1)));
    [even, between, mean].into_iter().flatten().collect()
}

/// The film when the edges of all contacts are one element further in.
///
/// Two elements in contact that touch at a corner close the film between them, though it may be open there.
pub(crate) fn opened(gap: &Field) -> Field {
    let (nx, ny) = (gap.grid().nx(), gap.grid().ny());
    let mut opened = gap.clone();
    for (i, value) in opened.values_mut().iter_mut().enumerate().filter(|(_, gap)| **gap <= 0.0) {
        let (x, y) = (i % nx, i / nx);
        let around = [((x + 1) % nx, y), ((x + nx - 1) % nx, y), (x, (y + 1) % ny), (x, (y + ny - 1) % ny)];
        *value = NEXT_TO_EDGE * around.map(|(x, y)| gap.at(x, y)).into_iter().fold(0.0, f64::max);
    }
    opened
}

/// The error bar of a permeance, from those of variants of the film.
///
/// It is half of their range. If only some of them percolate, the film is open on one grid and closed on another, so
/// there is no order of convergence. The bar is then the whole range.
pub(crate) fn error_bar(permeance: f64, variants: &[f64]) -> f64 {
    let [least, most] =
        variants.iter().fold([permeance; 2], |[least, most], variant| [least.min(*variant), most.max(*variant)]);
    if least > 0.0 { SHARE * (most - least) } else { most - least }
}
