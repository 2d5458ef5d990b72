//! The solution of the paper's procedure with its certificate, from fresh sums.

use crate::descent::certificate::{Certificate, Residuals};
use crate::descent::info::{GridSolution, MeshPressure, SolveInfo, Status};
use crate::paper::error::GaussSeidelError;
use crate::paper::procedure::Procedure;
use crate::paper::sweep;
use crate::problem::control::Control;
use crate::problem::tolerance::ErrorBound;

impl Procedure<'_> {
    /// The solution with its certificate.
    pub(super) fn finish(mut self, bound: ErrorBound) -> Result<GridSolution, GaussSeidelError> {
        let wanted = self.prescribed();
        self.scale_to_control(&wanted);
        self.displace()?;
        let v = self.displacement_of_elements();
        let gap: Vec<f64> = v.iter().zip(&wanted).map(|(v, wanted)| v - wanted).collect();
        let mean_pressure = self.mean_pressure();
        let mean_gap = self.weighted(&gap) / mean_pressure;
        let elastic_energy = 0.5 * self.weighted(&v);

        let lowering = self.penetration - self.problem.h_max;
        for (g, h) in self.displacement.values_mut().iter_mut().zip(self.pyramid[0].values()) {
            *g -= h + lowering + mean_gap;
        }
        let outside = self.displacement.values().iter().zip(&self.contact).filter(|&(_, &contact)| !contact);
        let inside = gap.iter().map(|g| g - mean_gap);
        let least_gap = inside.chain(outside.map(|(&g, _)| g)).fold(f64::INFINITY, f64::min);
        let residuals = Residuals { least_gap, excess: -least_gap, mean_gap, mean_pressure, elastic_energy };
        let certificate = Certificate::new(self.problem, &residuals);
        let pressure = self.mesh.to_field(&self.pressure, self.info.grid)?;
        let converged = self.settled && certificate.meets(bound) && pressure.min() >= 0.0;
        Ok(GridSolution {
            pressure,
            gap: self.displacement,
            status: if converged { Status::Converged } else { Status::NotConverged },
            elements: Some(MeshPressure { mesh: self.mesh, pressure: self.pressure }),
            info: SolveInfo {
                certificate,
                iteration_error: certificate.energy,
                mean_pressure,
                penetration: self.penetration + mean_gap,
                penetration_full_contact: self.problem.h_max - self.problem.h_mean,
                mean_displacement: 0.0,
                elastic_energy,
                levels: vec![self.info],
                coarser: None,
                friction: None,
            },
        })
    }

    /// Sets the last digits of the load, or of the penetration, by scaling the pressure.
    fn scale_to_control(&mut self, wanted: &[f64]) {
        let scale = match self.problem.bounds.control {
            Control::MeanPressure(mean) => mean / self.mean_pressure(),
            Control::Penetration(_) => self.weighted(wanted) / self.weighted(&self.displacement_of_elements()),
        };
        self.pressure.iter_mut().for_each(|p| *p *= scale);
    }

    /// Displacement at the centres of the elements.
    fn displacement_of_elements(&self) -> Vec<f64> {
        sweep::displacement(&self.coefficients, &self.sites, &self.pressure)
    }

    /// ∫ p · values over the cell, with one value for each element.
    fn weighted(&self, values: &[f64]) -> f64 {
        let elements = self.pressure.iter().zip(self.mesh.elements()).zip(values);
        elements.map(|((p, element), value)| p * element.area() * value).sum()
    }
}
