//! What goes with what: the table of features, methods and bodies.
//!
//! Every refusal of a combination comes from this table: those of the solver, the command line, Python and `rc-mpi`.
//! The guide's table (`docs/mesh-and-tolerance.md`) is [`markdown`]; `cargo xtask tidy` compares them.
//!
//! A new body, constraint or output is one row: a variant of [`Feature`] and its line in [`ROWS`], in the same order.
//! A line says for each method whether it takes the feature, or why not. If two features exclude each other whatever
//! the method, that is one line in `PAIRS`. Whoever sees the feature lists it: `solve/features.rs` for problems,
//! `rc-cli/src/scene/features.rs` for keys. The test `plans_are_refused_exactly_as_the_table_says` plans all
//! combinations.

use std::fmt;

use thiserror::Error;

use crate::problem::method::Method;

/// A property of a problem that some method or some other feature may exclude.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Feature {
    /// The kernel `spectral`.
    Spectral,
    /// Any [`rc_core::Kernel`] without a split by scale.
    OwnKernel,
    /// A kernel whose split by scale is that of another solid than the half-space.
    OtherSolid,
    /// A kernel that a function of a program gives, for one periodic grid.
    KernelFunction,
    /// An [`rc_core::Operator`] of the caller.
    OwnOperator,
    /// An elastic layer.
    Layer,
    /// An elastic layer on an elastic substrate.
    Coating,
    /// A patch with free borders.
    FreeBorders,
    /// A given penetration.
    Penetration,
    /// A hardness.
    Hardness,
    /// Several loads one after the other, with the plastic flow of each.
    History,
    /// The pressure of a fluid, which that of the contact exceeds.
    FluidPressure,
    /// A flat surface.
    Flat,
    /// Heights that are known only on a grid.
    HeightMap,
    /// A grid that is not n × n elements on a square cell.
    OblongGrid,
    /// Elements that are not squares.
    OblongElements,
    /// A grid that has not 2^k times the elements of its base grid along both sides.
    UnevenGrid,
    /// Smaller elements at the edges of contacts.
    BorderLevel,
    /// A wanted error of the contact area.
    AreaError,
    /// A grid of one row: the line contact of a profile, in plane strain.
    Line,
    /// The flow through the gap.
    Leakage,
    /// Several processes or threads that share the solve.
    Ranks,
    /// A file from which a solve continues.
    Checkpoint,
    /// A surface that slides over a material that relaxes.
    Sliding,
    /// A sliding surface whose lag has no adaptive form: not along x, without relaxation times, or on an uneven grid.
    LagOnGrid,
    /// Friction with partial slip under a shear force.
    Shear,
    /// Derivatives with respect to the heights.
    Gradient,
    /// Many loads or surfaces.
    Sweep,
    /// A picture while the solve runs.
    Watch,
    /// An estimate of the cost, without a solve.
    DryRun,
}

use Feature::{
    AreaError, BorderLevel, Checkpoint, Coating, DryRun, Flat, FluidPressure, FreeBorders, Gradient, Hardness,
    HeightMap, History, KernelFunction, LagOnGrid, Layer, Leakage, Line, OblongElements, OblongGrid, OtherSolid,
    OwnKernel, OwnOperator, Penetration, Ranks, Shear, Sliding, Spectral, Sweep, UnevenGrid, Watch,
};

/// Why a method does not take a feature; `None` if it does.
type Not = Option<&'static str>;

/// A feature, its key in scenes, its name, and what the methods of [`METHODS`] say to it.
type Row = (Feature, &'static str, &'static str, [Not; 3]);

/// The columns of the table.
const METHODS: [Method; 3] = [Method::Adaptive, Method::Uniform, Method::GaussSeidel];

const ALL: [Not; 3] = [None; 3];
const NO_FORM: Not = Some("a kernel without a split by scale has no adaptive form");
const SPECTRAL: Not = Some("the kernel spectral has no adaptive form");
const OPERATOR: Not = Some("the operator is the caller's");
const SQUARE: Not = Some("the adaptive method needs square elements");
const OF_LOVE: Not = Some("it needs the coefficients of the kernel love on the half-space");
const HALVES: Not = Some("only the adaptive method halves elements at the edges of contacts");
const OF_MAPS: Not = Some("its mesh divides the area of a map, and a profile has none");
const NO_TAILS: Not =
    Some("it needs a series of relaxation times, a velocity along x, and a grid that can be halved several times");
