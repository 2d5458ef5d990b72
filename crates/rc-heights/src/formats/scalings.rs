//! Sizes, units and marks of missing points that stand beside an array, by their usual names.
//!
//! They are attributes of the array, or attributes and short arrays of its group. Names are compared without case and
//! separators, with the letter of an axis and a unit before or behind: `pixel_size_x`, `dx`, `ScanSize`, `spacing
//! (um)`.

use rc_core::Grid;

use super::unit;
use crate::{HeightMap, LengthUnit, Unit};

/// Names of distances of points. Those of the second list need the letter of an axis.
const SPACINGS: [&[&str]; 2] = [
    &[
        "pixelsize",
        "pixelspacing",
        "pixelpitch",
        "spacing",
        "gridspacing",
        "samplespacing",
        "sampling",
        "samplingdistance",
        "pitch",
        "stepsize",
        "lateralresolution",
        "dxy",
        "dxdy",
    ],
    &["d", "delta", "step", "increment", "inc", "scale", "pixel", "pix", "px"],
];

/// Names of sides. Those of the second list need the letter of an axis.
const SIDES: [&[&str]; 2] = [
    &["scansize", "size", "scanrange", "fieldofview", "fov", "extent", "scanlength", "scanarea", "sides"],
    &["real", "l", "length", "range", "side", "width"],
];

/// Names of the height of the value 1.
const HEIGHT_SCALES: [&str; 7] =
    ["zscale", "scalez", "heightscale", "zfactor", "heightfactor", "zscalefactor", "heightscalefactor"];

/// Names of the unit of heights, of the sides, and of both.
const HEIGHT_UNITS: [&str; 5] = ["z", "height", "value", "data", "heights"];
const SIDE_UNITS: [&str; 7] = ["xy", "lateral", "length", "x", "y", "side", "distance"];

/// Names of values of missing points.
const MISSING: [&str; 10] = [
    "nodata",
    "nodatavalue",
    "nodatavals",
    "nodatavalues",
    "missing",
    "missingvalue",
    "badvalue",
    "invalid",
    "invalidvalue",
    "invalidvalues",
];

/// What stands beside an array.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    Numbers(Vec<f64>),
    Text(String),
}

/// Names with what they stand for.
pub(super) type Entries = Vec<(String, Value)>;

/// A length with its unit, if it is named.
type Length = (f64, Option<LengthUnit>);

/// What the entries beside an array say.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Scalings {
    spacing: [Option<Length>; 2],
    sides: [Option<Length>; 2],
    side_unit: Option<LengthUnit>,
    /// Name of the unit of the heights.
    pub(super) height_unit: Option<String>,
    /// Height of the value 1.
    pub(super) height_scale: Option<f64>,
    /// Values of missing points.
    missing: Vec<f64>,
}

/// The axes that a length belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Axes {
    Both,
    One(usize),
}

/// A name in its parts.
struct Name {
    /// Letters and digits, in lower case.
    word: String,
    unit: Option<LengthUnit>,
}

impl Name {
    fn of(name: &str) -> Self {
        let words: Vec<&str> = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
        // The first word is the quantity. `m` alone is a name.
        let unit = words.get(1..).and_then(<[&str]>::last).and_then(|word| unit::length(word));
        let words = if unit.is_some() { &words[..words.len() - 1] } else { &words[..] };
        Self { word: words.concat().to_lowercase(), unit }
    }

    /// Whether the word is one of the names, for all axes, or for one axis.
    fn axis(&self, [both, one]: [&[&str]; 2]) -> Option<Axes> {
        let word = self.word.as_str();
        if both.contains(&word) {
            return Some(Axes::Both);
        }
        let is_named = |rest: &str| both.contains(&rest) || one.contains(&rest);
        let is_of = |letter: char| {
            word.strip_prefix(letter).is_some_and(is_named) || word.strip_suffix(letter).is_some_and(is_named)
        };
        ['x', 'y'].into_iter().position(is_of).map(Axes::One)
    }

    /// The word without `unit` or `units` at its start or end.
    fn of_unit(&self) -> Option<&str> {
        let word = self.word.as_str();
        let ends = ["units", "unit"];
        ends.iter().find_map(|end| word.strip_suffix(end).or_else(|| word.strip_prefix(end)))
    }
}

