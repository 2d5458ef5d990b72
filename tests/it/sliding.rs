//! Steady sliding over viscoelastic solids.

use std::f64::consts::{FRAC_PI_4, TAU};

use rc_core::{Complex64, DVec2, Field, Grid, HeightField, Kernel, Silent};
use rc_fractal::{Normalisation, SpectrumParams, Surface};
use rc_kernel::{Layer, Love, LoveLayer, Relaxation, Spectral, Viscoelastic};
use rc_solver::{ContactProblem, Control, Friction, Method, Solution, SolveError, SolveParams, Status};
use rc_theory::hunter::Hunter;

use crate::assert_close;

/// The element from which another gets its value.
type Places<'a> = &'a dyn Fn(usize, usize) -> [usize; 2];

fn problem<'a>(heights: &'a Field, kernel: &'a dyn Kernel, load: f64) -> ContactProblem<'a> {
    ContactProblem::new(heights, Control::MeanPressure(load)).with_kernel(kernel)
}

/// The solution to this tolerance of the height range, or to the default tolerance if it is 0.
fn solved(heights: &Field, kernel: &dyn Kernel, load: f64, tolerance: f64) -> Solution<'static> {
    let params = if tolerance > 0.0 { SolveParams::to_tolerance(tolerance) } else { SolveParams::default() };
    let solution = problem(heights, kernel, load).solve(&params, &Silent);
    solution.unwrap_or_else(|error| panic!("{load}: {error}")).into_owned()
}

fn friction(solution: &Solution<'_>) -> Friction {
    solution.info().friction.expect("it slides")
}

/// A solid of the retardation length `length`, for a surface that slides along +x.
fn one_mode(glassy_ratio: f64, length: f64) -> (Relaxation, DVec2) {
    (Relaxation::single(glassy_ratio, 1.0).expect("a material"), DVec2::X * length / glassy_ratio)
}

/// The surface of `rc surface --waves 16 --rms 1.3e-3` in a cell of side 1.
fn rough(seed: u64, side: usize) -> Field {
    let params = SpectrumParams { normalisation: Normalisation::RmsHeight(1.3e-3), ..SpectrumParams::paper(16, seed) };
    Surface::new(&params).expect("a spectrum").sample(Grid::square(side).expect("a grid"))
}

/// A half-space under a surface that slides along x, each wave of which has this factor.
struct Toy(fn(i64) -> f64);

impl Kernel for Toy {
    fn name(&self) -> &'static str {
        "toy"
    }

    fn symbol(&self, grid: Grid) -> rc_core::Symbol<'_> {
        Spectral.symbol(grid)
    }

    fn sliding_velocity(&self) -> Option<DVec2> {
        Some(DVec2::X)
    }

    fn sliding_symbol(&self, grid: Grid) -> Option<rc_core::ComplexSymbol<'_>> {
        let symbol = Spectral.symbol(grid);
        Some(Box::new(move |kx, ky| {
            Complex64::from(self.0(kx) * symbol(kx.unsigned_abs() as usize, ky.unsigned_abs() as usize))
        }))
    }
}

/// The values are those of an independent program, solved to √(G/U) < 5e-7.
#[test]
fn a_rough_surface_has_the_area_and_friction_of_another_program() {
    let heights = rough(1, 256);
    let table = [
        (0.001, 0.07196, 0.000_468, 0.000_047, 0.02922),
        (0.01, 0.06201, 0.003_978, 0.000_424, 0.03738),
        (0.03, 0.04198, 0.007_775, 0.000_856, 0.05839),
        (0.1, 0.02155, 0.008_415, 0.001_020, 0.09546),
        (0.3, 0.01534, 0.005_009, 0.000_012, 0.12611),
        (1.0, 0.01302, 0.002_148, -0.000_365, 0.16451),
    ];
    for (length, counted, coefficient, lateral, peak) in table {
        let (material, velocity) = one_mode(10.0, length);
        let solution = solved(&heights, &Viscoelastic::new(Spectral, &material, velocity), 6e-4, 1e-10);
        let (found, pressure) = (friction(&solution), solution.pressure());
        let in_contact = pressure.values().iter().filter(|p| **p > 0.0).count() as f64 / heights.grid().len() as f64;
        assert!((in_contact - counted).abs() < 1e-5, "{length}: {in_contact} in contact");
        assert!((found.coefficient - coefficient).abs() < 1e-6, "{length}: {found:?}");
        assert!((found.lateral - lateral).abs() < 1e-6, "{length}: {found:?}");
        assert!((pressure.max() - peak).abs() < 2e-5, "{length}: {}", pressure.max());
        assert!(found.error > 0.0 && found.bound < 1e-2 * coefficient, "{length}: {found:?}");
        // A solve to the default tolerance has the same friction within the bound that it states.
        let quick = friction(&solved(&heights, &Viscoelastic::new(Spectral, &material, velocity), 6e-4, 0.0));
        assert!((quick.coefficient - coefficient).abs() < quick.bound.min(0.02 * coefficient), "{length}: {quick:?}");
        // Elements and waves agree within the error bars of both.
        let love = solved(&heights, &Viscoelastic::new(Love, &material, velocity), 6e-4, 0.0);
        let bar = friction(&love).error + found.error;
        assert!((friction(&love).coefficient - coefficient).abs() < bar, "{length}: {:?}", friction(&love));
        let bar = love.area().error + solution.area().error;
        assert!((love.area().fraction - solution.area().fraction).abs() < bar, "{length}: {:?}", love.area());
    }
}

