"""Keyword arguments as keys of a scene."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, Literal, Union

import numpy as np
from numpy.typing import NDArray

#: Elements per side: a number, ``(nx, ny)``, or text such as ``"512x256"``.
Grid = Union[int, tuple[int, int], str]
#: A number in SI units, or text with a unit such as ``"10kPa"``.
Quantity = Union[float, str]
#: Mean pressures (Pa) one after the other, or text such as ``"10MPa,0"``.
History = Union[Sequence[Quantity], str]
#: A shape at the centre of the cell.
Shape = Literal["sphere", "cylinder", "cone", "wave", "flat"]
#: What is beyond the heights.
Boundary = Literal["periodic", "free"]
#: How the problem is solved.
Method = Literal["adaptive", "uniform", "gauss-seidel"]
#: Conductivity of both bodies, or of each.
Conductivity = Union[float, tuple[float, float], str]
#: A Prony series: its file, pairs (g, tau), or the tuple of an array of g and one of tau (s).
Prony = Union[str, "os.PathLike[str]", Sequence[Sequence[float]], NDArray[np.float64], tuple[NDArray[np.float64], NDArray[np.float64]]]
#: A fractional Zener solid: ``alpha``, ``glassy_ratio`` and ``tau`` (s), or text such as ``"0.2,10,1e-3"``.
Fractional = Union[Mapping[str, float], str]
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
    if name == "history":
        return ",".join(load if isinstance(load, str) else repr(float(load)) for load in value)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if name == "prony":
        return _terms(value)
    if name == "fractional" and isinstance(value, Mapping):
        return _fractional(value)
    return value


def _terms(value: Any) -> list[list[float]]:
    """The terms [g, tau] of a Prony series."""
    is_pair = isinstance(value, tuple) and len(value) == 2 and not any(isinstance(part, tuple) for part in value)
    try:
        terms = np.asarray(value, float)
        terms = np.atleast_2d(terms.T) if is_pair else terms
    except (TypeError, ValueError):
        terms = np.empty(0)
    if terms.ndim != 2 or terms.shape[1] != 2:
        raise ValueError("prony: must be a file, a list of pairs (g, tau), or a tuple of two arrays of one length")
    return [[float(g), float(tau)] for g, tau in zip(terms[:, 0], terms[:, 1])]


def _fractional(value: Mapping[str, float]) -> str:
    names = ("alpha", "glassy_ratio", "tau")
    if set(value) != set(names):
        raise ValueError(f"fractional: must have {', '.join(names)}, not {', '.join(map(str, value))}")
    return ",".join(repr(float(value[name])) for name in names)


def with_absolute_files(keys: dict[str, Any]) -> dict[str, Any]:
    """The keys with absolute paths of the files they name, since the working directory may be another one later."""
    files = (*SURFACE_FILES, "add", "prony")
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
