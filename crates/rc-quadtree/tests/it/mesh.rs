//! Claims about the three meshes of Fig. 3 and the questions one can ask of them.

use std::collections::BTreeSet;

use crate::common::{at, discs, painted, with_halo};
use rc_core::{DVec2, Field, Grid};
use rc_quadtree::{
    Edge, Key, MAX_BASE, MAX_LEVEL, Mask, Mesh, MeshError, MeshKind, MeshParams, Neighbour, count, plan,
};

const KINDS: [MeshKind; 3] = [MeshKind::Uniform, MeshKind::AdaptiveUniform, MeshKind::Adaptive];

/// Two spots, one with a hole, one across the corner of the cell.
fn spots(side: usize) -> Mask {
    discs(side, &[(0.45, 0.5, 0.33), (0.98, 0.03, 0.2)], &[(0.5, 0.55, 0.07)])
}

fn build(mask: &Mask, kind: MeshKind) -> Mesh {
    Mesh::from_mask(mask, kind, &MeshParams::for_side(mask.side())).expect("for_side suits every side of these tests")
}

/// The places of all elements, as level, column, row.
fn places(mesh: &Mesh) -> BTreeSet<(u32, u32, u32)> {
    mesh.keys().iter().map(|key| (key.level(), key.ix(), key.iy())).collect()
}

#[test]
fn an_element_takes_at_most_forty_bytes() {
    for kind in KINDS {
        let mesh = build(&spots(256), kind);
        let fullest = mesh.split(&[0, mesh.len() / 2]).expect("the mesh is not deep");
        for mesh in [mesh, fullest] {
            let per_element = mesh.bytes() as f64 / mesh.len() as f64;
            assert!(per_element <= 40.0, "{kind:?}: {per_element} bytes an element");
        }
    }
}

#[test]
fn adaptive_mesh_is_the_rule_block_by_block() {
    for (side, base, ring) in [(96, 3, 1), (96, 12, 1), (80, 5, 2), (64, 1, 1), (64, 2, 3)] {
        let mask = spots(side);
        let depth = (side / base).ilog2();
        // A block of `size` cells may be one element when all cells within `ring` blocks of it are in contact.
        let inner = |level: u32, ix: i64, iy: i64| {
            let size = ((side / base) >> level) as i64;
            let reach = if level == depth { 0 } else { ring as i64 * size };
            let span = |i: i64| (i * size - reach)..((i + 1) * size + reach);
            span(iy).all(|y| span(ix).all(|x| at(&mask, x, y)))
        };
        let mut expected = BTreeSet::new();
        for level in 0..=depth {
            let per_side = (base as i64) << level;
            for (ix, iy) in (0..per_side).flat_map(|iy| (0..per_side).map(move |ix| (ix, iy))) {
                let in_larger = (0..level).any(|l| inner(l, ix >> (level - l), iy >> (level - l)));
                if inner(level, ix, iy) && !in_larger {
                    expected.insert((level, ix as u32, iy as u32));
                }
            }
        }
        let params = MeshParams { base, ring, halo: 0 };
        let mesh = Mesh::from_mask(&mask, MeshKind::Adaptive, &params).expect("the side suits the base");
        mesh.assert_well_formed();
        assert!(mesh.counts().iter().filter(|&&c| c > 0).count() >= 2, "the case has no coarse elements");
        assert_eq!(places(&mesh), expected, "side {side}, base {base}, ring {ring}");
    }
}

#[test]
fn elements_along_every_contact_border_are_the_smallest() {
    let mask = spots(128);
    let mesh = build(&mask, MeshKind::Adaptive);
    let everything = vec![true; mesh.len()];
    for piece in mesh.border(&everything).expect("one entry an element") {
        let element = mesh.element(piece.member);
        assert_eq!(element.level, 7, "{element:?} lies at the border");
        assert_eq!(piece.across, None, "everything but the outside is in the set");
    }
}

#[test]
fn halving_the_step_doubles_the_adaptive_mesh_and_quadruples_the_others() {
    let total = |side, kind| {
        let counts = count(&spots(side), kind, &MeshParams::default()).expect("a power of two");
        counts.iter().sum::<usize>() as f64
    };
    // Elements follow the length of the border (∝ n) or the area (∝ n²); the border of a digital disc varies by some
    // per cent.
    for (kind, factor) in [(MeshKind::Uniform, 4.0), (MeshKind::AdaptiveUniform, 4.0), (MeshKind::Adaptive, 2.0)] {
        let measured = total(1024, kind) / total(512, kind);
        let relative = measured / factor - 1.0;
        assert!(relative.abs() < 0.03, "{kind:?}: factor {measured}, expected {factor}, relative error {relative:.2e}");
    }
}

