//! `rc solve --watch`: a picture of the contact during the solve.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use rc_core::Snapshot;

use crate::files::names::WATCH_FILE;
use crate::terminal;
use rc_plot::{ContactRows, save_png};
use rc_sweep::files::{self, FileError};

/// Minimum time from one picture to the next.
const INTERVAL: Duration = Duration::from_secs(1);

/// Ratio of the time to the next picture to the time of the last one.
///
/// So pictures take at most a tenth of the time.
const SPARING: u32 = 10;

/// Draws pressures into one file at intervals, and removes the file at the end.
#[derive(Debug)]
pub(crate) struct Watch {
    path: PathBuf,
    /// E* (Pa).
    e_star: f64,
    /// λ (m).
    side: f64,
    interval: Duration,
    state: Mutex<State>,
}

/// State of the next picture.
#[derive(Clone, Copy, Debug)]
enum State {
    /// The picture is the first one, and is drawn at once.
    First,
    /// The picture is drawn after this moment.
    Next(Instant),
    /// A picture could not be written, so no more are drawn.
    GaveUp,
}

impl Watch {
    /// A picture in `folder`, for E* in Pa and the cell's side in m.
    pub(crate) fn new(folder: &Path, e_star: f64, side: f64) -> Self {
        Self { path: folder.join(WATCH_FILE), e_star, side, interval: INTERVAL, state: Mutex::new(State::First) }
    }

    /// Draws the pressure, if it is time.
    ///
    /// A picture that cannot be written does not end the solve. The user is told once, and no more pictures are drawn.
    pub(crate) fn look(&self, pressure: &Snapshot<'_>) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let started = Instant::now();
        let is_due = match *state {
            State::First => true,
            State::Next(due) => started >= due,
            State::GaveUp => false,
        };
        if !is_due {
            return;
        }
        *state = match self.draw(pressure) {
            Ok(()) => {
                let ended = Instant::now();
                State::Next(ended + self.interval.max(SPARING * (ended - started)))
            }
            Err(error) => {
                terminal::tell(&format!("watch: {error}; the solve continues without pictures"));
                State::GaveUp
            }
        };
    }

    fn draw(&self, pressure: &Snapshot<'_>) -> Result<(), FileError> {
        let mut picture = ContactRows::new(pressure.grid());
        pressure.pressure_rows(|rows| picture.take(rows));
        let picture = picture.finish(self.e_star, self.side);
        files::write_file(&self.path, |path| save_png(&picture, path))
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        let state = self.state.get_mut().unwrap_or_else(PoisonError::into_inner);
        if matches!(state, State::Next(_)) {
            // If it cannot be removed, the only harm is a needless picture.
            let _ = std::fs::remove_file(&self.path);
        }
    }
}

#[cfg(test)]
mod tests {
    use rc_core::Grid;

    use super::*;

    /// Shows a snapshot of a pressure that is `value` everywhere.
    fn show(watch: &Watch, (nx, ny): (usize, usize), value: f64) {
        let row = vec![value; nx];
        let rows = |take: &mut dyn FnMut(&[f64])| (0..ny).for_each(|_| take(&row));
        watch.look(&Snapshot::new(Grid::new(nx, ny).expect("a grid"), &rows));
    }

    fn watch(folder: &Path, interval: Duration) -> Watch {
        let mut watch = Watch::new(folder, 1e9, 1e-2);
        watch.interval = interval;
        watch
    }

    #[test]
    fn pictures_of_any_size_and_value_are_drawn_whole_and_are_gone_in_the_end() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let path = dir.path().join("new/watch.png");
        for grid in [(1, 1), (3, 2), (7, 2000), (1500, 64)] {
            for value in [0.0, 1e-3, 5e-324, 1e300, -1.0, f64::NAN, f64::INFINITY] {
                let watch = watch(&dir.path().join("new"), Duration::ZERO);
                show(&watch, grid, value);
                let bytes = std::fs::read(&path).unwrap_or_else(|cause| panic!("{grid:?}, {value}: {cause}"));
                assert!(bytes.starts_with(b"\x89PNG") && bytes.ends_with(b"IEND\xaeB`\x82"), "{grid:?}, {value}");
                drop(watch);
                assert_eq!(
                    std::fs::read_dir(dir.path().join("new")).expect("a folder").count(),
                    0,
                    "{grid:?}, {value}"
                );
            }
        }
    }

    #[test]
    fn the_next_picture_waits() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let path = dir.path().join("watch.png");
        let watch = watch(dir.path(), Duration::from_secs(3600));
        show(&watch, (64, 64), 1e-3);
        std::fs::remove_file(&path).expect("the first picture");
        show(&watch, (64, 64), 1e-3);
        assert!(!path.exists(), "drawn again within an hour");
    }

    #[test]
    fn a_picture_that_cannot_be_written_is_the_last() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let path = dir.path().join("watch.png");
        std::fs::create_dir(&path).expect("a folder in its way");
        let watch = watch(dir.path(), Duration::ZERO);
        show(&watch, (2, 2), 1e-3);
        std::fs::remove_dir(&path).expect("the folder");
        show(&watch, (2, 2), 1e-3);
        assert!(!path.exists(), "drawn again");
    }
}
