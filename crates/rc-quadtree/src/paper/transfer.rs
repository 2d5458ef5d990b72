//! Transfer of a pressure from one mesh to another, with conservation of the load.

use super::error::{MeshError, check_length};
use super::key::Key;
use super::mesh::Mesh;

/// A pressure on another mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Transferred {
    /// One value for each element of the new mesh.
    ///
    /// It is 0 where the old mesh has no element.
    pub values: Vec<f64>,
    /// Load that the new mesh does not cover, Σ p·area in E*·λ².
    ///
    /// It belongs to elements of the old mesh, or parts of them. It is exactly 0 when the new mesh covers all of them.
    pub lost: f64,
}

/// Transfers values per element (a pressure) from one mesh to another.
///
/// Smaller elements copy a value, larger elements average values by areas of overlap, and new elements get 0. The load
/// is conserved: the load of the values plus `lost` is the load of `old`, up to rounding (property test
/// `transfer_conserves_the_load`). Both meshes are intervals of one Morton curve, so a merge of two sorted lists is
/// enough.
///
/// # Errors
/// - [`MeshError::Length`] when there is not one value for each element of `from`.
/// - [`MeshError::DifferentBase`] when the meshes have different numbers of root squares per side.
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

/// Area of the smaller of two nested squares.
///
/// It is given in Morton codes, and relative to the source and to the target.
struct Share {
    codes: u64,
    of_source: f64,
    of_target: f64,
}

impl Share {
    fn new(source: Key, target: Key) -> Self {
        let codes = source.span().min(target.span());
        // Areas are powers of two, so both quotients are exact.
        let part = |of: Key| codes as f64 / of.span() as f64;
        Self { codes, of_source: part(source), of_target: part(target) }
    }
}