#[test]
fn counts_are_those_of_the_built_mesh() {
    for (side, halo) in [(96, 0), (64, 2)] {
        let mask = spots(side);
        let params = MeshParams { halo, ..MeshParams::for_side(side) };
        for kind in KINDS {
            let mesh = Mesh::from_mask(&mask, kind, &params).expect("for_side suits the side");
            let counted = count(&mask, kind, &params).expect("for_side suits the side");
            assert_eq!(mesh.counts(), counted, "{kind:?}, side {side}");
            assert_eq!(mesh.len(), counted.iter().sum::<usize>());
            let expected = match kind {
                MeshKind::Uniform => side * side,
                _ => with_halo(&mask, halo as i64).iter().filter(|&&c| c).count(),
            };
            assert_eq!(painted(&mesh, side).iter().filter(|&&c| c).count(), expected, "{kind:?}, side {side}");
        }
    }
}

#[test]
fn halo_elements_are_of_the_finest_size_and_leave_the_inside_alone() {
    let mask = spots(64);
    let without = build(&mask, MeshKind::Adaptive);
    let params = MeshParams { halo: 3, ..MeshParams::default() };
    let with = Mesh::from_mask(&mask, MeshKind::Adaptive, &params).expect("a power of two");
    with.assert_well_formed();
    let (without, with) = (places(&without), places(&with));
    assert!(without.is_subset(&with));
    assert!(with.difference(&without).all(|&(level, _, _)| level == 6), "a halo element is coarse");
}

#[test]
fn full_contact_is_the_roots_and_no_contact_is_empty() {
    for base in [1, 3, 8] {
        let side = base * 16;
        let params = MeshParams { base, ..MeshParams::default() };
        let mask = |contact| Mask::new(side, vec![contact; side * side]).expect("right length");
        let full = Mesh::from_mask(&mask(true), MeshKind::Adaptive, &params).expect("the side suits the base");
        full.assert_well_formed();
        assert_eq!(full.counts(), [base * base]);
        let none = Mesh::from_mask(&mask(false), MeshKind::Adaptive, &params).expect("the side suits the base");
        none.assert_well_formed();
        assert!(none.is_empty() && none.counts().is_empty());
        assert_eq!(none.locate(DVec2::splat(0.5)), None);
    }
}

#[test]
fn mirrored_and_shifted_contact_has_mirrored_and_shifted_elements() {
    let (side, base) = (96_usize, 3_u32);
    let mask = spots(side);
    let image = |map: &dyn Fn(i64, i64) -> (i64, i64)| {
        let n = side as i64;
        let cells = (0..n * n).map(|i| map(i % n, i / n)).map(|(ix, iy)| at(&mask, ix, iy)).collect();
        places(&build(&Mask::new(side, cells).expect("right length"), MeshKind::Adaptive))
    };
    let original = places(&build(&mask, MeshKind::Adaptive));
    let moved = |map: &dyn Fn(u32, u32, u32) -> (u32, u32)| -> BTreeSet<(u32, u32, u32)> {
        let place = |&(l, ix, iy): &(u32, u32, u32)| {
            let (ix, iy) = map(base << l, ix, iy);
            (l, ix, iy)
        };
        original.iter().map(place).collect()
    };
    let n = side as i64;
    assert_eq!(image(&|ix, iy| (n - 1 - ix, iy)), moved(&|m, ix, iy| (m - 1 - ix, iy)), "mirrored in x");
    assert_eq!(image(&|ix, iy| (ix, n - 1 - iy)), moved(&|m, ix, iy| (ix, m - 1 - iy)), "mirrored in y");
    assert_eq!(image(&|ix, iy| (iy, ix)), moved(&|_, ix, iy| (iy, ix)), "mirrored in the diagonal");
    let a_root = n / i64::from(base);
    let shifted = image(&|ix, iy| (ix - a_root, iy - 2 * a_root));
    let one_root = |m, ix, iy| ((ix + m / base) % m, (iy + 2 * (m / base)) % m);
    assert_eq!(shifted, moved(&one_root), "shifted by one and two roots");
}

