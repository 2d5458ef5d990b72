//! The scene: every key of a scene file.
//!
//! Each key is also a flag of the command line.

use std::path::{Path, PathBuf};

use clap::{ArgMatches, Args, Command, FromArgMatches, ValueEnum};
use rc_core::Boundary;
use rc_fractal::{Amplitudes, Truncation};
use rc_heights::{Layout, LengthUnit, Mask};
use rc_solver::Method;
use rc_sweep::memory::ByteSize;
use serde::{Deserialize, Serialize};

use super::form::FormName;
use super::history::HistorySpec;
use super::material::{FractionalSpec, PronySpec};
use super::names::{amplitudes, boundaries, methods, truncations};
use super::quantity::{angle, force, length, pressure, speed, time, viscosity};
use super::time_limit::TimeLimit;
use super::values::{
    Conductivity, FilePrecision, Fraction, GridSpec, HeightsLike, Marks, PsdConvention, ToleranceSpec,
};
use crate::help;

/// The embedded example: the paper's surface with N = 64 at σ0/E* = 8.9e-4.
///
/// It is also the source of defaults.
pub const EXAMPLE: &str = include_str!("../../assets/paper-n64.toml");

/// The rough surface: a file, or the parameters of a random one (Eq. 9-14).
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[command(next_help_heading = help::SURFACE)]
pub struct SurfaceKeys {
    /// Side λ of the cell, along x (m) [default: the file's; random surface: 0.01]
    #[arg(long, value_name = "M", value_parser = length::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "length::read")]
    pub cell: Option<f64>,
    /// Side of the cell along y (m) [default: the file's, or equal spacings]
    #[arg(long, value_name = "M", help_heading = help::FILES, value_parser = length::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "length::read")]
    pub cell_y: Option<f64>,
    /// Height map: text, .npy, instrument files; positive towards the half-space
    ///
    /// Formats: text, .xyz, .npy, .mat, .h5, .nc, .gwy, .gsf, .grd, .ibw, .sdf, .x3p, .sur, .spm, .opd, .dat, .al3d,
    /// .plu, .plux, .vk4, .vk6, .nid, .stp, .opdx, .frt, .bcrf, 16-bit .png or .tif.
    #[arg(long, value_name = "FILE")]
    pub heights: Option<PathBuf>,
    /// Line contact of a profile in plane strain: lines x z, or z with --cell
    ///
    /// The heights are constant along y. The profile repeats after its length, which is the number of points times their
    /// step.
    #[arg(long)]
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub line: bool,
    /// Fourier coefficients: lines kx ky Re Im (waves per cell; m)
    #[arg(long, value_name = "FILE", help_heading = help::FILES)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spectrum: Option<PathBuf>,
    /// Table of an isotropic spectrum: lines q C (rad/m, m⁴)
    ///
    /// ⟨h²⟩ = ∫ C d²q; --psd-convention says otherwise. There are no waves outside the table. Phases are random
    /// (--seed).
    #[arg(long, value_name = "FILE", help_heading = help::FILES)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub psd: Option<PathBuf>,
    /// plain: ⟨h²⟩ = ∫ C d²q; fourier: ⟨h²⟩ = ∫ C d²q/4π² [default: plain]
    #[arg(long, value_name = "NAME", help_heading = help::FILES, hide_possible_values = true, hide_short_help = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub psd_convention: Option<PsdConvention>,
    /// Random twin of a map, or of a profile: lines x z
    ///
    /// A twin of a map has its spectrum and heights, and a twin of a profile its spectrum. FILE is a height map, a
    /// folder of rc surface or rc prepare with one, or a text of two columns. The twin has the size and the grid of the
    /// map, unless --cell and --grid say otherwise. --seed gives another twin.
    #[arg(long, value_name = "FILE", help_heading = help::FILES)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub like: Option<PathBuf>,
    /// Heights of a twin: those of the map, or gaussian [default: map]
    #[arg(long, value_name = "NAME", help_heading = help::FILES, hide_possible_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub heights_like: Option<HeightsLike>,
    /// Unit of a file that names none: m, cm, mm, um, nm, pm [default: m]
    ///
    /// Or angstrom.
    #[arg(long, value_name = "UNIT", help_heading = help::FILES)]
    pub unit: Option<LengthUnit>,
    /// Unit of heights, where it differs from --unit
    #[arg(long, value_name = "UNIT", help_heading = help::FILES)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height_unit: Option<LengthUnit>,
    /// Height (m) of the value 1 in a file without a unit; overrides --unit
    ///
    /// In an image, 1 is one level of grey.
    #[arg(long, value_name = "M", help_heading = help::FILES, value_parser = length::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "length::read")]
    pub height_scale: Option<f64>,
    /// Values of missing points, in the numbers of the file: -9999,1e30
    #[arg(long, value_name = "VALUES", help_heading = help::FILES, allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub missing: Option<Marks>,
    /// Masked points of a .gwy: use (missing) or ignore [default: use]
    #[arg(long, value_name = "use|ignore", help_heading = help::FILES, hide_short_help = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mask: Option<Mask>,
    /// Channel of a file with several [default: the first with heights]
    ///
    /// rc inspect lists the channels of a file.
    #[arg(long, value_name = "NAME", help_heading = help::FILES)]
    pub channel: Option<String>,
    /// Lines of an ambiguous text: rows (matrix) or points (xyz)
    #[arg(long, value_name = "matrix|xyz", help_heading = help::FILES)]
    pub layout: Option<Layout>,
    /// N of a random surface: shortest wavelength = cell side / N [default: 64]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub waves: Option<usize>,
    /// Hurst exponent H [default: 0.8]
    #[arg(long, value_name = "H", allow_hyphen_values = true)]
    pub hurst: Option<f64>,
    /// Rms height (m) [default: 13e-6]
    #[arg(long, value_name = "M", value_parser = length::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "length::read")]
    pub rms: Option<f64>,
    /// Rms slope, instead of --rms
    #[arg(long, value_name = "SLOPE", help_heading = help::RANDOM, allow_hyphen_values = true)]
    pub rms_slope: Option<f64>,
    /// C0 of Eq. 9 (m⁴), instead of --rms
    #[arg(long, value_name = "C0", help_heading = help::RANDOM, allow_hyphen_values = true)]
    pub c0: Option<f64>,
    /// Seed of the random phases [default: 1]
    #[arg(long, value_name = "SEED", allow_hyphen_values = true)]
    pub seed: Option<u64>,
    /// disc: waves with |k| ≤ N; square: with |kx| and |ky| ≤ N [default: disc]
    #[arg(long, value_name = "NAME", help_heading = help::RANDOM, value_parser = truncations(), hide_possible_values = true)]
    pub truncation: Option<Truncation>,
    /// Flat spectrum below this number of waves per cell [default: 1]
    #[arg(long, value_name = "N", help_heading = help::RANDOM, allow_hyphen_values = true)]
    pub roll_off: Option<f64>,
    /// No waves below this number of waves per cell [default: 1]
    #[arg(long, hide_short_help = true, value_name = "N", help_heading = help::RANDOM, allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub low_cut: Option<f64>,
    /// fixed: those of the spectrum (Eq. 14); random: Gaussian [default: fixed]
    #[arg(long, value_name = "NAME", help_heading = help::RANDOM, value_parser = amplitudes(), hide_possible_values = true)]
    pub amplitudes: Option<Amplitudes>,
    /// Alone or added: sphere, cylinder (--radius), cone (--angle), flat, wave (--wavelength, --wave-amplitude)
    ///
    /// The highest point is at the centre of the cell. The sphere is the paraboloid -r²/2R, the cylinder -x²/2R with
    /// its axis along y. A wave is along x.
    #[arg(long, value_name = "NAME", hide_possible_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<FormName>,
    /// Radius R of the sphere or cylinder (m)
    #[arg(long, hide_short_help = true, value_name = "M", value_parser = length::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "length::read", skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Angle of the cone's flank to the plane (degrees)
    #[arg(long, hide_short_help = true, value_name = "DEG", value_parser = angle::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "angle::read", skip_serializing_if = "Option::is_none")]
    pub angle: Option<f64>,
    /// Wavelength of the wave (m)
    #[arg(long, hide_short_help = true, value_name = "M", value_parser = length::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "length::read", skip_serializing_if = "Option::is_none")]
    pub wavelength: Option<f64>,
    /// Amplitude of the wave (m), half of its range
    #[arg(long, hide_short_help = true, value_name = "M", value_parser = length::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "length::read", skip_serializing_if = "Option::is_none")]
    pub wave_amplitude: Option<f64>,
    /// Height map of the other body, mirrored along x and added
    ///
    /// Both maps are positive towards the other body, and have the same grid and cell. The flags for files are for both.
    #[arg(long, value_name = "FILE")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub add: Option<PathBuf>,
    /// Elements per side, 512 or 512x256 [default: the map's; 32 per shortest wave]
    ///
    /// 512x256 is 512 along x and 256 along y.
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub grid: Option<GridSpec>,
    /// Memory that reading a file may take. It is that of the run.
    #[arg(skip)]
    #[serde(skip)]
    pub read_limit: Option<ByteSize>,
}

