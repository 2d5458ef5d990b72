//! Pairs of a number in the archived run and a number in the paper.

/// One line of a table in docs/reproduction.md.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// Block of the row.
    pub(super) figure: &'static str,
    /// Name of the quantity.
    pub(super) what: &'static str,
    /// Name of the paper's value in `data/paper.csv`.
    pub(super) paper: Option<&'static str>,
    /// Table in the archived run. The keys of the line in that table follow.
    pub(super) table: &'static str,
    pub(super) first: &'static str,
    pub(super) waves: &'static str,
    pub(super) in_unit: &'static str,
    /// Row of fig5-summary with the standard deviation of one realisation. It is for paper values of a single map.
    pub(super) one: Option<&'static str>,
    /// Column of the value.
    pub(super) column: &'static str,
    /// Factor of both numbers. Their unit after the multiplication follows.
    pub(super) factor: f64,
    pub(super) unit: &'static str,
    /// Significant digits.
    pub(super) digits: usize,
}

/// A row without unit and paper value.
const fn row(figure: &'static str, what: &'static str, table: &'static str, first: &'static str) -> Row {
    Row {
        figure,
        what,
        paper: None,
        table,
        first,
        waves: "",
        in_unit: "",
        one: None,
        column: "value",
        factor: 1.0,
        unit: "",
        digits: 4,
    }
}

impl Row {
    const fn waves(self, waves: &'static str) -> Self {
        Self { waves, ..self }
    }

    const fn paper(self, name: &'static str) -> Self {
        Self { paper: Some(name), ..self }
    }

    /// The row with a paper value of one realisation.
    ///
    /// It is compared with the scatter of realisations.
    const fn of_one(self, name: &'static str, scatter: &'static str) -> Self {
        Self { paper: Some(name), one: Some(scatter), ..self }
    }

    const fn column(self, column: &'static str) -> Self {
        Self { column, ..self }
    }

    const fn in_unit(self, in_unit: &'static str) -> Self {
        Self { in_unit, ..self }
    }

    const fn digits(self, digits: usize) -> Self {
        Self { digits, ..self }
    }

    const fn shown(self, factor: f64, unit: &'static str) -> Self {
        Self { factor, unit, ..self }
    }
}

pub(super) const FIG5: &str = "fig5-summary";
const FIG7: &str = "fig7-summary";
const FIG8: &str = "fig8-summary";
const CUTOFF: &str = "statements-cutoff";
const CONVERGENCE: &str = "statements-convergence";
const MOMENTS: &str = "statements-moments";

