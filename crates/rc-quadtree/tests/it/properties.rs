//! Properties that hold for any contact set and any sequence of refinements.

use crate::common::{Disc, discs, painted, with_halo};
use proptest::prelude::*;
use rc_quadtree::{Mask, Mesh, MeshKind, MeshParams, Reconstruction, count, plan, transfer};

/// Seeds are fixed so that every run is the same; a failure prints its smallest case.
fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 64,
        rng_seed: prop::test_runner::RngSeed::Fixed(2012),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

fn a_disc(largest: f64) -> impl Strategy<Value = Disc> {
    (0.0..1.0, 0.0..1.0, 0.02..largest)
}

/// A contact set with spots, holes and now and then full contact, and the base of its mesh.
fn a_mask(side_and_base: (usize, usize)) -> impl Strategy<Value = Mask> {
    let spots = prop::collection::vec(a_disc(0.75), 0..5);
    (spots, prop::collection::vec(a_disc(0.1), 0..4)).prop_map(move |(s, h)| discs(side_and_base.0, &s, &h))
}

fn a_side_and_base() -> impl Strategy<Value = (usize, usize)> {
    prop::sample::select(vec![(32, 1), (32, 4), (48, 3), (64, 2), (80, 5), (7, 7), (1, 1)])
}

fn a_kind() -> impl Strategy<Value = MeshKind> {
    prop::sample::select(vec![MeshKind::Uniform, MeshKind::AdaptiveUniform, MeshKind::Adaptive])
}

/// One step of a sequence: split or merge about the given part of the elements, chosen by a hash of their keys.
#[derive(Clone, Copy, Debug)]
struct Step {
    split: bool,
    percent: u64,
    salt: u64,
}

fn a_step() -> impl Strategy<Value = Step> {
    (any::<bool>(), 0..=100_u64, any::<u64>()).prop_map(|(split, percent, salt)| Step { split, percent, salt })
}

impl Step {
    fn apply(self, mesh: &Mesh) -> Mesh {
        let chosen = |i: &usize| {
            let key = mesh.keys()[*i];
            // Families share the hash of their parent, so that merges find complete ones.
            let (ix, iy) = if self.split { (key.ix(), key.iy()) } else { (key.ix() / 2, key.iy() / 2) };
            let place = (u64::from(ix) << 40) ^ (u64::from(iy) << 8) ^ u64::from(key.level()) ^ self.salt;
            (place.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 33) % 100 < self.percent
        };
        let splittable = |i: &usize| !self.split || mesh.keys()[*i].level() < 7;
        let marked: Vec<usize> = (0..mesh.len()).filter(chosen).filter(splittable).collect();
        let result = if self.split { mesh.split(&marked) } else { mesh.merge(&marked) };
        result.expect("marked elements exist and are not deep")
    }
}

fn check_load(what: &str, value: f64, reference: f64) -> Result<(), TestCaseError> {
    // Up to 1e5 additions and as many rounded products; observed 1e-14.
    let relative = (value - reference).abs() / reference.abs().max(f64::MIN_POSITIVE);
    prop_assert!(relative < 1e-12, "{what}: load {value} for {reference}, relative error {relative:.2e}");
    Ok(())
}

