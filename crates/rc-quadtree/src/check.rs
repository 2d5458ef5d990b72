//! The invariants of a mesh, checked one by one.

use rc_core::DVec2;

use crate::{Edge, Key, MAX_LEVEL, Mesh, Neighbour, refine::touching_blocks};

impl Mesh {
    /// Checks every invariant, for tests: squares inside the cell and aligned, strictly sorted without overlap, total
    /// area at most that of the cell, the centre of every element located in it, 2:1 balance at edges and corners
    /// across the periodic seam, neighbours that see each other.
    ///
    /// *Cost*: some 20 binary searches an element.
    ///
    /// # Panics
    /// When an invariant does not hold; the text says which and where.
    pub fn assert_well_formed(&self) {
        self.assert_squares();
        for (index, &key) in self.keys().iter().enumerate() {
            let element = self.element(index);
            assert_eq!(
                self.locate(DVec2::new(element.x, element.y)),
                Some(index),
                "centre of {key:?} is located elsewhere"
            );
            self.assert_balanced(key);
            for edge in Edge::ALL {
                self.assert_seen_from_across(index, edge);
            }
        }
    }

    fn assert_squares(&self) {
        for &key in self.keys() {
            assert!(key.level() <= MAX_LEVEL, "{key:?} is too deep");
            let per_side = (self.base() as u64) << key.level();
            let (ix, iy) = (u64::from(key.ix()), u64::from(key.iy()));
            assert!(ix < per_side && iy < per_side, "{key:?} is outside the cell of {per_side} squares per side");
            assert_eq!(Key::new(key.level(), key.ix(), key.iy()), key, "{key:?} is not aligned to its size");
        }
        for pair in self.keys().windows(2) {
            assert!(pair[0].end() <= pair[1].start(), "{:?} and {:?} overlap or are not in order", pair[0], pair[1]);
        }
        assert!(self.area() <= 1.0, "the elements cover {} cells", self.area());
    }

    fn assert_balanced(&self, key: Key) {
        for block in touching_blocks(self.base(), key) {
            let Some(other) = self.find(block).map(|j| self.keys()[j]) else { continue };
            assert!(other.level() + 1 >= key.level(), "{key:?} touches {other:?}: not 2:1 balanced");
        }
    }

    fn assert_seen_from_across(&self, index: usize, edge: Edge) {
        let neighbour = self.neighbour(index, edge);
        for j in neighbour.indices() {
            let back = self.neighbour(j, edge.opposite());
            let right_size = matches!(
                (neighbour, back),
                (Neighbour::Same(_), Neighbour::Same(_))
                    | (Neighbour::Coarser(_), Neighbour::Finer(_))
                    | (Neighbour::Finer(_), Neighbour::Coarser(_))
            );
            let seen = right_size && back.indices().any(|i| i == index);
            let (own, other) = (self.keys()[index], self.keys()[j]);
            assert!(seen, "{own:?} sees {other:?} at its {edge:?} edge as {neighbour:?}, which sees {back:?}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What `assert_well_formed` says of a mesh that is not.
    fn complaint(mesh: &Mesh) -> String {
        let panic = std::panic::catch_unwind(|| mesh.assert_well_formed()).expect_err("the mesh is ill-formed");
        panic.downcast_ref::<String>().cloned().unwrap_or_default()
    }

    #[test]
    fn unbalanced_corner_across_the_seam_is_found() {
        // The lower left root touches the upper right one only at a corner, around the periodic cell.
        let keys = vec![Key::new(0, 0, 0), Key::new(2, 11, 11)];
        let complaint = complaint(&Mesh::from_sorted(3, keys));
        assert!(complaint.contains("not 2:1 balanced"), "{complaint}");
    }

    #[test]
    fn overlap_is_found() {
        let complaint = complaint(&Mesh::from_sorted(1, vec![Key::new(1, 0, 0), Key::new(2, 1, 1)]));
        assert!(complaint.contains("overlap"), "{complaint}");
    }

    #[test]
    fn square_outside_the_cell_is_found() {
        let complaint = complaint(&Mesh::from_sorted(3, vec![Key::new(1, 6, 0)]));
        assert!(complaint.contains("outside the cell"), "{complaint}");
    }
}
