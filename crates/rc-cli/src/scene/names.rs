//! Names of choices that the libraries offer, for the command line.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use rc_core::Boundary;
use rc_fractal::{Amplitudes, Truncation};
use rc_solver::Method;

/// A name, its value, and its text in the help.
type Named<T> = (&'static str, T, &'static str);

const TRUNCATIONS: [Named<Truncation>; 2] =
    [("disc", Truncation::Disc, "|k| ≤ N"), ("square", Truncation::Square, "max(|kx|, |ky|) ≤ N")];

const AMPLITUDES: [Named<Amplitudes>; 2] = [
    ("fixed", Amplitudes::Fixed, "Those of the spectrum (Eq. 14); phases alone are random"),
    ("random", Amplitudes::Random, "Gaussian about the spectrum"),
];

const METHODS: [Named<Method>; 3] = [
    (
        "adaptive",
        Method::Adaptive,
        "On elements that follow the contact: work and memory grow with the contact area (kernel love)",
    ),
    ("uniform", Method::Uniform, "FFT on the whole grid"),
    ("gauss-seidel", Method::GaussSeidel, "The procedure of the paper"),
];

const BOUNDARIES: [Named<Boundary>; 2] = [
    ("periodic", Boundary::Periodic, "The heights repeat: a periodic cell"),
    ("free", Boundary::Free, "A patch on an infinite half-space; nothing presses on it outside the patch"),
];

/// Reads a [`Boundary`].
pub(crate) fn boundaries() -> impl TypedValueParser<Value = Boundary> {
    parser(&BOUNDARIES)
}

/// Reads a [`Truncation`].
pub(crate) fn truncations() -> impl TypedValueParser<Value = Truncation> {
    parser(&TRUNCATIONS)
}

/// Reads [`Amplitudes`].
pub(crate) fn amplitudes() -> impl TypedValueParser<Value = Amplitudes> {
    parser(&AMPLITUDES)
}

/// Reads a [`Method`].
pub(crate) fn methods() -> impl TypedValueParser<Value = Method> {
    parser(&METHODS)
}

fn parser<T: Copy + Send + Sync>(named: &'static [Named<T>]) -> impl TypedValueParser<Value = T> {
    let values = named.iter().map(|(name, _, help)| PossibleValue::new(*name).help(*help));
    PossibleValuesParser::new(values).map(move |given| {
        let named = named.iter().find(|(name, ..)| *name == given);
        named.map(|(_, value, _)| *value).expect("the parser accepts these names only")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The command line and scene files have the same names.
    #[test]
    fn names_are_those_of_scene_files() {
        fn check<T: serde::Serialize>(named: &[Named<T>]) {
            for (name, value, _) in named {
                assert_eq!(serde_json::to_value(value).expect("a name"), *name);
            }
        }
        check(&TRUNCATIONS);
        check(&AMPLITUDES);
        check(&METHODS);
        check(&BOUNDARIES);
    }
}
