//! The mesh: sorted keys of the stored squares, and the questions one can ask of them.

use std::ops::Range;

use rc_core::DVec2;

use crate::{
    Key, MAX_LEVEL, MeshError,
    error::{check_base, check_length},
};

/// A periodic linear quadtree on the unit cell: squares of side `1 / (base · 2^level)`, sorted along the Morton curve.
///
/// Only the squares of the contact set (and its halo) are stored; everything else is "outside". Elements never
/// overlap, and elements that touch, at an edge or a corner, also across the periodic seam, differ by at most one
/// level. [`Mesh::assert_well_formed`] checks this; every operation of this crate keeps it.
///
/// *Memory*: 8 bytes an element (test `an_element_takes_at_most_forty_bytes`); neighbours are found by binary search.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mesh {
    base: usize,
    keys: Vec<Key>,
}

/// One square of the mesh, in units of λ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element {
    /// Centre along x.
    pub x: f64,
    /// Centre along y.
    pub y: f64,
    /// Side of the square, `1 / (base · 2^level)`.
    pub side: f64,
    /// Level of the square, 0 for a root square.
    pub level: u32,
}

impl Element {
    /// Half of the side: the paper's d_j (Eq. 5-6 hold with d_j as the half side).
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

/// One of the four edges of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Edge {
    /// Towards smaller x.
    Left,
    /// Towards larger x.
    Right,
    /// Towards smaller y.
    Down,
    /// Towards larger y.
    Up,
}

impl Edge {
    /// All four edges.
    pub const ALL: [Self; 4] = [Self::Left, Self::Right, Self::Down, Self::Up];

    /// The edge that a neighbour across this one has in common.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
            Self::Down => Self::Up,
            Self::Up => Self::Down,
        }
    }

    /// Step to the square across the edge, in columns and rows.
    pub(crate) fn step(self) -> (i64, i64) {
        match self {
            Self::Left => (-1, 0),
            Self::Right => (1, 0),
            Self::Down => (0, -1),
            Self::Up => (0, 1),
        }
    }

    /// The quarters (in Morton order) of the square across the edge that touch it, by increasing coordinate.
    fn touching_quarters(self) -> [usize; 2] {
        match self {
            Self::Left => [1, 3],
            Self::Right => [0, 2],
            Self::Down => [2, 3],
            Self::Up => [0, 1],
        }
    }
}

/// What lies across an edge of an element. In the periodic cell an element can be its own neighbour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Neighbour {
    /// No element: out of contact.
    Outside,
    /// An element of the same size.
    Same(usize),
    /// An element of twice the side; the edge is half of its own.
    Coarser(usize),
    /// Elements of half the side, one at each half of the edge by increasing coordinate; at most one of them is missing
    /// (outside).
    Finer([Option<usize>; 2]),
}

impl Neighbour {
    /// Indices of the elements across the edge, at most two.
    pub fn indices(self) -> impl Iterator<Item = usize> {
        let pair = match self {
            Self::Outside => [None, None],
            Self::Same(j) | Self::Coarser(j) => [Some(j), None],
            Self::Finer(pair) => pair,
        };
        pair.into_iter().flatten()
    }
}

impl Mesh {
    /// A mesh from keys that already keep every invariant.
    pub(crate) fn from_sorted(base: usize, keys: Vec<Key>) -> Self {
        Self { base, keys }
    }

    /// All `(base · 2^level)²` squares of one level.
    ///
    /// # Errors
    /// [`MeshError::Base`]; [`MeshError::TooDeep`] above [`MAX_LEVEL`]; [`MeshError::TooManyElements`] above 2^32.
    pub fn uniform(base: usize, level: u32) -> Result<Self, MeshError> {
        check_base(base)?;
        if level > MAX_LEVEL {
            return Err(MeshError::TooDeep { level });
        }
        let side = (base as u64) << level;
        if side > 1 << 16 {
            return Err(MeshError::TooManyElements { side });
        }
        let side = side as u32;
        let mut keys: Vec<Key> = (0..side).flat_map(|iy| (0..side).map(move |ix| Key::new(level, ix, iy))).collect();
        keys.sort_unstable();
        Ok(Self { base, keys })
    }

