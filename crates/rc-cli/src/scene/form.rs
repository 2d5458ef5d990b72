//! Simple shapes: a sphere, a cylinder, a cone, a wave, a flat.
//!
//! They are the whole surface, or are added to one.

use std::f64::consts::TAU;
use std::sync::Arc;

use clap::ValueEnum;
use rayon::prelude::*;
use rc_core::{DVec2, Field, Grid, HeightField};
use rc_fractal::Surface;
use serde::{Deserialize, Serialize};

/// Name of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum FormName {
    /// The paraboloid -r²/2R.
    Sphere,
    /// The parabola -x²/2R, with its axis along y.
    Cylinder,
    /// The cone -r tan α.
    Cone,
    /// A wave along x, with a crest at the centre.
    Wave,
    /// A plane.
    Flat,
}

/// A shape in units of λ. Its highest point, at height 0, is at the centre of the cell; a wave has mean height 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// The paraboloid -r²/2R.
    Sphere {
        /// Radius R (λ).
        radius: f64,
    },
    /// The parabola -x²/2R.
    Cylinder {
        /// Radius R (λ).
        radius: f64,
    },
    /// The cone -s r.
    Cone {
        /// Slope s of the flank.
        slope: f64,
    },
    /// The wave A cos(2πkx).
    Wave {
        /// Amplitude A (λ).
        amplitude: f64,
        /// Number k of waves per cell, which may not be whole.
        waves: f64,
    },
    /// Height 0.
    Flat,
}

impl Form {
    /// Height at this distance from the centre of the cell, both in λ.
    #[must_use]
    pub fn height(self, from_centre: DVec2) -> f64 {
        match self {
            Self::Sphere { radius } => -from_centre.length_squared() / (2.0 * radius),
            Self::Cylinder { radius } => -from_centre.x * from_centre.x / (2.0 * radius),
            Self::Cone { slope } => -slope * from_centre.length(),
            Self::Wave { amplitude, waves } => amplitude * (TAU * waves * from_centre.x).cos(),
            Self::Flat => 0.0,
        }
    }

    /// The number of waves per cell of a wave; `None` for another shape.
    #[must_use]
    pub fn waves(self) -> Option<f64> {
        if let Self::Wave { waves, .. } = self { Some(waves) } else { None }
    }

    /// The slope of a shape that is as steep everywhere.
    ///
    /// It is an rms slope for a wave. Spheres and cylinders are steep far from the contact only, and have none.
    #[must_use]
    pub fn slope(self) -> f64 {
        match self {
            Self::Cone { slope } => slope,
            Self::Wave { amplitude, waves } => TAU * waves * amplitude / 2.0_f64.sqrt(),
            Self::Sphere { .. } | Self::Cylinder { .. } | Self::Flat => 0.0,
        }
    }

    /// Adds the shape to heights on `grid`, in units of which `unit` make λ.
    pub(super) fn add_to(self, heights: &mut [f64], grid: Grid, unit: f64) {
        let centre = 0.5 * DVec2::new(1.0, grid.cell_ratio());
        heights.par_chunks_mut(grid.nx()).enumerate().for_each(|(iy, row)| {
            row.iter_mut().enumerate().for_each(|(ix, h)| *h += unit * self.height(grid.centre(ix, iy) - centre));
        });
    }

    /// The largest whole number of waves per cell, if the shape has no other waves.
    fn band_limit(self) -> Option<usize> {
        match self {
            Self::Wave { waves, .. } if waves.fract() == 0.0 => Some(waves as usize),
            _ => None,
        }
    }
}

/// A shape on the unit cell, alone or added to a surface of waves.
#[derive(Clone, Debug)]
pub struct FormedSurface {
    /// The surface under the shape.
    pub base: Option<Arc<Surface>>,
    /// The shape.
    pub form: Form,
}

impl HeightField for FormedSurface {
    fn height(&self, at: DVec2) -> f64 {
        let base = self.base.as_ref().map_or(0.0, |base| base.height(at));
        // Exactly symmetrical about the centre.
        base + self.form.height(at - at.floor() - 0.5)
    }

    fn band_limit(&self) -> Option<usize> {
        let base = self.base.as_ref().map(|base| base.waves());
        if self.form == Form::Flat { base } else { Some(self.form.band_limit()?.max(base.unwrap_or(0))) }
    }

    fn sample(&self, grid: Grid) -> Field {
        let mut heights = self.base.as_ref().map_or_else(|| Field::zeros(grid), |base| base.sample(grid));
        self.form.add_to(heights.values_mut(), grid, 1.0);
        heights
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rc_core::testing::check_height_field;
    use rc_fractal::SpectrumParams;

    #[test]
    fn shapes_alone_and_on_a_surface_are_height_fields() {
        let base = Arc::new(Surface::new(&SpectrumParams::paper(4, 1)).expect("a surface"));
        let forms = [
            Form::Sphere { radius: 3.0 },
            Form::Cylinder { radius: 3.0 },
            Form::Cone { slope: 0.1 },
            Form::Wave { amplitude: 1e-2, waves: 3.0 },
            Form::Flat,
        ];
        for form in forms {
            for base in [None, Some(Arc::clone(&base))] {
                check_height_field(&FormedSurface { base, form });
            }
        }
    }

    #[test]
    fn the_summit_is_at_the_centre() {
        for form in [Form::Sphere { radius: 3.0 }, Form::Cylinder { radius: 3.0 }, Form::Cone { slope: 0.1 }] {
            let surface = FormedSurface { base: None, form };
            assert_eq!(surface.height(DVec2::splat(0.5)).abs().to_bits(), 0, "{form:?}");
            let heights = surface.sample(Grid::square(8).expect("a grid"));
            assert_eq!(heights.at(3, 4).to_bits(), heights.at(4, 4).to_bits(), "{form:?}");
            assert_eq!(heights.max().to_bits(), heights.at(3, 3).to_bits(), "{form:?}");
        }
    }
}