const SYMMETRIC: Not = Some("its procedure needs a symmetric operator");
const NORMAL: Not = Some("its coefficients are those of normal pressures");
const DIVIDED: Not = Some("only the adaptive method runs on several ranks");

const TANGENTIAL: &str = "its response to tangential tractions is not known";

/// The rows of the table.
const ROWS: [Row; 30] = [
    (Spectral, "kernel", "the kernel spectral", [SPECTRAL, None, OF_LOVE]),
    (OwnKernel, "kernel", "a kernel without a split by scale", [NO_FORM, None, OF_LOVE]),
    (OtherSolid, "kernel", "another solid with a split by scale", [None, None, OF_LOVE]),
    (KernelFunction, "kernel", "a function as kernel", [NO_FORM, None, OF_LOVE]),
    (OwnOperator, "operator", "an operator of the caller", [OPERATOR, None, OPERATOR]),
    (Layer, "layer_thickness", "an elastic layer", [None, None, OF_LOVE]),
    (Coating, "substrate_young", "a coating on an elastic substrate", [None, None, OF_LOVE]),
    (FreeBorders, "boundary", "free borders", [None, None, Some("it solves on a periodic cell only")]),
    (Penetration, "penetration", "a given penetration", ALL),
    (Hardness, "hardness", "a hardness", [None, None, Some("its pressures have no upper bound")]),
    (History, "history", "a history of loads", [None, None, Some("its pressures have no upper bound")]),
    (FluidPressure, "fluid_pressure", "the pressure of a fluid", ALL),
    (Flat, "heights", "a flat surface", [Some("a flat surface needs no adaptive mesh"), None, None]),
    (HeightMap, "heights", "a height map", ALL),
    (
        OblongGrid,
        "grid",
        "a rectangular grid or cell",
        [None, None, Some("its mesh needs square elements in a square cell")],
    ),
    (OblongElements, "grid", "elements that are not square", [SQUARE, None, Some("its elements are squares")]),
    (UnevenGrid, "grid", "a grid that cannot be halved several times", ALL),
    (BorderLevel, "border_level", "a border level", [None, HALVES, HALVES]),
    (AreaError, "area_error", "a wanted error of the area", ALL),
    (Line, "line", "the line contact of a profile", [OF_MAPS, None, OF_MAPS]),
    (Leakage, "leakage", "the flow through the gap", ALL),
    (Ranks, "ranks", "several ranks", [None, DIVIDED, DIVIDED]),
    (Checkpoint, "checkpoint", "a checkpoint", ALL),
    (Sliding, "speed", "a sliding surface", [None, None, SYMMETRIC]),
    (LagOnGrid, "speed", "a lag that only whole grids have", [NO_TAILS, None, SYMMETRIC]),
    (Shear, "friction", "friction with partial slip", [None, None, NORMAL]),
    (Gradient, "gradient", "a gradient", [None, None, Some("its elements are of several sizes")]),
    (Sweep, "sweep", "a sweep", ALL),
    (Watch, "watch", "a picture while it is solved", ALL),
    (DryRun, "dry_run", "a dry run", ALL),
];