/// All rows, in the order of the document.
pub(super) const ROWS: &[Row] = &[
    row("fig1", "A/A0 of the realisation", "fig1-summary", "contact area"),
    row("fig1", "Δ", "fig1-summary", "penetration").shown(1.0, " µm"),
    row("fig1", "maximum displacement v", "fig1-summary", "greatest displacement").shown(1.0, " µm"),
    row("fig1", "mean displacement", "fig1-summary", "mean displacement").shown(1.0, " µm"),
    row("fig3", "contact fraction", "fig3-summary", "contact fraction").column("at_printed_fraction"),
    row("fig3", "elements, uniform", "fig3-summary", "elements uniform")
        .column("at_printed_fraction")
        .paper("fig3_elements_uniform"),
    row(
        "fig3",
        "elements, adaptive uniform (those in contact, all of the smallest size)",
        "fig3-summary",
        "elements adaptive uniform",
    )
    .column("at_printed_fraction")
    .paper("fig3_elements_adaptive_uniform"),
    row("fig3", "elements, adaptive with one ring", "fig3-summary", "elements adaptive")
        .column("at_printed_fraction")
        .paper("fig3_elements_adaptive"),
    row("fig3", "elements, adaptive with two rings", "fig3-summary", "elements adaptive with two rings")
        .column("at_printed_fraction")
        .paper("fig3_elements_adaptive"),
    row("fig3", "Δ at this contact fraction", "fig3-summary", "penetration")
        .in_unit("um")
        .column("at_printed_fraction")
        .shown(1.0, " µm"),
    row("fig4", "contact radius", "fig4-summary", "contact radius").column("numeric").shown(1e3, " mm"),
    row("fig4", "relative difference of the contact radius from Hertz in the cell", "fig4-summary", "contact radius")
        .column("relative_difference"),
    row("fig4", "load", "fig4-summary", "load").column("numeric").shown(1.0, " N"),
    row("fig4", "relative difference of the load from Hertz in the cell", "fig4-summary", "load")
        .column("relative_difference"),
    row("fig4", "peak pressure", "fig4-summary", "peak pressure").column("numeric").shown(1e-6, " MPa"),
    row("fig4", "relative difference of the peak pressure from Hertz in the cell", "fig4-summary", "peak pressure")
        .column("relative_difference"),
    row("fig5", "A/A0 at σ0/E* = 8.9e-4, N = 64", FIG5, "area fraction").waves("64").of_one("area_fraction_a", SCATTER),
    row("fig5", "A/A0 at σ0/E* = 8.9e-4, N = 128", FIG5, "area fraction")
        .waves("128")
        .of_one("area_fraction_b", SCATTER),
    row("fig5", "A/A0 at σ0/E* = 8.9e-4, mean of 28 realisations, N = 64", FIG5, MORE)
        .waves("64")
        .of_one("area_fraction_a", SCATTER),
    row("fig5", "A/A0 at σ0/E* = 8.9e-4, mean of 28 realisations, N = 128", FIG5, MORE)
        .waves("128")
        .of_one("area_fraction_b", SCATTER),
    row("fig5", "A/A0 at σ0/E* = 8.9e-4, by counting elements, N = 64", FIG5, "area fraction by counting")
        .waves("64")
        .of_one("area_fraction_a", SCATTER),
    row("fig5", "A/A0 at σ0/E* = 8.9e-4, by counting elements, N = 128", FIG5, "area fraction by counting")
        .waves("128")
        .of_one("area_fraction_b", SCATTER),
    row("fig5", "standard deviation of A/A0 of one realisation, N = 64", FIG5, "scatter of the area fraction")
        .waves("64"),
    row("fig5", "standard deviation of A/A0 of one realisation, N = 128", FIG5, "scatter of the area fraction")
        .waves("128"),
    row("fig5", "Persson's A/A0 at σ0/E* = 8.9e-4, N = 64", FIG5, "Persson's area fraction").waves("64"),
    row("fig5", "Persson's A/A0 at σ0/E* = 8.9e-4, N = 128", FIG5, "Persson's area fraction").waves("128"),
    row("fig5", "rms slope, N = 64", FIG5, "rms slope").waves("64"),
    row("fig5", "rms slope, N = 128", FIG5, "rms slope").waves("128"),
    row("fig5", "slope of the fitted line, A/A0 against σ0/E*, N = 64", FIG5, "slope of the line").waves("64"),
    row("fig5", "slope of the fitted line, A/A0 against σ0/E*, N = 128", FIG5, "slope of the line").waves("128"),
    row("fig5", "κ of the fitted line, N = 64", FIG5, "kappa of the line").waves("64"),
    row("fig5", "κ of the fitted line, N = 128", FIG5, "kappa of the line").waves("128"),
    row("fig5", "κ at σ0/E* = 8.9e-4, N = 64", FIG5, KAPPA).waves("64"),
    row("fig5", "κ at σ0/E* = 8.9e-4, N = 128", FIG5, KAPPA).waves("128"),
    row("fig5", "R² of the fitted line (the paper: above 0.9999), N = 64", FIG5, "R squared")
        .waves("64")
        .paper("fig5_r_squared")
        .digits(5),
    row("fig5", "R² of the fitted line (the paper: above 0.9999), N = 128", FIG5, "R squared")
        .waves("128")
        .paper("fig5_r_squared")
        .digits(5),
    row("fig5", "R² of a line up to σ0/E* = 4e-3, N = 64", FIG5, "R squared up to 4e-3").waves("64").digits(5),
    row("fig5", "R² of a line up to σ0/E* = 4e-3, N = 128", FIG5, "R squared up to 4e-3").waves("128").digits(5),
    row("fig5", "ratio of A/A0, N = 128 to N = 64, mean of 28 pairs", FIG5, "ratio of areas")
        .of_one("area_ratio", "scatter of the ratio of areas"),
    row("fig5", "standard deviation of the ratio of one pair", FIG5, "scatter of the ratio of areas"),
    row(
        "fig5",
        "maximum relative difference of A/A0 by the paper's procedure, four small contacts",
        FIG5,
        "greatest relative difference of areas by the paper's procedure",
    ),
    row("fig6", "A/A0, N = 64", "fig6-summary", "area fraction").waves("64").of_one("area_fraction_a", SCATTER),
    row("fig6", "A/A0, N = 128", "fig6-summary", "area fraction").waves("128").of_one("area_fraction_b", SCATTER),
    row("fig6", "contact spots, N = 64", "fig6-summary", "contact spots").waves("64"),
    row("fig6", "contact spots, N = 128", "fig6-summary", "contact spots").waves("128"),
    row("fig7", "h_max over rms height, N = 64", FIG7, "h_max").waves("64"),
    row("fig7", "d log10 σ0 / d(Δ/h_max), N = 64", FIG7, "d log10(load) / d(penetration/h_max) of realisations")
        .waves("64"),
    row("fig7", "d log10 σ0 / d(Δ/h_max), N = 128", FIG7, "d log10(load) / d(penetration/h_max) of realisations")
        .waves("128"),
    row("fig7", "d log10 σ0 / d(Δ/h_max) of the averaged curve (the line drawn), N = 64", FIG7, DRAWN).waves("64"),
    row("fig7", "d log10 σ0 / d(Δ/h_max) of the averaged curve (the line drawn), N = 128", FIG7, DRAWN).waves("128"),
    row("fig7", "R² of the averaged curve, N = 64", FIG7, "R squared of averages").waves("64").digits(5),
    row("fig7", "R² of the averaged curve, N = 128", FIG7, "R squared of averages").waves("128").digits(5),
    row("fig7", "lowest R² of a realisation, N = 64", FIG7, "lowest R squared of realisations").waves("64"),
    row("fig7", "lowest R² of a realisation, N = 128", FIG7, "lowest R squared of realisations").waves("128"),
    row("fig7", "decay length u0/h_rms, N = 64", FIG7, "u0").waves("64"),
    row("fig7", "decay length u0/h_rms, N = 128", FIG7, "u0").waves("128"),
    row("fig7", "Persson's u0/h_rms, γ = 0.40", FIG7, "Persson's u0 for gamma 0.40").waves("64"),
    row("fig7", "Persson's u0/h_rms, γ = 0.45", FIG7, "Persson's u0 for gamma 0.45").waves("64"),
    row(
        "fig7",
        "maximum difference of Δ/h_max between N = 64 and 128",
        FIG7,
        "greatest difference of penetration/h_max between surfaces",
    ),
    row("fig8", "Λ of the fit, N = 64", FIG8, "fitted Lambda").waves("64").shown(1e5, "·10⁻⁵ E*²"),
    row("fig8", "Λ of the fit, N = 128", FIG8, "fitted Lambda").waves("128").shown(1e5, "·10⁻⁵ E*²"),
    row("fig8", "Λ that follows from A/A0, N = 64", FIG8, "Lambda from the area fraction")
        .waves("64")
        .shown(1e5, "·10⁻⁵ E*²"),
    row("fig8", "Λ that follows from A/A0, N = 128", FIG8, "Lambda from the area fraction")
        .waves("128")
        .shown(1e5, "·10⁻⁵ E*²"),
    row(
        "fig8",
        "ratio of the fitted Λ to the theory's, E*² (rms slope)²/8, N = 64",
        FIG8,
        "fitted Lambda over slope^2/8",
    )
    .waves("64"),
    row(
        "fig8",
        "ratio of the fitted Λ to the theory's, E*² (rms slope)²/8, N = 128",
        FIG8,
        "fitted Lambda over slope^2/8",
    )
    .waves("128"),
    row("fig8", "A/A0, N = 64", FIG8, "area fraction").waves("64").of_one("area_fraction_a", SCATTER),
    row("fig8", "∫P dσ, N = 64", FIG8, "integral of P").waves("64").of_one("area_fraction_a", SCATTER),
    row("fig8", "erf(σ0/2√Λ) of the fit, N = 64", FIG8, "erf(load/2 sqrt(Lambda)) of the fit")
        .waves("64")
        .of_one("area_fraction_a", SCATTER),
    row("fig8", "A/A0, N = 128", FIG8, "area fraction").waves("128").of_one("area_fraction_b", SCATTER),
    row("fig8", "∫P dσ, N = 128", FIG8, "integral of P").waves("128").of_one("area_fraction_b", SCATTER),
    row("fig8", "erf(σ0/2√Λ) of the fit, N = 128", FIG8, "erf(load/2 sqrt(Lambda)) of the fit")
        .waves("128")
        .of_one("area_fraction_b", SCATTER),
    row("fig8", "ratio of the first bin (width 2e-4 E*) to the peak of P, N = 64", FIG8, "first bin over peak")
        .waves("64"),
    row("fig8", "ratio of the first bin (width 2e-4 E*) to the peak of P, N = 128", FIG8, "first bin over peak")
        .waves("128"),
    row(
        "fig8",
        "ratio of the first bin to the peak of P, by counting elements, N = 64",
        FIG8,
        "first bin over peak by elements",
    )
    .waves("64"),
    row(
        "fig8",
        "ratio of the first bin to the peak of P, by counting elements, N = 128",
        FIG8,
        "first bin over peak by elements",
    )
    .waves("128"),
    row("fig8", "d log P/d log σ, 0.01 to 0.1 of the peak stress, N = 64", FIG8, SLOPE).waves("64"),
    row("fig8", "d log P/d log σ, 0.01 to 0.1 of the peak stress, N = 128", FIG8, SLOPE).waves("128"),
    row("fig8", "d log P/d log σ, 0.004 to 0.04 of the peak stress, N = 64", FIG8, "slope from 0.004 to 0.04")
        .waves("64"),
    row("fig8", "d log P/d log σ, 0.004 to 0.04 of the peak stress, N = 128", FIG8, "slope from 0.004 to 0.04")
        .waves("128"),
    row(
        "fig8",
        "d log P/d log σ, 0.01 to 0.1 of the peak stress, N = 32, 32 elements per λ_min",
        FIG8,
        "slope from 0.01 to 0.1 with 32 elements per wave",
    ),
    row(
        "fig8",
        "d log P/d log σ by counting elements, N = 32, 32 elements per λ_min",
        FIG8,
        "slope by elements from 0.01 to 0.1 with 32 elements per wave",
    ),
    row(
        "fig8",
        "ratio of the first bin to the peak of P, by counting elements, N = 32, 32 elements per λ_min",
        FIG8,
        "first bin over peak by elements with 32 elements per wave",
    ),
    row(
        "fig8",
        "d log P/d log σ, 0.01 to 0.1 of the peak stress, N = 32, 64 elements per λ_min",
        FIG8,
        "slope from 0.01 to 0.1 with 64 elements per wave",
    ),
    row(
        "fig8",
        "d log P/d log σ by counting elements, N = 32, 64 elements per λ_min",
        FIG8,
        "slope by elements from 0.01 to 0.1 with 64 elements per wave",
    ),
    row(
        "fig8",
        "ratio of the first bin to the peak of P, by counting elements, N = 32, 64 elements per λ_min",
        FIG8,
        "first bin over peak by elements with 64 elements per wave",
    ),
    row(
        "fig8",
        "d log P/d log σ, 0.01 to 0.1 of the peak stress, N = 32, 128 elements per λ_min",
        FIG8,
        "slope from 0.01 to 0.1 with 128 elements per wave",
    ),
    row(
        "fig8",
        "d log P/d log σ by counting elements, N = 32, 128 elements per λ_min",
        FIG8,
        "slope by elements from 0.01 to 0.1 with 128 elements per wave",
    ),
    row(
        "fig8",
        "ratio of the first bin to the peak of P, by counting elements, N = 32, 128 elements per λ_min",
        FIG8,
        "first bin over peak by elements with 128 elements per wave",
    ),
    row("statements", "ratio of the area of N = 16 to that of N = 8", CUTOFF, "16").column("area_over_first"),
    row("statements", "ratio of the area of N = 64 to that of N = 8", CUTOFF, "64").column("area_over_first"),
    row("statements", "ratio of the area of N = 128 to that of N = 8", CUTOFF, "128").column("area_over_first"),
    row("statements", "ratio of the area of N = 256 to that of N = 8", CUTOFF, "256").column("area_over_first"),
    row("statements", "κ, N = 8", CUTOFF, "8").column("kappa"),
    row("statements", "κ, N = 64", CUTOFF, "64").column("kappa"),
    row("statements", "κ, N = 128", CUTOFF, "128").column("kappa"),
    row("statements", "κ, N = 256", CUTOFF, "256").column("kappa"),
    row("statements", "ratio of the elastic energy of N = 16 to that of N = 8", CUTOFF, "16")
        .column("energy_over_first"),
    row("statements", "ratio of the elastic energy of N = 64 to that of N = 8", CUTOFF, "64")
        .column("energy_over_first"),
    row("statements", "ratio of the elastic energy of N = 128 to that of N = 8", CUTOFF, "128")
        .column("energy_over_first"),
    row("statements", "ratio of the elastic energy of N = 256 to that of N = 8", CUTOFF, "256")
        .column("energy_over_first"),
    row("statements", "Δ/h_max, N = 8", CUTOFF, "8").column("penetration_over_h_max"),
    row("statements", "Δ/h_max, N = 64", CUTOFF, "64").column("penetration_over_h_max"),
    row("statements", "Δ/h_max, N = 128", CUTOFF, "128").column("penetration_over_h_max"),
    row("statements", "Δ/h_max, N = 256", CUTOFF, "256").column("penetration_over_h_max"),
    row("statements", "area by counting, relative error, 8 elements per λ_min", CONVERGENCE, "8")
        .column("counting_error")
        .digits(2),
    row("statements", "area by counting, relative error, 16 elements per λ_min", CONVERGENCE, "16")
        .column("counting_error")
        .digits(2),
    row("statements", "area by counting, relative error, 32 elements per λ_min", CONVERGENCE, "32")
        .column("counting_error")
        .digits(2),
    row("statements", "area with edges located, relative error, 8 elements per λ_min", CONVERGENCE, "8")
        .column("area_error")
        .digits(2),
    row("statements", "area with edges located, relative error, 16 elements per λ_min", CONVERGENCE, "16")
        .column("area_error")
        .digits(2),
    row("statements", "area with edges located, relative error, 32 elements per λ_min", CONVERGENCE, "32")
        .column("area_error")
        .digits(2),
    row("statements", "rms pressure, relative error, 8 elements per λ_min", CONVERGENCE, "8")
        .column("rms_pressure_error")
        .digits(2),
    row("statements", "rms pressure, relative error, 16 elements per λ_min", CONVERGENCE, "16")
        .column("rms_pressure_error")
        .digits(2),
    row("statements", "rms pressure, relative error, 32 elements per λ_min", CONVERGENCE, "32")
        .column("rms_pressure_error")
        .digits(2),
    row("statements", "Δ, relative error, 8 elements per λ_min", CONVERGENCE, "8")
        .column("penetration_error")
        .digits(2),
    row("statements", "Δ, relative error, 16 elements per λ_min", CONVERGENCE, "16")
        .column("penetration_error")
        .digits(2),
    row("statements", "Δ, relative error, 32 elements per λ_min", CONVERGENCE, "32")
        .column("penetration_error")
        .digits(2),
    row("statements", "excess kurtosis of heights, 100 realisations", MOMENTS, "excess kurtosis"),
    row("statements", "excess kurtosis of heights over all phases, exact", MOMENTS, "excess kurtosis of all phases"),
    row(
        "statements",
        "fraction of the surface beyond ±2 rms heights (Gaussian: 0.0455)",
        MOMENTS,
        "part beyond 2 rms heights",
    ),
    row(
        "statements",
        "fraction of the surface beyond ±3 rms heights (Gaussian: 0.0027)",
        MOMENTS,
        "part beyond 3 rms heights",
    ),
];

const SCATTER: &str = "scatter of the area fraction";
const MORE: &str = "area fraction of all realisations";
const KAPPA: &str = "kappa at the load of the printed areas";
const DRAWN: &str = "d log10(load) / d(penetration/h_max) of averages";
const SLOPE: &str = "slope from 0.01 to 0.1 of the peak stress";
