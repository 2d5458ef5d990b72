//! Transfer: a pressure from one mesh to another, with the load kept.

use super::error::{MeshError, check_length};
use super::key::Key;
use super::mesh::Mesh;

/// A pressure brought to another mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Transferred {
    /// One value for each element of the new mesh; 0 where the old mesh has no element.
    pub values: Vec<f64>,
    /// Load of the old elements, or parts of them, that the new mesh does not cover, Σ p·area in E*·λ². Exactly 0
    /// when it covers all.
    pub lost: f64,
}

/// Brings values per element (a pressure) from one mesh to another: smaller elements copy, larger ones average by areas
/// of overlap, new elements get 0.
///
/// The load is conserved: load of the values + `lost` = load of `old`, to rounding (property test
/// `transfer_conserves_the_load`). Both meshes are intervals of one Morton curve, so this is one merge of two sorted
/// lists.
///
/// # Errors
/// [`MeshError::Length`] when there is not one value for each element of `from`; [`MeshError::DifferentBase`].
pub fn transfer(from: &Mesh, to: &Mesh, old: &[f64]) -> Result<Transferred, MeshError> {
    check_length(from.len(), old.len())?;
    if from.base() != to.base() {
        return Err(MeshError::DifferentBase { from: from.base(), to: to.base() });
    }
    let mut values = vec![0.0; to.len()];
    let mut lost = 0.0;
    let mut j = 0;
    for (&source, &value) in from.keys().iter().zip(old) {
        let (mut given, mut covered) = (0.0, 0);
        while let Some(&target) = to.keys().get(j).filter(|target| target.start() < source.end()) {
            if target.end() > source.start() {
                let share = Share::new(source, target);
                values[j] += value * share.of_target;
                given += value * share.of_source;
                covered += share.codes;
            }
            if target.end() > source.end() {
                break;
            }
            j += 1;
        }
        if covered < source.span() {
            lost += (value - given) * from.square(source).area();
        }
    }
    Ok(Transferred { values, lost })
}

/// Area of the smaller of two nested squares, in Morton codes and relative to the source and to the target.
struct Share {
    codes: u64,
    of_source: f64,
    of_target: f64,
}

impl Share {
    fn new(source: Key, target: Key) -> Self {
        let codes = source.span().min(target.span());
        // Powers of two: both quotients are exact.
        let part = |of: Key| codes as f64 / of.span() as f64;
        Self { codes, of_source: part(source), of_target: part(target) }
    }
}
