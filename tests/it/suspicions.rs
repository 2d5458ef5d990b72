//! Tests of doubts about maps: what is planted is found, and sound maps give none.

use rc_core::{DVec2, Field, Grid, HeightField as _};
use rc_fractal::{Amplitudes, Normalisation, SpectrumParams, Surface, Truncation};
use rc_heights::suspicion::{Counter, Mark, Suspicions, counter, is_thin, marks, spikes};

/// Numbers in [0, 1), always the same for a seed (SplitMix64).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() * n as f64) as usize
    }

    /// A number of the normal distribution.
    fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.next()).ln()).sqrt() * (std::f64::consts::TAU * self.next()).cos()
    }
}

/// A self-affine surface of rms height 1, with this number of elements for its shortest wave.
fn surface(n: usize, elements: f64, hurst: f64, seed: u64) -> Field {
    let waves = ((n as f64 / elements) as usize).max(1);
    let amplitudes = if seed.is_multiple_of(2) { Amplitudes::Fixed } else { Amplitudes::Random };
    let normalisation = Normalisation::RmsHeight(1.0);
    let (roll_off, low_cut, truncation) = ([1.0_f64, 4.0][seed as usize % 2].min(waves as f64), 1.0, Truncation::Disc);
    let params = SpectrumParams { waves, hurst, roll_off, low_cut, truncation, amplitudes, normalisation, seed };
    Surface::new(&params).expect("a spectrum").sample(Grid::square(n).expect("a grid"))
}

fn tilted(mut field: Field, [x, y]: [f64; 2]) -> Field {
    let nx = field.grid().nx();
    field.values_mut().iter_mut().enumerate().for_each(|(i, height)| {
        *height += x * (i % nx) as f64 + y * (i / nx) as f64;
    });
    field
}

#[test]
fn generated_surfaces_have_no_spikes() {
    let mut maps = 0;
    for (n, seeds) in [(32, 3), (64, 2), (128, 2), (256, 1)] {
        for elements in [2.1, 4.0, 8.0, 16.0, 32.0] {
            for hurst in [0.1, 0.3, 0.5, 0.8, 1.0] {
                for seed in 0..seeds {
                    let field = surface(n, elements, hurst, 1000 * n as u64 + seed);
                    for field in [tilted(field.clone(), [0.3, -0.1]), field] {
                        let found = Suspicions::of(&field);
                        assert!(found.is_empty(), "{n}, {elements}, {hurst}, {seed}: {found:?}");
                        maps += 1;
                    }
                }
            }
        }
    }
    assert_eq!(maps, 400);
    let mut numbers = Numbers(5);
    for n in [64, 256, 1024] {
        let noise = Field::from_fn(Grid::square(n).expect("a grid"), |_| numbers.normal());
        assert_eq!(spikes(&noise, true), None, "noise, {n}");
    }
}

/// Plants `many` spikes of `size` x `size` points and `height` usual deviations, up and down. Returns their points.
fn plant(field: &mut Field, many: usize, size: usize, height: f64, numbers: &mut Numbers) -> Vec<(usize, usize)> {
    let n = field.grid().nx();
    let clean = field.clone();
    let mut deviations: Vec<f64> = (0..n * n)
        .filter(|i| (1..n - 1).contains(&(i % n)) && (1..n - 1).contains(&(i / n)))
        .map(|i| {
            let mut ring: Vec<f64> =
                [1, n - 1, n, n + 1].iter().flat_map(|d| [i - d, i + d]).map(|j| clean.values()[j]).collect();
            ring.sort_by(f64::total_cmp);
            (clean.values()[i] - 0.5 * (ring[3] + ring[4])).abs()
        })
        .collect();
    deviations.sort_by(f64::total_cmp);
    let step = height * 1.4826 * deviations[deviations.len() / 2];
    let mut places = Vec::new();
    for k in 0..many {
        let (x, y) = (numbers.below(n - size + 1), numbers.below(n - size + 1));
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        for i in 0..size * size {
            let (x, y) = (x + i % size, y + i / size);
            field.values_mut()[y * n + x] = clean.at(x, y) + sign * step;
            places.push((x, y));
        }
    }
    places.sort_unstable();
    places.dedup();
    places
}

