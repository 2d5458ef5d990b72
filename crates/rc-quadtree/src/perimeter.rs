//! The border of a set of elements.

use crate::{Edge, Mesh, MeshError, Neighbour, error::check_length};

/// One piece of the border between a set and the rest: an edge of a member of the set, or half of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BorderEdge {
    /// The member of the set.
    pub member: usize,
    /// Which of its edges.
    pub edge: Edge,
    /// The element across, which is not in the set; none where there is no element.
    pub across: Option<usize>,
    /// Length of the piece, in λ.
    pub length: f64,
}

/// The border of a set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perimeter {
    /// Number of pieces, see [`BorderEdge`].
    pub pieces: usize,
    /// Total length, in λ.
    pub length: f64,
}

impl Mesh {
    /// The border between the elements of a set (`members[i]` for element i) and everything else, members in Morton
    /// order. Every piece occurs once, on the side of its member; the seam of the periodic cell is no border.
    ///
    /// # Errors
    /// [`MeshError::Length`] when `members` has not one entry an element.
    pub fn border<'a>(&'a self, members: &'a [bool]) -> Result<impl Iterator<Item = BorderEdge> + 'a, MeshError> {
        check_length(self.len(), members.len())?;
        let set = (0..self.len()).filter(|&i| members[i]);
        let edges = set.flat_map(|member| Edge::ALL.map(|edge| (member, edge)));
        Ok(edges.flat_map(|(member, edge)| {
            let side = self.element(member).side;
            let (across, length) = match self.neighbour(member, edge) {
                Neighbour::Outside => ([Some(None), None], side),
                Neighbour::Same(j) | Neighbour::Coarser(j) => ([Some(Some(j)), None], side),
                Neighbour::Finer([first, second]) => ([Some(first), Some(second)], 0.5 * side),
            };
            let free = across.into_iter().flatten().filter(|across| across.is_none_or(|j| !members[j]));
            free.map(move |across| BorderEdge { member, edge, across, length })
        }))
    }

    /// Number of pieces and length of [`Mesh::border`].
    ///
    /// *Accuracy*: the length is that of the border of the same set on the finest uniform grid, to rounding (test
    /// `perimeter_is_that_of_the_mask`). It measures steps, so a smooth curve comes out longer by up to √2, and by
    /// 4/π on average over its directions.
    ///
    /// # Errors
    /// As [`Mesh::border`].
    pub fn perimeter(&self, members: &[bool]) -> Result<Perimeter, MeshError> {
        let empty = Perimeter { pieces: 0, length: 0.0 };
        let add =
            |sum: Perimeter, piece: BorderEdge| Perimeter { pieces: sum.pieces + 1, length: sum.length + piece.length };
        Ok(self.border(members)?.fold(empty, add))
    }
}
