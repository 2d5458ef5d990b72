//! The elements in contact, on which tractions act.

use rc_core::{Boundary, DVec2, Field, Grid};

/// The elements in contact of a solved normal contact, in the order of the grid.
pub(super) struct Contact {
    grid: Grid,
    /// Indices on the grid.
    places: Vec<usize>,
    /// The part of the grid that tractions are transformed on.
    part: Part,
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
    pub(super) fn new(pressure: &Field, friction: f64, boundary: Boundary) -> Self {
        let in_contact = || pressure.values().iter().enumerate().filter(|(_, p)| **p > 0.0);
        let limits = in_contact().map(|(_, p)| friction * p).collect();
        let places: Vec<usize> = in_contact().map(|(i, _)| i).collect();
        let part = Part::around(pressure.grid(), &places, boundary);
        Self { grid: pressure.grid(), places, part, limits }
    }

    /// Number of elements of the grid.
    pub(super) fn n_grid(&self) -> usize {
        self.grid.len()
    }

    /// The values of a field at these elements.
    pub(super) fn values(&self, field: &Field) -> Vec<f64> {
        self.places.iter().map(|&i| field.values()[i]).collect()
    }

    /// The part of the grid that tractions are transformed on.
    pub(super) fn part(&self) -> Grid {
        self.part.grid
    }

    /// The components of vectors as fields on the part, 0 elsewhere.
    pub(super) fn on_part(&self, vectors: &[DVec2]) -> [Field; 2] {
        let mut fields = [0, 1].map(|_| Field::zeros(self.part.grid));
        for (&i, vector) in self.places.iter().zip(vectors) {
            let i = self.part.place(self.grid, i);
            fields[0].values_mut()[i] = vector.x;
            fields[1].values_mut()[i] = vector.y;
        }
        fields
    }

    /// The components of vectors as fields on the grid, 0 elsewhere.
    pub(super) fn fields(&self, vectors: &[DVec2]) -> [Field; 2] {
        let component = |of: fn(&DVec2) -> f64| self.field(vectors.iter().map(of));
        [component(|v| v.x), component(|v| v.y)]
    }

    /// Values as a field on the grid, 0 elsewhere.
    pub(super) fn field(&self, values: impl Iterator<Item = f64>) -> Field {
        let mut field = Field::zeros(self.grid);
        for (&i, value) in self.places.iter().zip(values) {
            field.values_mut()[i] = value;
        }
        field
    }

    /// The vectors at these elements, from the fields of their components on the part.
    pub(super) fn vectors(&self, [x, y]: &[Field; 2]) -> Vec<DVec2> {
        let places = self.places.iter().map(|&i| self.part.place(self.grid, i));
        places.map(|i| DVec2::new(x.values()[i], y.values()[i])).collect()
    }
}

/// A rectangle of elements of a grid.
struct Part {
    /// Its elements.
    grid: Grid,
    /// Column and row of the first.
    first: [usize; 2],
}

impl Part {
    /// The whole grid, or with free borders the smallest rectangle with all of `places`.
    ///
    /// Without periodic images, the displacement within a rectangle needs no other element.
    fn around(grid: Grid, places: &[usize], boundary: Boundary) -> Self {
        let nx = grid.nx();
        let whole = Self { grid, first: [0, 0] };
        let (Some(low_row), Some(high_row)) = (places.first().map(|i| i / nx), places.last().map(|i| i / nx)) else {
            return whole;
        };
        let columns = places.iter().map(|i| i % nx);
        let (low, high) = columns.fold((nx, 0), |(low, high), column| (low.min(column), high.max(column)));
        match Grid::new(high + 1 - low, high_row + 1 - low_row) {
            Ok(grid) if boundary == Boundary::Free => Self { grid, first: [low, low_row] },
            _ => whole,
        }
    }

    /// The index on the part of element `i` of the grid.
    fn place(&self, grid: Grid, i: usize) -> usize {
        let (ix, iy) = (i % grid.nx() - self.first[0], i / grid.nx() - self.first[1]);
        self.grid.index(ix, iy)
    }
}
