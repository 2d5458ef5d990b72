//! Pairs of elements that are strongly bound.

use super::aggregates::{ALONE, Aggregates};
use super::graph::Graph;

/// Mark of an element that does not have an aggregate yet.
const FREE: u32 = u32::MAX - 1;

/// Maximum of Napov and Notay's quality of a pair.
///
/// It is the growth of the energy of a pressure that is replaced by its mean on the pair. The unit is the energy that
/// relaxation removes.
const WORST: f64 = 8.0;

/// Smallest dominance of an element's strongest bond, its ratio to the sum of all bonds.
///
/// From it on, an element without a partner joins the aggregate of its strongest bond.
const DOMINANT: f64 = 0.5;

/// Pairs along the strongest bonds, in the order of the elements.
///
/// `totals` are the sums of the bonds that relaxation sees. They are those of the elements, or sums over the elements
/// of an aggregate.
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

/// The free neighbour with the strongest bond among those that make a good pair.
///
/// It is the first one if several bonds are equal.
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