/// The elastic half-space, the load, and how the problem is solved.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[command(next_help_heading = help::CONTACT)]
pub struct ContactKeys {
    /// Young's modulus (Pa) [default, random surface: 0.4e9]
    #[arg(long, value_name = "PA", value_parser = pressure::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "pressure::read")]
    pub young: Option<f64>,
    /// Poisson's ratio [default, random surface: 0.45]
    #[arg(long, value_name = "NU", allow_hyphen_values = true)]
    pub poisson: Option<f64>,
    /// E* = E/(1-ν²) (Pa), instead of --young and --poisson
    #[arg(long, value_name = "PA", value_parser = pressure::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "pressure::read")]
    pub e_star: Option<f64>,
    /// Young's modulus of the other body (Pa) [default: it is rigid]
    ///
    /// It needs --poisson2 too. 1/E* is the sum of (1-ν²)/E of both bodies.
    #[arg(long, value_name = "PA", help_heading = help::PHYSICS, value_parser = pressure::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "pressure::read", skip_serializing_if = "Option::is_none")]
    pub young2: Option<f64>,
    /// Poisson's ratio of the other body
    #[arg(long, hide_short_help = true, value_name = "NU", help_heading = help::PHYSICS, allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub poisson2: Option<f64>,
    /// Mean pressure σ0 (Pa)
    #[arg(long, value_name = "PA", value_parser = pressure::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "pressure::read")]
    pub pressure: Option<f64>,
    /// Penetration Δ (m), instead of --pressure
    #[arg(long, value_name = "M", value_parser = length::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "length::read")]
    pub penetration: Option<f64>,
    /// Force (N), instead of --pressure: mean pressure times area of the cell
    #[arg(long, value_name = "N", value_parser = force::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "force::read", skip_serializing_if = "Option::is_none")]
    pub force: Option<f64>,
    /// Plastic contact: no pressure above this hardness (Pa)
    ///
    /// It is the usual first model of plastic contact. Without a hardness the contact is elastic.
    #[arg(long, value_name = "PA", help_heading = help::PHYSICS, value_parser = pressure::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "pressure::read", skip_serializing_if = "Option::is_none")]
    pub hardness: Option<f64>,
    /// Loads one after the other (Pa), such as 1e7,0: what flow leaves
    ///
    /// Instead of --pressure, with --hardness. Each mean pressure finds the surface that plastic flow under those before
    /// it has left. 0 unloads. The results are those of the last one above 0; residual.npy is the unloaded surface after
    /// the last.
    #[arg(long, value_name = "P1,P2", help_heading = help::PHYSICS, allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub history: Option<HistorySpec>,
    /// Reach each higher load of --history in N equal steps, and compare with one
    ///
    /// Plastic flow depends on the path. path_difference of the summary is what the steps change.
    #[arg(long, value_name = "N", help_heading = help::PHYSICS, hide_short_help = true, allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub history_steps: Option<usize>,
    /// Pressure of a fluid (Pa) on the grid, .npy or text: none is below it
    ///
    /// One value for each element. The surfaces touch where the pressure exceeds it. The load is that of both; pressures
    /// of the results are those of the contact alone, without the fluid.
    #[arg(long, value_name = "FILE", help_heading = help::PHYSICS)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fluid_pressure: Option<PathBuf>,
    /// Speed (m/s) of sliding over a solid that relaxes: adds friction
    ///
    /// Steady sliding along +x, or along --direction. The moduli of the solid are the relaxed ones.
    #[arg(long, value_name = "M/S", help_heading = help::PHYSICS, value_parser = speed::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "speed::read", skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// Direction of the speed (degrees): 0 is along +x, 90 along +y [default: 0]
    #[arg(long, value_name = "DEG", help_heading = help::PHYSICS, hide_short_help = true, value_parser = angle::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "angle::read", skip_serializing_if = "Option::is_none")]
    pub direction: Option<f64>,
    /// Solid that relaxes: lines g tau (relative to the modulus; s)
    ///
    /// A Prony series, E(t) = E (1 + sum g exp(-t/tau)). Under the title E, moduli are in Pa; titles may give other
    /// units, such as E (MPa).
    #[arg(long, value_name = "FILE", help_heading = help::PHYSICS)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub prony: Option<PronySpec>,
    /// Instead of --prony: ratio of the glassy to the relaxed modulus
    #[arg(long, value_name = "RATIO", help_heading = help::PHYSICS, hide_short_help = true, allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub glassy_ratio: Option<f64>,
    /// Relaxation time (s), with --glassy-ratio
    #[arg(long, value_name = "S", help_heading = help::PHYSICS, hide_short_help = true, value_parser = time::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "time::read", skip_serializing_if = "Option::is_none")]
    pub relaxation_time: Option<f64>,
    /// Instead of --prony: a fractional Zener solid, such as 0.2,10,1e-3
    ///
    /// Exponent alpha, ratio of the glassy to the relaxed modulus, relaxation time (s). In scenes also
    /// { alpha = 0.2, glassy_ratio = 10, tau = 1e-3 }.
    #[arg(long, value_name = "ALPHA,RATIO,S", help_heading = help::PHYSICS, hide_short_help = true, allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fractional: Option<FractionalSpec>,
    /// Coulomb's coefficient of a shear with partial slip, after the normal solve
    ///
    /// It needs --shear-pressure or --shear-displacement.
    #[arg(long, value_name = "MU", help_heading = help::PHYSICS, allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    /// Shear force per nominal area (Pa), with --friction: slip, stick, tractions
    #[arg(long, value_name = "PA", help_heading = help::PHYSICS, value_parser = pressure::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "pressure::read", skip_serializing_if = "Option::is_none")]
    pub shear_pressure: Option<f64>,
    /// Tangential displacement (m) of the rough surface, instead of --shear-pressure
    #[arg(long, value_name = "M", help_heading = help::PHYSICS, hide_short_help = true, value_parser = length::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "length::read", skip_serializing_if = "Option::is_none")]
    pub shear_displacement: Option<f64>,
    /// Direction of the shear (degrees): 0 is along +x, 90 along +y [default: 0]
    #[arg(long, value_name = "DEG", help_heading = help::PHYSICS, hide_short_help = true, value_parser = angle::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "angle::read", skip_serializing_if = "Option::is_none")]
    pub shear_angle: Option<f64>,
    /// Neglect that unlike bodies couple pressure and shear
    ///
    /// Without it, a Poisson's ratio above 0 is refused unless the bodies are alike, or one is rigid and the other
    /// incompressible.
    #[arg(long, help_heading = help::PHYSICS, hide_short_help = true)]
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub uncoupled: bool,
    /// Conductivities of both bodies, such as 400,50: adds the conductance
    ///
    /// Electrical (S/m) or thermal (W/(m K)). One value stands for both bodies.
    #[arg(long, value_name = "K1[,K2]", help_heading = help::PHYSICS, allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub conductivity: Option<Conductivity>,
    /// Jump distance m (m) of a gas in the gap g: adds the mean of 1/(g + m)
    ///
    /// Its product with the conductivity of the gas is the conductance of the gas.
    #[arg(long, value_name = "M", help_heading = help::PHYSICS, hide_short_help = true, value_parser = length::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "length::read", skip_serializing_if = "Option::is_none")]
    pub jump_distance: Option<f64>,
    /// love (the paper's loaded square) or spectral [default: love]
    ///
    /// love: pressure constant on each element, displacement at its centre (Eq. 5). spectral: the symbol 2/(E* q), as
    /// FFT codes have it.
    #[arg(long, value_name = "NAME", help_heading = help::MACHINE, hide_possible_values = true)]
    pub kernel: Option<KernelName>,
    /// periodic, or free: a patch on a half-space [default: periodic]
    ///
    /// periodic: the heights repeat. free: beyond the heights, nothing presses on the half-space.
    #[arg(long, value_name = "NAME", help_heading = help::PHYSICS, value_parser = boundaries(), hide_possible_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub boundary: Option<Boundary>,
    /// Layer or coating of this thickness (m), bonded to a rigid base
    #[arg(long, value_name = "M", help_heading = help::PHYSICS, value_parser = length::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "length::read", skip_serializing_if = "Option::is_none")]
    pub layer_thickness: Option<f64>,
    /// Poisson's ratio of the layer [default: --poisson]
    #[arg(long, hide_short_help = true, value_name = "NU", help_heading = help::PHYSICS, allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub layer_poisson: Option<f64>,
    /// Elastic substrate below the layer, instead of a rigid base: Young's modulus (Pa)
    #[arg(long, hide_short_help = true, value_name = "PA", help_heading = help::PHYSICS, value_parser = pressure::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "pressure::read", skip_serializing_if = "Option::is_none")]
    pub substrate_young: Option<f64>,
    /// Poisson's ratio of the substrate
    #[arg(long, hide_short_help = true, value_name = "NU", help_heading = help::PHYSICS, allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub substrate_poisson: Option<f64>,
    /// adaptive, uniform or gauss-seidel [default: cheaper of the first two]
    ///
    /// adaptive: on elements that follow the contact; work and memory grow with the contact area (kernel love, square
    /// elements). uniform: FFT on the whole grid. gauss-seidel: the procedure of the paper. The default follows from
    /// the estimated contact area; the summary gives the reason. A method that is named is used as given.
    #[arg(long, value_name = "NAME", help_heading = help::MACHINE, value_parser = methods(), hide_possible_values = true)]
    pub method: Option<Method>,
    /// Times to halve elements at edges of contacts, beyond --grid (adaptive)
    ///
    /// For generated surfaces.
    #[arg(long, value_name = "N", help_heading = help::MACHINE, allow_hyphen_values = true)]
    pub border_level: Option<usize>,
    /// Certified relative energy error of the pressure [default: 0.01]
    ///
    /// In contrast to --tolerance, it stays as strict with deep pits, offset heights and light loads.
    #[arg(long, value_name = "ERROR", help_heading = help::ACCURACY, allow_hyphen_values = true)]
    pub energy_tolerance: Option<f64>,
    /// Instead: overlap relative to the peak-to-valley height, or auto
    ///
    /// Other programs have a tolerance relative to the height. auto is an energy error well below the error of the
    /// grid.
    #[arg(long, value_name = "ERROR", help_heading = help::ACCURACY, allow_hyphen_values = true)]
    pub tolerance: Option<ToleranceSpec>,
    /// Wanted relative error of the contact area, such as 0.5%: sets the grid
    ///
    /// The grid is no finer than needed. The tolerance is auto, unless it is given. For random surfaces, instead of
    /// --grid.
    #[arg(long, value_name = "ERROR", help_heading = help::ACCURACY, allow_hyphen_values = true)]
    pub area_error: Option<Fraction>,
    /// Flow through the gap: permeance, percolation, critical constriction
    #[arg(long, help_heading = help::PHYSICS)]
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub leakage: bool,
    /// Viscosity (Pa s) of the film, with --pressure-drop: adds the flow in m³/s
    #[arg(long, value_name = "PAS", help_heading = help::PHYSICS, hide_short_help = true, value_parser = viscosity::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "viscosity::read", skip_serializing_if = "Option::is_none")]
    pub viscosity: Option<f64>,
    /// Pressure (Pa) that drives the flow across the cell
    #[arg(long, value_name = "PA", help_heading = help::PHYSICS, hide_short_help = true, value_parser = pressure::parse, allow_hyphen_values = true)]
    #[serde(default, deserialize_with = "pressure::read", skip_serializing_if = "Option::is_none")]
    pub pressure_drop: Option<f64>,
    /// Average pressure and gap to this many elements per side in the files
    #[arg(long, value_name = "N", help_heading = help::RESULTS, display_order = 100, allow_hyphen_values = true)]
    pub output_grid: Option<GridSpec>,
    /// single or double numbers in the files of fields [default: double]
    ///
    /// single: half the size, with relative errors of 6e-8. Results are computed in double precision.
    #[arg(long, value_name = "NAME", help_heading = help::RESULTS, display_order = 100, hide_short_help = true, hide_possible_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub precision: Option<FilePrecision>,
    /// Write elements.csv: the elements of the adaptive mesh
    ///
    /// Centre (m), size (m) and pressure (Pa). rc export --vtk draws them.
    #[arg(long, help_heading = help::RESULTS, display_order = 100, hide_short_help = true)]
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub elements: bool,
}

