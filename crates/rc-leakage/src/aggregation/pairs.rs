//! Pairs of elements that are strongly bound.

use super::aggregates::{ALONE, Aggregates};
use super::graph::Graph;

/// No aggregate yet.
const FREE: u32 = u32::MAX - 1;

/// Most that the energy of a pressure may grow when it is replaced by its mean on a pair, in units of what relaxation
/// takes off: Napov and Notay's quality.
const WORST: f64 = 8.0;

/// An element that is left without a partner joins the aggregate of its strongest bond, where this has at least this
/// part of all its bonds.
const DOMINANT: f64 = 0.5;

/// Pairs along the strongest bonds, in the order of the elements. `totals` are those of the bonds that relaxation sees:
/// of the elements themselves, or the sums over what they are made of.
pub(super) fn matched(graph: &Graph, totals: &[f64]) -> Aggregates {
    let mut of = vec![FREE; graph.len()];
    let mut number = 0;
    for element in 0..graph.len() {
        if graph.totals[element] <= 0.0 {
            of[element] = ALONE;
        } else if of[element] == FREE
            && let Some(partner) = partner((graph, totals), &of, element)
        {
            of[element] = number;
            of[partner] = number;
            number += 1;
        }
    }
    for element in 0..graph.len() {
        if of[element] == FREE {
            of[element] = joined((graph, totals), &of, element).unwrap_or_else(|| {
                number += 1;
                number - 1
            });
        }
    }
    Aggregates { of, number: number as usize }
}

/// The free neighbour with the strongest bond of those that make a good pair, the first of several.
fn partner((graph, totals): (&Graph, &[f64]), of: &[u32], element: usize) -> Option<usize> {
    let mut best = (0.0, None);
    for (other, bond) in graph.bonds_of(element).filter(|(other, _)| of[*other] == FREE) {
        let [a, b] = [element, other].map(|element| totals[element]);
        let quality = 2.0 * a * b / ((a + b) * bond);
        if bond > best.0 && quality <= WORST {
            best = (bond, Some(other));
        }
    }
    best.1
}

fn joined((graph, totals): (&Graph, &[f64]), of: &[u32], element: usize) -> Option<u32> {
    let strongest =
        graph.bonds_of(element).fold((element, 0.0), |best, bond| if bond.1 > best.1 { bond } else { best });
    (strongest.1 >= DOMINANT * totals[element] && of[strongest.0] != FREE).then(|| of[strongest.0])
}
