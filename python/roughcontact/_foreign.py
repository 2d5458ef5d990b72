"""Arrays of other packages: their units, coordinates and marks, as a file of them would be read."""

from __future__ import annotations

import re
import warnings
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roughcontact import _core

Floats = NDArray[np.float64]
Sides = tuple[float, float]


class InputWarning(UserWarning):
    """Something about the input or its result is in doubt, or was assumed. The text says what, and how to say otherwise.

    ``strict=True`` makes it a ``ValueError``. Those of a result are in :attr:`Result.warnings`.
    """


def tell(doubts: Sequence[str], strict: bool, stacklevel: int = 3) -> None:
    """Warns of each doubt, or raises the first with ``strict``."""
    if strict and doubts:
        raise ValueError(f"{doubts[0]} (an error because of strict=True)")
    for doubt in doubts:
        warnings.warn(doubt, InputWarning, stacklevel=stacklevel)


def of_keywords(text: str) -> str:
    """A message with keywords in place of the flags of the command line, but for those of ``rc surface``."""
    return re.sub(r"(?<!rc surface )--([a-z-]+)", lambda flag: flag[1].replace("-", "_"), text)


class Found(NamedTuple):
    """Heights (m), the size (m) if it is known, and what was assumed of them."""

    heights: Any
    sides: Sides | None = None
    doubts: tuple[str, ...] = ()


def found_in(heights: Any) -> Found:
    """Heights of any package as numbers in metres, with the size that comes along."""
    if _is_dataset(heights):
        heights = _only_map(heights)
    if hasattr(heights, "dims") and hasattr(heights, "coords"):
        return _of_data_array(heights)
    if callable(getattr(heights, "to_numpy", None)) and hasattr(heights, "columns") and hasattr(heights, "index"):
        return _of_table(heights)
    if _has_unit(heights):
        return Found(_in_metres(heights, "heights"))
    return Found(heights)


# Quantities with a unit: pint has `units` and `magnitude`, astropy `unit` and `value`.


_QUANTITIES = (("units", "magnitude"), ("unit", "value"))


def _has_unit(array: Any) -> bool:
    is_quantity = any(all(hasattr(array, name) for name in names) for names in _QUANTITIES)
    return is_quantity and callable(getattr(array, "to", None))


def _in_metres(quantity: Any, what: str) -> Any:
    try:
        converted = quantity.to("m")
    except Exception as cause:  # The errors of these packages have no common type.
        unit = getattr(quantity, "units", getattr(quantity, "unit", ""))
        raise ValueError(f"{what}: '{unit}' is not a unit of length ({cause})") from None
    return converted.magnitude if hasattr(converted, "magnitude") else converted.value


# Arrays of xarray.


def _is_dataset(array: Any) -> bool:
    return hasattr(array, "data_vars") and hasattr(array, "coords")


def _only_map(dataset: Any) -> Any:
    """The only map of a dataset."""
    maps = [name for name, array in dataset.data_vars.items() if sum(n != 1 for n in array.shape) == 2]
    if len(maps) != 1:
        names = ", ".join(map(str, maps)) or "none"
        raise ValueError(f"heights: a Dataset with one map is read as it, but this one has {len(maps)} ({names}); give one of its arrays")
    return dataset[maps[0]]


