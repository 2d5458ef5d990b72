//! `rc plot`: pictures of a result, a surface or a sweep.

use std::path::{Path, PathBuf};

use clap::Args;
use plotters::prelude::DrawingBackend;
use plotters::style::RGBColor;
use rc_core::Field;

use crate::curves::folder::Rows;
use crate::curves::pictures;
use crate::error::CliError;
use crate::files::result::ResultFolder;
use crate::inspect::{draw_surface, folder_of, is_scene};
use crate::terminal;
use rc_core::quantity::Scale;
use rc_plot::{
    Area, ContactPicture, LinePlot, LineStyle, Map, MapPicture, Palette, Picture, PictureError, Series, Shade,
    draw_lines, save_png, save_svg,
};
use rc_solver::PressureStatistics;
use rc_sweep::files::{self, Staged};

const BLUE: RGBColor = RGBColor(38, 92, 158);
const RED: RGBColor = RGBColor(190, 60, 50);

/// Size of the text of the line plots, in pixels.
const TEXT: f64 = 26.0;

/// Arguments of `rc plot`.
#[derive(Args, Clone, Debug)]
pub(crate) struct PlotArgs {
    /// Folder of a result, a surface or a sweep
    #[arg(value_name = "DIR")]
    pub(crate) folder: PathBuf,
    /// Folder for the pictures [default: the result's own]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Do not list the pictures
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// Runs `rc plot`.
///
/// # Errors
/// [`CliError`].
pub(crate) fn run(args: &PlotArgs) -> Result<(), CliError> {
    if is_scene(&args.folder) {
        let target = args.out.as_deref().unwrap_or_else(|| folder_of(&args.folder));
        let names = draw_surface(&args.folder, target, args.quiet)?;
        return if args.quiet { Ok(()) } else { terminal::print_names(target, &names) };
    }
    let target = args.out.as_deref().unwrap_or(&args.folder);
    match Rows::of(&args.folder)? {
        Some(Rows::Sweep) => {
            files::check_folder(target)?;
            let names = pictures::write(&args.folder, target)?;
            return if args.quiet { Ok(()) } else { terminal::print_names(target, &names) };
        }
        Some(Rows::Study(_)) => return Err(of_study(&args.folder)),
        None => {}
    }
    let result = ResultFolder::read_finite(&args.folder)?;
    files::check_folder(target)?;
    let names = write(target, &result)?;
    if args.quiet { Ok(()) } else { terminal::print_names(target, &names) }
}

/// The error for a study, whose pictures are there already.
fn of_study(folder: &Path) -> CliError {
    let message = format_args!(
        "a study, whose contacts are in its folder contact/; rc report {0} draws its curves, and rc plot {0}/sweep those of its \
         rows",
        folder.display()
    );
    CliError::in_file(folder, message)
}

fn write(target: &Path, result: &ResultFolder) -> Result<Vec<String>, CliError> {
    let ResultFolder { pressure, gap, side, .. } = result;
    let of_elements = result.is_of_elements();
    let contact = ContactPicture::of(pressure, 1.0, *side).sliding(result.direction);
    // For means over blocks, the picture of the solve is better than a new one, and stays.
    let (contact, contact_name) =
        if of_elements { (contact, "contact.png") } else { (contact.of_blocks(), "touched.png") };
    let shade = Shade::Values { range: (0.0, gap.max()), palette: Palette::Viridis, factor: 1.0, unit: "m" };
    let gap_map = MapPicture(Map { title: "Gap", field: gap, shade, side: *side });
    let sections = Sections::of(pressure, gap, *side, of_elements);
    let distribution = Distribution::of(pressure, of_elements);
    let mut staged = Staged::new(target)?;
    staged.add(contact_name, |path| save_png(&contact, path))?;
    staged.add("gap.png", |path| save_png(&gap_map, path))?;
    staged.add("sections.png", |path| save_png(&sections, path))?;
    staged.add("sections.svg", |path| save_svg(&sections, path))?;
    staged.add("distribution.png", |path| save_png(&distribution, path))?;
    staged.add("distribution.svg", |path| save_svg(&distribution, path))?;
    let names = staged.names().to_vec();
    staged.commit()?;
    Ok(names)
}

/// Pressure and gap along the row through the maximum of the pressure.
struct Sections {
    pressure: Profile,
    gap: Profile,
    length_unit: String,
    /// End of the x axis.
    length: f64,
    title: String,
}

/// A profile with its unit.
struct Profile {
    points: Vec<(f64, f64)>,
    unit: String,
    max: f64,
}

impl Profile {
    /// The profile of row `iy` of `field`, whose points have the distance `step`.
    fn of(field: &Field, iy: usize, step: f64, unit: &'static str) -> Self {
        let row = field.row(iy);
        let max = row.iter().copied().fold(0.0, f64::max);
        let scale = Scale::of(max, unit);
        let points = row.iter().enumerate().map(|(ix, value)| ((ix as f64 + 0.5) * step, value / scale.factor));
        Self { points: points.collect(), unit: scale.unit(), max: max / scale.factor }
    }
}

impl Sections {
    fn of(pressure: &Field, gap: &Field, side: f64, of_elements: bool) -> Self {
        let grid = pressure.grid();
        let peak = (0..grid.len()).max_by(|a, b| pressure.values()[*a].total_cmp(&pressure.values()[*b])).unwrap_or(0);
        let iy = peak / grid.nx();
        let scale = Scale::of(side, "m");
        let step = side / scale.factor / grid.nx() as f64;
        let y = rc_core::quantity::engineering(grid.centre(0, iy).y * side, "m");
        let greatest = if of_elements { "maximum pressure" } else { "maximum mean pressure of a block" };
        Self {
            pressure: Profile::of(pressure, iy, step, "Pa"),
            gap: Profile::of(gap, iy, step, "m"),
            length_unit: scale.unit(),
            length: side / scale.factor,
            title: format!("Section through the {greatest}, y = {y}"),
        }
    }

