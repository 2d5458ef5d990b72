//! Load that stays where it is when tensile pressures are clipped.
//!
//! Clipping adds load, which must be removed again. Removing it from the whole cell would move load over long
//! distances. Steps that are long enough for contacts to change would then undo their progress in long waves.
//!
//! The load of a step is therefore kept in squares of the cell, as far as there are pressures. The load of a square is
//! divided among its quarters by the loads that they have, down to the smallest squares. Between the centres of the
//! smallest squares, the loads before and after are interpolated. Their ratio is the factor on pressures.

/// Minimum number of elements along a side of the smallest squares.
///
/// The number of squares is a power of two. `docs/constants.md` compares 8 to 128.
const SMALLEST_SQUARE: usize = 64;

/// Minimum part of its load that a square keeps after clipping.
///
/// Where contacts vanish, the load before clipping may be zero.
const LEAST_PART: f64 = 0.5;

/// The load of a square.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Load {
    /// Σ p after clipping.
    pub(crate) clipped: f64,
    /// Sum of the pressures that clipping has added.
    pub(crate) added: f64,
}

impl Load {
    /// The load that it should have.
    fn part(self) -> f64 {
        (self.clipped - self.added).max(LEAST_PART * self.clipped)
    }

    pub(crate) fn plus(self, other: Self, area: f64) -> Self {
        Self { clipped: self.clipped + area * other.clipped, added: self.added + area * other.added }
    }
}

/// The division of the cell into squares.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Squares {
    /// Number of squares along both axes, powers of two.
    n: [usize; 2],
}

impl Squares {
    /// Squares of a cell with these numbers of elements along both axes.
    pub(crate) fn new(sides: [usize; 2]) -> Self {
        Self { n: sides.map(|side| 1 << (side / SMALLEST_SQUARE).max(1).ilog2()) }
    }

    pub(crate) fn len(self) -> usize {
        self.n[0] * self.n[1]
    }

    /// The square around a place, which is in parts of the cell.
    pub(crate) fn at(self, place: [f64; 2]) -> usize {
        let [x, y] = [0, 1].map(|axis| ((place[axis] * self.n[axis] as f64) as usize).min(self.n[axis] - 1));
        y * self.n[0] + x
    }
}

/// Factors on the pressures of a cell.
pub(crate) struct Shares {
    squares: Squares,
    /// The wanted load and the present load of each square.
    loads: Vec<[f64; 2]>,
}

impl Shares {
    /// Factors for the `loads` of squares. The sum of the loads stays as it is.
    pub(crate) fn new(squares: Squares, loads: &[Load]) -> Self {
        let mut levels = vec![(squares.n, loads.to_vec())];
        while let Some((n, finer)) = levels.last().filter(|(n, _)| *n != [1, 1]) {
            let half = n.map(|n| n.div_ceil(2));
            let mut coarser = vec![Load::default(); half[0] * half[1]];
            for (i, load) in finer.iter().enumerate() {
                let over = parent(i, *n, half);
                coarser[over] = coarser[over].plus(*load, 1.0);
            }
            levels.push((half, coarser));
        }
        let mut wanted = vec![levels.last().map_or(0.0, |(_, whole)| whole[0].clipped)];
        for pair in levels.windows(2).rev() {
            let [(n, finer), (half, _)] = pair else { unreachable!("windows of two") };
            let mut parts = vec![0.0; half[0] * half[1]];
            for (i, load) in finer.iter().enumerate() {
                parts[parent(i, *n, *half)] += load.part();
            }
            let of_square = |(i, load): (usize, &Load)| {
                let over = parent(i, *n, *half);
                if parts[over] > 0.0 { wanted[over] * (load.part() / parts[over]) } else { 0.0 }
            };
            wanted = finer.iter().enumerate().map(of_square).collect();
        }
        Self { squares, loads: wanted.into_iter().zip(loads).map(|(wanted, load)| [wanted, load.clipped]).collect() }
    }

    /// The maximum factor.
    pub(crate) fn maximum(&self) -> f64 {
        let factors = self.loads.iter().filter(|[_, clipped]| *clipped > 0.0).map(|[wanted, clipped]| wanted / clipped);
        factors.fold(1.0, f64::max)
    }

