"""Height maps: arrays with the size of the measured area."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from roughcontact import _core
from roughcontact._foreign import checked_shape, found_in, of_keywords, refuse_line_scan, tell
from roughcontact._keys import Grid, LengthUnit, Mask, Missing, Path, length, plain

if TYPE_CHECKING:
    from roughcontact._result import Result
    from roughcontact._surface import Surface

Floats = NDArray[np.float64]
Sides = tuple[float, float]


class HeightMap:
    """A measured map: heights in m, and the size of its cell if it is known.

    It can be used wherever an array of heights can, and brings its size along.

    Parameters
    ----------
    heights : array_like, shape (ny, nx)
        Heights (m), positive towards the half-space; NaN where nothing was measured. An array of xarray is read like the
        file that it would write: its attribute ``units``, its coordinates along x and y, and its marks of missing points
        count. Points, as an array of shape (n, 3) or a table with columns x, y and z, are put on their grid if it is regular.
    sides : (float, float), optional
        Sides of the map along x and y (m), positive.
    """

    __slots__ = ("heights", "sides")

    #: Heights (m), shape (ny, nx).
    heights: Floats
    #: Sides along x and y (m), or None if they are not known.
    sides: Sides | None

    def __init__(self, heights: ArrayLike, sides: Sides | None = None) -> None:
        given = None if sides is None else _sides(sides)
        self.heights, known, doubts = map_parts(heights, is_map=given is not None)
        if given is not None and known is not None:
            known, _ = _sides_of(self.heights.shape, known, *given, names=("sides", "sides"))
        self.sides = known if given is None else given
        tell(doubts, strict=False)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the heights, (ny, nx)."""
        return self.heights.shape

    @property
    def missing(self) -> int:
        """Number of points that were not measured."""
        return int(np.isnan(self.heights).sum())

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        if copy:
            return np.array(self.heights, dtype=dtype)
        return np.asarray(self.heights, dtype=dtype)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, HeightMap):
            return NotImplemented
        return self.sides == other.sides and np.array_equal(self.heights, other.heights, equal_nan=True)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        ny, nx = self.heights.shape
        size = "size not known" if self.sides is None else f"{self.sides[0]:g} m x {self.sides[1]:g} m"
        return f"HeightMap({nx} x {ny} points, {size}, {self.missing} missing)"


#: What :func:`roughcontact.solve` takes for a surface besides keywords.
Heights = Union[ArrayLike, HeightMap, "Surface", Path]


def as_heights(heights: Any) -> Floats:
    """Heights as an array of float64, row by row. Such an array is not copied."""
    if isinstance(heights, np.ma.MaskedArray):
        heights = np.ma.filled(heights.astype(np.float64), np.nan)
    try:
        array = np.asarray(heights)
        if np.iscomplexobj(array):
            raise TypeError("complex heights")
        array = np.require(array, np.float64, ["C", "A"])
    except (TypeError, ValueError) as cause:
        raise ValueError(f"heights: must be a 2-D array of numbers, shape (ny, nx): {cause}") from None
    if array.ndim == 1:
        raise ValueError(f"heights: must be a 2-D array, shape (ny, nx); {array.size} heights along one dimension are a profile, not a map")
    if array.ndim != 2:
        raise ValueError(f"heights: must be a 2-D array, shape (ny, nx), not of shape {array.shape}")
    return array


def as_field(name: str, values: Any) -> Floats:
    """Values of elements as an array of float64, row by row."""
    try:
        array = np.require(np.asarray(values), np.float64, ["C", "A"])
    except (TypeError, ValueError) as cause:
        raise ValueError(f"{name}: must be a 2-D array of numbers, shape (ny, nx): {cause}") from None
    if array.ndim != 2:
        raise ValueError(f"{name}: must be a 2-D array, one value for each element, not of shape {array.shape}")
    return array


def as_profile(heights: Any) -> Floats:
    """The heights of a profile as an array of one row."""
    array = heights.heights if isinstance(heights, HeightMap) else np.asarray(heights)
    if array.ndim == 1:
        array = array[None]
    if array.ndim != 2 or array.shape[0] != 1:
        raise ValueError(f"heights: with line, must be a profile, of shape (n,) or (1, n), not of shape {np.shape(heights)}")
    return as_heights(array)