    fn panel<B: DrawingBackend>(
        &self,
        area: &Area<B>,
        title: &str,
        (name, profile, colour): (&str, &Profile, RGBColor),
    ) -> Result<(), PictureError> {
        let plot = LinePlot {
            title,
            x_label: &format!("x ({})", self.length_unit),
            y_label: &format!("{name} ({})", profile.unit),
            x: (0.0, self.length),
            y: (0.0, above(profile.max)),
            series: vec![Series { name: "", points: profile.points.clone(), colour, style: LineStyle::Solid }],
        };
        draw_lines(area, &plot, TEXT)
    }
}

impl Picture for Sections {
    fn size(&self) -> (u32, u32) {
        (1600, 1100)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let (upper, lower) = area.split_vertically(self.size().1 / 2);
        self.panel(&upper, &self.title, ("pressure", &self.pressure, RED))?;
        self.panel(&lower, "", ("gap", &self.gap, BLUE))
    }
}

/// Distribution of the pressure in contact, or of the mean pressures of touched blocks.
struct Distribution {
    of_elements: bool,
    points: Vec<(f64, f64)>,
    unit: String,
    mean: f64,
    max: (f64, f64),
}

impl Distribution {
    fn of(pressure: &Field, of_elements: bool) -> Self {
        let statistics = PressureStatistics::of(pressure);
        let scale = Scale::of(statistics.max_pressure, "Pa");
        let bins: Vec<(f64, f64)> =
            statistics.distribution.bins().map(|(p, density)| (p / scale.factor, density * scale.factor)).collect();
        let highest = bins.iter().fold(0.0_f64, |highest, bin| highest.max(bin.1));
        Self {
            of_elements,
            points: bins,
            unit: scale.unit(),
            mean: statistics.mean_contact_pressure / scale.factor,
            max: (statistics.max_pressure / scale.factor, highest),
        }
    }

    /// Points on the outline of the bins.
    fn steps(&self) -> Vec<(f64, f64)> {
        let half = self.max.0 / self.points.len() as f64 / 2.0;
        self.points.iter().flat_map(|(p, density)| [(p - half, *density), (p + half, *density)]).collect()
    }
}

impl Picture for Distribution {
    fn size(&self) -> (u32, u32) {
        (1300, 850)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let top = above(self.max.1);
        let mean = vec![(self.mean, 0.0), (self.mean, top)];
        let (title, solved, their_mean) = if self.of_elements {
            ("Distribution of the pressure in contact", "elements in contact", "mean in contact")
        } else {
            ("Distribution of the mean pressure of touched blocks", "touched blocks", "mean of touched blocks")
        };
        let plot = LinePlot {
            title,
            x_label: &format!("pressure ({})", self.unit),
            y_label: &format!("probability density (1/{})", self.unit),
            x: (0.0, above(self.max.0)),
            y: (0.0, top),
            series: vec![
                Series { name: solved, points: self.steps(), colour: BLUE, style: LineStyle::Solid },
                Series { name: their_mean, points: mean, colour: RED, style: LineStyle::Dashed },
            ],
        };
        draw_lines(area, &plot, TEXT)
    }
}

/// End of an axis that begins at 0 and has to show `max`.
fn above(max: f64) -> f64 {
    if max > 0.0 { 1.05 * max } else { 1.0 }
}
