//! Properties that hold for any contact set.

use proptest::prelude::*;

use super::common::{Disc, discs, painted, with_halo};
use crate::paper::mark::plan;
use crate::paper::{Mask, Mesh, MeshKind, MeshParams, count, transfer};

/// A configuration with fixed seeds, so that every run is the same.
///
/// A failure prints its smallest case.
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

/// A contact set with spots and holes, sometimes full, and the base of its mesh.
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

fn check_load(what: &str, value: f64, reference: f64) -> Result<(), TestCaseError> {
    // The error of up to 1e5 additions and as many rounded products. Observed: 1e-14.
    let relative = (value - reference).abs() / reference.abs().max(f64::MIN_POSITIVE);
    prop_assert!(relative < 1e-12, "{what}: load {value} for {reference}, relative error {relative:.2e}");
    Ok(())
}

fn pressure(mesh: &Mesh) -> Vec<f64> {
    mesh.elements().map(|e| 1.0 + (9.0 * e.centre.x).sin() * (5.0 * e.centre.y).cos()).collect()
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
    fn transfer_conserves_the_load(
        (from, to) in (a_mask((80, 5)), a_mask((80, 5))),
        kinds in (a_kind(), a_kind()),
    ) {
        let params = MeshParams { base: 5, ..MeshParams::default() };
        let from = Mesh::from_mask(&from, kinds.0, &params).expect("80 = 5 * 16");
        let to = Mesh::from_mask(&to, kinds.1, &params).expect("80 = 5 * 16");
        let old = pressure(&from);
        let moved = transfer(&from, &to, &old).expect("one value an element");
        let kept = to.load(&moved.values);
        check_load("kept + lost", kept + moved.lost, from.load(&old))?;
    }

}
