"""Keyword arguments as keys of a scene."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, Literal, Union

import numpy as np

#: Elements per side: a number, ``(nx, ny)``, or text such as ``"512x256"``.
Grid = Union[int, tuple[int, int], str]
#: A number in SI units, or text with a unit such as ``"10kPa"``.
Quantity = Union[float, str]
#: A shape at the centre of the cell.
Shape = Literal["sphere", "cylinder", "cone", "wave", "flat"]
#: What is beyond the heights.
Boundary = Literal["periodic", "free"]
#: How the problem is solved.
Method = Literal["adaptive", "uniform", "gauss-seidel"]
#: Conductivity of both bodies, or of each.
Conductivity = Union[float, tuple[float, float], str]
#: A file or a folder.
Path = Union[str, "os.PathLike[str]"]
#: Keys of files that a surface is made from.
SURFACE_FILES = ("spectrum", "psd", "like")
#: Units of the lengths of a file.
LengthUnit = Literal["m", "cm", "mm", "um", "nm", "angstrom", "pm"]
#: Values that mark missing points of a file.
Missing = Union[float, Sequence[float]]
#: What masked points of a file are: missing, or points like others.
Mask = Literal["use", "ignore"]


#: Keys that are numbers along x and along y, and may be pairs.
_PAIRS = frozenset({"grid", "output_grid", "resample", "--resample", "--crop", "--repeat"})


def plain(keys: Mapping[str, Any]) -> dict[str, Any]:
    """The keys that have a value, with numbers of NumPy, paths and pairs as what they stand for."""
    return {name: _plain(name, value) for name, value in keys.items() if value is not None}


def _plain(name: str, value: Any) -> Any:
    if name == "missing" and not isinstance(value, str):
        return [float(mark) for mark in np.ravel(value)]
    if isinstance(value, (str, int, float)):
        # Numbers of NumPy that are floats too keep their value.
        return float(value) if type(value) is np.float64 else value
    if isinstance(value, (np.generic, np.ndarray)) and value.ndim == 0:
        return value.item()
    if name in _PAIRS and isinstance(value, (tuple, list)) and len(value) == 2:
        return f"{value[0]}x{value[1]}"
    if name == "conductivity" and isinstance(value, (tuple, list)) and len(value) == 2:
        return f"{value[0]},{value[1]}"
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return value


def with_absolute_files(keys: dict[str, Any]) -> dict[str, Any]:
    """The keys with absolute paths of the files of a surface, since the working directory may be another one later."""
    files = (*SURFACE_FILES, "add")
    named = {name for name in files if isinstance(keys.get(name), str)}
    return {name: os.path.abspath(value) if name in named else value for name, value in keys.items()}


def length(name: str, value: Any) -> float:
    """A length (m), positive and finite."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: must be a number (m), not {value!r}") from None
    if not (0.0 < number < np.inf):
        raise ValueError(f"{name}: must be positive and finite (m), not {number:g}")
    return number
