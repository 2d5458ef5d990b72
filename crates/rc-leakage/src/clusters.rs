//! Clusters of open elements on the periodic grid, and their winding around the cell.

use rc_core::Field;

use crate::network::Axis;
use crate::parallel;

/// A run of open elements in a row, from `start` to before `end`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    pub(crate) start: u32,
    pub(crate) end: u32,
}

/// The runs of open elements in each row, and their clusters.
///
/// Runs of a cluster are connected through faces.
#[derive(Debug)]
pub(crate) struct Clusters {
    nx: usize,
    /// All runs, row by row.
    pub(crate) runs: Vec<Run>,
    /// Index of the first run of each row. The last entry is the number of runs.
    pub(crate) first_of_row: Vec<usize>,
    sets: WindingSets,
}

/// Two runs that touch.
///
/// `leaves` tells how often the step from the first to the second leaves the cell along x and along y.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contact {
    pub(crate) runs: [usize; 2],
    pub(crate) leaves: [i32; 2],
}

impl Clusters {
    /// The clusters of the elements of `gap` above `threshold`.
    ///
    /// With `inclusive`, elements at the threshold count too.
    pub(crate) fn above(gap: &Field, threshold: f64, inclusive: bool) -> Self {
        let is_open = |value: f64| value > threshold || (inclusive && value >= threshold);
        let (nx, ny) = (gap.grid().nx(), gap.grid().ny());
        let rows = parallel::map((0..ny).collect(), |iy| runs_of(gap.row(iy), is_open));
        let (mut runs, mut first_of_row) = (Vec::with_capacity(rows.iter().map(Vec::len).sum()), vec![0]);
        for row in rows {
            runs.extend(row);
            first_of_row.push(runs.len());
        }
        let mut clusters = Self { nx, sets: WindingSets::new(runs.len()), runs, first_of_row };
        let mut sets = std::mem::replace(&mut clusters.sets, WindingSets::new(0));
        clusters.for_each_contact(|contact| sets.join(contact));
        clusters.sets = sets;
        clusters
    }

    /// Calls `visit` with each pair of runs that touch.
    ///
    /// The two runs may be the same run, which touches itself around the cell.
    pub(crate) fn for_each_contact(&self, mut visit: impl FnMut(Contact)) {
        let ny = self.first_of_row.len() - 1;
        for iy in 0..ny {
            let here = self.first_of_row[iy]..self.first_of_row[iy + 1];
            if let (Some(first), Some(last)) = (self.runs.get(here.clone()).and_then(<[_]>::first), here.clone().last())
                && first.start == 0
                && self.runs[last].end as usize == self.nx
            {
                visit(Contact { runs: [last, here.start], leaves: [1, 0] });
            }
            let next = (iy + 1) % ny;
            let leaves = [0, i32::from(next <= iy)];
            let (mut a, mut b) = (here.start, self.first_of_row[next]);
            while a < here.end && b < self.first_of_row[next + 1] {
                let (lower, upper) = (self.runs[a], self.runs[b]);
                if lower.start < upper.end && upper.start < lower.end {
                    visit(Contact { runs: [a, b], leaves });
                }
                if lower.end <= upper.end { a += 1 } else { b += 1 }
            }
        }
    }

    /// Whether a cluster winds around the cell along x, and along y.
    pub(crate) fn percolates(&mut self) -> [bool; 2] {
        (0..self.runs.len()).fold([false; 2], |[x, y], run| {
            let [along_x, along_y] = self.sets.winds(run);
            [x || along_x, y || along_y]
        })
    }

    /// Whether each run belongs to a cluster that winds along `axis`.
    pub(crate) fn winding(&mut self, axis: Axis) -> Vec<bool> {
        (0..self.runs.len()).map(|run| self.sets.winds(run)[axis.index()]).collect()
    }
}

fn runs_of(row: &[f64], is_open: impl Fn(f64) -> bool) -> Vec<Run> {
    let mut runs = Vec::new();
    let mut start = None;
    for (ix, &value) in row.iter().enumerate() {
        match (start, is_open(value)) {
            (None, true) => start = Some(ix),
            (Some(first), false) => {
                runs.push(Run { start: first as u32, end: ix as u32 });
                start = None;
            }
            _ => {}
        }
    }
    if let Some(first) = start {
        runs.push(Run { start: first as u32, end: row.len() as u32 });
    }
    runs
}