def _of_data_array(array: Any) -> Found:
    """An array with names, read like the file that it would write."""
    long = [dim for dim, n in zip(array.dims, array.shape, strict=True) if n != 1]
    if len(long) == 2 and array.ndim > 2:
        array = array.squeeze([dim for dim in array.dims if dim not in long], drop=True)
    if array.ndim != 2:
        return Found(array)
    if [str(dim).lower() for dim in array.dims] == ["x", "y"]:
        array = array.transpose(*reversed(array.dims))
    unit = _unit_of(array.attrs)
    if _has_unit(array.data):
        values, factor = np.asarray(_in_metres(array.data, "heights"), np.float64), 1.0
        unit = "m"
    else:
        values, factor = _unmarked(array), _factor("heights", unit)
    if factor != 1.0:
        # Single precision is left before the digits of the unit come in.
        values = np.asarray(values, np.float64) * factor
    axes = [_coordinate(array, axis) for axis in (1, 0)]
    x, y = axes
    if x is None or y is None:
        return Found(values)
    steps = [_step(name, coordinates) for name, coordinates, _ in (x, y)]
    values = values[:: -1 if steps[1] < 0 else 1, :: -1 if steps[0] < 0 else 1]
    # A unit that only one side has applies to both.
    units = [x[2] or y[2], y[2] or x[2]]
    factors = [_factor(f"unit of {name}", given) for name, given in zip("xy", units, strict=True)]
    lengths = [abs(step) * n * factor for step, n, factor in zip(steps, reversed(values.shape), factors, strict=True)]
    doubts: tuple[str, ...] = ()
    if not unit and any(units):
        doubts = ("assumed: the heights have no attribute units, so they are in metres, unlike their coordinates",)
    return Found(values, (float(lengths[0]), float(lengths[1])), doubts)


def _unit_of(attributes: Any) -> str:
    """The unit that attributes name; empty without one."""
    for name in ("units", "unit"):
        if name in attributes:
            return str(attributes[name]).strip()
    return ""


def _factor(what: str, unit: str) -> float:
    """The metres of a unit; 1 without one."""
    if not unit:
        return 1.0
    metres = _core.metres(unit)
    if metres is None:
        raise ValueError(f"{what}: '{unit}' is not a unit of length, as m")
    return metres


#: Attributes with values that mark missing points.
_MARKS = ("_FillValue", "missing_value")


def _unmarked(array: Any) -> Any:
    """The values of an array of xarray, unpacked, with NaN where an attribute says that they are missing."""
    values, attributes = np.asarray(array.data), array.attrs
    marks = [mark for name in _MARKS if name in attributes for mark in np.ravel(attributes[name])]
    packing = [attributes.get("scale_factor"), attributes.get("add_offset")]
    if values.dtype.kind not in "iuf" or not marks and packing == [None, None]:
        return values
    stored, values = values, values.astype(np.float64)
    for mark in marks:
        values[stored == mark] = np.nan
    scale, offset = (one if given is None else float(given) for given, one in zip(packing, (1.0, 0.0), strict=True))
    return values if packing == [None, None] else values * scale + offset


class _Axis(NamedTuple):
    name: str
    values: Floats
    unit: str


def _coordinate(array: Any, axis: int) -> _Axis | None:
    """The coordinates along an axis: those of its dimension if that is not an angle, or those called x or y."""
    dimension, letter = array.dims[axis], "yx"[axis]
    angles = str(dimension).lower().startswith(("lon", "lat"))
    for name in (*(() if angles else (dimension,)), letter, letter.upper()):
        if name not in array.coords:
            continue
        coordinate = array.coords[name]
        values = np.asarray(coordinate.data if not _has_unit(coordinate.data) else _in_metres(coordinate.data, str(name)))
        if values.dtype.kind not in "iuf":
            continue
        unit = "m" if _has_unit(coordinate.data) else _unit_of(coordinate.attrs)
        if values.shape == array.shape and np.allclose(values, values.take([0], 1 - axis), rtol=1e-9, atol=0.0):
            # A mesh: the same along the other axis.
            values = values.take(0, 1 - axis)
        if values.shape == (array.shape[axis],) and values.size > 1:
            return _Axis(letter, values.astype(np.float64), unit)
    return None


#: Maximum deviation of a coordinate from an even spacing, in spacings.
_EVEN = 0.1


