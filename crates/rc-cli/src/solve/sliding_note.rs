//! A note about the material of a sliding contact.

use std::f64::consts::{PI, TAU};

use rc_core::quantity::{digits, engineering};
use rc_sweep::Summary;

use crate::scene::resolve::ContactSetup;

/// Loss tangent below which all waves of a grid find an elastic solid.
const ELASTIC: f64 = 0.01;

/// Loss tangent above which a solve is slow.
const LOSSY: f64 = 5.0;

/// The note, if there is anything to note.
pub(super) fn of(summary: &Summary, contact: &ContactSetup) -> Option<String> {
    let sliding = contact.sliding.as_ref().filter(|sliding| sliding.speed > 0.0)?;
    let tangent = summary.friction?.max_loss_tangent;
    if tangent > LOSSY {
        return Some(format!("note: a loss tangent of {} makes the solve slow", digits(tangent, 2)));
    }
    let cell = contact.units.cell().sides();
    let longest = TAU * sliding.speed / cell[0].max(cell[1]);
    let shortest = PI * sliding.speed * (summary.grid[0] as f64 / cell[0]);
    // Fast or slow, the modulus is that of the shortest waves. Between two relaxation times it is that of a plateau.
    let [low, high] = [longest, shortest].map(|omega| sliding.material.modulus(omega).re);
    let is_elastic = tangent < ELASTIC && high - low < ELASTIC * high;
    is_elastic.then(|| {
        let modulus = engineering(high * contact.units.elasticity().e_star(), "Pa");
        let state = state(high, sliding.material.glassy_ratio(), summary.grid[1] == 1);
        format!("note: at this speed the solid is {state}, with E* = {modulus}; its friction is almost 0")
    })
}

/// What a solid of this modulus is, relative to the relaxed one. Waves across the velocity stay relaxed at any speed.
fn state(modulus: f64, glassy_ratio: f64, is_profile: bool) -> &'static str {
    if is_profile || modulus < 1.0 + ELASTIC {
        "elastic"
    } else if modulus > (1.0 - ELASTIC) * glassy_ratio {
        "nearly glassy along the sliding direction"
    } else {
        "nearly elastic along the sliding direction"
    }
}
