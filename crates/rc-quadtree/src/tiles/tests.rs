//! Tests of tiles: places, neighbours, halos, levels.

use super::*;

#[test]
fn tiles_are_found_across_the_seam() {
    let set = TileSet::new([48, 48], vec![[5, 0], [0, 5], [2, 3], [2, 3]]);
    assert_eq!(set.len(), 3);
    assert_eq!(set.places()[set.find(-1, 6).expect("stored")], [5, 0]);
    assert_eq!(set.find(3, 2), None);
}

#[test]
fn beyond_free_borders_there_is_no_tile() {
    let set = TileSet::new([44, 48], vec![[0, 0], [5, 0], [0, 5]]).with_boundary(Boundary::Free);
    for (column, row) in [(-1, 0), (6, 0), (0, -1), (0, 6), (5, 6)] {
        assert_eq!(set.find(column, row), None, "({column}, {row})");
    }
    assert!(set.find(5, 0).is_some() && set.find_cell(43, 0).is_some());
    assert_eq!([set.find_cell(44, 0), set.find_cell(-1, 0), set.find_cell(0, 48)], [None; 3]);
    let around = set.around(1);
    // Each tile has four places around it, of which two are common.
    assert_eq!((around.len(), around.boundary()), (4 + 4 + 4, Boundary::Free));
    assert!(around.places().iter().all(|&[column, row]| column < 6 && row < 6));
    let parents = TileSet::new([64, 64], vec![[0, 0]]).with_boundary(Boundary::Free).parents(5);
    let mut places = parents.places().to_vec();
    places.sort_unstable();
    assert_eq!(places, [[0, 0], [0, 1], [1, 0], [1, 1]]);
}

#[test]
fn cells_are_found_across_a_seam_that_cuts_tiles() {
    let set = TileSet::new([21, 12], vec![[0, 0], [2, 0], [2, 1]]);
    assert_eq!((set.extent(), set.n_cells(), set.n_inside()), ([3, 2], 192, 64 + 5 * 8 + 5 * 4));
    let at = |x: i64, y: i64| set.find_cell(x, y).map(|i| (set.places()[i / CELLS], i % TILE, i % CELLS / TILE));
    assert_eq!(at(-1, 0), Some(([2, 0], 4, 0)));
    assert_eq!(at(21, 12), Some(([0, 0], 0, 0)));
    assert_eq!(at(20, -1), Some(([2, 1], 4, 3)));
    assert_eq!(at(9, 0), None);
}

#[test]
fn rows_end_with_the_level() {
    let set = TileSet::full([11, 9]);
    let mut values = vec![f64::NAN; set.n_cells()];
    for (x, y) in (0..99).map(|i| (i % 11, i / 11)) {
        values[set.find_cell(x, y).expect("all tiles")] = (y * 11 + x) as f64;
    }
    let mut all = Vec::new();
    let Ok(()) = set.rows(&values, |first, rows| {
        assert_eq!(first * 11, all.len());
        all.extend_from_slice(rows);
        Ok::<_, std::convert::Infallible>(())
    });
    assert!(all.iter().enumerate().all(|(i, &value)| (value - i as f64).abs() < 1e-9), "{all:?}");
}

#[test]
fn parents_hold_the_halo() {
    let set = TileSet::new([64, 64], vec![[0, 0]]);
    let places = |halo| {
        let mut places = set.parents(halo).places().to_vec();
        places.sort_unstable();
        places
    };
    assert_eq!(places(0), [[0, 0]]);
    // The tile covers cells 0 to 3 of the 8 cells of its parent. Two more cells on either side extend beyond the
    // seam on one side only.
    assert_eq!(places(2), [[0, 0], [0, 3], [3, 0], [3, 3]]);
    assert_eq!(places(5).len(), 9);
}
