//! Strata of scenes, and whether bars hold in each.

use rc_figures::numeric::median;
use rc_figures::{Table, number};

use crate::accuracy::binomial::{at_least, at_most};
use crate::accuracy::measured::{Measured, QUANTITIES};
use crate::accuracy::scene::Family;

/// A bar should contain the error in 95 of 100 scenes. It fails below and above these parts.
const LEAST: f64 = 0.93;
const MOST: f64 = 0.99;

/// A bar that holds too often fails if it is more than the first number of times the rms error, and any bar above the
/// second, in so many scenes.
///
/// Gaussian errors have 1.96. An error with a bound, such as the height of a summit between samples, may always be within
/// a bar that is no wider.
const WIDE: f64 = 4.0;
const WIDEST: f64 = 10.0;
const MANY: usize = 100;

/// A stratum fails if its number of bars that hold has a smaller probability.
const SIGNIFICANT: f64 = 1e-4;

type Predicate = Box<dyn Fn(&Measured) -> bool>;

/// All strata: names, and which scenes are in them.
fn strata() -> Vec<(String, Predicate)> {
    let mut strata: Vec<(String, Predicate)> = Vec::new();
    let mut add = |name: String, is_in: Predicate| strata.push((name, is_in));
    let rough = |scene: &Measured| scene.family == Family::Rough;
    for spectral in [false, true] {
        let kernel = if spectral { "spectral" } else { "love" };
        let is_in = move |scene: &Measured| rough(scene) && scene.is_spectral == spectral;
        for n in [4, 6, 8, 12, 16, 32] {
            let name = format!("rough {kernel} {n} elements a wave");
            add(name, Box::new(move |scene| is_in(scene) && scene.elements_per_wave == n));
        }
    }
    for [low, high] in [[0.0, 0.02], [0.02, 0.1], [0.1, 0.4], [0.4, 0.8], [0.8, 0.95], [0.95, 0.99], [0.99, 1.0]] {
        let is_in = move |scene: &Measured| rough(scene) && (low..high).contains(&scene.limits[0]);
        add(format!("rough contact of {low} to {high}"), Box::new(is_in));
    }
    add("rough full contact".to_owned(), Box::new(move |scene| rough(scene) && scene.limits[0] >= 1.0));
    for [low, high] in [[3, 4], [5, 8], [9, 16], [17, 48]] {
        let is_in = move |scene: &Measured| rough(scene) && (low..=high).contains(&scene.waves);
        add(format!("rough N of {low} to {high}"), Box::new(is_in));
    }
    for [low, high] in [[0.3, 0.5], [0.5, 0.8], [0.8, 1.0]] {
        let is_in = move |scene: &Measured| rough(scene) && (low..high).contains(&scene.hurst);
        add(format!("rough H of {low} to {high}"), Box::new(is_in));
    }
    for family in Family::ALL {
        for kind in family.kinds() {
            add(kind.to_string(), Box::new(move |scene| scene.family == family && scene.kind == *kind));
        }
    }
    for level in [1, 2, 3] {
        let is_in = move |scene: &Measured| scene.border_level == level;
        add(format!("border level {level}"), Box::new(is_in));
    }
    add("contact at a free border".to_owned(), Box::new(|scene| scene.is_at_border));
    for [low, high] in [[0.0, 0.001], [0.001, 0.5], [0.5, 0.85], [0.85, 0.98], [0.98, 2.0]] {
        let is_in = move |scene: &Measured| scene.family == Family::Hardness && (low..high).contains(&scene.plastic);
        add(format!("plastic part of {low} to {}", high.min(1.0)), Box::new(is_in));
    }
    for spectral in [false, true] {
        let kernel = if spectral { "spectral" } else { "love" };
        for [low, high] in [[0.3, 0.7], [0.7, 1.5], [1.5, 4.0], [4.0, 30.0]] {
            let is_in = move |scene: &Measured| {
                scene.family == Family::Layer && scene.is_spectral == spectral && (low..high).contains(&scene.size)
            };
            add(format!("layer of {low} to {high} elements {kernel}"), Box::new(is_in));
        }
    }
    for [low, high] in [[0.3, 0.5], [0.5, 0.8], [0.8, 3.0]] {
        let is_in = move |scene: &Measured| scene.family == Family::Small && (low..high).contains(&scene.size);
        add(format!("contacts of radius {low} to {high}"), Box::new(is_in));
    }
    add("all but creases".to_owned(), Box::new(|scene| scene.family != Family::Creases));
    strata
}

/// The scenes of each stratum that has some.
fn divided(scenes: &[Measured]) -> Vec<(String, Vec<&Measured>)> {
    let members = |(name, is_in): (String, Predicate)| (name, scenes.iter().filter(|scene| is_in(scene)).collect());
    strata().into_iter().map(members).filter(|(_, members): &(String, Vec<_>)| !members.is_empty()).collect()
}

