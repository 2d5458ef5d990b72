//! Steps from elements to their neighbours, and the comparison of bonds.

use std::cmp::Ordering;

use rc_core::Grid;

/// A step from an element to its parent, or to a neighbour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Step {
    /// No step: the element is a root or in contact.
    None,
    East,
    West,
    North,
    South,
}

impl Step {
    pub(crate) fn back(self) -> Self {
        match self {
            Self::None => Self::None,
            Self::East => Self::West,
            Self::West => Self::East,
            Self::North => Self::South,
            Self::South => Self::North,
        }
    }

    /// The neighbour of element `index` of a periodic grid.
    #[inline]
    pub(crate) fn from(self, index: usize, grid: Grid) -> usize {
        let (nx, n) = (grid.nx(), grid.len());
        match self {
            Self::None => index,
            Self::East => {
                if index % nx == nx - 1 {
                    index + 1 - nx
                } else {
                    index + 1
                }
            }
            Self::West => {
                if index.is_multiple_of(nx) {
                    index + nx - 1
                } else {
                    index - 1
                }
            }
            Self::North => {
                if index + nx >= n {
                    index + nx - n
                } else {
                    index + nx
                }
            }
            Self::South => {
                if index < nx {
                    index + n - nx
                } else {
                    index - nx
                }
            }
        }
    }
}

/// Strength of a bond, for comparisons.
///
/// A hash orders bonds of the same conductance, so that trees in films of constant gap have short paths.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(crate) struct Strength(f64, u64);

impl Strength {
    /// Strength of an absent bond.
    pub(crate) const NONE: Self = Self(0.0, 0);

    /// Strength of the bond from element `index` along `axis`.
    #[inline]
    pub(crate) fn new(conductance: f64, index: usize, axis: usize) -> Self {
        let key = (2 * index + axis) as u64;
        // The factor is odd, so different bonds have different hashes.
        let mixed = key.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        Self(conductance, mixed ^ (mixed >> 32))
    }

    /// Compares two bonds; weaker ones come first.
    pub(crate) fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0).then(self.1.cmp(&other.1))
    }

    pub(crate) fn is_bond(&self) -> bool {
        self.0 > 0.0
    }
}