impl Scalings {
    /// What the attributes of an array say (`own`), and what stands around it (`others`).
    ///
    /// A unit without further words is that of the heights if it is the array's own, and otherwise that of all lengths.
    /// A unit that is called that of heights comes first.
    pub(super) fn of(own: &Entries, others: &Entries) -> Self {
        let mut found = Self::default();
        let entries = own.iter().map(|e| (true, e)).chain(others.iter().map(|e| (false, e)));
        let mut named: Vec<_> = entries.map(|(is_own, (name, value))| (is_own, Name::of(name), value)).collect();
        named.sort_by_key(|(is_own, name, _)| (!is_own, name.of_unit() == Some("")));
        for (is_own, name, value) in named {
            match value {
                Value::Text(text) if name.of_unit().is_some() => {
                    found.unit(name.of_unit().unwrap_or_default(), text, is_own);
                }
                Value::Text(text) => {
                    // As in `10 um`.
                    let (number, unit) = text.trim().split_once(char::is_whitespace).unwrap_or((text.trim(), ""));
                    if let Ok(number) = number.parse() {
                        let unit = unit::length(unit).or(name.unit);
                        found.numbers(&Name { unit, ..name }, &[number]);
                    }
                }
                Value::Numbers(numbers) => found.numbers(&name, numbers),
            }
        }
        found
    }

    fn unit(&mut self, of: &str, text: &str, is_own: bool) {
        let text = text.trim_end_matches('\0').trim();
        let is_side =
            SIDE_UNITS.contains(&of) || Name::of(of).axis(SPACINGS).or_else(|| Name::of(of).axis(SIDES)).is_some();
        if HEIGHT_UNITS.contains(&of) || of.is_empty() {
            self.height_unit.get_or_insert_with(|| text.to_owned());
        }
        if is_side || of.is_empty() && !is_own {
            self.side_unit = self.side_unit.or(unit::length(text));
        }
    }

    fn numbers(&mut self, name: &Name, numbers: &[f64]) {
        if MISSING.contains(&name.word.as_str()) {
            self.missing.extend(numbers);
        } else if let ([scale], true) = (numbers, HEIGHT_SCALES.contains(&name.word.as_str())) {
            self.height_scale = self.height_scale.or(Some(*scale));
            if let Some(unit) = name.unit {
                self.height_unit.get_or_insert_with(|| unit.to_string());
            }
        } else if let Some(axis) = name.axis(SPACINGS) {
            set(&mut self.spacing, axis, numbers, name.unit);
        } else if let Some(axis) = name.axis(SIDES) {
            set(&mut self.sides, axis, numbers, name.unit);
        }
    }

    /// Sides and their unit.
    ///
    /// A distance that is given along x only is that along y too.
    pub(super) fn sides(&self, grid: Grid) -> Option<([f64; 2], Unit)> {
        let n = [grid.nx() as f64, grid.ny() as f64];
        let of_spacing = self.spacing[0].or(self.spacing[1]).map(|_| {
            [0, 1].map(|axis| self.spacing[axis].or(self.spacing[1 - axis]).map(|(step, unit)| (step * n[axis], unit)))
        });
        let whole = match (of_spacing, self.sides) {
            (Some([Some(x), Some(y)]), _) | (_, [Some(x), Some(y)]) => [x, y],
            (_, [Some((x, unit)), None]) => [(x, unit), (x * n[1] / n[0], unit)],
            _ => return None,
        };
        let unit = |axis: usize| whole[axis].1.or(whole[1 - axis].1).or(self.side_unit);
        let sides = [0, 1].map(|axis| whole[axis].0 * unit(axis).map_or(1.0, LengthUnit::metres));
        // A size without a unit may be a number of points.
        let is_count =
            unit(0).is_none() && sides.iter().zip(n).all(|(side, n)| (side - n).abs() < 0.5) && of_spacing.is_none();
        let is_length = sides.iter().all(|side| *side > 0.0 && side.is_finite());
        (is_length && !is_count).then_some((sides, if unit(0).is_some() { Unit::Metre } else { Unit::Unnamed }))
    }

    /// Gives a map its unit of heights and, if its sides have none, that of lengths. Marked points become missing.
    pub(super) fn apply(&self, map: &mut HeightMap) {
        self.mark(map.heights.values_mut());
        let (unit, factor) = self.heights();
        crate::map::scale(map.heights.values_mut(), factor);
        (map.height_unit, map.number) = (unit, factor);
        if let (Some(unit), Some(sides), Unit::Unnamed) = (self.side_unit, &mut map.sides, map.side_unit) {
            crate::map::scale(sides, unit.metres());
            map.side_unit = Unit::Metre;
        }
    }

    /// Unit of the heights and the factor that converts values. The unit may be named by the array itself.
    pub(super) fn heights(&self) -> (Unit, f64) {
        let (unit, factor) = unit::of_values(self.height_unit.as_deref().unwrap_or_default());
        (unit, factor * self.height_scale.filter(|scale| *scale != 0.0 && scale.is_finite()).unwrap_or(1.0))
    }

