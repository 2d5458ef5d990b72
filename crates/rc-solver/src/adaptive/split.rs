//! Dividing elements, and keeping the sizes of neighbours within what the operator allows.

use super::elements::Elements;
use super::tiles::{TILE, TileSet, quarters};

/// Divides the chosen tiles into quarters of half the element side. `chosen` has a flag for each tile of each level; with
/// `deepen` a level is added below the finest, without it flags of the finest are void.
///
/// Larger neighbours are divided too, so that elements whose sizes differ by a factor of 4 are farther from each other than
/// `stencil_reach` cells of the size between.
pub(super) fn split(elements: &Elements, mut chosen: Vec<Vec<bool>>, deepen: bool, stencil_reach: usize) -> Elements {
    if !deepen {
        chosen[0].fill(false);
    }
    let levels = elements.levels();
    let reach = stencil_reach.div_ceil(TILE) as i64;
    for coarser in 1..levels.len() {
        let (finer, here) = chosen.split_at_mut(coarser);
        let divided = levels[coarser - 1].places().iter().zip(&finer[coarser - 1]).filter(|&(_, &chosen)| chosen);
        for (&[column, row], _) in divided {
            for y in i64::from(row) - reach..=i64::from(row) + reach {
                for x in i64::from(column) - reach..=i64::from(column) + reach {
                    if let Some(tile) = levels[coarser].find(x.div_euclid(2), y.div_euclid(2)) {
                        here[0][tile] = true;
                    }
                }
            }
        }
    }
    let part = |coarser: usize, wanted: bool| {
        let places = levels[coarser].places().iter().zip(&chosen[coarser]);
        places.filter(move |&(_, &chosen)| chosen == wanted).map(|(&place, _)| place)
    };
    let divided = |coarser: usize| part(coarser, true).flat_map(quarters);
    let mut result = Vec::with_capacity(levels.len() + 1);
    if deepen {
        result.push(TileSet::new(2 * levels[0].per_side(), divided(0).collect()));
    }
    for (coarser, tiles) in levels.iter().enumerate() {
        let places = part(coarser, false);
        let places =
            if coarser + 1 < levels.len() { places.chain(divided(coarser + 1)).collect() } else { places.collect() };
        result.push(TileSet::new(tiles.per_side(), places));
    }
    Elements::new(result)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn n_tiles(elements: &Elements) -> Vec<usize> {
        elements.levels().iter().map(TileSet::len).collect()
    }

    #[test]
    fn sizes_stay_graded() {
        let all = Elements::uniform(TileSet::full(8));
        let corner = |elements: &Elements| {
            let flags = |tiles: &TileSet| tiles.places().iter().map(|place| *place == [0, 0]).collect();
            elements.levels().iter().map(flags).collect::<Vec<Vec<bool>>>()
        };
        let two = split(&all, corner(&all), true, 8);
        assert_eq!(n_tiles(&two), [4, 63]);
        // The quarter in the corner is divided, and so are the three large tiles that touch it across the seams: two of
        // its neighbours' places each are theirs.
        let three = split(&two, corner(&two), true, 8);
        assert_eq!(n_tiles(&three), [4, 3 + 3 * 4, 60]);
        let area: usize = n_tiles(&three).iter().enumerate().map(|(coarser, n)| n << (2 * coarser)).sum();
        assert_eq!(area, 64 * 16);
        for place in three.levels()[2].places() {
            assert!(three.cover(2, place[0], place[1]));
        }
        assert!(three.cover(2, 0, 0), "it has smaller elements");
    }

    #[test]
    fn values_move_to_parts_and_means() {
        let all = Elements::uniform(TileSet::full(4));
        let values: Vec<f64> = (0..all.len()).map(|i| i as f64).collect();
        let flags = vec![all.levels()[0].places().iter().map(|place| *place == [1, 2]).collect()];
        let two = split(&all, flags, true, 8);
        let moved = all.moved(&two, &values, 0.0);
        let tile = all.levels()[0].find(1, 2).expect("all tiles");
        let fine = two.levels()[0].find(3, 4).expect("a quarter");
        // The cell in the lower right corner of the tile, four times.
        for cell in [6, 7, 14, 15] {
            assert_eq!(moved[fine * 64 + cell].to_bits(), values[tile * 64 + 7].to_bits());
        }
        let patch = two.around(&moved, 1, [0, 2], f64::NAN);
        for y in 0..8 {
            for x in 0..8 {
                assert_eq!(patch[8 + y][16 + x].to_bits(), values[tile * 64 + 8 * y + x].to_bits());
            }
        }
    }
}
