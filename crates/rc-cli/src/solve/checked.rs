//! Checked scenes, before heights are read or evaluated.

use std::time::Instant;

use rc_core::{Kernel, Observer};
use rc_solver::Feature;
use rc_sweep::memory::Budget;

use super::solved::{ProblemSetup, Solved};
use crate::error::CliError;
use crate::scene::features;
use crate::scene::keys::{ContactKeys, SurfaceKeys};
use crate::scene::loaded::LoadedSurface;
use crate::scene::resolve::{self, ContactSetup};
use crate::scene::surface::SurfaceSetup;
use crate::scene::values::{Fraction, ToleranceSpec};

/// A checked contact problem, common to the command line and the Python module.
#[derive(Clone, Debug)]
pub struct CheckedScene {
    /// The surface, not yet read or generated.
    pub surface: SurfaceSetup,
    /// Half-space, load and method.
    pub contact: ContactSetup,
    /// Relative error of the contact area that determines the grid.
    area_error: Option<Fraction>,
}

impl CheckedScene {
    /// Checks the keys.
    ///
    /// With a wanted error of the area, the tolerance is `auto` unless it is given.
    ///
    /// # Errors
    /// [`CliError::Input`].
    pub fn new(surface: SurfaceKeys, contact: ContactKeys) -> Result<Self, CliError> {
        resolve::check_size_and_material(&surface, &contact)?;
        if surface.line {
            features::check(&contact, [Feature::Line])?;
        }
        Self::with_surface(contact, surface.heights.is_some() || surface.like.is_some(), || resolve::surface(surface))
    }

    /// Checks the keys for a height map that a program holds.
    ///
    /// The map has `points` along x and y and the sides `sides` (m), or those of the keys.
    ///
    /// # Errors
    /// [`CliError::Input`].
    pub fn of_map(
        surface: SurfaceKeys,
        (sides, points): (Option<[f64; 2]>, [usize; 2]),
        contact: ContactKeys,
    ) -> Result<Self, CliError> {
        if surface.line {
            features::check(&contact, [Feature::Line])?;
        }
        let (surface, assumed) = surface.of_map(sides, points)?;
        resolve::check_cell_and_material(&surface, &contact)?;
        Self::with_surface(contact, true, || Ok(SurfaceSetup { assumed, ..resolve::surface_in_cell(surface)? }))
    }

    fn with_surface(
        contact: ContactKeys,
        is_map: bool,
        surface: impl FnOnce() -> Result<SurfaceSetup, CliError>,
    ) -> Result<Self, CliError> {
        let area_error = contact.area_error;
        let is_interpolated = is_map && area_error.is_none() && contact.border_level.is_some_and(|level| level > 0);
        features::check(&contact, (is_map && !is_interpolated).then_some(Feature::HeightMap))?;
        let contact = if area_error.is_some() {
            let auto = contact.energy_tolerance.is_none().then_some(ToleranceSpec::Auto);
            ContactKeys { area_error: None, tolerance: contact.tolerance.or(auto), ..contact }
        } else {
            contact
        };
        let mut surface = surface()?;
        if is_interpolated {
            surface.assumed.push("bicubic heights between the points of the map, for its border levels".to_owned());
        }
        let contact = ContactSetup { grid_is_chosen: area_error.is_some(), ..resolve::contact(contact, surface.cell)? };
        let surface = surface.bounded(contact.boundary)?;
        Ok(Self { surface, contact, area_error })
    }

    /// The problem on `surface`, with this kernel and this memory.
    #[must_use]
    pub fn problem<'a>(
        &'a self,
        surface: &'a LoadedSurface,
        kernel: &'a dyn Kernel,
        budget: Budget,
    ) -> ProblemSetup<'a> {
        ProblemSetup { surface, contact: &self.contact, kernel, budget }
    }

    /// Solves the problem of [`CheckedScene::problem`].
    ///
    /// `wall_seconds` counts from `started`.
    ///
    /// # Errors
    /// [`CliError::Input`]. A solution that did not converge is not an error, see [`Solved::failure`].
    pub fn solve<'a>(
        &self,
        problem: ProblemSetup<'a>,
        started: Instant,
        observer: &dyn Observer,
    ) -> Result<Solved<'a>, CliError> {
        match self.area_error {
            None => problem.solve(started, observer),
            Some(wanted) => problem.solve_to_area_error(wanted, started, observer),
        }
    }
}
