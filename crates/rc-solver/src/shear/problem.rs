//! The elements in contact, on which tractions act.

use rc_core::{DVec2, Field, Grid};

/// The elements in contact of a solved normal contact, in the order of the grid.
pub(super) struct Contact {
    grid: Grid,
    places: Vec<usize>,
    /// μp of each, in E*.
    pub(super) limits: Vec<f64>,
}

/// What is prescribed, in units of the solver.
#[derive(Clone, Copy)]
pub(super) enum Prescribed {
    /// Sum of the tractions of all elements.
    Total(DVec2),
    /// Displacement d.
    Displacement(DVec2),
}

impl Contact {
    /// The contact under `pressure`, with the coefficient of friction.
    pub(super) fn new(pressure: &Field, friction: f64) -> Self {
        let in_contact = || pressure.values().iter().enumerate().filter(|(_, p)| **p > 0.0);
        let limits = in_contact().map(|(_, p)| friction * p).collect();
        Self { grid: pressure.grid(), places: in_contact().map(|(i, _)| i).collect(), limits }
    }

    /// Number of elements of the grid.
    pub(super) fn n_grid(&self) -> usize {
        self.grid.len()
    }

    /// The values of a field at these elements.
    pub(super) fn values(&self, field: &Field) -> Vec<f64> {
        self.places.iter().map(|&i| field.values()[i]).collect()
    }

    /// The components of vectors as fields, 0 elsewhere.
    pub(super) fn fields(&self, vectors: &[DVec2]) -> [Field; 2] {
        let component = |of: fn(&DVec2) -> f64| self.field(vectors.iter().map(of));
        [component(|v| v.x), component(|v| v.y)]
    }

    /// Values as a field, 0 elsewhere.
    pub(super) fn field(&self, values: impl Iterator<Item = f64>) -> Field {
        let mut field = Field::zeros(self.grid);
        for (&i, value) in self.places.iter().zip(values) {
            field.values_mut()[i] = value;
        }
        field
    }

    /// The vectors at these elements, from the fields of their components.
    pub(super) fn vectors(&self, [x, y]: &[Field; 2]) -> Vec<DVec2> {
        self.places.iter().map(|&i| DVec2::new(x.values()[i], y.values()[i])).collect()
    }
}
