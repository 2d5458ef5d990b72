//! Weights of the coefficients, along one direction, for the eight centres of a tile.

use crate::tiles::heights::window::{Derivative, TAPS, window};
use rc_quadtree::TILE;

/// Maximum number of coefficients that the centres of a tile use along one direction.
///
/// These are TAPS, and the cells between first and last centre, rounded up to whole vectors.
pub(super) const MAX_WIDTH: usize = TAPS + TILE;

/// Weights for the eight centres of a tile, at one place relative to the coefficients.
#[derive(Clone)]
pub(super) struct Stencil {
    /// The first coefficient of each centre, counted from the tile's origin.
    pub(super) starts: [usize; TILE],
    /// The weights of each centre, beginning with its first coefficient.
    pub(super) weights: [[f64; TAPS]; TILE],
    /// The same weights by coefficient, beginning with the first one of the first centre.
    ///
    /// A weight is zero where a centre does not use the coefficient.
    pub(super) by_coefficient: [[f64; TILE]; MAX_WIDTH],
    /// Number of coefficients from the first to the last used one.
    pub(super) width: usize,
}

/// The stencils of all tiles of one level.
///
/// A coefficient cell is 2^`refinement` of its cells.
#[derive(Clone)]
pub(super) struct Stencils {
    /// Stencils of consecutive tiles, repeated along the line.
    stencils: Vec<Stencil>,
    /// Number of coefficients between the origins of a tile and its repetition.
    stride: usize,
}

impl Stencils {
    /// Stencils for the heights at the centres of the level.
    ///
    /// They may also be for a derivative of the heights, per coefficient cell.
    pub(super) fn new(refinement: u32, derivative: Derivative) -> Self {
        // A tile is 8/2^j coefficient cells long. All tiles are alike unless this is less than one.
        let n_stencils = 1_usize << refinement.saturating_sub(TILE.ilog2());
        let stride = (n_stencils * TILE) >> refinement;
        let stencils = (0..n_stencils).map(|tile| Stencil::new(tile, refinement, derivative)).collect();
        Self { stencils, stride }
    }

    /// The stencil of tile `t` along a line, and its origin.
    ///
    /// The origin is the coefficient that its `starts` count from.
    pub(super) fn of_tile(&self, t: usize) -> (&Stencil, usize) {
        let n_stencils = self.stencils.len();
        (&self.stencils[t % n_stencils], t / n_stencils * self.stride)
    }
}

impl Stencil {
    fn new(tile: usize, refinement: u32, derivative: Derivative) -> Self {
        let cells = 1.0 / f64::from(1_u32 << refinement);
        let (mut starts, mut weights) = ([0; TILE], [[0.0; TAPS]; TILE]);
        for (i, (start, weights)) in starts.iter_mut().zip(&mut weights).enumerate() {
            // Coefficients sit at the centres of their cells: coefficient 0 at half a cell from the origin.
            let place = ((TILE * tile + i) as f64 + 0.5) * cells - 0.5;
            // There are TAPS/2 coefficients on either side. The line begins with a halo of TAPS/2, so this coefficient
            // is at or above 0.
            let left = place.floor();
            *start = (left + 1.0) as usize;
            for (tap, weight) in weights.iter_mut().enumerate() {
                *weight = window(place - left + (TAPS / 2 - 1) as f64 - tap as f64, derivative);
            }
        }
        let mut by_coefficient = [[0.0; TILE]; MAX_WIDTH];
        for (i, (start, weights)) in starts.iter().zip(&weights).enumerate() {
            for (row, &weight) in by_coefficient[start - starts[0]..].iter_mut().zip(weights) {
                row[i] = weight;
            }
        }
        let width = starts[TILE - 1] - starts[0] + TAPS;
        Self { starts, weights, by_coefficient, width }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_tiles_the_line_and_reproduces_constants_and_ramps() {
        for refinement in 0..8 {
            let heights = Stencils::new(refinement, Derivative::None);
            let slopes = Stencils::new(refinement, Derivative::First);
            for tile in 0..40 {
                let ((stencil, origin), (slope, _)) = (heights.of_tile(tile), slopes.of_tile(tile));
                assert!(stencil.width <= MAX_WIDTH);
                for i in 0..TILE {
                    // The value of a coefficient is its own place on the line. The end of the halo is at 0.
                    let place = |tap: usize| (origin + stencil.starts[i] + tap) as f64 - (TAPS / 2) as f64;
                    let sum =
                        |weights: &[f64; TAPS]| weights.iter().enumerate().map(|(tap, w)| w * place(tap)).sum::<f64>();
                    let exact = ((TILE * tile + i) as f64 + 0.5) / f64::from(1 << refinement) - 0.5;
                    let one: f64 = stencil.weights[i].iter().sum();
                    assert!((one - 1.0).abs() < 1e-9, "constant: {one}");
                    let (ramp, unit) = (sum(&stencil.weights[i]), sum(&slope.weights[i]));
                    assert!((ramp - exact).abs() < 1e-8 * (1.0 + exact), "ramp: {ramp} against {exact}");
                    assert!((unit - 1.0).abs() < 1e-6, "slope of the ramp: {unit}");
                }
            }
        }
    }
}