fn pressure(mesh: &Mesh) -> Vec<f64> {
    mesh.elements().map(|e| 1.0 + (9.0 * e.x).sin() * (5.0 * e.y).cos()).collect()
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn mesh_of_any_mask_is_well_formed_and_covers_exactly_the_mask(
        (mask, base) in a_side_and_base().prop_flat_map(|s| (a_mask(s), Just(s.1))),
        kind in a_kind(),
        ring in 1..4_usize,
        halo in 0..3_usize,
    ) {
        let params = MeshParams { base, ring, halo };
        let mesh = Mesh::from_mask(&mask, kind, &params).expect("the side suits the base");
        mesh.assert_well_formed();
        let expected = match kind {
            MeshKind::Uniform => vec![true; mask.cells().len()],
            _ => with_halo(&mask, halo as i64),
        };
        prop_assert!(painted(&mesh, mask.side()) == expected, "{kind:?} covers other cells than it should");
        let counts = count(&mask, kind, &params).expect("the side suits the base");
        prop_assert_eq!(counts.iter().sum::<usize>(), mesh.len());
    }

    #[test]
    fn plan_is_pure(mask in a_mask((48, 3)), kind in a_kind()) {
        let params = MeshParams { base: 3, ..MeshParams::default() };
        let (before, first) = (mask.clone(), plan(&mask, kind, &params));
        prop_assert_eq!(&mask, &before);
        let second = plan(&mask, kind, &params);
        prop_assert!(first == second, "two plans of one mask differ");
        let plan = first.expect("48 = 3 * 16");
        prop_assert_eq!(Mesh::from_plan(&plan), Mesh::from_plan(&plan));
    }

    #[test]
    fn refining_and_coarsening_keep_every_invariant_and_the_load(
        (mask, base) in a_side_and_base().prop_flat_map(|s| (a_mask(s), Just(s.1))),
        steps in prop::collection::vec(a_step(), 1..6),
        linear in any::<bool>(),
    ) {
        let params = MeshParams { base, ..MeshParams::default() };
        let mut mesh = Mesh::from_mask(&mask, MeshKind::Adaptive, &params).expect("the side suits the base");
        let mut values = pressure(&mesh);
        let (area, load) = (mesh.area(), mesh.load(&values).expect("one value an element"));
        let reconstruction = if linear { Reconstruction::Limited } else { Reconstruction::Constant };
        for step in steps {
            let next = step.apply(&mesh);
            next.assert_well_formed();
            prop_assert_eq!(next.area(), area, "the covered area has changed");
            let moved = transfer(&mesh, &next, &values, reconstruction).expect("one value an element");
            prop_assert_eq!(moved.lost, 0.0);
            check_load("after a step", next.load(&moved.values).expect("one value an element"), load)?;
            let greatest = values.iter().copied().fold(0.0, f64::max);
            prop_assert!(moved.values.iter().all(|v| (0.0..=greatest).contains(v)), "a transfer made a new extreme");
            (mesh, values) = (next, moved.values);
        }
    }

    #[test]
    fn merging_undoes_splitting(mask in a_mask((48, 3)), step in a_step()) {
        let params = MeshParams { base: 3, ..MeshParams::default() };
        let mesh = Mesh::from_mask(&mask, MeshKind::Adaptive, &params).expect("48 = 3 * 16");
        let finer = Step { split: true, ..step }.apply(&mesh);
        let new: Vec<usize> = (0..finer.len()).filter(|&i| mesh.find(finer.keys()[i]).is_some_and(|j| {
            mesh.keys()[j] != finer.keys()[i]
        })).collect();
        prop_assert_eq!(finer.merge(&new).expect("indices are right"), mesh);
    }

    #[test]
    fn closures_are_their_own_closures(mask in a_mask((64, 2)), step in a_step()) {
        let params = MeshParams { base: 2, ..MeshParams::default() };
        let mesh = Mesh::from_mask(&mask, MeshKind::Adaptive, &params).expect("64 = 2 * 32");
        let marked: Vec<usize> = (0..mesh.len()).filter(|i| (*i as u64 ^ step.salt) % 100 < step.percent).collect();
        let split = mesh.split_closure(&marked).expect("indices are right");
        prop_assert!(marked.iter().all(|i| split.binary_search(i).is_ok()), "a marked element is not split");
        prop_assert_eq!(&mesh.split_closure(&split).expect("indices are right"), &split);
        let merge = mesh.merge_closure(&marked).expect("indices are right");
        prop_assert!(merge.iter().all(|i| marked.contains(i)), "an unmarked element is merged");
        prop_assert_eq!(&mesh.merge_closure(&merge).expect("indices are right"), &merge);
    }

    #[test]
    fn transfer_conserves_the_load(
        (from, to) in (a_mask((80, 5)), a_mask((80, 5))),
        kinds in (a_kind(), a_kind()),
        linear in any::<bool>(),
    ) {
        let params = MeshParams { base: 5, ..MeshParams::default() };
        let from = Mesh::from_mask(&from, kinds.0, &params).expect("80 = 5 * 16");
        let to = Mesh::from_mask(&to, kinds.1, &params).expect("80 = 5 * 16");
        let old = pressure(&from);
        let reconstruction = if linear { Reconstruction::Limited } else { Reconstruction::Constant };
        let moved = transfer(&from, &to, &old, reconstruction).expect("one value an element");
        let kept = to.load(&moved.values).expect("one value an element");
        check_load("kept + lost", kept + moved.lost, from.load(&old).expect("one value an element"))?;
    }

    #[test]
    fn a_set_and_its_complement_have_the_same_border(mask in a_mask((64, 1)), salt in any::<u64>()) {
        let everywhere = Mesh::uniform(1, 3).expect("small");
        let near = (0..everywhere.len()).filter(|i| salt >> (i % 64) & 1 == 1).collect::<Vec<_>>();
        let mesh = everywhere.split(&near).expect("not deep");
        let inside = |x: f64, y: f64| mask.cells()[(y * 64.0) as usize * 64 + (x * 64.0) as usize];
        let members: Vec<bool> = mesh.elements().map(|e| inside(e.x, e.y)).collect();
        let others: Vec<bool> = members.iter().map(|m| !m).collect();
        let length = |set: &[bool]| mesh.perimeter(set).expect("one entry an element").length;
        // Lengths are sums of powers of two: exact.
        prop_assert_eq!(length(&members), length(&others));
    }
}
