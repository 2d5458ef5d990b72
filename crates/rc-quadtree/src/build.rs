//! Building: from the plan of a mesh to its sorted keys.

use crate::{Key, Mark, Mask, Mesh, MeshError, MeshKind, MeshParams, RefinementPlan, plan};

impl Mesh {
    /// The mesh that a plan decided.
    ///
    /// *Cost*: in proportion to the elements; keys come out of the descent in Morton order, nothing is sorted.
    #[must_use]
    pub fn from_plan(plan: &RefinementPlan) -> Self {
        let base = plan.base();
        let mut roots: Vec<Key> =
            (0..base as u32).flat_map(|iy| (0..base as u32).map(move |ix| Key::new(0, ix, iy))).collect();
        roots.sort_unstable();
        let mut keys = Vec::with_capacity(plan.counts().iter().sum());
        let levels: Vec<&[Mark]> = (0..=plan.depth()).filter_map(|level| plan.marks(level)).collect();
        let descent = Descent { base, levels: &levels };
        for root in roots {
            descent.append(root, (root.ix() as usize, root.iy() as usize), &mut keys);
        }
        Self::from_sorted(base, keys)
    }

    /// The mesh of a contact set: [`plan`], then [`Mesh::from_plan`].
    ///
    /// *Cost*: 0.3 s or less for 4096² cells (`benches/mesh.rs`).
    ///
    /// # Errors
    /// As [`plan`].
    pub fn from_mask(mask: &Mask, kind: MeshKind, params: &MeshParams) -> Result<Self, MeshError> {
        Ok(Self::from_plan(&plan(mask, kind, params)?))
    }
}

/// The way down from a root square, quarters in Morton order.
struct Descent<'a> {
    base: usize,
    levels: &'a [&'a [Mark]],
}

impl Descent<'_> {
    /// Appends the elements of `square`, whose column and row are passed along because taking them out of the key
    /// costs more than the rest.
    fn append(&self, square: Key, (ix, iy): (usize, usize), keys: &mut Vec<Key>) {
        let level = square.level() as usize;
        match self.levels[level][iy * (self.base << level) + ix] {
            Mark::Outside | Mark::Covered => {}
            Mark::Element => keys.push(square),
            Mark::Split => {
                for (quarter, (dx, dy)) in square.children().into_iter().zip([(0, 0), (1, 0), (0, 1), (1, 1)]) {
                    self.append(quarter, (2 * ix + dx, 2 * iy + dy), keys);
                }
            }
        }
    }
}
