//! Tests of the steps that prepare a measured map: measured rectangle, spikes, long waves, window.
#![expect(clippy::float_cmp, reason = "heights that are copied keep their bits")]

use std::f64::consts::TAU;

use rc_core::testing::quasi_random;
use rc_core::{DVec2, Field, Grid};
use rc_heights::suspicion::spike_points;
use rc_heights::{Crop, Effect, Fill, HeightMap, Level, Periodic, TreatError, Treatment, Unit, apply, grids_after};

const SIDE: f64 = 1e-3;

fn map(nx: usize, ny: usize, height: impl Fn(f64, f64) -> f64) -> HeightMap {
    let heights = Field::from_fn(Grid::new(nx, ny).expect("a grid"), |DVec2 { x, y }| height(x, y));
    HeightMap::new(heights, Unit::Metre, Some([SIDE, SIDE * ny as f64 / nx as f64]), Unit::Metre)
}

/// A tilted rough map: waves of amplitudes 1/q^1.8 up to 40 per side, with an rms height of about 1 µm.
fn rough(nx: usize, ny: usize, seed: usize) -> HeightMap {
    let wave = |i: usize| {
        let [a, b, c] = [0, 1, 2].map(|k| quasi_random(3 * i + k + 7919 * seed));
        // As many waves per octave, in all directions.
        let (q, angle) = (40_f64.powf(a), TAU * b);
        (TAU * q * angle.cos(), TAU * q * angle.sin(), 1e-6 * q.powf(-0.8), TAU * c)
    };
    let waves: Vec<_> = (0..120).map(wave).collect();
    map(nx, ny, |x, y| {
        let sum: f64 = waves.iter().map(|(kx, ky, amplitude, phase)| amplitude * (kx * x + ky * y + phase).cos()).sum();
        0.3 * sum + 4e-6 * x
    })
}

fn treated(map: &HeightMap, treatment: Treatment) -> (HeightMap, Effect) {
    let (map, mut effects) = apply(map.clone(), &[treatment]).unwrap_or_else(|error| panic!("{error}"));
    (map, effects.remove(0))
}

/// Indices that are not beside each other, and not at the border, spread over the map.
fn places(map: &HeightMap, n: usize, seed: usize) -> Vec<usize> {
    let (grid, mut places) = (map.heights.grid(), Vec::<usize>::new());
    let mut i = 97 * seed;
    while places.len() < n {
        let (x, y) = (quasi_random(2 * i), quasi_random(5 * i + 1));
        let [x, y] = [x * (grid.nx() - 4) as f64 + 2.0, y * (grid.ny() - 4) as f64 + 2.0].map(|at| at as usize);
        let is_near = |j: &usize| (j % grid.nx()).abs_diff(x) < 4 && (j / grid.nx()).abs_diff(y) < 4;
        if !places.iter().any(is_near) {
            places.push(grid.index(x, y));
        }
        i += 1;
    }
    places.sort_unstable();
    places
}

#[test]
fn planted_spikes_are_found_and_other_points_keep_their_bits() {
    let despike = Treatment::Despike { sigma: 8.0 };
    for seed in 1..=4 {
        let clean = rough(220, 180, seed);
        let (same, effect) = treated(&clean, despike);
        assert!(same == clean && effect.changed == 0, "seed {seed}: {} good points were touched", effect.changed);
        let (mut spiky, at) = (clean.clone(), places(&clean, 60, seed));
        for (n, i) in at.iter().enumerate() {
            // 3 to 60 µm, up and down.
            let height = 3e-6 * 20_f64.powf(n as f64 / 59.0);
            spiky.heights.values_mut()[*i] += if n % 3 == 0 { -height } else { height };
        }
        let hole = clean.heights.grid().index(100, 90);
        spiky.heights.values_mut()[hole..hole + 5].fill(f64::NAN);
        let at: Vec<usize> = at.into_iter().filter(|i| !(hole..hole + 5).contains(i)).collect();
        let (despiked, effect) = treated(&spiky, despike);
        let removed: Vec<usize> = effect.removed.iter().map(|(i, _)| *i).collect();
        assert_eq!((removed, effect.changed, effect.missing), (at.clone(), at.len(), 5), "seed {seed}");
        for (i, (height, right)) in despiked.heights.values().iter().zip(clean.heights.values()).enumerate() {
            if at.contains(&i) {
                // A membrane is off by about the curvature times the square of the spacing.
                assert!((height - right).abs() < 1e-7, "seed {seed}: point {i} is off by {:e}", height - right);
            } else {
                assert!(height.is_nan() || height == right, "seed {seed}: point {i} changed");
            }
        }
    }
}

