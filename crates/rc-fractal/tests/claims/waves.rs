//! Surfaces of given waves.

use std::f64::consts::TAU;

use rc_core::{DVec2, Grid, HeightField};
use rc_fractal::{Amplitudes, Complex64, MAX_WAVES, SpectrumParams, Surface, Truncation, Wave, WaveError};

use crate::surface;

/// Selects the waves of a surface that are given.
type Half = fn(&Wave) -> bool;

/// Every wave of a surface, and the opposite of every wave.
fn waves_of(surface: &Surface) -> Vec<Wave> {
    let n = surface.waves() as i64;
    let all = (-n..=n).flat_map(|kx| (-n..=n).map(move |ky| (kx, ky)));
    let waves = all.map(|(kx, ky)| Wave { kx, ky, amplitude: surface.amplitude(kx, ky) });
    waves.filter(|wave| wave.amplitude != Complex64::ZERO).collect()
}

fn wave(kx: i64, ky: i64, re: f64, im: f64) -> Wave {
    Wave { kx, ky, amplitude: Complex64::new(re, im) }
}

/// The waves of a surface define the same surface again, bit by bit.
///
/// They are given as half planes to both sides along both axes, and completely in another order.
#[test]
fn a_surface_is_that_of_its_waves_whichever_half_is_given() {
    for truncation in [Truncation::Disc, Truncation::Square] {
        let params = SpectrumParams { truncation, amplitudes: Amplitudes::Random, ..SpectrumParams::paper(12, 3) };
        let original = surface(params);
        let all = waves_of(&original);
        let halves: [Half; 5] = [
            |wave| (wave.kx, wave.ky) > (0, 0),
            |wave| (wave.kx, wave.ky) < (0, 0),
            |wave| (wave.ky, wave.kx) > (0, 0),
            |wave| wave.ky >= 0,
            |_| true,
        ];
        for (number, half) in halves.into_iter().enumerate() {
            let mut waves: Vec<Wave> = all.iter().copied().filter(half).collect();
            waves.reverse();
            let made = Surface::from_waves(waves).expect("waves of a surface");
            assert_eq!((made.waves(), made.params()), (12, None));
            assert_eq!(made.moments(), original.moments(), "{truncation:?}, half {number}");
            for (nx, ny) in [(25, 25), (40, 33), (9, 9)] {
                let grid = Grid::new(nx, ny).expect("small");
                assert_eq!(made.sample(grid), original.sample(grid), "{truncation:?}, half {number} on {grid}");
            }
            let at = DVec2::new(0.37, 0.91);
            assert_eq!(made.height(at).to_bits(), original.height(at).to_bits());
        }
    }
}

#[test]
fn one_wave_is_a_cosine() {
    let (amplitude, phase) = (2e-3, 0.4);
    let given = Complex64::from_polar(0.5 * amplitude, phase);
    for (kx, ky) in [(3, -2), (0, -5), (-4, 0), (0, 1)] {
        // The mean height and zeros are ignored.
        let waves = vec![wave(0, 0, 7.0, 0.0), Wave { kx, ky, amplitude: given }, wave(9, 9, 0.0, 0.0)];
        let surface = Surface::from_waves(waves).expect("a wave");
        assert_eq!(surface.waves(), kx.abs().max(ky.abs()) as usize);
        for at in [DVec2::new(0.1, 0.7), DVec2::new(0.93, 0.02)] {
            let expected = amplitude * (TAU * (kx as f64 * at.x + ky as f64 * at.y) + phase).cos();
            let height = surface.height(at);
            assert!((height - expected).abs() < 1e-15, "({kx}, {ky}) at {at}: {height:e}, {expected:e}");
        }
        let moments = surface.moments();
        assert!((moments.rms_height / (amplitude / 2.0_f64.sqrt()) - 1.0).abs() < 1e-14, "{moments:?}");
    }
}

#[test]
fn a_scaled_surface_has_scaled_heights_and_no_spectrum() {
    let original = surface(SpectrumParams::paper(8, 2));
    let scaled = original.clone().scaled(-0.25);
    assert_eq!((scaled.params(), scaled.waves()), (None, 8));
    let at = DVec2::new(0.3, 0.6);
    assert_eq!(scaled.height(at).to_bits(), (-0.25 * original.height(at)).to_bits());
}

#[test]
fn waves_that_make_no_surface_are_named() {
    let long = MAX_WAVES as i64;
    let refused = [
        (vec![], "all waves are zero"),
        (vec![wave(0, 0, 1.0, 0.0), wave(1, 2, 0.0, 0.0)], "all waves are zero"),
        (vec![wave(1, long + 1, 1.0, 0.0)], "wave (1, 4097): kx and ky must be from -4096 to 4096"),
        (vec![wave(i64::MIN, 0, 1.0, 0.0)], "wave (-9223372036854775808, 0): kx and ky must be"),
        (vec![wave(1, 2, f64::NAN, 0.0)], "wave (1, 2): its amplitude is NaN + 0i; it must be finite"),
        (vec![wave(1, 2, 1.0, 0.0), wave(1, 2, 1.0, 0.0)], "wave (1, 2) is given twice"),
        (vec![wave(-1, 2, 1.0, 0.0), wave(-1, 2, 1.0, 0.0)], "wave (-1, 2) is given twice"),
        (
            vec![wave(1, -2, 1.0, 3.0), wave(-1, 2, 1.0, 3.0)],
            "wave (1, -2) is 1 + 3i, and its opposite, -k, is 1 + 3i; a real surface needs the conjugate",
        ),
        (vec![wave(0, 0, 1.0, 1.0)], "wave (0, 0) is 1 + 1i"),
    ];
    for (waves, expected) in refused {
        let error = Surface::from_waves(waves).expect_err(expected).to_string();
        assert!(error.starts_with(expected) && !error.contains('\n'), "{error}");
    }
    assert_eq!(Surface::from_waves(Vec::new()).expect_err("no waves"), WaveError::Flat);
}

/// Opposite waves differ by rounding in files with few digits, or after a Fourier transform.
#[test]
fn opposites_may_differ_by_rounding() {
    let waves =
        vec![wave(2, 1, 1.0, -0.5), wave(-2, -1, 1.0 + 1e-8, 0.5), wave(1, 0, 1e-14, 0.0), wave(-1, 0, -1e-14, 0.0)];
    let surface = Surface::from_waves(waves).expect("conjugates but for rounding");
    assert!((surface.amplitude(2, 1) - Complex64::new(1.0 + 5e-9, -0.5)).norm() < 1e-15);
}