class Parts(NamedTuple):
    """A map of any kind."""

    heights: Floats
    sides: Sides | None = None
    #: What was assumed.
    doubts: tuple[str, ...] = ()


def map_parts(heights: Any, *, is_map: bool = False) -> Parts:
    """Array and size of anything that has heights: an array, a map, a topography, an array or a table with names, points.

    An array of a few columns is known to be a map with ``is_map``.
    """
    if isinstance(heights, HeightMap):
        return Parts(heights.heights, heights.sides)
    if callable(getattr(heights, "heights", None)) and hasattr(heights, "physical_sizes"):
        refuse_line_scan(heights)
        return Parts(*_of_topography(heights))
    found = found_in(heights)
    array, sides = as_heights(found.heights), found.sides
    if sides is None and not is_map:
        array, sides = checked_shape(array)
    return Parts(array, sides, found.doubts)


def _of_topography(topography: Any) -> tuple[Floats, Sides]:
    """A topography of SurfaceTopography, whose arrays have x first."""
    if topography.unit is not None:
        topography = topography.to_unit("m")
    array = topography.heights()
    x, y = topography.physical_sizes
    return as_heights(array.T), (float(x), float(y))


def _sides(sides: Any) -> Sides:
    """Two lengths."""
    try:
        x, y = sides
    except (TypeError, ValueError):
        raise ValueError(f"sides: must be two lengths (m), along x and y, not {sides!r}") from None
    return length("sides", x), length("sides", y)


#: Relative difference of lengths that are the same.
_SAME_LENGTH = 1e-3


def _sides_of(
    shape: tuple[int, ...],
    known: Sides | None,
    cell: float | None,
    cell_y: float | None,
    names: tuple[str, str] = ("cell", "cell_y"),
) -> tuple[Sides | None, tuple[str, ...]]:
    """The size of a map and what was assumed of it: its own, which the given one must not contradict, or the given one."""
    given = [None if side is None else length(name, side) for name, side in zip(names, (cell, cell_y), strict=True)]
    if known is not None:
        for name, extent, side, own in zip(names, ("wide", "high"), given, known, strict=True):
            if side is not None and abs(side / own - 1.0) > _SAME_LENGTH:
                raise ValueError(f"heights: the map is {own:g} m {extent}, but {name} says {side:g} m; omit {name}")
        return known, ()
    side, side_y = given
    if side is None:
        if side_y is not None:
            raise ValueError("cell: must be given (m) beside cell_y")
        return None, ()
    if side_y is not None:
        return (side, side_y), ()
    return equal_spacings(shape, side)


def equal_spacings(shape: tuple[int, ...], side: float) -> tuple[Sides, tuple[str, ...]]:
    """The size of a map that is ``side`` wide and has equal spacings along x and y, and what was assumed of it."""
    ny, nx = shape
    if nx == ny:
        return (side, side), ()
    side_y = side * ny / nx
    assumed = f"assumed: equal spacings along x and y, so the map of {nx} x {ny} points is {side:g} m x {side_y:g} m; cell_y says otherwise"
    return (side, side_y), (assumed,)


def pair(sides: list[float] | None) -> Sides | None:
    """Sides as a tuple."""
    return None if sides is None else (sides[0], sides[1])


def channels(path: Path) -> dict[str, bool]:
    """List the channels of a file, as ``rc inspect`` does.

    Parameters
    ----------
    path : path
        A height map of any format.

    Returns
    -------
    dict
        The names in the order of the file, and whether the values are lengths. :func:`read` takes the first with lengths.
    """
    return dict(_core.channels(os.fspath(path)))