#[test]
fn only_points_beyond_the_given_number_of_deviations_go() {
    let noise = |i: usize| (0..6).map(|k| quasi_random(6 * i + k) - 0.5).sum::<f64>();
    let mut noisy = map(100, 100, |_, _| 0.0);
    noisy.heights.values_mut().iter_mut().enumerate().for_each(|(i, height)| *height = 1e-9 * noise(i));
    noisy.heights.values_mut()[5050] = 7e-9;
    noisy.heights.values_mut()[2020] = -40e-9;
    let count = |sigma: f64| treated(&noisy, Treatment::Despike { sigma }).1.changed;
    assert_eq!((count(5.0), count(20.0), count(100.0)), (2, 1, 0));
    assert_eq!(spike_points(&noisy.heights, 20.0), [2020]);
    for sigma in [0.0, 2.9, -8.0, f64::NAN, f64::INFINITY] {
        let refused = apply(noisy.clone(), &[Treatment::Despike { sigma }]);
        assert!(matches!(refused, Err(TreatError::Sigma { .. })), "{sigma}: {refused:?}");
    }
}

#[test]
fn spikes_beside_holes_and_in_groups_are_replaced_by_what_is_around() {
    let mut spiky = rough(64, 64, 9);
    let clean = spiky.clone();
    let index = |x: usize, y: usize| 64 * y + x;
    for (x, y) in [(20, 20), (21, 20), (40, 10)] {
        spiky.heights.values_mut()[index(x, y)] += 2e-5;
    }
    // The spike at (40, 10) has missing points on all four sides.
    for (x, y) in [(39, 10), (41, 10), (40, 9), (40, 11)] {
        spiky.heights.values_mut()[index(x, y)] = f64::NAN;
    }
    let (despiked, effect) = treated(&spiky, Treatment::Despike { sigma: 8.0 });
    assert_eq!((effect.changed, effect.missing), (3, 4));
    for (x, y) in [(20, 20), (21, 20), (40, 10)] {
        let off = despiked.heights.at(x, y) - clean.heights.at(x, y);
        assert!(off.abs() < 3e-7, "({x}, {y}) is off by {off:e}");
    }
}

/// A rough map with round holes, in which every ninth point is measured.
fn with_holes(mut map: HeightMap) -> HeightMap {
    let grid = map.heights.grid();
    for iy in 0..grid.ny() {
        for ix in 0..grid.nx() {
            let [x, y] = [ix % 40, iy % 40].map(|at| at as f64 - 20.0);
            if x.hypot(y) < 9.0 && !(ix % 3 == 0 && iy % 3 == 0) {
                map.heights.values_mut()[grid.index(ix, iy)] = f64::NAN;
            }
        }
    }
    map
}

#[test]
fn groups_of_outliers_at_and_in_holes_are_found_and_good_points_and_walls_stay() {
    let despike = Treatment::Despike { sigma: 8.0 };
    let clean = with_holes(rough(200, 160, 5));
    let (same, effect) = treated(&clean, despike);
    assert_eq!((same.missing(), effect.changed), (clean.missing(), 0), "good points were touched");
    let mut wrong = clean.clone();
    // A single point inside a hole, and groups of two and of five at its border, on either side.
    let groups: [&[(usize, usize)]; 3] =
        [&[(21, 21)], &[(60, 28), (60, 29)], &[(91, 19), (91, 20), (90, 20), (91, 21), (90, 21)]];
    let mut planted: Vec<usize> = groups.concat().into_iter().map(|(x, y)| clean.heights.grid().index(x, y)).collect();
    for (n, i) in planted.iter().enumerate() {
        wrong.heights.values_mut()[*i] = if n % 3 == 0 { -2e-5 } else { 1e-4 };
    }
    let (despiked, effect) = treated(&wrong, despike);
    let mut removed: Vec<usize> = effect.removed.iter().map(|(i, _)| *i).collect();
    removed.sort_unstable();
    planted.sort_unstable();
    assert_eq!(removed, planted);
    for i in planted.into_iter().filter(|i| clean.heights.values()[*i].is_finite()) {
        let off = despiked.heights.values()[i] - clean.heights.values()[i];
        // In the middle of a hole, the height is not known better than to the rms height.
        assert!(off.abs() < 1e-6, "point {i} is off by {off:e}");
    }
    // The floors of pits with walls that are not measured, nine points each, are features.
    let pits = map(120, 120, |x, y| {
        let [i, j] = [x, y].map(|at| (at * 120.0) as usize % 8);
        let wall = i.abs_diff(3).max(j.abs_diff(3));
        if wall == 2 { f64::NAN } else { 1e-8 * quasi_random((1e4 * x) as usize) - if wall < 2 { 5e-6 } else { 0.0 } }
    });
    assert_eq!(treated(&pits, despike).1.changed, 0, "floors of pits were removed");
}

