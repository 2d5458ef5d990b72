//! The constant κ of the contact area at light loads, beside theory.

use rc_core::quantity::digits;
use rc_sweep::Summary;
use rc_theory::persson::Persson;

/// Contact area from which the constant says little.
const MOST_AREA: f64 = 0.3;

/// Error of the contact area, relative to the area, from which the constant is not known.
const MOST_ERROR: f64 = 0.2;

/// Nayak's parameter up to which a surface counts as regular: a single wave has 1.5.
const REGULAR: f64 = 1.6;

/// κ of Bush, Gibson and Thomas, √(2π).
const BUSH_GIBSON_THOMAS: f64 = 2.506_628_274_631;

/// The line about κ = A E* h'/p, with the rms slope h' and the area A relative to the nominal area.
///
/// `None` where theories of rough half-spaces say nothing: with much contact or an area that is not known, with a hardness, and on a regular surface.
/// Source: A. W. Bush, R. D. Gibson and T. R. Thomas, Wear 35 (1975) 87-111, and [`Persson`].
pub(super) fn kappa(summary: &Summary, e_star: f64, nayak: Option<f64>) -> Option<String> {
    let reduced = summary.mean_pressure / (e_star * summary.rms_slope);
    let light = summary.area_fraction > 0.0 && summary.area_fraction < MOST_AREA && reduced > 0.0;
    let known = summary.area_fraction_error < MOST_ERROR * summary.area_fraction;
    if !light || !known || summary.hardness.is_some() || nayak? <= REGULAR {
        return None;
    }
    let theory = Persson::from_rms_slope(summary.mean_pressure / e_star, summary.rms_slope).area_fraction();
    Some(format!(
        "κ = A E*√⟨|∇h|²⟩/p = {} ± {}, with the contact area A relative to the nominal area, and p/(E*√⟨|∇h|²⟩) = {}. Persson's \
         theory has {} at this load (erf law), and √(8/π) = {} at light loads. Bush, Gibson and Thomas have √(2π) = {} at light \
         loads.",
        digits(summary.area_fraction / reduced, 4),
        digits(summary.area_fraction_error / reduced, 1),
        digits(reduced, 3),
        digits(theory / reduced, 4),
        digits(Persson::KAPPA, 4),
        digits(BUSH_GIBSON_THOMAS, 4)
    ))
}

#[cfg(test)]
mod tests {
    use rc_core::Grid;

    use super::super::contact::tests::summary;
    use super::*;

    #[test]
    fn the_constant_is_that_of_the_area_and_absent_where_it_means_nothing() {
        let mut light = summary(Grid::square(2).expect("a grid"), 1.0, 0.1, None);
        (light.area_fraction, light.area_fraction_error, light.hardness) = (0.02, 0.001, None);
        let line = kappa(&light, 1e3, Some(10.0)).expect("a light load");
        assert!(line.contains("= 2 ± 0.1,") && line.contains("Persson's theory has 1.596 at this load"), "{line}");
        assert_eq!(kappa(&light, 1e3, Some(1.5)), None, "a single wave");
        light.area_fraction_error = 0.01;
        assert_eq!(kappa(&light, 1e3, Some(10.0)), None, "an area that is not known");
        light.area_fraction_error = 0.001;
        light.area_fraction = 0.4;
        assert_eq!(kappa(&light, 1e3, Some(10.0)), None, "much contact");
    }
}
