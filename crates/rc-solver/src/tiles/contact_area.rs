//! The contact area on a mesh.

use std::ops::Range;

use rayon::prelude::*;
use rc_core::{Boundary, EdgeBias, Grid, SlidingCompliance};
use rc_quadtree::{BLOCK_CELLS, CELLS, Elements, TILE, TileSet};

use crate::solution::contact_area::area::ContactArea;
use crate::solution::contact_area::edge_sums::EdgeSums;
use crate::solution::contact_area::plastic::{PlasticEdges, left};
use crate::solution::contact_area::sliding_edges::SlidingEdges;
use crate::tiles::mesh::{Mesh, Surroundings};

/// Number of tiles that are summed together.
///
/// Sums have this order for any number of threads.
const TILES_AT_ONCE: usize = 64;

/// Pressure and gap on elements.
#[derive(Clone, Copy)]
pub(crate) struct Values<'a> {
    pub(crate) mesh: &'a Mesh,
    pub(crate) pressure: &'a [f64],
    pub(crate) gap: &'a [f64],
    /// The gap of elements in contact.
    pub(crate) contact_gap: f64,
    /// The maximum pressure.
    pub(crate) hardness: f64,
    /// The shift of contact edges.
    pub(crate) bias: EdgeBias,
    /// Moduli of edges across x and across y, in E*.
    pub(crate) moduli: [f64; 2],
}

impl Values<'_> {
    /// The contact area, where the smallest elements are those of `finest`.
    pub(crate) fn contact_area(&self, finest: Grid) -> ContactArea {
        ContactArea::from_sums(&self.edge_sums(|at| at), finest, self.bias)
    }

    /// The contact area under a sliding surface, with the moduli that `compliance` gives its edges.
    pub(crate) fn sliding_area(&self, finest: Grid, compliance: &SlidingCompliance) -> ContactArea {
        let at_rest = self.contact_area(finest);
        // Each contact from edge to edge has two of the edges of an axis.
        let chord = 4.0 * at_rest.cells * finest.len() as f64 / at_rest.perimeter_edges.max(1) as f64;
        let edges = SlidingEdges::of_chord([chord, at_rest.cells], finest.spacing().x, |q| compliance.at(q));
        ContactArea::of_sliding(&edges, |moduli| Self { moduli, ..*self }.contact_area(finest))
    }

    /// The plastic part of the contact. `None` without a hardness.
    pub(crate) fn plastic_edges(&self, finest: Grid) -> Option<PlasticEdges> {
        let Self { mesh, pressure, gap, contact_gap, hardness, bias, .. } = *self;
        if hardness.is_infinite() {
            return None;
        }
        let mut sums = self.edge_sums(|at| left(at, hardness));
        // Where there is no element, there is no pressure.
        let covered = |(coarser, tiles): (usize, &TileSet)| tiles.n_inside() << (2 * coarser);
        let covered: usize = mesh.levels().iter().enumerate().map(covered).sum();
        sums[0].n_contact += finest.len() - covered;
        // The pressure along free borders belongs to the whole contact.
        for sums in &mut sums {
            sums.at_border = 0.0;
        }
        let blocks = pressure.par_chunks(BLOCK_CELLS).zip(gap.par_chunks(BLOCK_CELLS)).map(|(pressure, gap)| {
            let pairs = pressure.iter().zip(gap).filter(|(p, _)| **p >= hardness);
            [pairs.map(|(_, g)| (contact_gap - g).max(0.0)).sum()]
        });
        let [flow] = mesh.layout().total(blocks.collect());
        Some(PlasticEdges::from_sums(&sums, finest, bias, flow / finest.len() as f64))
    }

    /// Sums over the elements of each size. `seen` changes pressure and gap before they are summed.
    fn edge_sums(&self, seen: impl Fn([f64; 2]) -> [f64; 2] + Sync) -> Vec<EdgeSums> {
        let around = [self.pressure, self.gap].map(|values| self.mesh.surroundings(values));
        self.mesh.own_levels().map(|level| self.sums_of_level(level, &around, &seen)).collect()
    }

    /// The sums of one level, with the pressures and gaps around its tiles.
    fn sums_of_level(
        &self,
        (coarser, places, values): (usize, &[[u32; 2]], Range<usize>),
        [pressures, gaps]: &[Surroundings<'_>; 2],
        seen: &(impl Fn([f64; 2]) -> [f64; 2] + Sync),
    ) -> EdgeSums {
        let Self { mesh, pressure, contact_gap, hardness, moduli, .. } = *self;
        let between = (moduli[0] * moduli[1]).sqrt();
        let (side, tiles) = (mesh.side(coarser), &mesh.levels()[coarser]);
        let is_free = tiles.boundary() == Boundary::Free;
        let add_tile = |sums: &mut EdgeSums, tile: usize, place: [u32; 2]| {
            let start = values.start + tile * CELLS;
            if pressure[start..start + CELLS].iter().all(|&p| seen([p, 0.0])[0] <= 0.0) {
                return;
            }
            let pressure = pressures.elements.around(&pressures.values, coarser, place, 0.0);
            // Where there is no element, the gap is not known.
            let gap = gaps.elements.around(&gaps.values, coarser, place, f64::NAN);
            // Cells beyond the grid are across the seam.
            let [width, height] = tiles.inside(place);
            let patch = Inside::of(tiles, place);
            let cells = (0..CELLS).map(|cell| (cell % TILE, cell / TILE)).filter(|&(x, y)| x < width && y < height);
            for (x, y) in cells.map(|(x, y)| (TILE + x, TILE + y)) {
                if seen([pressure[y][x], 0.0])[0] > 0.0 {
                    let at = |dx: isize, dy: isize| {
                        let (x, y) = patch.place(x.wrapping_add_signed(dx), y.wrapping_add_signed(dy));
                        let modulus = match (dx, dy) {
                            (_, 0) => moduli[0],
                            (0, _) => moduli[1],
                            _ => between,
                        };
                        seen([pressure[y][x], modulus * (gap[y][x] - contact_gap)])
                    };
                    let elements = &pressures.elements;
                    sums.add([side; 2], hardness, &at, &|dx, dy| {
                        distance((elements, coarser), place, [x, y], [dx, dy])
                    });
                    if is_free {
                        let at = [place[0] as usize * TILE + x - TILE, place[1] as usize * TILE + y - TILE];
                        sums.add_at_border(seen([pressure[y][x], 0.0])[0], hardness, [at, tiles.sides()], [side; 2]);
                    }
                }
            }
        };
        let chunks = places.par_chunks(TILES_AT_ONCE).enumerate();
        let chunks: Vec<EdgeSums> = chunks
            .map(|(chunk, places)| {
                let mut sums = EdgeSums::default();
                for (tile, &place) in places.iter().enumerate() {
                    add_tile(&mut sums, chunk * TILES_AT_ONCE + tile, place);
                }
                sums
            })
            .collect();
        let total = self.mesh.ranks().fold(EdgeSums::default().to_values(), |sum| {
            chunks.into_iter().fold(EdgeSums::from_values(&sum), |a, b| a + b).to_values()
        });
        EdgeSums::from_values(&total)
    }
}