def read(
    path: Path,
    *,
    unit: LengthUnit | None = None,
    height_unit: LengthUnit | None = None,
    height_scale: float | None = None,
    channel: str | None = None,
    layout: Literal["matrix", "xyz"] | None = None,
    missing: Missing | None = None,
    mask: Mask | None = None,
    strict: bool = False,
) -> HeightMap:
    """Read a height map of any format that the command line reads.

    Parameters
    ----------
    path : path
        Text, ``.npy``, ``.h5``, ``.nc``, ``.mat``, 16-bit ``.png`` or ``.tif``, or a file from an instrument or from Gwyddion.
    unit : {"m", "cm", "mm", "um", "nm", "angstrom", "pm"}, optional
        Unit of the lengths of a file that names none. Default: m.
    height_unit : {"m", "cm", "mm", "um", "nm", "angstrom", "pm"}, optional
        Unit of the heights, where it differs from ``unit``.
    height_scale : float, optional
        Height (m) of the value 1 in a file that names no unit. In an image, 1 is one level of grey.
    channel : str, optional
        Channel of a file with several; :func:`channels` lists them. Default: the first with heights.
    layout : {"matrix", "xyz"}, optional
        Layout of an ambiguous text of numbers: a row of the map in each line, or a point in each line.
    missing : float or sequence of float, optional
        Values that mark missing points, in the numbers of the file, beside those that the file declares.
    mask : {"use", "ignore"}, default "use"
        Whether masked points of a file are missing.
    strict : bool, default False
        Raise ``ValueError`` instead of warning with :class:`InputWarning`.

    Returns
    -------
    HeightMap
        Heights (m), with NaN where nothing was measured, and the size if the file has it.
    """
    keys = {
        "unit": unit,
        "height_unit": height_unit,
        "height_scale": height_scale,
        "channel": channel,
        "layout": layout,
        "missing": missing,
        "mask": mask,
    }
    heights, sides, doubts = _core.read(os.fspath(path), plain(keys))
    tell(doubts, strict)
    return of_parts(heights, pair(sides))


def of_parts(heights: Floats, sides: Sides | None) -> HeightMap:
    """The map of an array that is known to be one."""
    made = HeightMap.__new__(HeightMap)
    made.heights, made.sides = heights, sides
    return made


def prepare(
    heights: ArrayLike | HeightMap | Path,
    *,
    cell: float | None = None,
    cell_y: float | None = None,
    crop: str | None = None,
    flip: str | Sequence[str] | None = None,
    despike: float | bool | None = None,
    fill: Literal["laplace", "nearest", "lowest"] | None = None,
    level: Literal["mean", "plane", "quadratic"] | None = None,
    high_pass: float | None = None,
    periodic: Literal["mirror", "window", "as-is"] | None = None,
    taper: float | None = None,
    low_pass: float | None = None,
    resample: Grid | None = None,
    repeat: str | None = None,
    missing: Missing | None = None,
    mask: Mask | None = None,
    strict: bool = False,
) -> HeightMap:
    """Treat a measured map, as ``rc surface`` does, in the order of the parameters.

    Most measured maps need ``crop="measured", despike=True, level="plane", fill="laplace", periodic="mirror"``, which
    ``rc prepare`` does.

    Parameters
    ----------
    heights : array_like of shape (ny, nx), HeightMap or path
        The map (m).
    cell, cell_y : float, optional
        Sides (m) along x and y, where the map does not know them. Without ``cell_y``, spacings are equal along x and y.
    crop : str, optional
        The part that is kept: ``"measured"``, ``"square"``, or numbers of points such as ``"512"``, ``"512x256"``, ``"512x256+100+50"``.
    flip : str or sequence of str, optional
        Axes that are mirrored, ``"x"``, ``"y"`` or ``"z"``. Several are ``"x,y"`` or ``("x", "y")``.
    despike : float or bool, optional
        Isolated points are replaced if they are farther than this many robust deviations from their neighbours, 8 if True.
    fill : {"laplace", "nearest", "lowest"}, optional
        How missing points get heights.
    level : {"mean", "plane", "quadratic"}, optional
        The form that is subtracted.
    high_pass : float, optional
        Gaussian filter (L-filter). Waves of this length (m) keep half of their height, and longer ones go.
    periodic : {"mirror", "window", "as-is"}, optional
        How opposite borders are made to meet. ``mirror`` doubles the sides.
    taper : float, optional
        Fraction of a side that ``window`` fades at each of its two ends. Default: 0.1.
    low_pass : float, optional
        Gaussian filter. Waves of this length (m) keep half of their height.
    resample : int, (int, int) or str, optional
        New numbers of points along x and y on the same area.
    repeat : str, optional
        Copies of a periodic map side by side: ``"3x4"``, or ``"square"`` (as many as make a square cell).
    missing, mask : optional
        How a file is read, as for :func:`read`.
    strict : bool, default False
        Raise ``ValueError`` instead of warning with :class:`InputWarning`.

    Returns
    -------
    HeightMap
        The map after all treatments.
    """
    array, known, doubts = map_parts(_read_or_given(heights, missing, mask, strict))
    sides, assumed = _sides_of(array.shape, known, cell, cell_y)
    tell(doubts + assumed, strict)
    if flip is not None and not isinstance(flip, str):
        flip = ",".join(map(str, flip))
    flags = {
        "--crop": crop,
        "--flip": flip,
        "--despike": (8.0 if despike else None) if isinstance(despike, bool) else despike,
        "--fill": fill,
        "--level": level,
        "--high-pass": high_pass,
        "--periodic": periodic,
        "--taper": taper,
        "--low-pass": low_pass,
        "--resample": resample,
        "--repeat": repeat,
    }
    words = [word for flag, value in plain(flags).items() for word in (flag, str(value))]
    treated, sides_after, found = _core.treat(array, sides, words)
    tell([of_keywords(text) for text in found], strict)
    return of_parts(treated, pair(sides_after))