/// Elements of 1/200 of the half width at rest, in a cell of 64 half widths.
#[test]
fn a_cylinder_is_that_of_hunter() {
    let (half_width, n) = (1.0 / 64.0, 64 * 200);
    let heights = Field::from_fn(Grid::new(n, 1).expect("a grid"), |at| -(at.x - 0.5).powi(2) / 2.0);
    let load = FRAC_PI_4 * half_width * half_width;
    for (glassy_ratio, length) in
        [(10.0, 0.01), (10.0, 0.1), (10.0, 0.3), (10.0, 1.0), (100.0, 0.01), (100.0, 0.1), (100.0, 0.3), (100.0, 1.0)]
    {
        let (material, velocity) = one_mode(glassy_ratio, length * half_width);
        let exact = Hunter { radius: 1.0, glassy_ratio, length: length * half_width }.at_load(load).expect("a contact");
        for kernel in [
            &Viscoelastic::new(Spectral, &material, velocity) as &dyn Kernel,
            &Viscoelastic::new(Love, &material, velocity),
        ] {
            let solution = solved(&heights, kernel, load, 1e-9);
            let what = format!("{} {glassy_ratio} {length}", kernel.name());
            assert_close(&what, friction(&solution).coefficient, exact.friction, 1e-3);
            assert_close(&what, solution.area().fraction, 2.0 * exact.half_width, 5e-3);
        }
    }
}

/// μ σ0 = Σ (q/4) q·v̂ |h|² E''(q·v), for each wave of amplitude |h|.
#[test]
fn full_contact_has_the_friction_of_all_its_waves() {
    let materials = [
        Relaxation::single(10.0, 0.02).expect("one mode"),
        Relaxation::prony(&[[3.0, 1e-3], [2.0, 0.01], [8.0, 0.3]]).expect("a series"),
        Relaxation::fractional(0.3, 100.0, 0.05).expect("a fractional solid"),
    ];
    let waves = [([1, 0], 1e-3), ([3, -2], 4e-4), ([0, 4], 3e-4), ([-2, 5], 2e-4)];
    for (nx, ny) in [(32, 32), (45, 24)] {
        let grid = Grid::new(nx, ny).expect("a grid");
        let height = |at: DVec2| {
            let of_wave = |([kx, ky], amplitude): ([i64; 2], f64)| amplitude * grid.angular_wave(kx, ky).dot(at).cos();
            waves.map(of_wave).iter().sum::<f64>()
        };
        let heights = Field::from_fn(grid, height);
        for material in &materials {
            for velocity in [DVec2::X, DVec2::new(-0.3, 0.4), -2.0 * DVec2::Y] {
                let load = 1.0;
                let solution = solved(&heights, &Viscoelastic::new(Spectral, material, velocity), load, 0.0);
                assert_eq!(solution.status(), Status::FullContact);
                let force = |along: DVec2| -> f64 {
                    let of_wave = |([kx, ky], amplitude): ([i64; 2], f64)| {
                        let q = grid.angular_wave(kx, ky);
                        -0.25 * q.length() * q.dot(along) * amplitude * amplitude * material.modulus(q.dot(velocity)).im
                    };
                    waves.map(of_wave).iter().sum::<f64>() / load
                };
                let (found, along) = (friction(&solution), velocity.normalize());
                assert_close("friction", found.coefficient, force(along), 1e-12);
                assert!((found.lateral - force(along.perp())).abs() < 1e-12 * force(along), "{found:?}");
                assert_close("power", found.power, velocity.length() * force(along) * load, 1e-12);
                assert!(found.error <= 1e-12 * found.coefficient && found.of_displacement > 0.0, "{found:?}");
            }
        }
    }
}

