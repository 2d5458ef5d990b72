//! The vector work of the iteration, on a block of rows at a time, with the sums that decide the next step.
//!
//! Each function fills the rows of a convolution or takes them, so the vectors pass through the cache once. Sums are in
//! double precision and in a fixed order: element by element in a block, then block by block. What the heights overlap the rigid
//! plane, h - c, is taken first: a constant in the heights, however large, then cancels before anything is added to it.

use super::gap::GapSums;

/// `g = L p - h + c` from a fresh `displacement = L p`.
pub(super) fn fresh_gap(displacement: &[f64], offset: f64, h: &[f64], p: &[f64], g: &mut [f64]) -> GapSums {
    let mut sums = GapSums::EMPTY;
    for (((&v, &h), &p), g) in displacement.iter().zip(h).zip(p).zip(g) {
        let overlap = h - offset;
        *g = v - overlap;
        sums.add_element(p, *g, overlap);
    }
    sums
}

/// Multiplies the pressure by `scale`; the gap follows, since v is linear in p.
pub(super) fn rescale(scale: f64, offset: f64, h: &[f64], p: &mut [f64], g: &mut [f64]) -> GapSums {
    let mut sums = GapSums::EMPTY;
    for ((&h, p), g) in h.iter().zip(p).zip(g) {
        let overlap = h - offset;
        *p *= scale;
        *g = scale * (*g + overlap) - overlap;
        sums.add_element(*p, *g, overlap);
    }
    sums
}

/// Chooses the elements to iterate on, those that press or penetrate, and fills their residual. Returns their number and
/// Σ t over them.
pub(super) fn first_residual(
    (p, g): (&[f64], &[f64]),
    (zero_gap, unit): (f64, f64),
    t: &[f32],
    active: &mut [bool],
    residual: &mut [f32],
) -> [f64; 2] {
    let (mut count, mut sum) = (0_u32, 0.0);
    for ((((&p, &g), &t), active), residual) in p.iter().zip(g).zip(t).zip(active).zip(residual) {
        let gap = g - zero_gap;
        *active = p > 0.0 || gap < 0.0;
        *residual = if *active { (gap * unit) as f32 } else { 0.0 };
        if *active {
            count += 1;
            sum += f64::from(t);
        }
    }
    [f64::from(count), sum]
}

/// Takes the step `p += α t`, `g += α u` and fills the residual on the same elements.
pub(super) fn next_residual(
    step: f64,
    (zero_gap, unit): (f64, f64),
    (p, g): (&mut [f64], &mut [f64]),
    (t, u): (&[f32], &[f32]),
    active: &[bool],
    residual: &mut [f32],
) {
    for (((((p, g), &t), &u), &active), residual) in p.iter_mut().zip(g).zip(t).zip(u).zip(active).zip(residual) {
        *p += step * f64::from(t);
        *g += step * f64::from(u);
        *residual = if active { ((*g - zero_gap) * unit) as f32 } else { 0.0 };
    }
}

/// Takes the preconditioned residual z. Returns Σ z, Σ z u, Σ u over the active elements.
pub(super) fn take_preconditioned(rows: &[f32], u: &[f32], active: &[bool], z: &mut [f32]) -> [f64; 3] {
    let mut sums = [0.0; 3];
    z.copy_from_slice(rows);
    for ((&z, &u), &active) in rows.iter().zip(u).zip(active) {
        if active {
            let (z, u) = (f64::from(z), f64::from(u));
            sums[0] += z;
            sums[1] += z * u;
            sums[2] += u;
        }
    }
    sums
}

/// The next direction, `t = -z + β t + shift` on the active elements, zero elsewhere.
pub(super) fn next_direction(z: &[f32], beta: f32, shift: f32, active: &[bool], t: &mut [f32], rows: &mut [f32]) {
    for (((&z, &active), t), row) in z.iter().zip(active).zip(t).zip(rows) {
        *t = if active { beta * *t - z + shift } else { 0.0 };
        *row = *t;
    }
}

/// Takes `u = L t`. Returns Σ t u, Σ (g - zero gap) t and Σ u over the active elements.
pub(super) fn take_response(
    rows: &[f32],
    t: &[f32],
    g: &[f64],
    zero_gap: f64,
    active: &[bool],
    u: &mut [f32],
) -> [f64; 3] {
    let mut sums = [0.0; 3];
    u.copy_from_slice(rows);
    for (((&u, &t), &g), &active) in rows.iter().zip(t).zip(g).zip(active) {
        if active {
            let (u, t) = (f64::from(u), f64::from(t));
            sums[0] += t * u;
            sums[1] += (g - zero_gap) * t;
            sums[2] += u;
        }
    }
    sums
}

/// Takes the step, clips tensile pressures, and fills what the clipping added. Returns Σ p and the number clipped.
pub(super) fn clip(
    step: f64,
    unit: f64,
    (p, g): (&mut [f64], &mut [f64]),
    (t, u): (&[f32], &[f32]),
    added: &mut [f32],
) -> [f64; 2] {
    let (mut sum, mut clipped) = (0.0, 0_u32);
    for ((((p, g), &t), &u), added) in p.iter_mut().zip(g).zip(t).zip(u).zip(added) {
        let stepped = *p + step * f64::from(t);
        *g += step * f64::from(u);
        *p = stepped.max(0.0);
        *added = ((*p - stepped) * unit) as f32;
        sum += *p;
        clipped += u32::from(stepped < 0.0);
    }
    [sum, f64::from(clipped)]
}

/// Takes the displacement of what clipping added, then multiplies the pressure by `scale`.
pub(super) fn take_clipped(
    rows: &[f32],
    range: f64,
    scale: f64,
    offset: f64,
    h: &[f64],
    (p, g): (&mut [f64], &mut [f64]),
) -> GapSums {
    let mut sums = GapSums::EMPTY;
    for (((&v, &h), p), g) in rows.iter().zip(h).zip(p.iter_mut()).zip(g) {
        let overlap = h - offset;
        *p *= scale;
        *g = scale * (*g + range * f64::from(v) + overlap) - overlap;
        sums.add_element(*p, *g, overlap);
    }
    sums
}