/// Disjoint sets whose members know their copy of the cell relative to the root.
#[derive(Debug)]
struct WindingSets {
    parent: Vec<u32>,
    /// Copy of the cell of each member, relative to that of its parent.
    copy: Vec<[i32; 2]>,
    /// Whether the set of a root winds along x, and along y.
    winds: Vec<[bool; 2]>,
}

impl WindingSets {
    fn new(n: usize) -> Self {
        Self { parent: (0..n as u32).collect(), copy: vec![[0; 2]; n], winds: vec![[false; 2]; n] }
    }

    /// The root of `member`, and its copy of the cell relative to the root's.
    fn find(&mut self, member: usize) -> (usize, [i32; 2]) {
        let (mut root, mut total) = (member, [0; 2]);
        while self.parent[root] as usize != root {
            total = add(total, self.copy[root]);
            root = self.parent[root] as usize;
        }
        let (mut at, mut rest) = (member, total);
        while at != root {
            let (next, own) = (self.parent[at] as usize, self.copy[at]);
            (self.parent[at], self.copy[at]) = (root as u32, rest);
            rest = [rest[0] - own[0], rest[1] - own[1]];
            at = next;
        }
        (root, total)
    }

    /// Joins the sets of two members.
    ///
    /// If both are in one set already, and the step leads to another copy of the cell, the set winds.
    fn join(&mut self, Contact { runs: [a, b], leaves }: Contact) {
        let ((root_a, copy_a), (root_b, copy_b)) = (self.find(a), self.find(b));
        let to_b = add(copy_a, leaves);
        let shift = [to_b[0] - copy_b[0], to_b[1] - copy_b[1]];
        let winds_b = if root_a == root_b {
            [shift[0] != 0, shift[1] != 0]
        } else {
            (self.parent[root_b], self.copy[root_b]) = (root_a as u32, shift);
            self.winds[root_b]
        };
        let winds = &mut self.winds[root_a];
        *winds = [winds[0] || winds_b[0], winds[1] || winds_b[1]];
    }

    fn winds(&mut self, member: usize) -> [bool; 2] {
        let (root, _) = self.find(member);
        self.winds[root]
    }
}

fn add(a: [i32; 2], b: [i32; 2]) -> [i32; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

#[cfg(test)]
mod tests {
    use rc_core::Grid;

    use super::*;

    fn percolates(picture: &[&str]) -> [bool; 2] {
        let grid = Grid::new(picture[0].len(), picture.len()).expect("a grid");
        let values = picture.iter().flat_map(|row| row.bytes().map(|c| if c == b'.' { 1.0 } else { 0.0 }));
        Clusters::above(&Field::new(grid, values.collect()).expect("a field"), 0.0, false).percolates()
    }

    #[test]
    fn clusters_percolate_where_they_wind_around_the_cell() {
        assert_eq!(percolates(&["####", "....", "####"]), [true, false]);
        assert_eq!(percolates(&["#.##", "#.##", "#.##"]), [false, true]);
        assert_eq!(percolates(&["....", "....", "...."]), [true, true]);
        assert_eq!(percolates(&["####", "####"]), [false, false]);
        // The cluster touches all borders, but it does not wind around the cell, since the openings do not meet.
        assert_eq!(percolates(&["#.###", "#.###", "...#.", "####.", "####."]), [false, false]);
        // Elements that touch only at corners are not connected.
        assert_eq!(percolates(&[".###", "#.##", "##.#", "###."]), [false, false]);
        // A staircase winds along both axes at once.
        assert_eq!(percolates(&["..##", "#..#", "##..", ".##."]), [true, true]);
        assert_eq!(percolates(&["."]), [true, true]);
        // A ring that leaves the cell and comes back does not wind.
        assert_eq!(percolates(&[".##.", "####", "####", ".##."]), [false, false]);
    }
}
