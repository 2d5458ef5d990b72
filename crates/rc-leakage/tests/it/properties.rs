//! Properties of every flow.

use rc_core::testing::quasi_random;
use rc_core::{Field, Grid};
use rc_leakage::{Axis, Leakage, LeakageError, LeakageParams, leakage};

/// Smooth random waves, with contact where they are below `level`.
fn rough(n: usize, level: f64) -> Field {
    let wave = |k: usize| std::f64::consts::TAU * quasi_random(31 * k + 5);
    Field::from_fn(Grid::square(n).expect("a grid"), |at| {
        let height: f64 = (0..40)
            .map(|k| {
                let [kx, ky] = [(k % 9) as f64 - 4.0, (k / 8) as f64];
                (std::f64::consts::TAU * (kx * at.x + ky * at.y) + wave(k)).cos() / (2.0 + kx.hypot(ky))
            })
            .sum();
        (height - level).max(0.0).powf(1.5)
    })
}

fn solved(gap: &Field) -> Leakage {
    leakage(gap, &LeakageParams::default()).expect("a flow")
}

fn moved(gap: &Field, from: impl Fn(usize, usize) -> (usize, usize)) -> Field {
    let grid = gap.grid();
    let n = grid.nx();
    let values = (0..grid.len()).map(|i| {
        let (ix, iy) = from(i % n, i / n);
        gap.at(ix % n, iy % n)
    });
    Field::new(grid, values.collect()).expect("a field")
}

#[test]
fn shifts_keep_transposing_swaps_and_scaling_cubes_the_permeance() {
    let gap = rough(96, -0.6);
    let [x, y] = solved(&gap).flows.map(|flow| flow.permeance);
    assert!(x > 0.0 && y > 0.0, "{x}, {y}");
    let same = |a: f64, b: f64, what: &str| assert!((a / b - 1.0).abs() < 1e-9, "{what}: {a} for {b}");
    let [shifted, _] = solved(&moved(&gap, |ix, iy| (ix + 37, iy + 11))).flows.map(|flow| flow.permeance);
    same(shifted, x, "shifted");
    let transposed = solved(&moved(&gap, |ix, iy| (iy, ix))).flows.map(|flow| flow.permeance);
    same(transposed[0], y, "transposed, x");
    same(transposed[1], x, "transposed, y");
    for scale in [1e-9, 1e6] {
        let mut scaled = gap.clone();
        scaled.values_mut().iter_mut().for_each(|gap| *gap *= scale);
        same(solved(&scaled).flows[0].permeance, x * scale.powi(3), "scaled");
    }
}

#[test]
fn the_flow_is_conserved_near_the_threshold_and_through_a_pinhole() {
    for level in [-1.2, -0.6, -0.3, -0.1] {
        for flow in &solved(&rough(192, level)).flows {
            assert!(flow.info.conservation <= 1e-10, "{level}: {flow:?}");
            assert!(!flow.percolates || flow.info.iterations <= 40, "{level}: {flow:?}");
        }
    }
    // A slit joins wide pools and is a hundred times narrower, which gives six decades of conductance.
    let pinhole =
        Field::from_fn(Grid::square(128).expect("a grid"), |at| match (at.x > 0.5, at.y > 0.5 && at.y < 0.52) {
            (true, _) => 1.0,
            (false, true) => 1e-2,
            (false, false) => 0.0,
        });
    let flow = &solved(&pinhole).flows[0];
    assert!(flow.percolates && flow.info.conservation <= 1e-10, "{flow:?}");
    // The resistance of the pools is negligible.
    let slit = 1e-6 * (3.0 / 128.0) / 0.5;
    assert!((flow.permeance / slit - 1.0).abs() < 0.02, "{} for {slit}", flow.permeance);
}

