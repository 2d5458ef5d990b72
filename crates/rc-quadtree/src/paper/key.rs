//! Keys of squares, which hold place and size and sort along the Morton curve.

use crate::morton::{gather, morton_code};

/// Deepest level of a key, with squares of side 2^-20 of a root square.
pub const MAX_LEVEL: u32 = 20;

/// Maximum number of root squares per side.
///
/// With [`MAX_LEVEL`] levels below them, a coordinate takes 29 bits and a whole key 63 bits.
pub const MAX_BASE: usize = 512;

const LEVEL_BITS: u32 = 5;
const LEVEL_MASK: u64 = (1 << LEVEL_BITS) - 1;

/// The place and size of one square of the mesh in 8 bytes.
///
/// Level l has `base · 2^l` squares per side. A square is at column `ix` and row `iy` of its level. The key is the
/// Morton code (the bits of y and x in turn) of its lower left corner, in units of the smallest square. The level
/// follows after the code.
///
/// Hence keys sort along the Morton curve. A square covers the interval of `4^(MAX_LEVEL - l)` codes that starts at its
/// own code. Two squares either are nested or have disjoint intervals. Sources: G. M. Morton, *A computer oriented
/// geodetic data base*, IBM Ottawa, 1966; linear quadtrees: I. Gargantini, Commun. ACM 25 (1982) 905-910.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Key(u64);

impl Key {
    /// The square of level `level` at column `ix` and row `iy`, each below `base << level`.
    pub(super) fn new(level: u32, ix: u32, iy: u32) -> Self {
        let to_finest = MAX_LEVEL - level;
        Self::from_code(morton_code(ix << to_finest, iy << to_finest), level)
    }

    fn from_code(code: u64, level: u32) -> Self {
        Self((code << LEVEL_BITS) | u64::from(level))
    }

    /// Level of the square.
    ///
    /// It is 0 for a root square, and increases by one with every halving of the side.
    #[must_use]
    pub fn level(self) -> u32 {
        (self.0 & LEVEL_MASK) as u32
    }

    /// Column of the square in its level.
    #[must_use]
    pub fn ix(self) -> u32 {
        gather(self.start()) >> (MAX_LEVEL - self.level())
    }

    /// Row of the square in its level.
    #[must_use]
    pub fn iy(self) -> u32 {
        gather(self.start() >> 1) >> (MAX_LEVEL - self.level())
    }

    /// First Morton code of the square.
    pub(super) fn start(self) -> u64 {
        self.0 >> LEVEL_BITS
    }

    /// Number of Morton codes of the square, its area in units of the smallest square.
    pub(super) fn span(self) -> u64 {
        1 << (2 * (MAX_LEVEL - self.level()))
    }

    /// First Morton code after the square.
    pub(super) fn end(self) -> u64 {
        self.start() + self.span()
    }

    /// The four quarters in Morton order: lower left, lower right, upper left, upper right.
    ///
    /// The level must be below [`MAX_LEVEL`].
    pub(super) fn children(self) -> [Self; 4] {
        let quarter = self.span() / 4;
        std::array::from_fn(|q| Self::from_code(self.start() + q as u64 * quarter, self.level() + 1))
    }
}

impl std::fmt::Debug for Key {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Key(level {}, ix {}, iy {})", self.level(), self.ix(), self.iy())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn largest_key_comes_back_unchanged() {
        let last = ((MAX_BASE as u32) << MAX_LEVEL) - 1;
        let key = Key::new(MAX_LEVEL, last, last - 1);
        assert_eq!((key.level(), key.ix(), key.iy()), (MAX_LEVEL, last, last - 1));
    }

    #[test]
    fn children_tile_their_parent_in_order() {
        let parent = Key::new(3, 5, 2);
        let children = parent.children();
        assert_eq!(children.map(|c| (c.level(), c.ix(), c.iy())), [(4, 10, 4), (4, 11, 4), (4, 10, 5), (4, 11, 5)]);
        assert_eq!(children[0].start(), parent.start());
        assert_eq!(children[3].end(), parent.end());
        for child in children {
            assert!(parent < child, "an ancestor sorts before its parts");
        }
    }
}