/// Distance of the neighbour of a cell around the tile at `place`, in sides of the cell. It is 0 beyond a free border.
///
/// The tile begins at cell 8 along both axes. A neighbour may be twice or half as large.
fn distance((elements, coarser): (&Elements, usize), place: [u32; 2], cell: [usize; 2], step: [isize; 2]) -> f64 {
    let tiles = &elements.levels()[coarser];
    let mut tile = [0; 2];
    for axis in [0, 1] {
        let (n, first) = (tiles.sides()[axis] as i64, i64::from(place[axis]) * TILE as i64);
        let at = first + cell[axis] as i64 - TILE as i64 + step[axis] as i64;
        if !(0..n).contains(&at) && tiles.boundary() == Boundary::Free {
            return 0.0;
        }
        tile[axis] = at.rem_euclid(n) / TILE as i64;
    }
    let [column, row] = tile;
    match tile == place.map(i64::from) || tiles.find(column, row).is_some() {
        true => 1.0,
        false if elements.cover(coarser, column as u32, row as u32) => 0.75,
        false => 1.5,
    }
}

/// The cells around a tile that are there: beyond a free border are those beside it.
struct Inside([[usize; 2]; 2]);

impl Inside {
    /// First and last cells along both axes of the tiles around a place.
    ///
    /// They are three by three tiles, with the one at `place` in the middle.
    fn of(tiles: &TileSet, place: [u32; 2]) -> Self {
        let is_free = tiles.boundary() == Boundary::Free;
        Self([0, 1].map(|axis| {
            // The patch begins a tile before its tile.
            let place = place[axis] as usize * TILE;
            let (first, last) = (TILE.saturating_sub(place), tiles.sides()[axis] + TILE - place - 1);
            if is_free { [first, last.min(3 * TILE - 1)] } else { [0, 3 * TILE - 1] }
        }))
    }

    fn place(&self, x: usize, y: usize) -> (usize, usize) {
        let [[left, right], [below, above]] = self.0;
        (x.clamp(left, right), y.clamp(below, above))
    }
}
