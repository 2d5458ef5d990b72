//! A mesh as sorted keys of its squares.

use rc_core::DVec2;

use super::key::Key;

/// A periodic linear quadtree on the unit cell.
///
/// It has squares of side `1 / (base · 2^level)`, sorted along the Morton curve. Only the squares of the contact set
/// and its halo are stored. All other points are out of contact. Elements never overlap. Elements that touch at an edge
/// or a corner, also across the periodic seam, differ by at most one level.
///
/// *Memory*: 8 bytes for each element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mesh {
    base: usize,
    keys: Vec<Key>,
}

/// One square of the mesh, in units of λ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Square {
    /// Centre of the square.
    pub centre: DVec2,
    /// Side of the square, `1 / (base · 2^level)`.
    pub side: f64,
}

impl Square {
    /// Half of the side, the paper's d_j (Eq. 5-6 hold with d_j as the half side).
    #[must_use]
    pub fn half_side(&self) -> f64 {
        0.5 * self.side
    }

    /// Area of the square, in λ².
    #[must_use]
    pub fn area(&self) -> f64 {
        self.side * self.side
    }
}

impl Mesh {
    /// A mesh from keys that satisfy every invariant.
    pub(super) fn from_sorted(base: usize, keys: Vec<Key>) -> Self {
        Self { base, keys }
    }

    /// Number of root squares per side of the cell.
    #[must_use]
    pub fn base(&self) -> usize {
        self.base
    }

    /// Number of elements.
    #[must_use]
    pub fn len(&self) -> usize {
        self.keys.len()
    }

    /// Whether there are no elements, and no contact.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.keys.is_empty()
    }

    /// Keys of the elements in Morton order.
    #[must_use]
    pub fn keys(&self) -> &[Key] {
        &self.keys
    }

    /// The elements in Morton order.
    #[must_use]
    pub fn elements(&self) -> impl ExactSizeIterator<Item = Square> + '_ {
        self.keys.iter().map(|&key| self.square(key))
    }

    /// Number of elements of each level, from level 0 to the deepest that occurs.
    #[must_use]
    pub fn counts(&self) -> Vec<usize> {
        let mut counts = Vec::new();
        for key in &self.keys {
            let level = key.level() as usize;
            if counts.len() <= level {
                counts.resize(level + 1, 0);
            }
            counts[level] += 1;
        }
        counts
    }

    /// Place and size of the square `key` in this cell. The square need not be an element.
    pub(super) fn square(&self, key: Key) -> Square {
        let per_side = ((self.base as u64) << key.level()) as f64;
        let centre = |i: u32| (f64::from(i) + 0.5) / per_side;
        Square { centre: DVec2::new(centre(key.ix()), centre(key.iy())), side: 1.0 / per_side }
    }
}