    /// The wanted gains of squares, relative to the `rooms` that their pressures have.
    pub(crate) fn changes(&self, rooms: &[f64]) -> Self {
        let loads = self.loads.iter().zip(rooms).map(|([wanted, clipped], room)| [wanted - clipped, *room]);
        Self { squares: self.squares, loads: loads.collect() }
    }

    /// The factor at a place, which is in parts of the cell.
    pub(crate) fn at(&self, place: [f64; 2]) -> f64 {
        let n = self.squares.n;
        let [(x, ax), (y, ay)] = [0, 1].map(|axis| {
            let from_centre = place[axis] * n[axis] as f64 - 0.5;
            let before = from_centre.floor();
            (
                [
                    (before as isize).rem_euclid(n[axis] as isize) as usize,
                    (before as isize + 1).rem_euclid(n[axis] as isize) as usize,
                ],
                from_centre - before,
            )
        });
        let mut sum = [0.0; 2];
        for (y, weight_y) in y.into_iter().zip([1.0 - ay, ay]) {
            for (x, weight_x) in x.into_iter().zip([1.0 - ax, ax]) {
                let [wanted, clipped] = self.loads[y * n[0] + x];
                sum = [sum[0] + weight_x * weight_y * wanted, sum[1] + weight_x * weight_y * clipped];
            }
        }
        if sum[1] > 0.0 { sum[0] / sum[1] } else { 1.0 }
    }
}

/// The square that contains square `i` of a level of `n` squares.
fn parent(i: usize, n: [usize; 2], half: [usize; 2]) -> usize {
    let [x, y] = [i % n[0], i / n[0]];
    // Along an axis with a single square, nothing is halved.
    let [x, y] = [if n[0] > 1 { x / 2 } else { x }, if n[1] > 1 { y / 2 } else { y }];
    y * half[0] + x
}

#[cfg(test)]
mod tests {
    use rc_core::testing::quasi_random;

    use super::*;

    #[test]
    fn squares_keep_their_parts_of_the_load() {
        for sides in [[256, 256], [1024, 64], [70, 300], [30, 8]] {
            let squares = Squares::new(sides);
            let load = |i: usize| Load { clipped: 1.0 + quasi_random(i), added: 0.3 * quasi_random(7 * i + 1) };
            let loads: Vec<Load> = (0..squares.len()).map(load).collect();
            let before: f64 = loads.iter().map(|load| load.clipped - load.added).sum();
            let clipped: f64 = loads.iter().map(|load| load.clipped).sum();
            let shares = Shares::new(squares, &loads);
            let sum: f64 = shares.loads.iter().map(|[wanted, _]| wanted).sum();
            assert!((sum / clipped - 1.0).abs() < 1e-12, "{sides:?}: {sum}");
            for ([wanted, _], load) in shares.loads.iter().zip(&loads) {
                let expected = clipped / before * (load.clipped - load.added);
                assert!((wanted / expected - 1.0).abs() < 1e-12, "{sides:?}: {wanted}");
            }
        }
    }

    #[test]
    fn a_square_without_load_takes_from_the_others_of_its_quarter_first() {
        let squares = Squares::new([256, 256]);
        let mut loads = vec![Load { clipped: 1.0, added: 0.0 }; 16];
        // Clipping has added all of its pressure.
        loads[0] = Load { clipped: 1.0, added: 1.0 };
        let shares = Shares::new(squares, &loads);
        // The cell keeps 16 where it had 15 before.
        for (square, factor) in
            [(0, 3.0 / 7.0), (1, 6.0 / 7.0), (5, 6.0 / 7.0), (15, 1.0)].map(|(i, f)| (i, f * 16.0 / 15.0))
        {
            let [wanted, clipped] = shares.loads[square];
            assert!((wanted / clipped - factor).abs() < 1e-12, "{square}: {wanted}");
        }
    }

    #[test]
    fn factors_are_interpolated_around_the_cell() {
        let squares = Squares::new([128, 128]);
        let shares = Shares { squares, loads: vec![[1.0, 1.0], [6.0, 3.0], [9.0, 3.0], [4.0, 1.0]] };
        for (place, factor) in
            [([0.25, 0.25], 1.0), ([0.75, 0.75], 4.0), ([0.0, 0.25], 7.0 / 4.0), ([0.5, 0.5], 20.0 / 8.0)]
        {
            assert!((shares.at(place) - factor).abs() < 1e-12, "{place:?}: {}", shares.at(place));
        }
    }
}
