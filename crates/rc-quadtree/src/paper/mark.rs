//! Choice of the squares that become elements, from the contact set alone.

use super::error::{MeshError, depth_of};
use super::mask::{Mask, eroded};

/// The three meshes of Fig. 3.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MeshKind {
    /// Every cell of the finest grid is an element, in contact or not ("uniform grid").
    Uniform,
    /// The cells in contact and the halo are elements of the finest size.
    ///
    /// This is the "adaptive uniform grid", after P. Wriggers, *Computational Contact Mechanics*, Wiley, 2002, as the
    /// paper cites it. The paper's numbers at one penetration are 2.75e6 of 4.2e6 = 2048² cells. Their ratio 0.656 is a
    /// contact fraction, so the paper's mesh has no halo.
    AdaptiveUniform,
    /// The paper's mesh ("adaptive non-uniform grid").
    ///
    /// Elements are finest along every contact border, and sizes double inwards.
    Adaptive,
}

/// Parameters of the mesh of a contact set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshParams {
    /// Root squares per side. The largest element has side 1 / base.
    ///
    /// The mask has `base · 2^k` cells per side.
    pub base: usize,
    /// Number of blocks around a block that must be in contact with it.
    ///
    /// The block is then one element. These blocks have its own size. The value 1 is closest to the paper. The value 2
    /// gives a smoother pressure, with half as many elements again.
    pub ring: usize,
    /// Number of rows and columns around contact whose cells are elements too.
    ///
    /// These cells out of contact are elements of the finest size. [`MeshKind::Uniform`] has them in any case.
    pub halo: usize,
}

impl Default for MeshParams {
    /// The paper's mesh on a grid of 2^k cells per side.
    ///
    /// It has one root square, a ring of 1, and no halo.
    fn default() -> Self {
        Self { base: 1, ring: 1, halo: 0 }
    }
}

/// Role of one square of one level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Mark {
    /// The square is out of contact and has no element.
    Outside,
    /// The elements are smaller than this square.
    Divided,
    /// The square is an element.
    Element,
    /// The square is a part of a larger element.
    Covered,
}

/// The plan of a mesh, with a mark for each square of each level.
///
/// A mark takes one byte, so a plan takes 4/3 bytes for each cell of the mask.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct RefinementPlan {
    base: usize,
    levels: Vec<Vec<Mark>>,
}

impl RefinementPlan {
    /// Number of root squares per side.
    pub(super) fn base(&self) -> usize {
        self.base
    }

    /// Marks of the squares of each level, from the roots to the finest.
    ///
    /// They are row-major, with `base · 2^level` squares per side.
    pub(super) fn levels(&self) -> &[Vec<Mark>] {
        &self.levels
    }

    /// Number of elements of each level.
    pub(super) fn counts(&self) -> Vec<usize> {
        self.levels.iter().map(|marks| marks.iter().filter(|&&m| m == Mark::Element).count()).collect()
    }
}

/// Plans the mesh of [`Mesh::from_mask`](super::Mesh::from_mask).
///
/// The plan depends only on the arguments (test `plan_is_pure`).
pub(super) fn plan(mask: &Mask, kind: MeshKind, params: &MeshParams) -> Result<RefinementPlan, MeshError> {
    let depth = depth_of(mask.side(), params.base)?;
    if params.ring == 0 {
        return Err(MeshError::ZeroRing);
    }
    let finest = match kind {
        MeshKind::Uniform => vec![true; mask.cells().len()],
        MeshKind::AdaptiveUniform | MeshKind::Adaptive => mask.widened(params.halo),
    };
    let mut inner = match kind {
        MeshKind::Uniform | MeshKind::AdaptiveUniform => vec![Vec::new(); depth as usize],
        MeshKind::Adaptive => inner_blocks(mask, params, depth),
    };
    let mut occupied = coarser_levels(&finest, mask.side(), depth, |[a, b, c, d]| a | b | c | d);
    inner.push(finest.clone());
    occupied.push(finest);

    let mut levels: Vec<Vec<Mark>> = Vec::with_capacity(occupied.len());
    for (level, (occupied, inner)) in occupied.iter().zip(&inner).enumerate() {
        let marks = mark_level(levels.last(), params.base << level, occupied, inner);
        levels.push(marks);
    }
    Ok(RefinementPlan { base: params.base, levels })
}

/// Number of elements of each level, from level 0 to the finest, without building the mesh.
///
/// The mesh is the one that [`Mesh::from_mask`](super::Mesh::from_mask) would build.
///
/// *Cost*: 4096² cells take about 0.1 s, and 4 bytes for each cell (`benches/mesh.rs`).
///
/// # Errors
/// - [`MeshError::Base`] and [`MeshError::Side`] when the mask does not have `base · 2^k` cells per side.
/// - [`MeshError::TooDeep`] when k is above [`MAX_LEVEL`](super::MAX_LEVEL).
/// - [`MeshError::ZeroRing`] when the ring is 0.
pub fn count(mask: &Mask, kind: MeshKind, params: &MeshParams) -> Result<Vec<usize>, MeshError> {
    Ok(plan(mask, kind, params)?.counts())
}

/// The blocks in contact whose ring is in contact too.
///
/// They are given for each level above the finest.
fn inner_blocks(mask: &Mask, params: &MeshParams, depth: u32) -> Vec<Vec<bool>> {
    let full = coarser_levels(mask.cells(), mask.side(), depth, |[a, b, c, d]| a & b & c & d);
    full.iter().enumerate().map(|(level, cells)| eroded(cells, params.base << level, params.ring)).collect()
}

/// Combines the four quarters of every block, for each level above the finest.
fn coarser_levels(finest: &[bool], side: usize, depth: u32, combine: fn([bool; 4]) -> bool) -> Vec<Vec<bool>> {
    let mut levels: Vec<Vec<bool>> = Vec::with_capacity(depth as usize + 1);
    for step in 0..depth {
        let finer = levels.last().map_or(finest, Vec::as_slice);
        let coarser = finer.chunks_exact(2 * (side >> step)).flat_map(|rows| {
            let (lower, upper) = rows.split_at(rows.len() / 2);
            let quarters = lower.chunks_exact(2).zip(upper.chunks_exact(2));
            quarters.map(move |(l, u)| combine([l[0], l[1], u[0], u[1]]))
        });
        levels.push(coarser.collect());
    }
    levels.reverse();
    levels
}

/// Marks of one level of `side` squares per side.
///
/// `inner` is empty when no square of this level may be an element.
fn mark_level(coarser: Option<&Vec<Mark>>, side: usize, occupied: &[bool], inner: &[bool]) -> Vec<Mark> {
    let mut marks = Vec::with_capacity(occupied.len());
    for (iy, row) in occupied.chunks_exact(side).enumerate() {
        let inner = inner.get(iy * side..(iy + 1) * side).unwrap_or_default();
        let coarser = coarser.map_or(&[][..], |marks| &marks[(iy / 2) * (side / 2)..][..side / 2]);
        marks.extend(row.iter().enumerate().map(|(ix, &occupied)| {
            if matches!(coarser.get(ix / 2), Some(Mark::Element | Mark::Covered)) {
                Mark::Covered
            } else if inner.get(ix).is_some_and(|&inner| inner) {
                Mark::Element
            } else if occupied {
                Mark::Divided
            } else {
                Mark::Outside
            }
        }));
    }
    marks
}