#[test]
fn planted_spikes_are_found() {
    let mut numbers = Numbers(11);
    // Elements of the shortest wave, Hurst exponent, spikes, their size and height, the part of their points to be
    // found.
    let cases = [
        (1, 1, 15.0, 0.95),
        (8, 1, 10.0, 0.85),
        (8, 1, 30.0, 0.95),
        (100, 1, 15.0, 0.85),
        (8, 2, 15.0, 0.65),
        (30, 2, 60.0, 0.75),
    ];
    for (many, size, height, part) in cases {
        let (mut found, mut planted) = (0, 0);
        for (n, elements, hurst) in
            [(64, 4.0, 0.8), (64, 8.0, 0.5), (128, 2.5, 0.3), (128, 16.0, 0.8), (256, 32.0, 1.0)]
        {
            for seed in 0..6 {
                let mut field = surface(n, elements, hurst, 77 + seed);
                let places = plant(&mut field, many, size, height, &mut numbers);
                let field = tilted(field, [0.2, 0.1]);
                let name = format!("{n}, {elements}, {many} of {size}, {height}");
                let Some(spikes) = spikes(&field, false) else {
                    assert!(many == 1, "{name}: none of {} is found", places.len());
                    planted += places.len();
                    continue;
                };
                assert!(spikes.at.iter().all(|at| places.binary_search(at).is_ok()), "{name}: {spikes:?}");
                assert!(spikes.count <= places.len() && spikes.largest != 0.0, "{name}: {spikes:?}");
                (found, planted) = (found + spikes.count, planted + places.len());
            }
        }
        assert!(found as f64 >= part * planted as f64, "{many} of {size}, {height}: {found} of {planted}");
    }
}

#[test]
fn one_spike_is_found_anywhere() {
    // Among others, in a large map, at the border, in a corner, and beside missing points.
    for (n, x, y) in [(33, 16, 16), (256, 0, 100), (256, 255, 255), (1024, 500, 3), (40, 20, 0)] {
        for sign in [1.0, -1.0] {
            let mut field = tilted(surface(n, 8.0, 0.8, 4), [0.05, 0.3]);
            field.values_mut()[y * n + x] += sign * 3.0;
            let found = spikes(&field, false).unwrap_or_else(|| panic!("{n}: {x}, {y}"));
            assert_eq!((found.count, &found.at[..]), (1, &[(x, y)][..]), "{n}");
            assert!((found.largest - sign * 3.0).abs() < 0.5, "{n}: {found:?}");
        }
    }
    let mut field = surface(64, 8.0, 0.8, 9);
    for i in [20 * 64 + 30, 21 * 64 + 30, 22 * 64 + 30, 20 * 64 + 31] {
        field.values_mut()[i] = f64::NAN;
    }
    assert_eq!(spikes(&field, false), None, "holes alone");
    field.values_mut()[21 * 64 + 31] += 4.0;
    let found = spikes(&field, false).expect("a spike beside a hole");
    assert_eq!((found.count, &found.at[..]), (1, &[(31, 21)][..]));
}

/// A height at x and y, in elements from the centre.
type Shape = fn(f64, f64) -> f64;

