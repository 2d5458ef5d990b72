//! Contact spots: the connected parts of the contact.

use rc_core::{Field, Grid};

/// One connected part of the contact, across edges of elements and the sides of the periodic cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Elements of it.
    pub elements: usize,
    /// Sum of the pressures of its elements: its load over the area of an element.
    pub pressure: f64,
}

/// The spots of a pressure field, largest first; of equal ones, the one that begins in an earlier row.
#[must_use]
pub fn contact_spots(pressure: &Field) -> Vec<Spot> {
    let grid = pressure.grid();
    let mut waiting: Vec<bool> = pressure.values().iter().map(|p| *p > 0.0).collect();
    let mut front = Vec::new();
    let mut spots = Vec::new();
    for start in 0..grid.len() {
        if !std::mem::take(&mut waiting[start]) {
            continue;
        }
        let mut spot = Spot { elements: 0, pressure: 0.0 };
        front.push(start);
        while let Some(element) = front.pop() {
            spot.elements += 1;
            spot.pressure += pressure.values()[element];
            front.extend(neighbours(grid, element).into_iter().filter(|&next| std::mem::take(&mut waiting[next])));
        }
        spots.push(spot);
    }
    spots.sort_by_key(|spot| std::cmp::Reverse(spot.elements));
    spots
}

/// The elements across the four edges of `element`, around the periodic cell.
fn neighbours(grid: Grid, element: usize) -> [usize; 4] {
    let (nx, ny) = (grid.nx(), grid.ny());
    let (ix, iy) = (element % nx, element / nx);
    [
        grid.index((ix + 1) % nx, iy),
        grid.index((ix + nx - 1) % nx, iy),
        grid.index(ix, (iy + 1) % ny),
        grid.index(ix, (iy + ny - 1) % ny),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spots_join_across_edges_and_the_sides_of_the_cell_and_not_across_corners() {
        #[rustfmt::skip]
        let values = vec![
            1.0, 0.0, 0.0, 2.0,
            0.0, 3.0, 0.0, 0.0,
            0.0, 0.0, 0.0, 0.0,
            5.0, 0.0, 0.0, 0.0,
        ];
        let field = Field::new(Grid::square(4).expect("a grid"), values).expect("a field");
        let expected = [Spot { elements: 3, pressure: 8.0 }, Spot { elements: 1, pressure: 3.0 }];
        assert_eq!(contact_spots(&field), expected);
    }

    #[test]
    fn no_contact_has_no_spot_and_full_contact_has_one() {
        let grid = Grid::new(3, 5).expect("a grid");
        assert_eq!(contact_spots(&Field::zeros(grid)), []);
        let full = contact_spots(&Field::from_fn(grid, |_, _| 2.0));
        assert_eq!(full, [Spot { elements: 15, pressure: 30.0 }]);
    }
}
