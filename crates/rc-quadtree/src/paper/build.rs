//! Conversion of the plan of a mesh to its sorted keys.

use super::error::MeshError;
use super::key::Key;
use super::mark::{Mark, MeshKind, MeshParams, RefinementPlan, plan};
use super::mask::Mask;
use super::mesh::Mesh;

impl Mesh {
    /// The mesh of a contact set, by the paper's "purely geometric criteria" (text at Fig. 3).
    ///
    /// The smallest elements lie along every contact border. Sizes double towards the inside of each spot. There are no
    /// elements outside contact and halo.
    ///
    /// A block of 2^k × 2^k cells may be one element if it and `ring` blocks of its own size around it are all in
    /// contact. The ring continues around the periodic cell. The largest such blocks are the elements.
    ///
    /// With a ring of at least 1 the result is 2:1 balanced at edges and corners without further work. A block of half
    /// the side that touches an element has its own ring within the ring of that element. So it is at least a part of
    /// an element of half the side.
    ///
    /// The mesh depends only on the arguments. Mirror images have mirrored meshes. So do images that are shifted by a
    /// multiple of a root square, or of any block that is not smaller than the largest element.
    ///
    /// *Cost*: 0.3 s or less for 4096² cells (`benches/mesh.rs`).
    ///
    /// # Errors
    /// Those of [`count`](super::count).
    pub fn from_mask(mask: &Mask, kind: MeshKind, params: &MeshParams) -> Result<Self, MeshError> {
        Ok(Self::from_plan(&plan(mask, kind, params)?))
    }

    /// The mesh of a plan.
    ///
    /// *Cost*: in proportion to the number of elements. The descent generates keys in Morton order, so they are not
    /// sorted.
    pub(super) fn from_plan(plan: &RefinementPlan) -> Self {
        let base = plan.base();
        let mut roots: Vec<Key> =
            (0..base as u32).flat_map(|iy| (0..base as u32).map(move |ix| Key::new(0, ix, iy))).collect();
        roots.sort_unstable();
        let mut keys = Vec::with_capacity(plan.counts().iter().sum());
        let walk = MortonWalk { base, levels: plan.levels() };
        for root in roots {
            walk.append(root, (root.ix() as usize, root.iy() as usize), &mut keys);
        }
        Self::from_sorted(base, keys)
    }
}

/// The descent from a root square, with quarters in Morton order.
struct MortonWalk<'a> {
    base: usize,
    levels: &'a [Vec<Mark>],
}

impl MortonWalk<'_> {
    /// Appends the elements of `square`.
    ///
    /// Its column and row are arguments, because to extract them from the key costs more than the rest.
    fn append(&self, square: Key, (ix, iy): (usize, usize), keys: &mut Vec<Key>) {
        let level = square.level() as usize;
        match self.levels[level][iy * (self.base << level) + ix] {
            Mark::Outside | Mark::Covered => {}
            Mark::Element => keys.push(square),
            Mark::Divided => {
                for (quarter, (dx, dy)) in square.children().into_iter().zip([(0, 0), (1, 0), (0, 1), (1, 1)]) {
                    self.append(quarter, (2 * ix + dx, 2 * iy + dy), keys);
                }
            }
        }
    }
}
