//! Tables of an operator for each level of a hierarchy: L, or its approximate inverse.

use std::f64::consts::PI;

use rc_core::Grid;
use rc_fft::{SymbolTable, WaveTable};
use rc_kernel::{CoarseElement, Filter, RelaxedStencil, ScaleSplit, Stencil};

use crate::grid::factors::Factors;
use crate::grid::response::table_of_response;
use crate::problem::steps::Step;
use crate::tiles::base::Base;
use crate::tiles::ladder;
use crate::tiles::ladder::{has_squares, sides_of};
use crate::tiles::operator::coarse::CoarseTable;
use crate::tiles::operator::hierarchy::Reach;
use crate::tiles::operator::sizes::{Real, Sizes};
use crate::tiles::operator::stencil::Taps;
use crate::tiles::operator::tails::TailTable;
use crate::tiles::operator::transfer::Transfer;
use crate::tiles::operator::uneven::Uneven;
use crate::tiles::solid::{Solid, wavenumber};

/// Tables of one operator on levels 0 to K.
///
/// Level 0 is the base grid, with its Fourier transform.
#[derive(Clone)]
pub(crate) struct Tables<T> {
    pub(crate) sizes: Sizes<T>,
    pub(crate) base: Factors<T>,
    /// Displacement by a uniform pressure of 1, in λ.
    pub(crate) compliance: f64,
    /// Stencils of levels 1 to K, and transfers to the next coarser level.
    pub(crate) levels: Vec<(Taps<T>, Transfer<T>)>,
    /// Tails of the stencils of levels 1 to K under a sliding surface. Empty at rest.
    pub(crate) tails: Vec<TailTable<T>>,
    /// The transfer between the finest level and the next coarser one, if they are uneven.
    ///
    /// The coarser level does not have half as many elements along a side then.
    pub(crate) uneven: Option<Uneven<T>>,
    /// Tables of elements 2, 4, … times as large as the finest.
    ///
    /// Empty when these elements are like any value of their level.
    coarse: Vec<CoarseTable<T>>,
}

impl<T: Real> Tables<T> {
    /// Changes the eigenvalue for constant vectors.
    pub(crate) fn set_mean(&mut self, eigenvalue: f64, base: Base) {
        let ([nx, ny], n) = (base.period(), base.grid().len() as f64);
        let n_period = nx as f64 * ny as f64;
        // The load on the period is what the heights get.
        self.base.set_mean(T::rounded(n / n_period * eigenvalue / n_period));
    }

    /// The table of elements 2^`coarser` times as large as the finest.
    pub(crate) fn coarse_table(&self, coarser: usize) -> Option<&CoarseTable<T>> {
        self.coarse.get(coarser - 1)
    }
}

/// The split kernel of one base grid. Tables of any number of levels follow from it.
pub(crate) struct Prepared<T> {
    sizes: Sizes<T>,
    solid: Solid,
    symbol: Factors<T>,
    /// Stencil and transfer of the finest level. Those below are of levels between it and the base grid.
    finest: (Stencil, Transfer<T>),
    between: (Stencil, Transfer<T>),
    coarse: Vec<CoarseElement>,
    scale: Scale,
    remainder_curvature: f64,
    split: ScaleSplit,
}

/// The dependence of weights on the side h of an element.
#[derive(Clone, Copy)]
enum Scale {
    /// Weights are proportional to h: displacements.
    Side,
    /// Weights are proportional to 1/h: pressures.
    Inverse,
}

/// Reach of the preconditioner's stencils.
const INVERSE_RADIUS: usize = 2;

impl<T: Real> Prepared<T> {
    /// Prepares `v = L p` for Love's squares, and elements up to 2^`n_coarse` times as large.
    pub(crate) fn displacement(split: &ScaleSplit, solid: impl Into<Solid>, n_coarse: usize) -> Self {
        let _running = Step::Kernels.begin();
        let solid = solid.into();
        let base = solid.base();
        let cutoff = 0.5 * split.params().cutoff as f64 * base.grid().spacing().min_element();
        let sizes = T::sizes(split.params());
        let transfer = |filter: &Filter| Transfer::new(filter, sizes.taps);
        Self {
            sizes,
            symbol: remainder_symbol(split, &solid, cutoff),
            finest: (split.love_stencil(), transfer(&split.love_filter())),
            between: (level_stencil(split, base.grid()), transfer(&split.level_filter())),
            coarse: split.coarse_elements(n_coarse),
            scale: Scale::Side,
            remainder_curvature: split.remainder_curvature(cutoff) + solid.curvature(),
            solid,
            split: split.clone(),
        }
    }