/// Far below the relaxation the contact is that of the relaxed solid. Far above, waves across the velocity still relax.
#[test]
fn at_both_ends_of_the_speed_the_contact_is_elastic() {
    let heights = rough(2, 128);
    let rest = solved(&heights, &Spectral, 1e-3, 1e-9);
    let sliding = |length: f64| {
        let (material, velocity) = one_mode(10.0, length);
        solved(&heights, &Viscoelastic::new(Spectral, &material, velocity), 1e-3, 1e-9)
    };
    let differs = |a: &Solution<'_>, b: &Solution<'_>| {
        let (a, b) = (a.pressure().values(), b.pressure().values());
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / b.iter().copied().fold(0.0, f64::max)
    };
    let slow = sliding(1e-9);
    assert!(differs(&slow, &rest) < 1e-5 && friction(&slow).coefficient.abs() < friction(&slow).error);
    assert_close("stiffness", slow.stiffness(), rest.stiffness(), 2e-3);
    // Waves along x see the glassy modulus, those across it the relaxed one.
    let glassy = Toy(|kx| if kx == 0 { 1.0 } else { 0.1 });
    let (fast, glassy) = (sliding(1e6), solved(&heights, &glassy, 1e-3, 1e-9));
    assert!(differs(&fast, &glassy) < 1e-5 && friction(&fast).coefficient.abs() < friction(&fast).error);
}

#[test]
fn mirrored_and_turned_surfaces_have_mirrored_and_turned_contacts() {
    let n = 96;
    let heights = rough(3, n);
    let grid = heights.grid();
    let place = |f: Places<'_>, field: &Field| {
        let values = (0..n * n).map(|i| {
            let [x, y] = f(i % n, i / n);
            field.at(x, y)
        });
        Field::new(grid, values.collect()).expect("a value for each element")
    };
    let material = Relaxation::prony(&[[4.0, 0.01], [5.0, 0.1]]).expect("a material");
    let relaxed: [&dyn Fn(DVec2) -> Box<dyn Kernel>; 2] =
        [&|velocity| Box::new(Viscoelastic::new(Love, &material, velocity)), &|velocity| {
            Box::new(Viscoelastic::new(Spectral, &material, velocity))
        }];
    for kernel in relaxed {
        let along = solved(&heights, &*kernel(DVec2::X), 1e-3, 1e-9);
        let cases: [(Places<'_>, DVec2, f64); 3] = [
            // Mirrored along x, and sliding backwards.
            (&|x, y| [n - 1 - x, y], -DVec2::X, -1.0),
            // Exchanged axes, and sliding along y. Left and right are exchanged too.
            (&|x, y| [y, x], DVec2::Y, -1.0),
            // Turned by a quarter to the left.
            (&|x, y| [y, n - 1 - x], DVec2::Y, 1.0),
        ];
        for (map, velocity, lateral) in cases {
            let other = solved(&place(map, &heights), &*kernel(velocity), 1e-3, 1e-9);
            let (a, b) = (friction(&along), friction(&other));
            assert_close("friction", b.coefficient, a.coefficient, 1e-6);
            assert!((b.lateral - lateral * a.lateral).abs() < 1e-6 * a.coefficient, "{velocity}: {a:?}, {b:?}");
            let expected = place(map, along.pressure());
            let off = other.pressure().values().iter().zip(expected.values()).map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f64::max) < 1e-4 * expected.max(), "{velocity}");
        }
    }
}