/// Features that exclude each other with every method. The message names the key of the first.
const PAIRS: [(Feature, Feature, &str); 62] = [
    (Spectral, FreeBorders, "its waves are periodic"),
    (FreeBorders, KernelFunction, "the function describes a periodic cell"),
    (FreeBorders, Layer, "the response of a layer is known in a periodic cell only"),
    (Layer, KernelFunction, "the function already describes the solid"),
    (Hardness, OwnOperator, "its pressures have no upper bound"),
    (History, Penetration, "its loads are pressures"),
    (History, Sliding, "plastic flow is of a contact at rest"),
    (History, BorderLevel, "plastic flow is known on the elements of the grid only"),
    (History, AreaError, "its loads follow each other on one grid (give grid instead)"),
    (History, Checkpoint, "it is of one load only"),
    (History, Sweep, "the rows of a sweep are independent of each other"),
    (
        BorderLevel,
        HeightMap,
        "between the points of a map in a rectangular cell there are no heights (those of a square map are bicubic)",
    ),
    (
        FluidPressure,
        Hardness,
        "the pressure that the fluid leaves to the contact would be limited differently at each point",
    ),
    (FluidPressure, BorderLevel, "it is known on the elements of the grid only"),
    (FluidPressure, AreaError, "it is known on one grid only (give grid instead)"),
    (FluidPressure, Ranks, "it is not divided among ranks"),
    (FluidPressure, Checkpoint, "the file would not notice another fluid"),
    (FluidPressure, Sliding, "its viscous friction is not modelled"),
    (FluidPressure, Shear, "friction under a fluid is not modelled"),
    (FluidPressure, Gradient, "derivatives of the heights that it leaves are not known"),
    (FluidPressure, Sweep, "it belongs to one surface and load"),
    (BorderLevel, OblongGrid, "it divides square grids only"),
    (BorderLevel, UnevenGrid, "it needs a small number times a large power of 2, such as 1024 or 1536 elements"),
    (AreaError, HeightMap, "a map has its own grid, which cannot be chosen"),
    (AreaError, OblongGrid, "it chooses square grids only"),
    (AreaError, KernelFunction, "the function is evaluated on one grid only (give grid instead)"),
    (AreaError, Checkpoint, "it solves on several grids (give grid instead)"),
    (AreaError, Sweep, "rc solve chooses a grid for each solve (give grid instead)"),
    (AreaError, DryRun, "its grid is not known before the solve (give grid instead)"),
    (Line, FreeBorders, "a load on a line displaces a half-plane without limit, so the profile is periodic"),
    (Line, Leakage, "each contact of a profile closes the gap along its whole width"),
    (Sliding, FreeBorders, "its waves are periodic"),
    (Sliding, KernelFunction, "the function has no compliance for each alias of a wave"),
    (Sliding, Coating, "only one of its two materials would relax"),
    (Sliding, BorderLevel, "the displacement lags behind elements of one size only"),
    (Sliding, Ranks, "rows of tiles are not divided among ranks"),
    (Shear, OtherSolid, TANGENTIAL),
    (Shear, KernelFunction, TANGENTIAL),
    (Shear, OwnOperator, TANGENTIAL),
    (Shear, Layer, TANGENTIAL),
    (Shear, Coating, TANGENTIAL),
    (Shear, Hardness, "plastic flow under shear is not modelled"),
    (Shear, BorderLevel, "tangential tractions are on elements of one size"),
    (Shear, Sliding, "partial slip ends where the whole surface slides"),
    (Shear, AreaError, "its second contact needs the grid of the first (give grid instead)"),
    (Shear, Ranks, "tangential tractions are not divided among ranks"),
    (Shear, Checkpoint, "it solves two contacts, which would share the file"),
    (Shear, Sweep, "rc shear makes the shear curves of a finished sweep"),
    (Shear, DryRun, "it solves two contacts (omit friction for the cost of each)"),
    (Gradient, FreeBorders, "its linear system is that of a periodic cell"),
    (Gradient, OwnOperator, "the preconditioner of its linear system is that of a kernel"),
    (Gradient, Hardness, "plastic elements are not in its linear system"),
    (Gradient, Sliding, "its linear system must be symmetric"),
    (Gradient, Shear, "derivatives of tractions are not known"),
    (Gradient, BorderLevel, "derivatives are with respect to elements of one size"),
    (Gradient, Ranks, "its linear system is not divided among ranks"),
    (Watch, DryRun, "a dry run has no contact to show"),
    (Watch, Ranks, "no rank has the whole contact while it is solved"),
    (Leakage, Ranks, "the flow is not solved over ranks"),
    (Hardness, Ranks, "plastic elements are not divided among ranks"),
    (BorderLevel, Ranks, "ranks share elements of one size only"),
    (UnevenGrid, Ranks, "ranks share levels of which each halves the next coarser one"),
];

/// A combination that cannot be solved.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{subject} cannot be combined with {}: {because}; {remedy}", .object.name())]
#[non_exhaustive]
pub struct Refusal {
    /// What was asked for.
    pub subject: Subject,
    /// The feature that it excludes.
    pub object: Feature,
    /// The reason.
    pub because: String,
    /// What to give instead.
    pub remedy: String,
}

/// What a refusal is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// A method that was asked for.
    Method(Method),
    /// A feature.
    Feature(Feature),
}

