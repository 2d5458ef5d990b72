//! Refining and coarsening: first the closure of what was asked for (a plain list), then the new mesh.

use std::collections::BTreeSet;

use crate::{Key, MAX_LEVEL, Mesh, MeshError};

impl Mesh {
    /// The elements that must be split when the `marked` ones are: these, and every larger element that would
    /// otherwise touch one of a quarter of its side. Sorted, each once; a closure is its own closure.
    ///
    /// # Errors
    /// [`MeshError::NoSuchElement`]; [`MeshError::TooDeep`] when a marked element has the deepest level of a key.
    pub fn split_closure(&self, marked: &[usize]) -> Result<Vec<usize>, MeshError> {
        self.check_indices(marked)?;
        let mut closure = BTreeSet::new();
        let mut pending = marked.to_vec();
        while let Some(index) = pending.pop() {
            let key = self.keys()[index];
            if key.level() == MAX_LEVEL {
                return Err(MeshError::TooDeep { level: MAX_LEVEL + 1 });
            }
            if closure.insert(index) {
                let touching = touching_blocks(self.base(), key).filter_map(|block| self.find(block));
                pending.extend(touching.filter(|&j| self.keys()[j].level() < key.level()));
            }
        }
        Ok(closure.into_iter().collect())
    }

    /// The mesh with the `marked` elements, and their [`Mesh::split_closure`], split into four.
    ///
    /// # Errors
    /// As [`Mesh::split_closure`].
    pub fn split(&self, marked: &[usize]) -> Result<Self, MeshError> {
        let closure = self.split_closure(marked)?;
        let mut keys = Vec::with_capacity(self.len() + 3 * closure.len());
        let mut from = 0;
        for index in closure {
            keys.extend_from_slice(&self.keys()[from..index]);
            keys.extend(self.keys()[index].children());
            from = index + 1;
        }
        keys.extend_from_slice(&self.keys()[from..]);
        Ok(Self::from_sorted(self.base(), keys))
    }

    /// The elements that can be merged when only `marked` ones may: complete families of four quarters of one square,
    /// all marked, whose union would touch no element of a quarter of its side. Sorted; a multiple of four elements,
    /// each family consecutive; a closure is its own closure.
    ///
    /// # Errors
    /// [`MeshError::NoSuchElement`].
    pub fn merge_closure(&self, marked: &[usize]) -> Result<Vec<usize>, MeshError> {
        self.check_indices(marked)?;
        let mut is_marked = vec![false; self.len()];
        for &index in marked {
            is_marked[index] = true;
        }
        let mut families: Vec<(Key, usize)> = Vec::new();
        for (first, &key) in self.keys().iter().enumerate() {
            let Some(parent) = key.parent() else { continue };
            if self.keys()[first..].starts_with(&parent.children()) && is_marked[first..first + 4].iter().all(|&m| m) {
                families.push((parent, first));
            }
        }
        // A merge can only be forbidden by smaller elements, so the decision on these comes first.
        families.sort_by_key(|&(parent, _)| std::cmp::Reverse(parent.level()));
        let mut merged = vec![false; self.len()];
        for (parent, first) in families {
            if !self.touches_quarter_size(parent, &merged) {
                merged[first..first + 4].fill(true);
            }
        }
        Ok((0..self.len()).filter(|&i| merged[i]).collect())
    }

    /// The mesh with the families of the [`Mesh::merge_closure`] of the `marked` elements merged; other marked
    /// elements stay.
    ///
    /// # Errors
    /// As [`Mesh::merge_closure`].
    pub fn merge(&self, marked: &[usize]) -> Result<Self, MeshError> {
        let closure = self.merge_closure(marked)?;
        let mut keys = Vec::with_capacity(self.len() - closure.len() / 4 * 3);
        let mut from = 0;
        for family in closure.chunks_exact(4) {
            keys.extend_from_slice(&self.keys()[from..family[0]]);
            keys.extend(self.keys()[family[0]].parent());
            from = family[3] + 1;
        }
        keys.extend_from_slice(&self.keys()[from..]);
        Ok(Self::from_sorted(self.base(), keys))
    }

    /// Does the square `block` touch an element, not about to be merged, of a quarter of its side?
    fn touches_quarter_size(&self, block: Key, merged: &[bool]) -> bool {
        let level = block.level() + 2;
        if level > MAX_LEVEL {
            return false;
        }
        let (left, low) = (4 * i64::from(block.ix()), 4 * i64::from(block.iy()));
        let ring = (-1..=4).flat_map(|dy| (-1..=4).map(move |dx| (dx, dy)));
        let outside = ring.filter(|(dx, dy)| !((0..4).contains(dx) && (0..4).contains(dy)));
        outside.map(|(dx, dy)| Key::wrapped(self.base(), level, left + dx, low + dy)).any(|square| {
            let found = self.find(square).filter(|&j| self.keys()[j] == square);
            found.is_some_and(|j| !merged[j])
        })
    }

    fn check_indices(&self, indices: &[usize]) -> Result<(), MeshError> {
        match indices.iter().find(|&&index| index >= self.len()) {
            Some(&index) => Err(MeshError::NoSuchElement { index, len: self.len() }),
            None => Ok(()),
        }
    }
}

/// The eight squares of the same size that touch `key` at an edge or a corner, around the periodic cell.
pub(crate) fn touching_blocks(base: usize, key: Key) -> impl Iterator<Item = Key> {
    let steps = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];
    steps.into_iter().map(move |(dx, dy)| key.step(base, dx, dy))
}