/// How the command runs, and where its results go.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[command(next_help_heading = help::RESULTS)]
pub struct RunKeys {
    /// Folder for the results; without it nothing is written
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Worker threads; results do not depend on it [default: all cores]
    #[arg(long, value_name = "N", help_heading = help::MACHINE, allow_hyphen_values = true)]
    pub threads: Option<usize>,
    /// Refuse what is estimated to need more: 500MB, 2GB, or bytes
    ///
    /// The program itself, about 10 MB, is not counted.
    #[arg(long, value_name = "SIZE", help_heading = help::MACHINE, allow_hyphen_values = true)]
    pub memory_limit: Option<ByteSize>,
    /// Stop the command after this time, with what there is: 90s, 5min, 1h
    ///
    /// A solve that takes longer is marked not_converged. A sweep begins no further row.
    #[arg(long, value_name = "TIME", help_heading = help::MACHINE, allow_hyphen_values = true)]
    pub time_limit: Option<TimeLimit>,
    /// Print only errors, and what --json asks for
    #[arg(long)]
    #[serde(default)]
    pub quiet: bool,
    /// A warning is an error: exit code 2
    ///
    /// What is known before the solve ends the command before it. A warning that only the solution shows leaves the
    /// results written.
    #[arg(long)]
    #[serde(default)]
    pub strict: bool,
    /// Print the results as JSON, also with --quiet
    #[arg(long)]
    #[serde(default)]
    pub json: bool,
}

