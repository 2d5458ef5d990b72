//! Claims about the three meshes of Fig. 3 and their methods.

use std::collections::BTreeSet;

use rc_core::Grid;

use super::common::{at, discs, painted, params_for, with_halo};
use crate::paper::mark::plan;
use crate::paper::{MAX_BASE, Mask, Mesh, MeshError, MeshKind, MeshParams, count};

const KINDS: [MeshKind; 3] = [MeshKind::Uniform, MeshKind::AdaptiveUniform, MeshKind::Adaptive];

/// Two spots. One has a hole, and one lies across the corner of the cell.
fn spots(side: usize) -> Mask {
    discs(side, &[(0.45, 0.5, 0.33), (0.98, 0.03, 0.2)], &[(0.5, 0.55, 0.07)])
}

fn build(mask: &Mask, kind: MeshKind) -> Mesh {
    Mesh::from_mask(mask, kind, &params_for(mask.side())).expect("params_for suits every side of these tests")
}

/// The places of all elements, as level, column, row.
fn places(mesh: &Mesh) -> BTreeSet<(u32, u32, u32)> {
    mesh.keys().iter().map(|key| (key.level(), key.ix(), key.iy())).collect()
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
fn halving_the_step_doubles_the_adaptive_mesh_and_quadruples_the_others() {
    let total = |side, kind| {
        let counts = count(&spots(side), kind, &MeshParams::default()).expect("a power of two");
        counts.iter().sum::<usize>() as f64
    };
    // Numbers of elements follow the length of the border (∝ n) or the area (∝ n²). The border of a digital disc varies
    // by some per cent.
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
        let params = MeshParams { halo, ..params_for(side) };
        for kind in KINDS {
            let mesh = Mesh::from_mask(&mask, kind, &params).expect("params_for suits the side");
            let counted = count(&mask, kind, &params).expect("params_for suits the side");
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
fn elements_along_every_contact_border_are_the_smallest() {
    let side = 128;
    let mask = spots(side);
    let mesh = build(&mask, MeshKind::Adaptive);
    let mut n_larger = 0;
    for key in mesh.keys().iter().filter(|key| key.level() < 7) {
        let size = (side >> key.level()) as i64;
        let (left, low) = (i64::from(key.ix()) * size, i64::from(key.iy()) * size);
        let beside = (0..size)
            .flat_map(|i| [(left - 1, low + i), (left + size, low + i), (left + i, low - 1), (left + i, low + size)]);
        assert!(beside.into_iter().all(|(ix, iy)| at(&mask, ix, iy)), "{key:?} lies at the border");
        n_larger += 1;
    }
    assert!(n_larger > 100, "the case has larger elements");
}

#[test]
fn fields_are_averaged_and_painted() {
    let grid = Grid::square(96).expect("a grid");
    let mesh = build(&spots(96), MeshKind::Adaptive);
    let value = |x: f64, y: f64| 1.0 + (7.0 * x).sin() * (3.0 * y).cos();
    let values: Vec<f64> = mesh.elements().map(|element| value(element.centre.x, element.centre.y)).collect();
    for side in [3, 24, 96, 192] {
        let back = mesh.to_field(&values, Grid::square(side).expect("a grid")).expect("a side of this base");
        let (mean, load) = (back.mean(), mesh.load(&values));
        // The error of 1e4 additions of numbers of order 1.
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

    let mesh = build(&mask, MeshKind::Adaptive);
    let len = mesh.len();
    assert_eq!(mesh.to_field(&[1.0], mesh_grid(96)), Err(MeshError::Length { expected: len, actual: 1 }));
    assert_eq!(mesh.to_field(&vec![0.0; len], mesh_grid(100)), Err(MeshError::Side { side: 100, base: 3 }));
    let long = Grid::new(96, 48).expect("a grid");
    assert_eq!(mesh.to_field(&vec![0.0; len], long), Err(MeshError::NotSquare { grid: long }));
}

fn mesh_grid(side: usize) -> Grid {
    Grid::square(side).expect("a grid")
}
