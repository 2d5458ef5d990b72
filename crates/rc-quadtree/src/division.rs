//! Division of elements into quarters.
//!
//! Sizes of neighbours stay within the limits of an operator.

use crate::elements::Elements;
use crate::tiles::{TILE, TileSet, quarters};

/// Divides the elements of the chosen tiles into quarters.
///
/// `chosen` has a flag for each tile of each level, finest first. With `deepen` a level is added below the finest.
/// Without it the flags of the finest level are ignored.
///
/// Larger neighbours are divided too. Then the distance between elements whose sizes differ by a factor of 4 is more
/// than `reach` cells of the size between.
///
/// # Panics
/// When `chosen` has fewer levels than `elements`.
#[must_use]
pub fn divide(elements: &Elements, mut chosen: Vec<Vec<bool>>, deepen: bool, reach: usize) -> Elements {
    if !deepen {
        chosen[0].fill(false);
    }
    choose_larger_neighbours(elements, &mut chosen, reach);
    let levels = elements.levels();
    let mut result = Vec::with_capacity(levels.len() + 1);
    if deepen {
        let (sides, quarters) = (levels[0].sides(), quarters_of_chosen(&levels[0], &chosen[0]));
        result.push(levels[0].of_same_cell(sides.map(|side| 2 * side), quarters.collect()));
    }
    for (coarser, tiles) in levels.iter().enumerate() {
        let mut places: Vec<[u32; 2]> = with_flag(tiles, &chosen[coarser], false).collect();
        if let Some(larger) = levels.get(coarser + 1) {
            places.extend(quarters_of_chosen(larger, &chosen[coarser + 1]));
        }
        result.push(tiles.of_same_cell(tiles.sides(), places));
    }
    Elements::new(result)
}

/// Chooses the tiles of each level near chosen tiles of the next finer level.
///
/// They are within `reach` cells of one of these.
fn choose_larger_neighbours(elements: &Elements, chosen: &mut [Vec<bool>], reach: usize) {
    let levels = elements.levels();
    let reach = reach.div_ceil(TILE) as i64;
    for coarser in 1..levels.len() {
        let (finer, here) = chosen.split_at_mut(coarser);
        for [column, row] in with_flag(&levels[coarser - 1], &finer[coarser - 1], true) {
            for y in i64::from(row) - reach..=i64::from(row) + reach {
                for x in i64::from(column) - reach..=i64::from(column) + reach {
                    if let Some(tile) = levels[coarser].find(x.div_euclid(2), y.div_euclid(2)) {
                        here[0][tile] = true;
                    }
                }
            }
        }
    }
}

/// Places of the tiles whose flag is `wanted`.
fn with_flag(tiles: &TileSet, flags: &[bool], wanted: bool) -> impl Iterator<Item = [u32; 2]> {
    tiles.places().iter().zip(flags).filter(move |&(_, &flag)| flag == wanted).map(|(&place, _)| place)
}

/// Places of the quarters of the chosen tiles, on the next finer level.
fn quarters_of_chosen(tiles: &TileSet, chosen: &[bool]) -> impl Iterator<Item = [u32; 2]> {
    with_flag(tiles, chosen, true).flat_map(quarters)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn n_tiles(elements: &Elements) -> Vec<usize> {
        elements.levels().iter().map(TileSet::len).collect()
    }

    #[test]
    fn sizes_stay_graded() {
        let all = Elements::uniform(TileSet::full([64, 64]));
        let corner = |elements: &Elements| {
            let flags = |tiles: &TileSet| tiles.places().iter().map(|place| *place == [0, 0]).collect();
            elements.levels().iter().map(flags).collect::<Vec<Vec<bool>>>()
        };
        let two = divide(&all, corner(&all), true, 8);
        assert_eq!(n_tiles(&two), [4, 63]);
        // The quarter in the corner is divided, and so are the three large tiles that touch it across the seams. Two of
        // the neighbours' places of each belong to these tiles.
        let three = divide(&two, corner(&two), true, 8);
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
        let all = Elements::uniform(TileSet::full([32, 32]));
        let values: Vec<f64> = (0..all.len()).map(|i| i as f64).collect();
        let flags = vec![all.levels()[0].places().iter().map(|place| *place == [1, 2]).collect()];
        let two = divide(&all, flags, true, 8);
        let moved = all.moved(&two, &values, 0.0);
        let tile = all.levels()[0].find(1, 2).expect("all tiles");
        let fine = two.levels()[0].find(3, 4).expect("a quarter");
        // The cell in the lower right corner of the tile appears four times.
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