#[test]
fn every_cell_centre_is_located_in_the_element_that_covers_it() {
    let mask = spots(96);
    let grid = Grid::square(96).expect("a grid");
    for kind in [MeshKind::AdaptiveUniform, MeshKind::Adaptive] {
        let mesh = build(&mask, kind);
        for (ix, iy) in (0..96).flat_map(|iy| (0..96).map(move |ix| (ix, iy))) {
            let at = grid.centre(ix, iy);
            let found = mesh.locate(at + DVec2::new(-2.0, 5.0));
            assert_eq!(found, mesh.locate(at), "the same point of another cell");
            assert_eq!(found.is_some(), mask.cells()[grid.index(ix, iy)], "cell ({ix}, {iy}) of {kind:?}");
            if let Some(element) = found.map(|i| mesh.element(i)) {
                let reach = element.half_side();
                assert!((at.x - element.x).abs() < reach && (at.y - element.y).abs() < reach, "{at} in {element:?}");
            }
        }
    }
}

#[test]
fn odd_points_are_wrapped_or_outside() {
    let mesh = Mesh::uniform(3, 4).expect("small");
    let last = mesh.locate(DVec2::new(1.0 - 1e-9, 0.5));
    assert_eq!(mesh.locate(DVec2::new(-1e-300, 0.5)), last, "just left of the cell is its last column");
    assert_eq!(mesh.locate(DVec2::new(1.0, 0.5)), mesh.locate(DVec2::new(0.0, 0.5)));
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(mesh.locate(DVec2::new(x, 0.5)), None);
    }
}

#[test]
fn elements_within_a_square_are_those_it_contains() {
    let mesh = build(&spots(96), MeshKind::Adaptive);
    for block in Mesh::uniform(3, 2).expect("small").keys() {
        let range = mesh.within(*block);
        for (i, &key) in mesh.keys().iter().enumerate() {
            assert_eq!(range.contains(&i), block.contains(key), "{key:?} in {block:?}");
        }
    }
}

#[test]
fn neighbours_wrap_around_the_cell() {
    let mesh = Mesh::uniform(3, 1).expect("small");
    let place = |i: usize| (mesh.keys()[i].ix(), mesh.keys()[i].iy());
    let corner = mesh.locate(DVec2::ZERO).expect("everything is in the mesh");
    for (edge, expected) in [(Edge::Left, (5, 0)), (Edge::Right, (1, 0)), (Edge::Down, (0, 5)), (Edge::Up, (0, 1))] {
        let Neighbour::Same(j) = mesh.neighbour(corner, edge) else { panic!("{edge:?}: not of the same size") };
        assert_eq!(place(j), expected, "{edge:?}");
    }
    let whole = Mesh::uniform(1, 0).expect("small");
    whole.assert_well_formed();
    assert_eq!(whole.neighbour(0, Edge::Up), Neighbour::Same(0), "one element is its own image");
}

#[test]
fn perimeter_is_that_of_the_mask() {
    for (side, halo) in [(96, 0), (64, 0), (64, 2)] {
        let mask = spots(side);
        let n = side as i64;
        let steps = (0..n * n).flat_map(|i| [(i % n, i / n, 1, 0), (i % n, i / n, 0, 1)]);
        let edges = steps.filter(|&(ix, iy, dx, dy)| at(&mask, ix, iy) != at(&mask, ix + dx, iy + dy)).count();
        let reference = edges as f64 / side as f64;
        let params = MeshParams { halo, ..MeshParams::for_side(side) };
        for kind in KINDS {
            let mesh = Mesh::from_mask(&mask, kind, &params).expect("for_side suits the side");
            let grid = Grid::square(side).expect("a grid");
            let cell = |v: f64| (v * side as f64) as usize;
            let members: Vec<bool> = mesh.elements().map(|e| mask.cells()[grid.index(cell(e.x), cell(e.y))]).collect();
            let perimeter = mesh.perimeter(&members).expect("one entry an element");
            assert_eq!(perimeter.pieces, edges, "{kind:?}: the border has the finest step everywhere");
            let relative = perimeter.length / reference - 1.0;
            assert!(relative.abs() < 1e-13, "{kind:?}: {} for {reference}, relative {relative:.2e}", perimeter.length);
        }
    }
}

#[test]
fn splitting_ripples_across_the_seam() {
    // Splitting the lower left element twice more makes its neighbours across both seams too coarse.
    let mut mesh = Mesh::uniform(1, 2).expect("small");
    for _ in 0..3 {
        let corner = mesh.locate(DVec2::ZERO).expect("everything is in the mesh");
        mesh = mesh.split(&[corner]).expect("not deep");
        mesh.assert_well_formed();
    }
    let level_at = |along_both| mesh.locate(DVec2::splat(along_both)).map(|i| mesh.element(i).level);
    assert_eq!(level_at(0.0), Some(5));
    assert!(level_at(0.999) >= Some(4), "across the corner: {:?}", level_at(0.999));
    assert_eq!(level_at(0.6), Some(2), "far away nothing is split");
    assert_eq!(mesh.area(), 1.0, "splitting keeps the area exactly");
}