#[test]
fn the_measured_rectangle_has_no_border_that_is_mostly_missing() {
    let whole = rough(60, 50, 1);
    let mut framed = whole.clone();
    let is_missing = |x: usize, y: usize| {
        // Whole rows and columns, a ragged row of which two thirds are missing, one that is measured for two thirds,
        // and a hole.
        let is_third = x.is_multiple_of(3);
        x < 2 || x == 59 || y == 0 || (y == 49 && !is_third) || (y == 48 && is_third) || (x == 30 && y == 20)
    };
    for i in (0..3000).filter(|i| is_missing(i % 60, i / 60)) {
        framed.heights.values_mut()[i] = f64::NAN;
    }
    let measured = Treatment::Crop("measured".parse().expect("a part"));
    let (part, effect) = treated(&framed, measured);
    assert_eq!((part.heights.grid().nx(), part.heights.grid().ny()), (57, 48));
    assert_eq!((effect.changed, effect.missing), (3000 - 57 * 48, 20));
    assert_eq!(part.heights.at(0, 0), whole.heights.at(2, 1));
    let [dx, dy] = whole.spacing();
    assert_eq!(part.sides, Some([57.0 * dx, 48.0 * dy]));
    assert_eq!(treated(&part, measured).1.changed, 0, "nothing is left to cut");
    // The grid is known only afterwards; what is known before is not less.
    assert_eq!(grids_after(&framed, &[measured]), Ok(vec![framed.heights.grid()]));
    let mut empty = whole;
    empty.heights.values_mut().fill(f64::NAN);
    assert_eq!(treated(&empty, measured).0.heights.grid(), empty.heights.grid());
}

#[test]
fn high_pass_is_what_low_pass_leaves() {
    let original = rough(128, 96, 3);
    let wavelength = SIDE / 5.0;
    let (short, _) = treated(&original, Treatment::HighPass { wavelength });
    let (long, _) = treated(&original, Treatment::LowPass { wavelength });
    for ((short, long), height) in
        short.heights.values().iter().zip(long.heights.values()).zip(original.heights.values())
    {
        assert!((short + long - height).abs() < 1e-20, "{short:e} + {long:e} is not {height:e}");
    }
    for waves in [5.0_f64, 10.0, 20.0] {
        let wave = map(200, 200, |x, _| 1e-6 * (TAU * waves * x).cos());
        let filter = Treatment::HighPass { wavelength: SIDE / 10.0 };
        let (filtered, _) = apply(wave.clone(), &[Treatment::Periodic(Periodic::AsIs), filter]).expect("a map");
        let (kept, expected) =
            (filtered.heights.rms() / wave.heights.rms(), 1.0 - 0.5_f64.powf((waves / 10.0).powi(2)));
        assert!((kept - expected).abs() < 1e-6, "{waves} waves: {kept} is kept, expected {expected}");
    }
    let refused = apply(original, &[Treatment::HighPass { wavelength: 2.0 * SIDE }]).expect_err("too long").to_string();
    assert!(refused.starts_with("high_pass: must be from"), "{refused}");
}

#[test]
fn a_window_fades_to_the_lowest_height_and_raises_no_point() {
    let original = rough(90, 70, 5);
    let (faded, _) = treated(&original, Treatment::Periodic(Periodic::Window { taper: 0.15 }));
    let (lowest, grid) = (original.heights.min(), original.heights.grid());
    let range = original.heights.max() - lowest;
    for (i, (height, before)) in faded.heights.values().iter().zip(original.heights.values()).enumerate() {
        assert!(*height <= before + 1e-12 * range && *height >= lowest - 1e-12 * range, "point {i}");
        let (x, y) = (i % grid.nx(), i / grid.nx());
        if x == 0 || y == 0 || x + 1 == grid.nx() || y + 1 == grid.ny() {
            assert!(height - lowest < 0.01 * range, "point {i} of the border is {height:e}");
        }
    }
    let off = faded.heights.at(45, 35) - original.heights.at(45, 35);
    assert!(off.abs() < 1e-12 * range, "the middle changed by {off:e}");
}

#[test]
fn effects_count_the_points_that_changed() {
    let mut holed = rough(40, 30, 2);
    holed.heights.values_mut()[..40].fill(f64::NAN);
    holed.heights.values_mut()[500] = f64::NAN;
    let treatments = [
        Treatment::Crop(Crop::Measured),
        Treatment::Level(Level::Plane),
        Treatment::Fill(Fill::Laplace),
        Treatment::Periodic(Periodic::Mirror),
    ];
    let (_, effects) = apply(holed, &treatments).expect("a map");
    let changed: Vec<usize> = effects.iter().map(|effect| effect.changed).collect();
    assert_eq!(changed, [40, 29 * 40, 1, 0]);
}
