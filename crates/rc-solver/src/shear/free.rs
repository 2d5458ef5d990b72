//! How the traction of each element may move: freely where it sticks, along the border of its disc where it slips.

use rc_core::DVec2;

/// The motions that are free at some tractions.
pub(super) struct Free {
    /// Gradient `L_T` t - d of the energy for each element.
    pub(super) gradient: Vec<DVec2>,
    /// Unit vector of the traction of an element that slips; `None` for one that sticks.
    slips: Vec<Option<DVec2>>,
    /// Scale of the motion of each element in the preconditioner: 1, or less where the border of the disc is bent.
    scales: Vec<f64>,
}

impl Free {
    /// The motions at `tractions` within `limits`, with the displacements of the elements and that of the bodies.
    ///
    /// An element slips if a step of its gradient alone, of 1/`own`, ends beyond its disc.
    pub(super) fn new(
        (tractions, limits): (&[DVec2], &[f64]),
        displacements: &[DVec2],
        displacement: DVec2,
        own: f64,
    ) -> Self {
        let gradient: Vec<DVec2> = displacements.iter().map(|v| *v - displacement).collect();
        let slips = tractions.iter().zip(limits).zip(&gradient);
        let slips = slips.map(|((t, limit), g)| {
            let is_beyond = (*t - *g / own).length() > *limit;
            is_beyond.then(|| t.normalize_or_zero()).filter(|unit| *unit != DVec2::ZERO)
        });
        let slips: Vec<_> = slips.collect();
        // Along a border of radius μp, the energy is bent by the slip over μp beside the response of the element.
        let scale = |((slips, g), limit): ((&Option<DVec2>, &DVec2), &f64)| {
            slips.map_or(1.0, |unit| (1.0 + (-g.dot(unit)).max(0.0) / (limit * own)).sqrt().recip())
        };
        let scales = slips.iter().zip(&gradient).zip(limits).map(scale).collect();
        Self { gradient, slips, scales }
    }

    /// The gradient against which the tractions may move.
    pub(super) fn residual(&self) -> Vec<DVec2> {
        let mut residual: Vec<DVec2> = self.gradient.iter().map(|g| -*g).collect();
        self.confine(&mut residual);
        residual
    }

    /// Takes from each vector what leads out of a disc, or into it.
    pub(super) fn confine(&self, vectors: &mut [DVec2]) {
        for (vector, slips) in vectors.iter_mut().zip(&self.slips) {
            if let Some(unit) = slips {
                *vector -= vector.dot(*unit) * *unit;
            }
        }
    }

    /// Scales motions for the preconditioner.
    pub(super) fn scale(&self, vectors: &mut [DVec2]) {
        vectors.iter_mut().zip(&self.scales).for_each(|(vector, scale)| *vector *= *scale);
    }

    /// Moves tractions of elements that slip to the border of their disc.
    pub(super) fn to_border(&self, tractions: &mut [DVec2], limits: &[f64]) {
        for ((traction, slips), &limit) in tractions.iter_mut().zip(&self.slips).zip(limits) {
            if let Some(unit) = slips {
                *traction = limit * traction.normalize_or(*unit);
            }
        }
    }

    /// Takes the mean motion from `vectors`, which are free, so that their sum is zero.
    pub(super) fn balance(&self, vectors: &mut [DVec2]) {
        let mean = self.solved(vectors.iter().sum());
        for (vector, slips) in vectors.iter_mut().zip(&self.slips) {
            *vector -= slips.map_or(mean, |unit| mean - mean.dot(unit) * unit);
        }
    }

    /// The mean of the gradient over the free motions.
    pub(super) fn mean_gradient(&self) -> DVec2 {
        let mut gradient = self.gradient.clone();
        self.confine(&mut gradient);
        self.solved(gradient.iter().sum())
    }

    /// The vector whose free parts add up to `sum`.
    fn solved(&self, sum: DVec2) -> DVec2 {
        let [mut xx, mut yy, mut xy] = [0.0; 3];
        for slips in &self.slips {
            let unit = slips.unwrap_or(DVec2::ZERO);
            xx += 1.0 - unit.x * unit.x;
            yy += 1.0 - unit.y * unit.y;
            xy -= unit.x * unit.y;
        }
        // If all slip in one direction, there is no motion along it.
        let least = 1e-9 * (xx + yy) + f64::MIN_POSITIVE;
        let (xx, yy) = (xx + least, yy + least);
        DVec2::new(yy * sum.x - xy * sum.y, xx * sum.y - xy * sum.x) / (xx * yy - xy * xy)
    }
}