def _read_or_given(heights: Any, missing: Missing | None, mask: Mask | None, strict: bool) -> Any:
    """The map of a file, or anything else as it is, to which keywords for files do not apply."""
    if isinstance(heights, (str, os.PathLike)):
        return read(heights, missing=missing, mask=mask, strict=strict)
    for name, value in (("missing", missing), ("mask", mask)):
        if value is not None:
            raise ValueError(f"{name}: is for files; omit it, because the heights are an array (m)")
    return heights


def inspect(
    what: ArrayLike | HeightMap | Surface | Result | Path,
    *,
    cell: float | None = None,
    cell_y: float | None = None,
    missing: Missing | None = None,
    mask: Mask | None = None,
) -> dict[str, Any]:
    """Statistics of a surface or of a result, as ``rc inspect --json`` prints them.

    Parameters
    ----------
    what : array_like, HeightMap, Surface, Result or path
        Heights (m), a random surface, a result, or a file or result folder.
    cell, cell_y : float, optional
        Sides (m) of a map that does not know them. Without ``cell_y``, spacings are equal along x and y.
    missing, mask : optional
        How a file is read, as for :func:`read`.

    Returns
    -------
    dict
        For a surface: rms height (m), slope and curvature (1/m), parameters of ISO 25178, spectrum, distribution.
        For a result: ``summary`` and ``pressure``.
    """
    from roughcontact._result import Result
    from roughcontact._surface import Surface

    is_folder = isinstance(what, (str, os.PathLike)) and os.path.isdir(what)
    if (isinstance(what, (Surface, Result)) or is_folder) and not (cell is None and cell_y is None):
        raise ValueError("cell: a surface and a result have their own; omit cell and cell_y")
    found: dict[str, Any]
    if isinstance(what, Surface):
        found = json.loads(_core.inspect_surface(plain(what.keys())))
    elif isinstance(what, Result):
        with tempfile.TemporaryDirectory() as folder:
            what.save(folder)
            found = json.loads(_core.inspect_result(folder))
    elif is_folder:
        found = json.loads(_core.inspect_result(os.fspath(what)))  # type: ignore[arg-type]
    else:
        array, known, doubts = map_parts(_read_or_given(what, missing, mask, strict=False))
        sides, assumed = _sides_of(array.shape, known, cell, cell_y)
        tell(doubts + assumed, strict=False)
        found = json.loads(_core.inspect_map(array, sides, {}))
    return found