    /// Root squares per side of the cell.
    #[must_use]
    pub fn base(&self) -> usize {
        self.base
    }

    /// Number of elements.
    #[must_use]
    pub fn len(&self) -> usize {
        self.keys.len()
    }

    /// Is nothing in contact?
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.keys.is_empty()
    }

    /// Keys of the elements in Morton order.
    #[must_use]
    pub fn keys(&self) -> &[Key] {
        &self.keys
    }

    /// Memory of the elements, in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.keys.capacity() * size_of::<Key>()
    }

    /// Place and size of the square `key` in this cell, whether it is an element or not.
    #[must_use]
    pub fn square(&self, key: Key) -> Element {
        let per_side = ((self.base as u64) << key.level()) as f64;
        let centre = |i: u32| (f64::from(i) + 0.5) / per_side;
        Element { x: centre(key.ix()), y: centre(key.iy()), side: 1.0 / per_side, level: key.level() }
    }

    /// Element `index`.
    ///
    /// # Panics
    /// When `index` is not below [`Mesh::len`].
    #[must_use]
    pub fn element(&self, index: usize) -> Element {
        self.square(self.keys[index])
    }

    /// The elements in Morton order.
    #[must_use]
    pub fn elements(&self) -> impl ExactSizeIterator<Item = Element> + '_ {
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

    /// Area of all elements over the area of the cell, exact to rounding of one division.
    #[must_use]
    pub fn area(&self) -> f64 {
        let cell = (self.base as u64).pow(2) << (2 * MAX_LEVEL);
        self.keys.iter().map(|key| key.span()).sum::<u64>() as f64 / cell as f64
    }

    /// Total load Σ p·side² of a pressure per element, in units of E*·λ², summed in Morton order.
    ///
    /// # Errors
    /// [`MeshError::Length`] when there is not one value an element.
    pub fn load(&self, pressure: &[f64]) -> Result<f64, MeshError> {
        check_length(self.len(), pressure.len())?;
        Ok(self.elements().zip(pressure).map(|(e, p)| p * e.area()).sum())
    }

    /// The element that contains the point `at`, in λ, taken periodically; none outside, and for coordinates that
    /// are not finite. Elements own their lower and left edges.
    #[must_use]
    pub fn locate(&self, at: DVec2) -> Option<usize> {
        if !at.is_finite() {
            return None;
        }
        let per_side = (self.base as u32) << MAX_LEVEL;
        // A tiny negative coordinate wraps to 1.0 by rounding: it belongs to the last column.
        let cell = |v: f64| ((v.rem_euclid(1.0) * f64::from(per_side)) as u32).min(per_side - 1);
        self.find(Key::new(MAX_LEVEL, cell(at.x), cell(at.y)))
    }

    /// The element that is the square `block` or contains it.
    #[must_use]
    pub fn find(&self, block: Key) -> Option<usize> {
        let index = self.keys.partition_point(|key| key.start() <= block.start()).checked_sub(1)?;
        self.keys[index].contains(block).then_some(index)
    }

    /// Indices of the elements that are the square `block` or parts of it; they are consecutive.
    #[must_use]
    pub fn within(&self, block: Key) -> Range<usize> {
        let start = self.keys.partition_point(|&key| key < block);
        let len = self.keys[start..].partition_point(|key| key.start() < block.end());
        start..start + len
    }

    /// What lies across an edge of element `index`, around the periodic cell.
    ///
    /// # Panics
    /// When `index` is not below [`Mesh::len`].
    #[must_use]
    pub fn neighbour(&self, index: usize, edge: Edge) -> Neighbour {
        let key = self.keys[index];
        let (dx, dy) = edge.step();
        let across = key.step(self.base, dx, dy);
        if let Some(j) = self.find(across) {
            return if self.keys[j].level() == key.level() { Neighbour::Same(j) } else { Neighbour::Coarser(j) };
        }
        if key.level() == MAX_LEVEL {
            return Neighbour::Outside;
        }
        let quarters = across.children();
        // The square across is no element, so an element found here is exactly the quarter.
        match edge.touching_quarters().map(|q| self.find(quarters[q])) {
            [None, None] => Neighbour::Outside,
            pair => Neighbour::Finer(pair),
        }
    }
}
