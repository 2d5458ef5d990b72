//! Maps that a program holds.

use rc_sweep::FileMark;

/// Size and mark of a height map that a program holds.
#[derive(Clone, Copy, Debug)]
pub struct MapMark {
    /// Sides of its cell along x and y (m), if the program knows them.
    pub sides: Option<[f64; 2]>,
    /// Numbers of points along x and y.
    pub points: [usize; 2],
    /// Mark that identifies the map.
    pub mark: FileMark,
}