#[test]
fn merging_keeps_what_balance_or_marks_forbid() {
    let fine = Mesh::uniform(1, 3).expect("small");
    let corner = fine.locate(DVec2::ZERO).expect("everything is in the mesh");
    let mesh = fine.split(&[corner]).expect("not deep");
    let all: Vec<usize> = (0..mesh.len()).collect();
    let merged = mesh.merge(&all).expect("indices are right");
    merged.assert_well_formed();
    assert_eq!(merged.counts(), [0, 0, 15, 4], "the corner is merged once, its surroundings can go with it");
    let three = &mesh.merge_closure(&all[1..4]).expect("indices are right");
    assert!(three.is_empty(), "an incomplete family stays: {three:?}");
}

#[test]
fn fields_are_averaged_and_painted() {
    let grid = Grid::square(96).expect("a grid");
    let field = Field::from_fn(grid, |DVec2 { x, y }| 1.0 + (7.0 * x).sin() * (3.0 * y).cos());
    let mesh = build(&spots(96), MeshKind::Adaptive);
    let values = mesh.from_field(&field).expect("96 = 3 * 32");
    for side in [3, 24, 96, 192] {
        let back = mesh.to_field(&values, Grid::square(side).expect("a grid")).expect("a side of this base");
        let (mean, load) = (back.mean(), mesh.load(&values).expect("one value an element"));
        // 1e4 additions of numbers of order 1.
        assert!((mean - load).abs() < 1e-12, "side {side}: mean {mean}, load {load}, difference {:.2e}", mean - load);
    }
    let painted = mesh.to_field(&vec![1.0; mesh.len()], grid).expect("96 = 3 * 32");
    assert_eq!(Mask::positive(&painted), Ok(spots(96)), "painting ones gives the mask back");
}

#[test]
fn bad_input_is_a_typed_error() {
    let mask = spots(96);
    let with = |base, ring| plan(&mask, MeshKind::Adaptive, &MeshParams { base, ring, halo: 0 }).err();
    assert_eq!(with(0, 1), Some(MeshError::Base { base: 0 }));
    assert_eq!(with(MAX_BASE + 1, 1), Some(MeshError::Base { base: MAX_BASE + 1 }));
    for base in [1, 5, 192] {
        assert_eq!(with(base, 1), Some(MeshError::Side { side: 96, base }));
    }
    assert_eq!(with(3, 0), Some(MeshError::ZeroRing));
    assert_eq!(with(3, usize::MAX), None, "a ring beyond the cell is the whole cell");
    let halo = MeshParams { base: 3, ring: 1, halo: usize::MAX };
    assert_eq!(Mesh::from_mask(&mask, MeshKind::Adaptive, &halo).map(|mesh| mesh.area()), Ok(1.0));

    assert_eq!(Mesh::uniform(0, 1), Err(MeshError::Base { base: 0 }));
    assert_eq!(Mesh::uniform(1, MAX_LEVEL + 1), Err(MeshError::TooDeep { level: MAX_LEVEL + 1 }));
    assert_eq!(Mesh::uniform(1, 17), Err(MeshError::TooManyElements { side: 1 << 17 }));

    let mesh = build(&mask, MeshKind::Adaptive);
    let len = mesh.len();
    let missing = MeshError::NoSuchElement { index: len, len };
    assert_eq!(mesh.split(&[len]), Err(missing));
    assert_eq!(mesh.merge(&[0, len]), Err(missing));
    let length = MeshError::Length { expected: len, actual: 1 };
    assert_eq!(mesh.perimeter(&[true]), Err(length));
    assert_eq!(mesh.load(&[1.0]), Err(length));
    let odd = Field::zeros(Grid::square(100).expect("a grid"));
    assert_eq!(mesh.from_field(&odd), Err(MeshError::Side { side: 100, base: 3 }));
    let long = Grid::new(96, 48).expect("a grid");
    assert_eq!(mesh.to_field(&vec![0.0; len], long), Err(MeshError::NotSquare { grid: long }));
}

#[test]
fn splitting_below_the_deepest_level_is_an_error() {
    let mut mesh = Mesh::uniform(1, 0).expect("small");
    for _ in 0..MAX_LEVEL {
        mesh = mesh.split(&[0]).expect("not yet the deepest");
    }
    mesh.assert_well_formed();
    assert_eq!(mesh.keys().iter().map(|key: &Key| key.level()).max(), Some(MAX_LEVEL));
    assert_eq!(mesh.split(&[0]), Err(MeshError::TooDeep { level: MAX_LEVEL + 1 }));
}
