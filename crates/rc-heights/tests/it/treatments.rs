//! Tests of treatments on planes, waves and holes.
#![expect(clippy::float_cmp, reason = "heights that are moved or copied keep their bits")]

use std::f64::consts::TAU;

use rc_core::{DVec2, Field, Grid};
use rc_heights::{
    Crop, Effect, Fill, Flip, HeightMap, Level, Periodic, SAME_LENGTH, TreatError, Treatment, Unit, apply, grids_after,
    hann,
};

/// A map on a rectangle of `sides` m.
fn map(nx: usize, ny: usize, sides: [f64; 2], height: impl Fn(f64, f64) -> f64) -> HeightMap {
    let heights =
        Field::from_fn(Grid::new(nx, ny).expect("a grid"), |DVec2 { x, y }| height(x * sides[0], y * sides[1]));
    HeightMap::new(heights, Unit::Metre, Some(sides), Unit::Metre)
}

fn treated(map: HeightMap, treatment: Treatment) -> (HeightMap, Effect) {
    let (map, mut effects) = apply(map, &[treatment]).unwrap_or_else(|error| panic!("{error}"));
    (map, effects.remove(0))
}

fn largest(map: &HeightMap) -> f64 {
    map.heights.max().max(-map.heights.min())
}

#[test]
fn levels_take_their_form_away_and_nothing_else() {
    let form = |x: f64, y: f64| 3.0 + 0.2 * x - 0.1 * y;
    let bowl = move |x: f64, y: f64| form(x, y) + 0.03 * x * x - 0.02 * x * y + 0.05 * y * y;
    // Rounding of heights near 3, over 40 points per side.
    let exact = 1e-13;
    for hole in [false, true] {
        let with_hole = |mut map: HeightMap| {
            if hole {
                map.heights.values_mut()[100..300].fill(f64::NAN);
            }
            map
        };
        let (plane, _) = treated(with_hole(map(40, 30, [2.0, 3.0], form)), Treatment::Level(Level::Plane));
        assert!(largest(&plane) < exact, "plane: {} is left", largest(&plane));
        let (quadratic, _) = treated(with_hole(map(40, 30, [2.0, 3.0], bowl)), Treatment::Level(Level::Quadratic));
        assert!(largest(&quadratic) < exact, "quadratic: {} is left", largest(&quadratic));
        let (mean, effect) = treated(with_hole(map(40, 30, [2.0, 3.0], bowl)), Treatment::Level(Level::Mean));
        assert!(largest(&mean) > 0.3 && effect.rms_height > 0.1, "the mean takes more than the mean away");
        assert_eq!(effect.missing, if hole { 200 } else { 0 });
    }
    // A wave of whole periods is orthogonal to the mean but not to a tilt. The remainder is smaller than its amplitude.
    let wave = map(64, 64, [1.0, 1.0], |x, _| (TAU * 8.0 * x).sin());
    let (left, _) = treated(wave.clone(), Treatment::Level(Level::Mean));
    let change =
        left.heights.values().iter().zip(wave.heights.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(change < 1e-14, "a wave without mean changed by {change}");
}

#[test]
fn a_form_that_the_points_do_not_determine_is_refused() {
    let mut line = map(8, 8, [1.0, 1.0], |x, _| x);
    line.heights.values_mut()[8..].fill(f64::NAN);
    let refused = apply(line, &[Treatment::Level(Level::Plane)]);
    assert!(matches!(refused, Err(TreatError::Undetermined { points: 8, .. })), "{refused:?}");
}

#[test]
fn laplace_fills_a_hole_in_a_harmonic_surface_with_it() {
    // With equal distances of points in both directions, x² - y² is harmonic for differences too.
    let saddle = |x: f64, y: f64| x * x - y * y + 0.3 * x;
    let whole = map(40, 40, [1.0, 1.0], saddle);
    let mut holed = whole.clone();
    for iy in 10..30 {
        for ix in 8..25 {
            let i = holed.heights.grid().index(ix, iy);
            holed.heights.values_mut()[i] = f64::NAN;
        }
    }
    let (filled, effect) = treated(holed.clone(), Treatment::Fill(Fill::Laplace));
    let off =
        filled.heights.values().iter().zip(whole.heights.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    // The iteration ends at 1e-8 of its first residual. Heights are of order 1.
    assert!(off < 1e-7 && effect.missing == 0, "off by {off}");
    let (lowest, _) = treated(holed.clone(), Treatment::Fill(Fill::Lowest));
    assert_eq!(lowest.heights.at(15, 15), holed.heights.min());
    let (nearest, _) = treated(holed, Treatment::Fill(Fill::Nearest));
    assert_eq!(nearest.heights.at(8, 20), whole.heights.at(7, 20));
}

#[test]
fn a_mirrored_map_is_periodic_and_keeps_its_heights() {
    let (mirrored, effect) = treated(map(32, 16, [2.0, 1.0], |x, y| x + y), Treatment::Periodic(Periodic::Mirror));
    assert_eq!((mirrored.heights.grid().nx(), mirrored.heights.grid().ny()), (64, 32));
    assert_eq!(mirrored.sides, Some([4.0, 2.0]));
    let ramp = Effect::of(&map(32, 16, [2.0, 1.0], |x, y| x + y), "as read");
    assert!(ramp.border_step.is_some_and(|ratio| ratio > 15.0), "{ramp:?}");
    assert!(effect.border_step.is_some_and(|ratio| ratio == 0.0), "{effect:?}");
    assert!((effect.rms_height / ramp.rms_height - 1.0).abs() < 1e-12, "{} {}", effect.rms_height, ramp.rms_height);
    assert_eq!(mirrored.heights.at(0, 0), mirrored.heights.at(63, 31));
}

#[test]
fn a_window_fades_borders_and_leaves_the_middle() {
    let ramp = map(100, 100, [1.0, 1.0], |x, y| x + 2.0 * y);
    let (faded, effect) = treated(ramp.clone(), Treatment::Periodic(Periodic::Window { taper: 0.2 }));
    assert!((faded.heights.at(50, 40) - ramp.heights.at(50, 40)).abs() < 1e-15, "the middle changed");
    assert!(effect.border_step.is_some_and(|ratio| ratio < 0.2), "{effect:?}");
    for taper in [0.0, 0.6, f64::NAN] {
        let refused = apply(ramp.clone(), &[Treatment::Periodic(Periodic::Window { taper })]);
        assert!(matches!(refused, Err(TreatError::Taper(_))), "{refused:?}");
    }
}

#[test]
fn hann_keeps_the_mean_square_of_a_wave() {
    let wave = map(256, 256, [1.0, 1.0], |x, y| 5.0 + (TAU * (20.3 * x + 7.0 * y)).sin());
    let windowed = hann(&wave.heights);
    // The product of window and wave has a mean square of ½, except for waves of the window, which are 20 waves away.
    assert!((windowed.rms() * 2_f64.sqrt() - 1.0).abs() < 1e-3, "rms {}", windowed.rms());
    for (nx, ny) in [(256, 1), (1, 256)] {
        let line = map(nx, ny, [1.0, 1.0], |x, y| (TAU * 20.3 * if ny == 1 { x } else { y }).sin());
        let rms = hann(&line.heights).rms() * 2_f64.sqrt();
        assert!((rms - 1.0).abs() < 1e-2, "one line of {nx} x {ny}: rms {rms}");
    }
}

#[test]
fn the_filter_halves_waves_of_its_length() {
    let sides = [1e-3, 1e-3];
    for (waves, expected) in [(10.0, 0.5), (20.0, 0.0625), (5.0, 0.5_f64.powf(0.25))] {
        let wave = map(200, 100, sides, |x, y| (TAU * waves * x / 1e-3).cos() * if y > 0.0 { 1e-6 } else { 0.0 });
        let low_pass = Treatment::LowPass { wavelength: 1e-4 };
        let (filtered, _) = apply(wave, &[Treatment::Periodic(Periodic::AsIs), low_pass]).expect("a filtered map");
        let kept = filtered.heights.rms() / (1e-6 / 2_f64.sqrt());
        // exp(-π (αλq)²) = 2^-(λ/wavelength)², and the weights are cut off at 3e-9.
        assert!((kept - expected).abs() < 1e-6, "{waves} waves: {kept} is kept, expected {expected}");
    }
    // Four points per wave are the minimum. For shorter waves, the weights at points do not have the effect of the
    // formula.
    let shortest = map(64, 64, sides, |x, _| (TAU * 16.0 * x / 1e-3).cos());
    let low_pass = Treatment::LowPass { wavelength: 1e-3 / 16.0 };
    let (filtered, _) =
        apply(shortest.clone(), &[Treatment::Periodic(Periodic::AsIs), low_pass]).expect("a filtered map");
    let kept = filtered.heights.rms() / shortest.heights.rms();
    assert!((kept - 0.5).abs() < 3e-3, "{kept} of four points a wave is kept");
    for wavelength in [2e-3, 3.9e-3 / 64.0, f64::NAN] {
        let refused = apply(shortest.clone(), &[Treatment::LowPass { wavelength }]);
        assert!(matches!(refused, Err(TreatError::Wavelength { .. })), "{refused:?}");
    }
}

#[test]
fn fewer_points_are_means_and_more_points_are_on_the_curve() {
    let wave = |x: f64, y: f64| (TAU * (2.0 * x + y)).sin();
    let fine = map(240, 240, [1.0, 1.0], wave);
    let coarse = Treatment::Resample(Grid::new(100, 80).expect("a grid"));
    let (means, effect) = treated(fine.clone(), coarse);
    assert!((means.heights.mean() - fine.heights.mean()).abs() < 1e-15, "the mean changed");
    assert_eq!((effect.grid.nx(), effect.grid.ny(), means.sides), (100, 80, Some([1.0, 1.0])));
    let finer = Treatment::Resample(Grid::new(360, 500).expect("a grid"));
    let (curve, _) = apply(fine, &[Treatment::Periodic(Periodic::AsIs), finer]).expect("a finer map");
    let exact = map(360, 500, [1.0, 1.0], wave);
    let off = curve.heights.values().iter().zip(exact.heights.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    // Third order: (2π·2/240)³ is 1.4e-4.
    assert!(off < 2e-4, "off by {off}");
}

#[test]
fn parts_are_where_they_are_asked_for() {
    let numbered = map(6, 4, [3.0, 4.0], |x, y| (2.0 * x).floor() + 10.0 * y.floor());
    let crop = |text: &str| apply(numbered.clone(), &[Treatment::Crop(text.parse().expect(text))]);
    let (part, _) = crop("2x3+1+1").expect("a part");
    assert_eq!(part.heights.values(), [11.0, 12.0, 21.0, 22.0, 31.0, 32.0]);
    assert_eq!(part.sides, Some([1.0, 3.0]));
    let (middle, _) = crop("2").expect("a part");
    assert_eq!(middle.heights.values(), [12.0, 13.0, 22.0, 23.0]);
    let (square, _) = crop("square").expect("a part");
    assert_eq!((square.heights.grid().nx(), square.heights.grid().ny(), square.sides), (6, 3, Some([3.0, 3.0])));
    for outside in ["7x1", "2x2+5+0", "0"] {
        assert!(crop(outside).is_err(), "{outside}");
    }
    for text in ["", "2x", "2+1", "2x2+1+1+1", "squares", "-1"] {
        assert!(text.parse::<Crop>().is_err(), "'{text}' was read as a part");
    }
}

#[test]
fn the_square_of_any_map_is_one_that_is_accepted() {
    // Numbers and distances of points as in instruments, and few points at awkward distances.
    let cases = [
        (1024, 768, 1.0, 1.0),
        (640, 480, 1.0, 1.11),
        (97, 61, 0.73, 1.0),
        (50, 50, 1.0, 1.37),
        (7, 90, 2.6, 0.4),
        (4000, 3000, 1.0, 1.0),
    ];
    for (nx, ny, dx, dy) in cases {
        let sides = [dx * nx as f64, dy * ny as f64];
        let (square, _) = treated(map(nx, ny, sides, |x, _| x), Treatment::Crop(Crop::Square));
        let [x, y] = square.sides.expect("sides");
        assert!((x / y - 1.0).abs() <= SAME_LENGTH, "{nx} x {ny}, {dx} x {dy}: {x} x {y}");
        // The part is not needlessly small: up to the shorter side, no larger part is a square.
        let grid = square.heights.grid();
        for larger in grid.nx() + 1..=(sides[0].min(sides[1]) / dx) as usize {
            let fits = |ny: usize| (dx * larger as f64 / (dy * ny as f64) - 1.0).abs() <= SAME_LENGTH;
            assert!(!(1..=ny).any(fits), "{larger} points along x are a square too, not only {grid}");
        }
    }
    let image = HeightMap { sides: None, ..map(16, 12, [1.0, 1.0], |x, _| x) };
    let (square, effect) = treated(image, Treatment::Crop(Crop::Square));
    assert_eq!(
        (square.sides, effect.grid),
        (None, Grid::square(12).expect("a grid")),
        "points without a size are squares"
    );
    let refused = apply(map(3, 3, [3.0, 3.0 * 2.3], |x, _| x), &[Treatment::Crop(Crop::Square)]);
    assert!(matches!(refused, Err(TreatError::NoSquare { .. })), "{refused:?}");
}

#[test]
fn grids_are_known_before_the_map_is_treated() {
    let grid = |nx, ny| Grid::new(nx, ny).expect("a grid");
    let original = map(30, 20, [3.0, 1.0], |x, y| x + y);
    let treatments = [
        Treatment::Crop("24x20".parse().expect("a part")),
        Treatment::Level(Level::Plane),
        Treatment::Periodic(Periodic::Mirror),
        Treatment::Resample(grid(60, 10)),
        Treatment::Crop(Crop::Square),
    ];
    let (_, effects) = apply(original.clone(), &treatments).expect("a treated map");
    let expected: Vec<Grid> = effects.iter().map(|effect| effect.grid).collect();
    assert_eq!(grids_after(&original, &treatments), Ok(expected));
    let large = Treatment::Resample(grid(1 << 20, 1 << 20));
    assert_eq!(grids_after(&original, &[large]), Ok(vec![grid(1 << 20, 1 << 20)]), "no memory is taken");
}

#[test]
fn resampling_in_either_order_is_the_same_map() {
    let fine = map(24, 40, [1.0, 1.0], |x, y| (TAU * (2.0 * x + y)).sin());
    let resample = |nx, ny| Treatment::Resample(Grid::new(nx, ny).expect("a grid"));
    let (both, _) = treated(fine.clone(), resample(90, 7));
    let (steps, _) = apply(fine, &[resample(90, 40), resample(90, 7)]).expect("a map");
    let off = both.heights.values().iter().zip(steps.heights.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    // Rounding of sums of some ten heights of order 1.
    assert!(off < 1e-14, "off by {off:e}");
}

#[test]
fn the_nearest_height_is_the_nearest_by_length() {
    // The distance of points along x is ten times that along y. So a point three rows away is nearer than a neighbour
    // along x.
    let mut holed = map(9, 9, [9.0, 0.9], |x, y| 10.0 * x.floor() + (10.0 * y).floor());
    for iy in 3..6 {
        let i = holed.heights.grid().index(4, iy);
        holed.heights.values_mut()[i] = f64::NAN;
    }
    let (filled, _) = treated(holed.clone(), Treatment::Fill(Fill::Nearest));
    let [below, above] = [2, 6].map(|iy| holed.heights.at(4, iy));
    assert_eq!([3, 5].map(|iy| filled.heights.at(4, iy)), [below, above]);
    assert!([below, above].contains(&filled.heights.at(4, 4)), "{}", filled.heights.at(4, 4));
    // A large hole is compared with a search over all points.
    let mut wide = map(30, 40, [3.0, 1.0], |x, y| x + 31.7 * y);
    for i in (0..1200).filter(|i| i % 97 != 0) {
        wide.heights.values_mut()[i] = f64::NAN;
    }
    let (filled, _) = treated(wide.clone(), Treatment::Fill(Fill::Nearest));
    let place = |i: usize| [(i % 30) as f64 * 0.1, (i / 30) as f64 * 0.025];
    let apart = |i: usize, j: usize| (place(i)[0] - place(j)[0]).hypot(place(i)[1] - place(j)[1]);
    let there: Vec<usize> = (0..1200).step_by(97).collect();
    for i in 0..1200 {
        let least = there.iter().map(|j| apart(i, *j)).fold(f64::INFINITY, f64::min);
        let from =
            there.iter().find(|j| wide.heights.values()[**j] == filled.heights.values()[i]).expect("a measured height");
        assert!(apart(i, *from) < least + 0.025, "point {i}: {} away, the nearest {least}", apart(i, *from));
    }
}

#[test]
fn a_map_flipped_twice_is_itself() {
    let original = map(5, 4, [1.0, 1.0], |x, y| x + 3.0 * y);
    for (axis, corner) in [(Flip::X, (4, 0)), (Flip::Y, (0, 3)), (Flip::Z, (0, 0))] {
        let (once, _) = treated(original.clone(), Treatment::Flip(axis));
        let sign = if axis == Flip::Z { -1.0 } else { 1.0 };
        assert_eq!(once.heights.at(0, 0), sign * original.heights.at(corner.0, corner.1), "{axis}");
        assert_eq!(treated(once, Treatment::Flip(axis)).0, original, "{axis}");
    }
}

#[test]
fn treatments_that_need_every_height_say_so() {
    let mut holed = map(8, 8, [1.0, 1.0], |x, _| x);
    holed.heights.values_mut()[3] = f64::NAN;
    for treatment in [
        Treatment::Periodic(Periodic::Mirror),
        Treatment::LowPass { wavelength: 0.5 },
        Treatment::HighPass { wavelength: 0.5 },
        Treatment::Resample(Grid::square(4).expect("a grid")),
    ] {
        let error = apply(holed.clone(), &[treatment]).expect_err("a hole").to_string();
        assert!(error.contains("without missing points (this one has 1)") && error.contains("fill"), "{error}");
    }
}

/// A profile is a map of one row, with a square cell.
#[test]
fn profiles_are_levelled_filtered_and_mirrored_along_their_row() {
    let profile = |height: fn(f64) -> f64| map(200, 1, [2.0, 2.0], |x, _| height(x));
    let (plane, _) = treated(profile(|x| 3.0 + 0.2 * x), Treatment::Level(Level::Plane));
    let (quadratic, _) = treated(profile(|x| 3.0 + 0.2 * x - 0.1 * x * x), Treatment::Level(Level::Quadratic));
    assert!(largest(&plane) < 1e-13 && largest(&quadratic) < 1e-13, "{} and {}", largest(&plane), largest(&quadratic));
    let (twice, _) = treated(profile(|x| x), Treatment::Periodic(Periodic::Mirror));
    assert_eq!((twice.heights.grid(), twice.sides), (Grid::new(400, 1).expect("a grid"), Some([4.0, 4.0])));
    assert!((0..200).all(|i| twice.heights.at(i, 0) == twice.heights.at(399 - i, 0)));
    let wave: fn(f64) -> f64 = |x| (TAU * 5.0 * x).cos();
    let (half, _) = treated(profile(wave), Treatment::LowPass { wavelength: 0.2 });
    for (kept, height) in half.heights.values().iter().zip(profile(wave).heights.values()) {
        assert!((kept - 0.5 * height).abs() < 1e-6, "{kept} for {height}");
    }
}
