//! Transfer: a pressure from one mesh to another, with the load kept.

use crate::{Edge, Key, Mesh, MeshError, Neighbour, error::check_length};

/// How a pressure varies inside an element when a smaller one receives a part of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Reconstruction {
    /// Constant, as the boundary elements have it: quarters copy the value.
    #[default]
    Constant,
    /// Linear with limited slopes. Along each axis the slope is the smaller of the two to the neighbours, and zero
    /// when they differ in sign or a neighbour is missing; both are scaled down until the value stays, in the whole
    /// element, between the least and the greatest of the element and its neighbours. So quarters keep the load, no
    /// new extremes appear, and a pressure stays non-negative. (T. J. Barth, D. C. Jespersen, AIAA 89-0366, 1989,
    /// with a minmod slope.)
    Limited,
}

/// A pressure brought to another mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Transferred {
    /// One value for each element of the new mesh; 0 where the old mesh has no element.
    pub values: Vec<f64>,
    /// Load of the old elements, or parts of them, that the new mesh does not cover, Σ p·area in E*·λ². Exactly 0
    /// when it covers all.
    pub lost: f64,
}

/// Brings values per element (a pressure) from one mesh to another, by areas of overlap: merging averages, splitting
/// copies or reconstructs, new elements get 0.
///
/// The load is conserved: `to.load(values) + lost == from.load(old)` to rounding (property test
/// `transfer_conserves_the_load`). Both meshes are intervals of one Morton curve, so this is one merge of two sorted
/// lists.
///
/// # Errors
/// [`MeshError::Length`] when there is not one value for each element of `from`; [`MeshError::DifferentBase`].
pub fn transfer(from: &Mesh, to: &Mesh, old: &[f64], reconstruction: Reconstruction) -> Result<Transferred, MeshError> {
    check_length(from.len(), old.len())?;
    if from.base() != to.base() {
        return Err(MeshError::DifferentBase { from: from.base(), to: to.base() });
    }
    let mut values = vec![0.0; to.len()];
    let mut lost = 0.0;
    let mut j = 0;
    for (i, (&source, &value)) in from.keys().iter().zip(old).enumerate() {
        let slopes = match reconstruction {
            Reconstruction::Constant => (0.0, 0.0),
            Reconstruction::Limited => limited_slopes(from, old, i),
        };
        let (mut given, mut covered) = (0.0, 0);
        while let Some(&target) = to.keys().get(j).filter(|target| target.start() < source.end()) {
            if target.end() > source.start() {
                let share = Share::new(from, source, target);
                let part = value + slopes.0 * share.dx + slopes.1 * share.dy;
                values[j] += part * share.of_target;
                given += part * share.of_source;
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

/// The square that two nested squares have in common: the smaller one.
struct Share {
    /// Centre of the common square, from the centre of the source, in λ.
    dx: f64,
    dy: f64,
    /// Its area, in Morton codes and in parts of the source and of the target.
    codes: u64,
    of_source: f64,
    of_target: f64,
}

impl Share {
    fn new(mesh: &Mesh, source: Key, target: Key) -> Self {
        let common = if source.contains(target) { target } else { source };
        let (outer, inner) = (mesh.square(source), mesh.square(common));
        let codes = common.span();
        // Powers of two: both quotients are exact.
        let part = |of: Key| codes as f64 / of.span() as f64;
        Self { dx: inner.x - outer.x, dy: inner.y - outer.y, codes, of_source: part(source), of_target: part(target) }
    }
}

/// Slopes (along x, along y) of [`Reconstruction::Limited`] in element `index`, per λ.
fn limited_slopes(mesh: &Mesh, values: &[f64], index: usize) -> (f64, f64) {
    let own = values[index];
    let side = mesh.element(index).side;
    let (mut least, mut greatest) = (own, own);
    let mut slope_across = |edge: Edge| {
        let neighbour = mesh.neighbour(index, edge);
        let distance = match neighbour {
            Neighbour::Outside => return 0.0,
            Neighbour::Same(_) => side,
            Neighbour::Coarser(_) => 1.5 * side,
            Neighbour::Finer(_) => 0.75 * side,
        };
        let (mut sum, mut count) = (0.0, 0.0);
        for j in neighbour.indices() {
            least = least.min(values[j]);
            greatest = greatest.max(values[j]);
            sum += values[j];
            count += 1.0;
        }
        (sum / count - own) / distance
    };
    let x = minmod(slope_across(Edge::Right), -slope_across(Edge::Left));
    let y = minmod(slope_across(Edge::Up), -slope_across(Edge::Down));
    let rise = 0.5 * side * (x.abs() + y.abs());
    let allowed = (own - least).min(greatest - own);
    if rise > allowed { (x * allowed / rise, y * allowed / rise) } else { (x, y) }
}

/// The one closer to zero when both have the same sign, else zero.
fn minmod(a: f64, b: f64) -> f64 {
    if a.signum() == b.signum() { a.signum() * a.abs().min(b.abs()) } else { 0.0 }
}