    /// Prepares about the inverse of L as a preconditioner, except for the mean: |q|/2 for waves of the half-space.
    ///
    /// Under a sliding surface, it is that of the `solid` with the storage modulus of each wave.
    pub(crate) fn inverse(split: &ScaleSplit, solid: impl Into<Solid>) -> Self {
        let _running = Step::Kernels.begin();
        let solid = solid.into();
        let base = solid.base();
        let sizes = T::sizes(split.params());
        let part = (split.inverse_stencil(INVERSE_RADIUS), Transfer::new(&split.level_filter(), sizes.taps));
        let (periodic, [along_x, _]) = (base.periodic_grid(), base.periods_per_side());
        let symbol = SymbolTable::new(periodic, |kx: usize, ky: usize| {
            let storage = solid.sliding().map_or(1.0, |storage| storage.at(2.0 * PI * kx as f64).re);
            let of_half_space = PI * (kx as f64).hypot(ky as f64 / periodic.cell_ratio()) / along_x;
            of_half_space / (1.0 + of_half_space * solid.deviation(kx, ky)) / storage
        });
        Self {
            sizes,
            solid,
            symbol: Factors::AtRest(symbol),
            finest: part.clone(),
            between: part,
            coarse: Vec::new(),
            scale: Scale::Inverse,
            // There is no bound. Values on the base grid are not a smooth part of anything.
            remainder_curvature: f64::INFINITY,
            split: split.clone(),
        }
    }

    /// The number of cells that values reach on a level.
    pub(crate) fn reach(&self) -> Reach {
        Reach { filter: self.finest.1.reach(), stencil: self.finest.0.radius() }
    }

    /// Bound of the second derivatives, along the axes, of values on the base grid.
    ///
    /// Pressures are between 0 and 1.
    pub(crate) fn remainder_curvature(&self) -> f64 {
        self.remainder_curvature
    }

    /// Tables for a finest level of this whole grid.
    pub(crate) fn tables(&self, finest: Grid) -> Tables<T> {
        let _running = Step::Kernels.begin();
        let n_levels = ladder::n_levels(self.base().grid(), finest);
        // A preconditioner halves every level.
        let is_uneven = matches!(self.scale, Scale::Side) && !ladder::is_even(self.base().grid(), finest);
        let below = is_uneven.then(|| self.below_uneven(finest, n_levels));
        let (mut levels, mut tails, mut sum) = (Vec::with_capacity(n_levels), Vec::new(), 0.0);
        for level in 1..=n_levels {
            let (stencil, transfer) = if level == n_levels { &self.finest } else { &self.between };
            let stencil = below.as_ref().filter(|_| level + 1 == n_levels).unwrap_or(stencil);
            let factor = self.factor(level, (level == n_levels && is_uneven).then_some(finest));
            let relaxed = self.relaxed(level, n_levels);
            sum += factor * relaxed.as_ref().map_or_else(|| stencil.sum(), RelaxedStencil::sum);
            let near = relaxed.as_ref().map_or(stencil, |relaxed| &relaxed.near);
            levels.push((Taps::new(near, factor, self.sizes.around), transfer.clone()));
            tails.extend(relaxed.map(|relaxed| TailTable::new(&relaxed.tails, factor, relaxed.near.radius())));
        }
        let mut base = if is_uneven && n_levels == 1 {
            remainder_symbol(&self.split, &self.solid, self.cutoff() * finest.spacing().min_element())
        } else {
            self.symbol.clone()
        };
        let compliance = self.solid.compliance();
        match self.scale {
            // With free borders a uniform pressure displaces.
            Scale::Side if self.base().is_free() => {}
            // A constant gives zero (Eq. 3), unless the solid is on a base. The base grid subtracts what the stencils
            // add to it.
            Scale::Side => base.set_mean(T::rounded((compliance - sum) / self.base().grid().len() as f64)),
            // Its stencils act on differences between levels, which are zero for a constant.
            Scale::Inverse => base.set_mean(T::rounded(0.0)),
        }
        let uneven = is_uneven.then(|| self.uneven(finest, n_levels));
        Tables { sizes: self.sizes, base, compliance, levels, tails, uneven, coarse: self.coarse_tables(n_levels) }
    }

    fn base(&self) -> Base {
        self.solid.base()
    }