/// Loss tangents up to 5, light and heavy loads, few and many scales.
#[test]
fn strongly_damped_solids_converge() {
    // Newton's method alone fails in a tenth of these scenes.
    for seed in [2, 14, 25] {
        let heights = rough(seed, 128);
        for glassy_ratio in [10.0, 30.0, 100.0] {
            for length in [0.003, 0.03, 0.1, 0.3] {
                for load in [1e-4, 6e-3] {
                    let (material, velocity) = one_mode(glassy_ratio, length);
                    let kernel = Viscoelastic::new(Spectral, &material, velocity);
                    let solution = problem(&heights, &kernel, load).solve(&SolveParams::default(), &Silent);
                    let solution = solution.unwrap_or_else(|error| panic!("{seed} {glassy_ratio} {length}: {error}"));
                    assert!(solution.certificate().meets(solution.bound()));
                    assert!(friction(&solution).coefficient > 0.0);
                }
            }
        }
    }
}

#[test]
fn a_given_penetration_a_hardness_and_a_layer_slide_too() {
    let heights = rough(5, 128);
    let (material, velocity) = one_mode(10.0, 0.05);
    let layer = Layer::on_rigid_base(0.1, 0.48);
    let solids: [Box<dyn Kernel>; 2] = [
        Box::new(Viscoelastic::new(Love, &material, velocity)),
        Box::new(Viscoelastic::new(LoveLayer(layer), &material, velocity)),
    ];
    for kernel in solids {
        let given = solved(&heights, &*kernel, 2e-3, 1e-9);
        let depth = Control::Penetration(given.info().penetration);
        let by_depth = ContactProblem::new(&heights, depth).with_kernel(&*kernel);
        let by_depth = by_depth.solve(&SolveParams::to_tolerance(1e-9), &Silent).expect("a solution");
        assert_close("load", by_depth.info().mean_pressure, 2e-3, 1e-4);
        assert_close("friction", friction(&by_depth).coefficient, friction(&given).coefficient, 1e-4);
        let hardness = 0.4 * given.pressure().max();
        let hard = problem(&heights, &*kernel, 2e-3).with_hardness(hardness).solve(&SolveParams::default(), &Silent);
        let hard = hard.expect("a solution");
        assert!(hard.pressure().max() <= hardness && hard.area().fraction > given.area().fraction);
        assert!(friction(&hard).coefficient > 0.0);
    }
    // A layer is stiffer, so less of it touches.
    let thin = LoveLayer(Layer::on_rigid_base(0.01, 0.3));
    let areas =
        [&Viscoelastic::new(Love, &material, velocity) as &dyn Kernel, &Viscoelastic::new(thin, &material, velocity)]
            .map(|kernel| solved(&heights, kernel, 2e-3, 0.0).area().fraction);
    assert!(areas[1] < areas[0], "{areas:?}");
}

/// A direction between the axes lies between those along them, and its force has a component across.
#[test]
fn elements_and_waves_agree_in_every_direction() {
    let heights = rough(7, 256);
    let (material, velocity) = one_mode(10.0, 0.05);
    for angle in [0.0, 0.3, 1.0, 2.5] {
        let velocity = velocity.length() * DVec2::from_angle(angle * TAU / 4.0);
        let [love, spectral] = [
            &Viscoelastic::new(Love, &material, velocity) as &dyn Kernel,
            &Viscoelastic::new(Spectral, &material, velocity),
        ]
        .map(|kernel| friction(&solved(&heights, kernel, 1e-3, 0.0)));
        assert!(
            (love.coefficient - spectral.coefficient).abs() < love.error + spectral.error,
            "{love:?}, {spectral:?}"
        );
    }
}

#[test]
fn what_cannot_slide_is_refused() {
    let heights = rough(1, 64);
    // A solid that would gain energy.
    let active = Toy(|kx| if kx.abs() == 3 { -1.0 } else { 1.0 });
    let error = problem(&heights, &active, 1e-3).solve(&SolveParams::default(), &Silent).expect_err("no solution");
    assert!(error.to_string().contains("positive real part"), "{error}");
    let (material, velocity) = one_mode(10.0, 0.05);
    let kernel = Viscoelastic::new(Love, &material, velocity);
    let oblique = Viscoelastic::new(Love, &material, velocity.rotate(DVec2::from_angle(0.3)));
    for (kernel, method) in [(&oblique as &dyn Kernel, Method::Adaptive), (&kernel, Method::GaussSeidel)] {
        let refused = problem(&heights, kernel, 1e-3).solve(&SolveParams::default().by(method), &Silent);
        assert!(matches!(refused, Err(SolveError::Unsupported(_))), "{method}");
    }
}