    /// Makes the points missing that have a mark, which may have more digits than 32 bits.
    #[expect(clippy::float_cmp, reason = "the mark is one value of the stored type")]
    fn mark(&self, values: &mut [f64]) {
        let is_marked = |value: f64| self.missing.iter().any(|mark| value == *mark || value == f64::from(*mark as f32));
        if !self.missing.is_empty() {
            values.iter_mut().filter(|value| is_marked(**value)).for_each(|value| *value = f64::NAN);
        }
    }
}

/// Stores a length for an axis, or one or two lengths for both. The first entry counts.
fn set(lengths: &mut [Option<Length>; 2], axes: Axes, numbers: &[f64], unit: Option<LengthUnit>) {
    let found = match (axes, numbers) {
        (Axes::One(axis), [length]) => [0, 1].map(|i| (i == axis).then_some(*length)),
        (Axes::Both, [length]) => [Some(*length); 2],
        (Axes::Both, [x, y]) => [Some(*x), Some(*y)],
        _ => [None; 2],
    };
    for (to, length) in lengths.iter_mut().zip(found) {
        *to = to.or(length.map(|length| (length, unit)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scalings(own: &[(&str, Value)], others: &[(&str, Value)]) -> Scalings {
        let entries =
            |given: &[(&str, Value)]| given.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect();
        Scalings::of(&entries(own), &entries(others))
    }

    fn number(value: f64) -> Value {
        Value::Numbers(vec![value])
    }

    fn text(value: &str) -> Value {
        Value::Text(value.to_owned())
    }

    #[test]
    fn sizes_have_many_names() {
        type Case = (Vec<(&'static str, Value)>, Option<([f64; 2], Unit)>);
        let grid = Grid::new(10, 20).expect("a grid");
        let (metre, unnamed) = (Unit::Metre, Unit::Unnamed);
        let cases: [Case; 10] = [
            (vec![("pixel_size", number(0.5))], Some(([5.0, 10.0], unnamed))),
            (vec![("pixel_size_um", number(0.5))], Some(([5e-6, 10e-6], metre))),
            (vec![("dx", number(0.5)), ("dy", number(0.25))], Some(([5.0, 5.0], unnamed))),
            (vec![("PixelSizeX", number(0.5)), ("unit", text("um"))], Some(([5e-6, 10e-6], metre))),
            (
                vec![("scan_size", Value::Numbers(vec![4.0, 8.0])), ("scan_size_unit", text("nm"))],
                Some(([4e-9, 8e-9], metre)),
            ),
            (vec![("XReal", number(1e-6)), ("YReal", number(2e-6))], Some(([1e-6, 2e-6], unnamed))),
            (vec![("ScanSize", text("30 um"))], Some(([30e-6, 30e-6], metre))),
            (vec![("size", Value::Numbers(vec![10.0, 20.0]))], None),
            (vec![("spacing", number(-1.0))], None),
            (vec![("temperature", number(1.0))], None),
        ];
        for (given, expected) in cases {
            let found = scalings(&[], &given).sides(grid);
            let is_close = found.zip(expected).is_some_and(|((a, of_a), (b, of_b))| {
                of_a == of_b && a.iter().zip(b).all(|(a, b)| (a / b - 1.0).abs() < 1e-12)
            });
            assert!(is_close || found == expected, "{given:?}: {found:?}");
        }
    }

    #[test]
    fn a_unit_of_an_array_is_that_of_its_heights_only() {
        let grid = Grid::new(10, 10).expect("a grid");
        let entries = [("units", text("nm")), ("dx", number(1e-6))];
        let own = scalings(&entries, &[]);
        assert_eq!(own.heights(), (Unit::Metre, 1e-9));
        assert_eq!(own.sides(grid).map(|(_, unit)| unit), Some(Unit::Unnamed));
        assert_eq!(scalings(&[], &entries).sides(grid).map(|(_, unit)| unit), Some(Unit::Metre));
        let scaled = scalings(&[("z_scale", number(2.0)), ("z_unit", text("um"))], &[]);
        assert_eq!(scaled.heights(), (Unit::Metre, 2e-6));
        let both = scalings(&[], &[("unit", text("um")), ("z_unit", text("nm"))]);
        assert_eq!(both.heights(), (Unit::Metre, 1e-9), "the unit of heights, in any order");
        assert_eq!(scalings(&[("unit", text("V"))], &[]).heights(), (Unit::NotLength, 1.0));
    }

    #[test]
    fn marks_of_missing_points_are_found_in_their_type() {
        let mut values = [1.0, f64::from(-3.4028235e38_f32), -9999.0];
        scalings(&[("NoData", number(-3.4028234663852886e38)), ("no data value", number(-9999.0))], &[])
            .mark(&mut values);
        assert_eq!(values.map(f64::is_nan), [false, true, true]);
    }
}
