//! Invalid parameters are refused, with their value.

use rc_fractal::{MAX_WAVES, Normalisation, SpectrumError, SpectrumParams, Surface};

fn error(params: SpectrumParams) -> SpectrumError {
    Surface::new(&params).expect_err("these parameters cannot be")
}

#[test]
fn the_number_of_waves_has_bounds() {
    for waves in [0, MAX_WAVES + 1, usize::MAX] {
        assert_eq!(error(SpectrumParams::paper(waves, 1)), SpectrumError::Waves { waves });
    }
    assert_eq!(error(SpectrumParams::paper(0, 1)).to_string(), "a surface needs 1 to 4096 waves, not 0");
    assert!(Surface::new(&SpectrumParams::paper(1, 1)).is_ok());
}

#[test]
fn the_hurst_exponent_has_bounds() {
    for hurst in [0.0, -0.3, 1.000_001, f64::INFINITY] {
        assert_eq!(error(SpectrumParams { hurst, ..SpectrumParams::paper(4, 1) }), SpectrumError::Hurst { hurst });
    }
    let nan = error(SpectrumParams { hurst: f64::NAN, ..SpectrumParams::paper(4, 1) });
    assert_eq!(nan.to_string(), "the Hurst exponent must be above 0 and at most 1, not NaN");
    assert!(Surface::new(&SpectrumParams { hurst: 1.0, ..SpectrumParams::paper(4, 1) }).is_ok());
}

#[test]
fn the_roll_off_lies_within_the_spectrum() {
    for roll_off in [0.99, -1.0, 4.01, f64::INFINITY] {
        let params = SpectrumParams { roll_off, ..SpectrumParams::paper(4, 1) };
        assert_eq!(error(params), SpectrumError::RollOff { roll_off, waves: 4 });
    }
    let nan = error(SpectrumParams { roll_off: f64::NAN, ..SpectrumParams::paper(4, 1) });
    assert_eq!(nan.to_string(), "the roll-off wavenumber must be between 1 and the number of waves (4), not NaN");
    assert!(Surface::new(&SpectrumParams { roll_off: 4.0, ..SpectrumParams::paper(4, 1) }).is_ok());
}

#[test]
fn the_low_cut_lies_within_the_spectrum() {
    for low_cut in [0.0, -1.0, 4.01, f64::INFINITY] {
        let params = SpectrumParams { low_cut, ..SpectrumParams::paper(4, 1) };
        assert_eq!(error(params), SpectrumError::LowCut { low_cut, waves: 4 });
    }
    let nan = error(SpectrumParams { low_cut: f64::NAN, ..SpectrumParams::paper(4, 1) });
    assert_eq!(nan.to_string(), "the lowest wavenumber must be between 1 and the number of waves (4), not NaN");
    assert!(Surface::new(&SpectrumParams { low_cut: 4.0, ..SpectrumParams::paper(4, 1) }).is_ok());
}

#[test]
fn the_size_is_positive_and_finite() {
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let normalisations = [
            (Normalisation::RmsHeight(value), "rms height"),
            (Normalisation::RmsSlope(value), "rms slope"),
            (Normalisation::C0(value), "spectrum prefactor C0"),
        ];
        for (normalisation, what) in normalisations {
            let params = SpectrumParams { normalisation, ..SpectrumParams::paper(4, 1) };
            assert_eq!(error(params).to_string(), format!("the {what} must be positive and finite, not {value}"));
        }
    }
}