impl Feature {
    fn row(self) -> &'static Row {
        &ROWS[self as usize]
    }

    /// Its key in scene files, or the name of its flag.
    #[must_use]
    pub fn key(self) -> &'static str {
        self.row().1
    }

    /// Its name within a sentence.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.row().2
    }

    /// Why the method does not take the feature; `None` if it does.
    fn excluded_by(self, method: Method) -> Not {
        METHODS.iter().position(|&column| column == method).and_then(|column| self.row().3[column])
    }
}

impl Refusal {
    /// The key of a scene that has to change.
    #[must_use]
    pub fn key(&self) -> &'static str {
        match self.subject {
            Subject::Method(_) => "method",
            Subject::Feature(feature) => feature.key(),
        }
    }

    /// The same refusal with more about its reason.
    #[must_use]
    pub(crate) fn noted(self, note: impl fmt::Display) -> Self {
        Self { because: format!("{} ({note})", self.because), ..self }
    }
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Method(method) => write!(f, "the method {method}"),
            Self::Feature(feature) => f.write_str(feature.name()),
        }
    }
}

/// The reason why a problem with these features cannot be solved by `method`; `None` if it can.
///
/// Without a method, the adaptive or the uniform method must solve it, which are those that are chosen automatically.
#[must_use]
pub fn refusal(features: &[Feature], method: Option<Method>) -> Option<Refusal> {
    let has = |feature: &Feature| features.contains(feature);
    if let Some((one, other, why)) = PAIRS.iter().find(|(one, other, _)| has(one) && has(other)) {
        return Some(excluding(*one, *other, (*why).to_owned()));
    }
    let excluded = |method| features.iter().find_map(|&feature| feature.excluded_by(method).map(|why| (feature, why)));
    let Some(method) = method else {
        let ((one, why), (other, also)) = (excluded(Method::Adaptive)?, excluded(Method::Uniform)?);
        return Some(excluding(other, one, format!("{why}, and {also}")));
    };
    let (object, why) = excluded(method)?;
    let others: Vec<_> = METHODS.into_iter().filter(|&other| excluded(other).is_none()).map(Method::name).collect();
    let remedy =
        if others.is_empty() { "omit one of the two".to_owned() } else { format!("give {}", others.join(" or ")) };
    Some(Refusal { subject: Subject::Method(method), object, because: why.to_owned(), remedy })
}

fn excluding(subject: Feature, object: Feature, because: String) -> Refusal {
    Refusal { subject: Subject::Feature(subject), object, because, remedy: "omit one of the two".to_owned() }
}

/// The table in Markdown, for the guide.
#[must_use]
pub fn markdown() -> String {
    let head = "| | `adaptive` | `uniform` | `gauss-seidel` | cannot be combined with |\n|---|---|---|---|---|";
    let line = |(feature, _, name, methods): Row| {
        let others = PAIRS.iter().filter_map(|&(one, other, _)| match feature {
            _ if feature == one => Some(other.name()),
            _ if feature == other => Some(one.name()),
            _ => None,
        });
        let methods = methods.map(|not| if not.is_none() { "yes" } else { "no" }).join(" | ");
        format!("| {name} | {methods} | {} |\n", others.collect::<Vec<_>>().join(", "))
    };
    std::iter::once(format!("{head}\n")).chain(ROWS.into_iter().map(line)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_feature_has_its_row_and_its_way_to_be_solved() {
        for (index, (feature, ..)) in ROWS.into_iter().enumerate() {
            assert_eq!(feature as usize, index, "{feature:?} is not in the order of the rows");
            assert_eq!(refusal(&[feature], None), None, "{feature:?} is solved by no method");
        }
    }

    #[test]
    fn a_refusal_says_what_would_be_right() {
        let told = |features: &[Feature], method| refusal(features, method).map(|refusal| refusal.to_string());
        assert_eq!(
            told(&[Hardness], Some(Method::GaussSeidel)).as_deref(),
            Some(
                "the method gauss-seidel cannot be combined with a hardness: its pressures have no upper bound; give adaptive or uniform"
            )
        );
        assert_eq!(
            told(&[OwnKernel, BorderLevel], None).as_deref(),
            Some(
                "a border level cannot be combined with a kernel without a split by scale: a kernel without a split by scale has no adaptive form, and only the adaptive method halves elements at the edges of contacts; omit one of the two"
            )
        );
    }
}