/// Ratios of errors to bars of one quantity in scenes that have a bar.
fn ratios(scenes: &[&Measured], quantity: usize) -> Vec<f64> {
    scenes.iter().filter_map(|scene| scene.ratio(quantity)).collect()
}

fn held(ratios: &[f64]) -> usize {
    ratios.iter().filter(|ratio| **ratio <= 1.0).count()
}

/// Whether too many bars hold, or they are much wider than errors. It has the ratios of errors to bars.
fn is_too_wide(ratios: &[f64]) -> bool {
    let is_wider = |than: f64| ratios.len() >= MANY && than * rms(ratios) < 1.0;
    is_wider(WIDEST) || (is_wider(WIDE) && at_least(held(ratios), ratios.len(), MOST) < SIGNIFICANT)
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// One line for each bar that holds too seldom or too often in a stratum.
///
/// The bars are not made for creases.
pub(super) fn faults(scenes: &[Measured]) -> Vec<String> {
    let mut faults = Vec::new();
    for (name, scenes) in divided(scenes) {
        if scenes.iter().any(|scene| scene.kind == "creases") {
            continue;
        }
        for (i, quantity) in QUANTITIES.into_iter().enumerate() {
            let all = ratios(&scenes, i);
            let of_mesh: Vec<&Measured> = scenes.iter().copied().filter(|scene| scene.is_of_mesh(i)).collect();
            let of_mesh = ratios(&of_mesh, i);
            let fault = if at_most(held(&all), all.len(), LEAST) < SIGNIFICANT {
                "too narrow"
            } else if is_too_wide(&of_mesh) {
                "too wide"
            } else {
                continue;
            };
            faults.push(format!("{name}: the bar of {quantity} is {fault}: {} of {} hold", held(&all), all.len()));
        }
    }
    faults
}

/// One line for each stratum.
pub(super) fn table(scenes: &[Measured]) -> Table {
    let of = |suffix: &str| QUANTITIES.map(|quantity| format!("{quantity}_{suffix}"));
    let mut header = vec!["stratum".to_owned(), "scenes".to_owned()];
    header.extend(of("held_percent"));
    header.extend(of("bar_over_rms_error"));
    header.extend(
        [
            "area_rms_error_percent",
            "area_counted_rms_error_percent",
            "rms_pressure_median_error_percent",
            "rms_pressure_of_elements_median_error_percent",
        ]
        .map(str::to_owned),
    );
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    Table::new("coverage", &header, divided(scenes).into_iter().map(|(name, scenes)| row(name, &scenes)))
}

fn row(name: String, scenes: &[&Measured]) -> Vec<String> {
    let percent = |value: f64| number(100.0 * value);
    let of_quantity = |of: &dyn Fn(&[f64]) -> String| {
        (0..QUANTITIES.len())
            .map(|i| ratios(scenes, i))
            .map(|ratios| if ratios.is_empty() { String::new() } else { of(&ratios) })
            .collect::<Vec<_>>()
    };
    let middle = |of: fn(&Measured) -> f64| percent(median(scenes.iter().map(|scene| of(scene).abs()).collect()));
    let mut row = vec![name, scenes.len().to_string()];
    row.extend(of_quantity(&|ratios| percent(held(ratios) as f64 / ratios.len() as f64)));
    row.extend(of_quantity(&|ratios| number(rms(ratios).recip().min(1e3))));
    row.extend(rms_errors_of_area(scenes.iter().copied()).map(percent));
    row.push(middle(|scene| scene.errors[1] / scene.limits[1]));
    row.push(middle(|scene| scene.of_elements[1] / scene.limits[1]));
    row
}

/// Rms relative errors of the area and of the area by counting.
pub(super) fn rms_errors_of_area<'a>(scenes: impl Iterator<Item = &'a Measured>) -> [f64; 2] {
    let (mut n, mut sums) = (0.0, [0.0; 2]);
    for scene in scenes {
        n += 1.0;
        sums[0] += (scene.errors[0] / scene.limits[0]).powi(2);
        sums[1] += (scene.of_elements[0] / scene.limits[0]).powi(2);
    }
    sums.map(|sum: f64| (sum / f64::max(n, 1.0)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_are_too_wide_where_they_are_many_times_the_errors() {
        // Errors between -1 and 1, relative to a bar of the given number of rms errors.
        let ratios =
            |bar: f64| (0..400).map(|i| (f64::from(i) / 200.0 - 1.0) * 3.0_f64.sqrt() / bar).collect::<Vec<_>>();
        assert_eq!([1.96, 3.0, 12.0].map(|bar| is_too_wide(&ratios(bar))), [false, false, true]);
        // 0.99^1000 is below the significance.
        let many = [ratios(5.0), ratios(5.0), ratios(5.0)].concat();
        assert!(is_too_wide(&many) && !is_too_wide(&ratios(5.0)));
    }
}