/// A number from 0 to 1, without correlation (SplitMix64).
fn random(i: usize) -> f64 {
    let mut bits = (i as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// Random elements, of which a fraction `walls` is walls, with gaps over `decades` decades.
///
/// The film percolates up to a fraction of 0.4073.
fn noise(n: usize, walls: f64, decades: f64) -> Field {
    let grid = Grid::square(n).expect("a grid");
    let of = |i: usize| 10.0_f64.powf(-decades * random(i + grid.len()));
    let gap = (0..grid.len()).map(|i| if random(i) < walls { 0.0 } else { of(i) });
    Field::new(grid, gap.collect()).expect("a field")
}

#[test]
fn white_noise_with_walls_is_solved_up_to_the_threshold() {
    for (walls, decades) in [(0.1, 0.5), (0.25, 0.5), (0.38, 0.5), (0.38, 4.0), (0.3, 7.0)] {
        for flow in &solved(&noise(256, walls, decades)).flows {
            assert!(flow.percolates && flow.info.conservation <= 1e-10, "{walls}, {decades}: {flow:?}");
            assert!(flow.info.error <= 1e-9 && flow.info.iterations <= 70, "{walls}, {decades}: {flow:?}");
        }
    }
}

#[test]
fn wide_pools_in_series_with_slits_a_hundred_million_times_narrower_have_the_resistance_of_the_slits() {
    // The conductances differ by 24 decades.
    let slits = 4.0;
    let gap = Field::from_fn(Grid::square(128).expect("a grid"), |at| match ((slits * at.x).fract() < 0.25, at.y) {
        (false, _) => 1.0,
        (true, y) if y > 0.4 && y < 0.6 => 1e-8,
        (true, _) => 0.0,
    });
    let flow = &solved(&gap).flows[0];
    assert!(flow.info.error <= 1e-9 && flow.info.conservation <= 1e-10, "{flow:?}");
    let wide = gap.values().iter().filter(|gap| **gap > 0.0 && **gap < 1.0).count() as f64 / 32.0 / 128.0;
    // The flow does not spread in the slits. Half of an element at each end of a slit has a negligible resistance.
    let exact = 1e-24 * wide / 0.25;
    assert!((flow.permeance / exact - 1.0).abs() < 1e-6, "{} for {exact}", flow.permeance);
}

#[test]
fn the_flux_carries_the_permeance_and_contact_carries_nothing() {
    let gap = rough(128, -0.6);
    let leakage = solved(&gap);
    let axis = leakage.flow_axis().expect("a flow");
    let flux = leakage.flux.as_ref().expect("a flow");
    let (along, across) = match axis {
        Axis::X => (&flux.x, &flux.y),
        Axis::Y => (&flux.y, &flux.x),
    };
    let permeance = leakage.flows[axis.index()].permeance;
    // The flow through a section of a square cell of side 1 is the mean flux.
    assert!((along.mean() / permeance - 1.0).abs() < 1e-9, "{} for {permeance}", along.mean());
    assert!(across.mean().abs() < permeance, "{} across {permeance}", across.mean());
    let closed = gap.values().iter().zip(flux.magnitude().into_values()).filter(|(gap, _)| **gap <= 0.0);
    assert!(closed.map(|(_, flux)| flux).fold(0.0, f64::max) <= 0.0, "a flux in contact");
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    // The second gap needs aggregates.
    for gap in [rough(200, -0.5), noise(200, 0.38, 4.0)] {
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| solved(&gap))
        };
        assert_eq!(with(1), with(4));
    }
}

#[test]
fn where_nothing_percolates_nothing_flows() {
    let grid = Grid::square(16).expect("a grid");
    for gap in
        [Field::zeros(grid), Field::from_fn(grid, |at| if (at - 0.5).abs().max_element() < 0.3 { 1.0 } else { 0.0 })]
    {
        let leakage = solved(&gap);
        assert!(leakage.flux.is_none() && leakage.flow_axis().is_none(), "{leakage:?}");
        for flow in leakage.flows {
            assert!(!flow.percolates && flow.permeance.to_bits() == 0 && flow.constriction.is_none(), "{flow:?}");
        }
    }
}

#[test]
fn a_closed_film_has_the_leak_through_smaller_contacts_as_its_error_bar() {
    for n in [16, 17] {
        let grid = Grid::square(n).expect("a grid");
        let bars = |gap: &dyn Fn(usize, usize) -> f64| {
            let gap = Field::new(grid, (0..n * n).map(|i| gap(i % n, i / n)).collect()).expect("a field");
            let flows = solved(&gap).flows;
            assert!(flows.iter().all(|flow| flow.permeance.to_bits() == 0), "{n}: it leaks");
            flows.map(|flow| flow.permeance_error.expect("a bar"))
        };
        // Two parts of a channel along x meet at corners of elements only.
        let [x, _] = bars(&|ix, iy| if iy == 4 + usize::from(ix > 7) { 0.1 } else { 0.0 });
        assert!(x > 0.0 && x < 1e-3, "{n}: {x}");
        // Contact of many elements on all sides stays closed, and so does a film without a gap.
        let pool = |ix: usize, iy: usize| if ix.abs_diff(8) < 3 && iy.abs_diff(8) < 3 { 0.1 } else { 0.0 };
        assert_eq!(bars(&pool).map(f64::to_bits), [0; 2], "{n}: a pool");
        assert_eq!(bars(&|_, _| 0.0).map(f64::to_bits), [0; 2], "{n}: full contact");
    }
}

#[test]
fn a_gap_that_is_not_one_is_refused_with_its_place() {
    for bad in [-1e-300, f64::NAN, f64::INFINITY] {
        let mut gap = Field::from_fn(Grid::new(4, 3).expect("a grid"), |_| 1.0);
        gap.values_mut()[6] = bad;
        let error = leakage(&gap, &LeakageParams::default()).expect_err("a bad gap");
        assert!(matches!(error, LeakageError::Gap { ix: 2, iy: 1, .. }), "{error}");
    }
}