/// Discretisation of the half-space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum KernelName {
    /// Pressure constant on each element, displacement at its centre (Eq. 5).
    Love,
    /// The symbol 2/(E* q), as FFT codes have it.
    Spectral,
    /// A symbol that a Python program gives; only that program can repeat the result.
    #[value(skip)]
    Own,
}

/// A scene: the three groups of keys.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// The rough surface.
    pub surface: SurfaceKeys,
    /// Half-space, load, method.
    pub contact: ContactKeys,
    /// Run and output.
    pub run: RunKeys,
}

// By hand, for the order of headings.
impl Args for Scene {
    fn augment_args(command: Command) -> Command {
        let keys = RunKeys::augment_args(ContactKeys::augment_args(SurfaceKeys::augment_args(Command::new("keys"))));
        help::add_by_heading(command, &keys)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for Scene {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        Ok(Self {
            surface: SurfaceKeys::from_arg_matches(matches)?,
            contact: ContactKeys::from_arg_matches(matches)?,
            run: RunKeys::from_arg_matches(matches)?,
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        self.surface.update_from_arg_matches(matches)?;
        self.contact.update_from_arg_matches(matches)?;
        self.run.update_from_arg_matches(matches)
    }
}

impl ContactKeys {
    /// Number of keys that give the load.
    #[must_use]
    pub fn n_loads(&self) -> usize {
        [self.pressure, self.penetration, self.force].iter().flatten().count() + usize::from(self.history.is_some())
    }
}

impl Scene {
    /// Whether the scene has no key at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// The scene with its relative paths taken from `folder`.
    #[must_use]
    pub fn relative_to(mut self, folder: &Path) -> Self {
        let SurfaceKeys { heights, spectrum, psd, like, add, .. } = &mut self.surface;
        let prony = self.contact.prony.as_mut().and_then(PronySpec::path);
        let others = [&mut self.contact.fluid_pressure, &mut self.run.out];
        for path in [heights, spectrum, psd, like, add].into_iter().chain(others).flatten().chain(prony) {
            *path = folder.join(&*path);
        }
        self
    }
}

mod over;
mod surface;

#[cfg(test)]
mod tests;