#[test]
fn shapes_have_no_spikes() {
    let n = 128;
    let grid = Grid::square(n).expect("a grid");
    let every = |value: f64, period: f64, width: f64| value.rem_euclid(period) < width;
    let shapes: [(&str, Shape); 14] = [
        ("paraboloid", |x, y| -(x * x + y * y) / 300.0),
        ("sphere on a plane", |x, y| (1600.0 - x * x - y * y).max(0.0).sqrt()),
        ("cone", |x, y| -x.hypot(y)),
        ("cone on a plane", |x, y| (20.0 - x.hypot(y)).max(0.0)),
        ("pyramid", |x, y| -x.abs().max(y.abs())),
        ("diamond", |x, y| -x.abs() - y.abs()),
        ("cylinder", |x, _| -x * x),
        ("roof", |x, _| -x.abs()),
        ("plane", |x, y| 0.3 * x + 0.7 * y),
        ("waves", |x, y| (x / 5.0).sin() * (y / 5.0).cos()),
        ("posts", |x, y| if x.hypot(y) < 23.0 { 0.0 } else { -2e-6 }),
        ("many posts", |x, y| f64::from((x.rem_euclid(16.0) - 8.0).hypot(y.rem_euclid(16.0) - 8.0) < 4.0)),
        ("sawtooth", |x, y| (x + 0.37 * y).rem_euclid(12.0)),
        ("flat", |_, _| 3.0),
    ];
    let of = |shape: &dyn Fn(f64, f64) -> f64| {
        Field::from_fn(grid, |DVec2 { x, y }| shape((x * n as f64).floor() - 64.0, (y * n as f64).floor() - 64.0))
    };
    for (name, shape) in shapes {
        assert_eq!(Suspicions::of(&of(&shape)), Suspicions::default(), "{name}");
    }
    for (period, width) in [(8.0, 1.0), (8.0, 4.0), (2.0, 1.0), (128.0, 1.0), (11.0, 2.0)] {
        let grating = of(&|x, _| f64::from(every(x, period, width)));
        let slanted = of(&|x, y| f64::from(every((x + y).floor(), period, width)));
        let posts = of(&|x, y| f64::from(every(x, period, width) && every(y, period, width)));
        let checkers = of(&|x, y| f64::from(every(x, period, width) == every(y, period, width)));
        for (name, field) in [("grating", grating), ("slanted", slanted), ("posts", posts), ("checkers", checkers)] {
            assert_eq!(spikes(&field, false), None, "{name}, {period}, {width}");
        }
    }
    // Few levels of a rough surface.
    for levels in [2.0, 4.0, 8.0, 20.0, 100.0, 1000.0] {
        for elements in [4.0, 16.0] {
            let mut field = surface(n, elements, 0.8, 6);
            let range = field.max() - field.min();
            field.values_mut().iter_mut().for_each(|height| *height = (*height / range * levels).round());
            assert_eq!(spikes(&field, false), None, "{levels} levels, {elements}");
        }
    }
}

#[test]
fn worn_and_stepped_surfaces_have_no_spikes() {
    // Edges and kinks of such surfaces leave single points far from their neighbours, but not only single points.
    type Shape = fn(f64) -> f64;
    let shapes: [(&str, Shape); 4] =
        [("terraces", |z| z.round()), ("worn", |z| z.min(0.0)), ("lognormal", f64::exp), ("cubed", |z| z * z * z)];
    for (name, shape) in shapes {
        let mut alarms = 0;
        for seed in 0..24 {
            let (rough, n) = (surface(128, [6.0, 8.0, 12.0][seed as usize % 3], 0.7, 900 + seed), 128);
            let rms = (rough.values().iter().map(|z| z * z).sum::<f64>() / f64::from(n * n)).sqrt();
            let values = rough.values().iter().map(|z| shape(z / rms) + 0.02 * z / rms).collect();
            let field = Field::new(rough.grid(), values).expect("a field");
            alarms += usize::from(spikes(&field, true).is_some());
        }
        assert!(alarms <= 2, "{name}: {alarms} of 24");
    }
}

#[test]
fn spikes_on_plateaus_are_found() {
    let mut field = Field::from_fn(Grid::square(128).expect("a grid"), |DVec2 { x, y }| {
        f64::from((16.0 * x).rem_euclid(2.0) < 1.0 && (16.0 * y).rem_euclid(2.0) < 1.0)
    });
    assert_eq!(spikes(&field, false), None);
    for at in [1200, 5000, 9043] {
        field.values_mut()[at] += 30.0;
    }
    assert_eq!(spikes(&field, false).map(|spikes| spikes.count), Some(3));
}