def _step(name: str, coordinates: Floats) -> float:
    """The spacing of coordinates, negative where they decrease."""
    step = float(coordinates[-1] - coordinates[0]) / (len(coordinates) - 1)
    if not np.isfinite(step) or step == 0.0:
        raise ValueError(f"{name}: goes from {coordinates[0]:g} to {coordinates[-1]:g}; a grid needs two different finite ends")
    even = coordinates[0] + step * np.arange(len(coordinates))
    off = ~(np.abs(coordinates - even) <= _EVEN * abs(step))
    if off.any():
        i = int(np.argmax(off))
        raise ValueError(
            f"{name}: is not evenly spaced: value {i} (from 0) is {coordinates[i]:g}, and even spacing makes it {even[i]:g}"
        )
    return step


# Tables of pandas.

#: Titles of columns that count lines, as pandas writes an index without a name.
_COUNTS = ("unnamed: 0", "index", "idx", "no", "line", "row")


def _of_table(table: Any) -> Found:
    """A table: points if its columns are x, y and a height, else a row of the map in each row."""
    titles = [str(title).strip().lower() for title in table.columns]
    if titles and titles[0] in _COUNTS and _counts(table.iloc[:, 0].to_numpy()):
        table, titles = table.iloc[:, 1:], titles[1:]
    word = [title.split()[0].split("(")[0].split("[")[0] if title else "" for title in titles]
    if "x" in word and "y" in word:
        others = [i for i, name in enumerate(word) if name not in ("x", "y")]
        named = [i for i in others if word[i] in ("z", "h", "height", "heights")]
        height = named or others
        if len(height) != 1:
            raise ValueError(f"heights: a table of points has columns x, y and z, not {', '.join(titles)}")
        return Found(*of_points(table.iloc[:, [word.index("x"), word.index("y"), height[0]]].to_numpy()))
    return Found(table.to_numpy())


def _counts(values: Any) -> bool:
    """Whether numbers count 0, 1, 2, ... or 1, 2, 3, ..."""
    if values.dtype.kind not in "iuf":
        return False
    return bool((values == np.arange(len(values)) + (1 if len(values) and values[0] == 1 else 0)).all())


# Arrays of points, and profiles.

#: Minimum number of rows of an array of two or three columns that is no map.
_MANY = 16

#: Minimum number of points on a regular grid that are points, even if an array of so few rows may be a map.
_ENOUGH = 9


def of_points(points: Any) -> tuple[Floats, Sides]:
    """The map of points x, y and z (m).

    Raises
    ------
    ValueError
        When they are on no regular grid.
    """
    try:
        values = np.require(np.asarray(points), np.float64, ["C", "A"])
    except (TypeError, ValueError) as cause:
        raise ValueError(f"heights: columns x, y and z must be numbers: {cause}") from None
    try:
        heights, (x, y) = _core.points(values)
    except ValueError as cause:
        shape = " x ".join(map(str, values.shape))
        raise ValueError(
            f"heights: the {shape} array is a list of points x, y, z, not a map, and {str(cause).removeprefix('heights: ')}; "
            "put them on a grid first, or give HeightMap(array, sides) if it is a map of three columns"
        ) from None
    return heights, (x, y)


def checked_shape(array: Floats) -> tuple[Floats, Sides | None]:
    """A map as it is, or that of an array of points. Refuses a profile by its name."""
    rows, columns = array.shape
    if columns == 3 and rows >= _ENOUGH:
        try:
            return of_points(array)
        except ValueError:
            if rows >= _MANY:
                raise
    if columns == 2 and rows >= _MANY:
        raise ValueError(
            f"heights: the {rows} x 2 array is a profile (x and height), not a map; "
            "give an array of shape (ny, nx), or HeightMap(array, sides) if it is a map of two columns"
        )
    return array, None


def refuse_line_scan(topography: Any) -> None:
    """Refuses a line scan of SurfaceTopography."""
    sizes = getattr(topography, "physical_sizes", None)
    if getattr(topography, "dim", None) == 1 or isinstance(sizes, (tuple, list)) and len(sizes) == 1:
        kind = type(topography).__name__
        raise ValueError(f"heights: the topography ({kind}) is a line scan, a profile; a contact needs a map")