    /// The stencil of a level under a sliding surface. `None` at rest.
    fn relaxed(&self, level: usize, n_levels: usize) -> Option<RelaxedStencil> {
        let spacing = ladder::doubled(self.base().grid(), level).spacing();
        let compliance = self.solid.sliding()?.in_units_of(spacing.x);
        if matches!(self.scale, Scale::Inverse) {
            let near = self.split.inverse_stencil_of(INVERSE_RADIUS, &compliance);
            return Some(RelaxedStencil { near, tails: Vec::new() });
        }
        if level == n_levels {
            return Some(self.split.relaxed_love(&compliance));
        }
        let sides = spacing / spacing.min_element();
        Some(if has_squares(self.base().grid()) {
            self.split.relaxed_level(&compliance)
        } else {
            self.split.relaxed_uneven_level(0.5 * self.cutoff(), sides.into(), &compliance)
        })
    }

    /// The cutoff, in elements of a level.
    fn cutoff(&self) -> f64 {
        self.split.params().cutoff as f64
    }

    /// The stencil of the level below an uneven finest level.
    ///
    /// The finest level does not have twice as many elements. The two cutoffs differ by less than a factor of two.
    fn below_uneven(&self, finest: Grid, n_levels: usize) -> Stencil {
        let spacing = ladder::doubled(self.base().grid(), n_levels - 1).spacing();
        let inner = self.cutoff() * finest.spacing().min_element() / spacing.min_element();
        self.split.uneven_level_stencil(inner, (spacing / spacing.min_element()).into())
    }

    /// The transfer to an uneven finest level.
    fn uneven(&self, finest: Grid, n_levels: usize) -> Uneven<T> {
        let levels = [sides_of(finest), sides_of(ladder::doubled(self.base().grid(), n_levels - 1))];
        let [fine, coarse] = levels.map(|sides| self.base().period_of(sides));
        let filters = [0, 1].map(|axis| self.split.uneven_filter(coarse[axis] as f64 / fine[axis] as f64));
        Uneven::new(&filters, fine, coarse)
    }

    /// Factor on a stencil in units of the elements of a level.
    ///
    /// The level's grid is the doubled base grid, unless another `grid` is given.
    fn factor(&self, level: usize, grid: Option<Grid>) -> f64 {
        let grid = grid.unwrap_or_else(|| ladder::doubled(self.base().grid(), level));
        match self.scale {
            Scale::Side => grid.spacing().min_element(),
            Scale::Inverse => grid.nx() as f64,
        }
    }

    fn coarse_tables(&self, n_levels: usize) -> Vec<CoarseTable<T>> {
        let side = self.sizes.around;
        // Elements of one size act on each other across a border with larger elements as they do anywhere.
        let whole = [&self.finest.0].into_iter().chain(self.coarse.iter().map(|element| &element.whole));
        let levels = (1..n_levels).rev();
        levels
            .zip(self.coarse.iter().zip(whole))
            .map(|(level, (element, finer))| {
                let across = Taps::new(finer, self.factor(level + 1, None), side);
                CoarseTable::new(element, self.factor(level, None), across, side)
            })
            .collect()
    }
}

/// The remainder of the split at `cutoff`, in λ, on the base grid.
///
/// It is that without images where borders are free, and has the deviation of the solid otherwise.
///
/// Under a sliding surface, each wave has the compliance of its own.
fn remainder_symbol<T: Real>(split: &ScaleSplit, solid: &Solid, cutoff: f64) -> Factors<T> {
    let base = solid.base();
    if base.is_free() {
        let (spacing, reach) = (base.grid().spacing(), base.period().map(|n| n / 2 + 1));
        return Factors::AtRest(table_of_response(base.periodic_grid(), reach, &|ix, iy| {
            let r = (spacing.x * ix as f64).hypot(spacing.y * iy as f64);
            spacing.x * spacing.y * split.remainder(r, cutoff)
        }));
    }
    let base = base.grid();
    let at_rest = |kx: usize, ky: usize| {
        let q = wavenumber(base, kx, ky);
        if q == 0.0 { 0.0 } else { split.remainder_symbol(q, cutoff) + solid.deviation(kx, ky) }
    };
    let Some(compliance) = solid.sliding() else { return Factors::AtRest(SymbolTable::new(base, at_rest)) };
    Factors::Sliding(WaveTable::new(base, |kx, ky| {
        compliance.at(base.angular_wave(kx, ky).x) * at_rest(kx.unsigned_abs() as usize, ky.unsigned_abs() as usize)
    }))
}

/// The stencil of levels between the base grid and the finest.
///
/// Their elements are squares or nearly squares, like those of the base grid.
fn level_stencil(split: &ScaleSplit, base: Grid) -> Stencil {
    if has_squares(base) {
        return split.level_stencil();
    }
    let sides = base.spacing() / base.spacing().min_element();
    split.uneven_level_stencil(0.5 * split.params().cutoff as f64, sides.into())
}