#[test]
fn marks_of_missing_points_are_values_far_from_all_others() {
    let heights = |factor: f64, mark: f64, count: usize| {
        let mut field = surface(32, 8.0, 0.8, 2);
        field.values_mut().iter_mut().for_each(|height| *height *= factor);
        (0..count).for_each(|i| field.values_mut()[5 + 97 * i] = mark);
        field
    };
    let found = [
        -9999.0,
        9999.0,
        -99_999.0,
        -32_768.0,
        32_767.0,
        -32_767.0,
        65_535.0,
        -999.0,
        1e30,
        1e38,
        -1e30,
        3.402_823_5e38,
        -3.402_823_466e38,
        9.96921e36,
        1.70141e38,
        2_147_483_647.0,
        2_147_483_640.0,
        -2_147_483_648.0,
        f64::MAX,
        f64::from(f32::MAX),
        f64::from(1.70141e38_f32),
    ];
    for value in found {
        for factor in [1.0, 1e-3, 1e-6, 1e-9, 1e-10] {
            let mark = Some(Mark { value: value * factor, count: 3 });
            assert_eq!(marks(&heights(factor, value * factor, 3)), mark, "{value} x {factor}");
        }
    }
    // Other numbers, and numbers near the heights.
    for (factor, value, count) in [(1.0, -9998.0, 3), (1.0, 500.0, 1), (1e4, -9999.0, 3), (1.0, 0.0, 9), (1.0, -1.0, 2)]
    {
        assert_eq!(marks(&heights(factor, value, count)), None, "{value}");
    }
    let mut two = heights(1.0, -9999.0, 4);
    two.values_mut()[700] = 1e38;
    assert_eq!(marks(&two), Some(Mark { value: -9999.0, count: 4 }));
    assert_eq!(Suspicions::of(&two).spikes, None, "marks are no spikes");
    two.values_mut().iter_mut().filter(|height| **height > 100.0).for_each(|height| *height = f64::NAN);
    assert_eq!(marks(&two), Some(Mark { value: -9999.0, count: 4 }));
    let flat = Field::new(Grid::new(3, 2).expect("a grid"), vec![2.0, 2.0, -9999.0, 2.0, 2.0, 2.0]).expect("heights");
    assert_eq!(marks(&flat), Some(Mark { value: -9999.0, count: 1 }));
}

/// A value in a row and a column.
type Value<'a> = &'a dyn Fn(usize, usize) -> f64;

#[test]
fn a_row_or_a_column_that_counts_is_no_row_of_heights() {
    let table = |ny: usize, nx: usize, value: Value<'_>| {
        let grid = Grid::new(nx, ny).expect("a grid");
        Field::new(grid, (0..nx * ny).map(|i| value(i / nx, i % nx)).collect()).expect("values")
    };
    let height = |iy: usize, ix: usize| ((iy * 7 + ix * 13) as f64 * 0.37).sin();
    for from in [0.0, 1.0] {
        for factor in [1.0, 1e-6, 1e-9] {
            let row = table(6, 9, &|iy, ix| factor * if iy == 0 { from + ix as f64 } else { height(iy, ix) });
            let column = table(6, 9, &|iy, ix| factor * if ix == 0 { from + iy as f64 } else { height(iy, ix) });
            assert_eq!(
                (counter(&row), counter(&column)),
                (Some(Counter::Row), Some(Counter::Column)),
                "{from} {factor}"
            );
        }
    }
    let none: [(&str, Value<'_>); 7] = [
        ("heights", &height),
        ("a plane", &|iy, ix| (iy + ix) as f64),
        ("a mesh", &|_, ix| ix as f64),
        ("a mesh of y", &|iy, _| iy as f64),
        ("from 2", &|iy, ix| if iy == 0 { 2.0 + ix as f64 } else { height(iy, ix) }),
        ("steps of a half", &|iy, ix| if iy == 0 { 0.5 * ix as f64 } else { height(iy, ix) }),
        ("a gap", &|iy, ix| if iy == 0 { (ix + ix / 5) as f64 } else { height(iy, ix) }),
    ];
    for (name, value) in none {
        assert_eq!(counter(&table(6, 9, value)), None, "{name}");
    }
    assert_eq!(counter(&table(4, 3, &|iy, ix| if iy == 0 { ix as f64 } else { height(iy, ix) })), None, "three values");
    assert_eq!(counter(&table(1, 9, &|_, ix| ix as f64)), None, "one row");
}

#[test]
fn two_to_four_columns_or_rows_are_few() {
    for (nx, ny, thin) in [(3, 600, true), (600, 4, true), (2, 2, true), (5, 5, false), (1, 50, false), (12, 8, false)]
    {
        assert_eq!(is_thin(Grid::new(nx, ny).expect("a grid")), thin, "{nx} x {ny}");
    }
}
