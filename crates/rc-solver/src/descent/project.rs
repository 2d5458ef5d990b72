//! The projection at the end of a round: to the bounds, to the load of each place, and to the load or the penetration.

use rc_core::Observer;

use crate::descent::layout::BlockLayout;
use crate::descent::load::project_to_load;
use crate::descent::operators::{read_blocks, write_blocks};
use crate::descent::penetration::STEPS;
use crate::descent::rows::{self, ClippedStep, ElementValues, Gradient};
use crate::descent::shares::{Load, Shares, Squares};
use crate::descent::state::{Descent, Follows};
use crate::descent::stop::{Stopped, unless_stopped};
use crate::descent::sums::GapSums;
use crate::descent::values::ElementVectors;
use crate::parallel;
use crate::problem::steps::Step;

/// Pressure on a square of side 1 alone that displaces its centre by 1: π / (4 ln(1 + √2)) E*.
const ALONE: f64 = 0.891;

/// Margin on the factor by which the projection multiplies pressures.
///
/// If even this multiple stays below the hardness, the hardness is not considered.
const MARGIN: f64 = 2.0;

impl Descent<'_> {
    /// Takes a step, clips pressures to their bounds, and restores the load or the penetration.
    ///
    /// Each part of the load is restored where it was.
    pub(crate) fn project(&mut self, length: f64, is_heavy: bool, observer: &dyn Observer) -> Result<GapSums, Stopped> {
        let _running = Step::Projection.begin();
        let gradient = self.gradient();
        let (n_changed, loads) = self.clip(length, is_heavy, &gradient);
        let shares = Shares::new(self.squares(), &loads);
        unless_stopped(observer)?;
        let reached = self.may_reach_hardness(&shares);
        if n_changed == 0 {
            // Where the hardness is reached, the load waits for a fresh gap. Single precision changes it a little.
            let load: f64 = loads.iter().map(|load| load.clipped).sum();
            let sums = self.rescale(if reached { 1.0 } else { self.scale_to_load(load) });
            let sums = self.within_bounds(sums);
            return Ok(self.meet_penetration(sums));
        }
        Ok(self.restore(&shares, reached, gradient.unit))
    }

    /// As [`Descent::project`], along a direction whose displacement is not known.
    ///
    /// One application of L gives that of the step, of clipping and of the loads that are moved.
    pub(crate) fn leap(&mut self, length: f64, observer: &dyn Observer) -> Result<GapSums, Stopped> {
        let _running = Step::Projection.begin();
        let (gradient, len) = (self.gradient(), self.layout.len());
        self.directions.displacement.fill(0.0);
        let (_, loads) = self.clip(length, false, &gradient);
        let shares = Shares::new(self.squares(), &loads);
        unless_stopped(observer)?;
        let reached = self.may_reach_hardness(&shares);
        let (factor, (direction, added)) = ((length * gradient.unit) as f32, self.directions.direction_and_added());
        parallel::for_each(direction.chunks(len).zip(added.chunks_mut(len)), |(direction, added)| {
            for (t, added) in direction.iter().zip(added) {
                *added += factor * t;
            }
        });
        Ok(self.restore(&shares, reached, gradient.unit))
    }

    /// Restores the loads of squares after clipping. The gap follows all changes of the pressure.
    fn restore(&mut self, shares: &Shares, reached: bool, unit: f64) -> GapSums {
        // Loads are only moved between squares. Scaling, which is exact, then sets the load of the cell.
        let scale = if reached || self.follows == Follows::Changes {
            self.share_within_bounds(shares, unit);
            1.0
        } else {
            let load = self.share(shares, unit);
            self.scale_to_load(load)
        };
        self.info.operator_applications += 1;
        self.operators.corrections.apply();
        let (offset, range) = (self.problem.offset(), self.problem.unit());
        let (len, empty) = (self.layout.len(), GapSums::empty(self.pressed, self.problem.bounds.hardness));
        let elements = ElementVectors { heights: self.heights, pressure: &mut self.pressure, gap: &mut self.gap };
        let sums = read_blocks(&*self.operators.corrections, elements.blocks(len), |block, displacement| {
            block.with_heights(|values| values.add_clipped(displacement, range, scale, offset, empty))
        });
        let sums = GapSums::total(&self.layout, sums);
        self.pressed = sums.next_pressed();
        let sums = self.within_bounds(sums);
        self.meet_penetration(sums)
    }

    /// The factor from this load to the prescribed one. It is 1 if none is prescribed, or if nothing presses.
    fn scale_to_load(&self, load: f64) -> f64 {
        match self.problem.bounds.mean() {
            Some(mean) if load > 0.0 => mean * self.n_cell() / load,
            _ => 1.0,
        }
    }

    /// Whether the hardness may limit pressures when the loads of squares are shared out.
    fn may_reach_hardness(&self, shares: &Shares) -> bool {
        let bounds = self.problem.bounds;
        bounds.is_limited()
            && MARGIN * shares.maximum() * parallel::maximum(&self.pressure.all(), 0.0) >= bounds.hardness
    }

    /// Brings the pressure between its bounds and to its load, in the order of gaps.
    ///
    /// Before gaps are known, depths are in their place.
    pub(crate) fn project_to_load(&mut self) {
        let (n_cell, layout) = (self.n_cell(), self.layout.clone());
        if self.pressure.is_single() {
            let scale = self.scale_to_load(self.pressure.sum(&layout));
            return self.pressure.update(|p| *p *= scale);
        }
        project_to_load(self.problem, n_cell, &layout, self.pressure.all_mut(), Some(&self.gap.all()));
    }

    /// Projects a start that has pressures beyond the hardness. The gap comes from a fresh application of L.
    pub(crate) fn within_bounds(&mut self, sums: GapSums) -> GapSums {
        if sums.max_pressure > self.problem.bounds.hardness { self.plastic_start() } else { sums }
    }

    /// Takes a step and clips pressures to their bounds.
    ///
    /// In heavy contact, elements that join get a pressure at once. Returns the number of changed pressures, and the
    /// load of each square.
    fn clip(&mut self, length: f64, is_heavy: bool, gradient: &Gradient) -> (u64, Vec<Load>) {
        let (len, squares, layout) = (self.layout.len(), self.squares(), &self.layout);
        let spacing = self.info.grid.spacing();
        let joining = if is_heavy { ALONE / (spacing.x * spacing.y).sqrt() } else { 0.0 };
        let elements = ElementVectors { heights: self.heights, pressure: &mut self.pressure, gap: &mut self.gap };
        let blocks = elements.blocks(len).zip(self.directions.clipped_steps(len)).enumerate();
        let of_blocks = parallel::map(blocks, |(i, (block, mut step))| {
            let joining = joining / layout.area(i).sqrt();
            block.without_heights(|mut values| {
                let n_clipped = values.clip(length, joining, &mut step, gradient);
                (n_clipped, loads_of_block((i, layout), &squares, &values, (&step, gradient)))
            })
        });
        self.add_loads(of_blocks)
    }

    /// Number of changed pressures, and the load of each square, from those of blocks.
    fn add_loads(&self, of_blocks: Vec<(u32, Vec<(usize, Load)>)>) -> (u64, Vec<Load>) {
        let (layout, ranks) = (&self.layout, self.layout.ranks());
        let mut loads = vec![Load::default(); self.squares().len()];
        let n_clipped = ranks.count(of_blocks.iter().map(|(n, _)| *n as usize).sum());
        let of_blocks = of_blocks.into_iter().map(|(_, of_block)| of_block).enumerate();
        let mine = of_blocks.flat_map(|(i, of_block)| {
            let in_units = move |(square, load): (usize, Load)| {
                [square as f64, layout.area(i) * load.clipped, layout.area(i) * load.added]
            };
            of_block.into_iter().map(in_units)
        });
        // The order is that of blocks, including those of other ranks.
        for [square, clipped, added] in ranks.concatenate(mine.collect()) {
            let square = &mut loads[square as usize];
            *square = square.plus(Load { clipped, added }, 1.0);
        }
        (n_clipped as u64, loads)
    }

    /// Writes the changes of pressures that restore the loads of squares by scaling. Returns the whole load.
    fn share(&mut self, shares: &Shares, unit: f64) -> f64 {
        let (len, layout) = (self.layout.len(), &self.layout);
        let blocks = self.pressure.blocks(len).zip(self.directions.added().chunks(len)).enumerate();
        let sums = write_blocks(&mut *self.operators.corrections, blocks, |(i, (block, added)), written| {
            block.change(|pressure| {
                let mut sum = 0.0;
                layout.for_each_run(i, pressure.len(), |run, place| {
                    let (changed, written) = (&mut pressure[run.clone()], &mut written[run.clone()]);
                    sum += rows::share(changed, shares.at(place), unit, &added[run], written);
                });
                [sum]
            })
        });
        let [load] = self.layout.total(sums);
        load
    }

    /// Writes the changes of pressures that restore the loads of squares and of the cell, as far as bounds allow.
    ///
    /// Only pressures between the bounds change, unless they cannot take the load.
    fn share_within_bounds(&mut self, shares: &Shares, unit: f64) {
        let before = self.pressure.all().into_owned();
        let (len, layout, bounds) = (self.layout.len(), &self.layout, self.problem.bounds);
        let changes = shares.changes(&self.rooms());
        parallel::for_each(self.pressure.all_mut().chunks_mut(len).enumerate(), |(i, block)| {
            layout.for_each_run(i, block.len(), |run, place| {
                let factor = changes.at(place).clamp(STEPS[0], STEPS[1]);
                block[run].iter_mut().for_each(|p| *p = bounds.along(*p, factor));
            });
        });
        self.project_to_load();
        let pressure = self.pressure.all();
        let blocks = pressure.chunks(len).zip(before.chunks(len)).zip(self.directions.added().chunks(len));
        write_blocks(&mut *self.operators.corrections, blocks, |((pressure, before), added), written| {
            for (((p, before), added), written) in pressure.iter().zip(before).zip(added).zip(written) {
                *written = ((p - before) * unit) as f32 + added;
            }
        });
    }

    /// Σ p (1 - p/H) of each square.
    fn rooms(&self) -> Vec<f64> {
        let (len, squares, layout) = (self.layout.len(), self.squares(), &self.layout);
        let bounds = self.problem.bounds;
        let of_blocks = parallel::map(self.pressure.all().chunks(len).enumerate(), |(i, block)| {
            let mut rooms: Vec<(usize, f64)> = Vec::new();
            layout.for_each_run(i, block.len(), |run, place| {
                let room: f64 = block[run].iter().map(|&p| bounds.direction(p)).sum();
                match rooms.last_mut() {
                    Some((square, sum)) if *square == squares.at(place) => *sum += room,
                    _ => rooms.push((squares.at(place), room)),
                }
            });
            rooms
        });
        let mut rooms = vec![0.0; squares.len()];
        for (i, block) in of_blocks.into_iter().enumerate() {
            for (square, room) in block {
                rooms[square] += layout.area(i) * room;
            }
        }
        rooms
    }

    fn squares(&self) -> Squares {
        Squares::new(self.layout.sides())
    }
}

/// The load of each square in block `i` after a clipped step.
fn loads_of_block(
    (i, layout): (usize, &BlockLayout),
    squares: &Squares,
    values: &ElementValues<'_>,
    (step, gradient): (&ClippedStep<'_>, &Gradient),
) -> Vec<(usize, Load)> {
    let (mut loads, mut last): (Vec<(usize, Load)>, _) = (Vec::new(), 0);
    layout.for_each_run(i, values.pressure.len(), |run, place| {
        let (square, pressure) = (squares.at(place), &values.pressure[run.clone()]);
        let added: f64 = step.added[run].iter().copied().map(f64::from).sum();
        let load = Load { clipped: pressure.iter().sum(), added: added / gradient.unit };
        // A run lies in the same square as the one before or in the next. Each row of a block begins in the
        // first square again.
        let is_this = |&i: &usize| loads.get(i).is_some_and(|(other, _)| *other == square);
        let known = [last, last + 1, 0].into_iter().find(is_this).or_else(|| (0..loads.len()).find(is_this));
        last = known.unwrap_or_else(|| {
            loads.push((square, Load::default()));
            loads.len() - 1
        });
        loads[last].1 = loads[last].1.plus(load, 1.0);
    });
    loads
}
