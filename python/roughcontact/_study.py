"""One contact under varied treatments of a measured map."""

from __future__ import annotations

import json
import os
import tempfile
import warnings
from collections.abc import Sequence
from typing import Any, Literal, NamedTuple, Union

import numpy as np

from roughcontact import _core
from roughcontact._foreign import of_keywords, tell
from roughcontact._keys import Boundary, Conductivity, Grid, LengthUnit, Mask, Method, Missing, Path, Quantity, plain
from roughcontact._run import NotConvergedWarning
from roughcontact._sweep import Loads
from roughcontact._table import Table

#: Treatments that False leaves out.
_USUAL = frozenset({"crop", "despike", "level", "fill", "periodic"})

#: Arguments that are no flags with a value.
_OPTIONS = frozenset({"path", "pressures", "threads", "out", "resume", "strict"})

#: A name, or False for a usual treatment that is left out.
Fill = Union[Literal["laplace", "nearest", "lowest"], Literal[False]]
Level = Union[Literal["mean", "plane", "quadratic"], Literal[False]]
Periodic = Union[Literal["mirror", "window", "as-is"], Literal[False]]


class Study(NamedTuple):
    """The rows of a study, and what they say about each result."""

    #: A row for each treatment and pressure, with the columns ``step``, ``treatment`` and ``same_as``.
    rows: Table
    #: A row for each pressure and result: ``pressure`` (Pa), ``result``, ``unit``, ``value``, ``mesh_error``,
    #: ``treatment_low``, ``low_by``, ``treatment_high``, ``high_by``.
    ranges: Table
    #: The treatments with their steps, the unchanged ones first.
    treatments: list[dict[str, Any]]
    #: Treatments that the map or the contact does not allow, with the reason.
    skipped: list[dict[str, Any]]


def study(
    path: Path,
    *,
    pressures: Loads,
    cell: Quantity | None = None,
    cell_y: Quantity | None = None,
    unit: LengthUnit | None = None,
    height_unit: LengthUnit | None = None,
    height_scale: Quantity | None = None,
    channel: str | None = None,
    layout: Literal["matrix", "xyz"] | None = None,
    missing: Missing | None = None,
    mask: Mask | None = None,
    crop: str | Literal[False] | None = None,
    flip: str | Sequence[str] | None = None,
    despike: float | bool | None = None,
    level: Level | None = None,
    fill: Fill | None = None,
    high_pass: float | None = None,
    periodic: Periodic | None = None,
    taper: float | None = None,
    low_pass: Quantity | None = None,
    resample: Grid | None = None,
    young: Quantity | None = None,
    poisson: float | None = None,
    young2: Quantity | None = None,
    poisson2: float | None = None,
    e_star: Quantity | None = None,
    hardness: Quantity | None = None,
    conductivity: Conductivity | None = None,
    jump_distance: Quantity | None = None,
    kernel: Literal["love", "spectral"] | None = None,
    boundary: Boundary | None = None,
    layer_thickness: Quantity | None = None,
    layer_poisson: float | None = None,
    substrate_young: Quantity | None = None,
    substrate_poisson: float | None = None,
    method: Method | None = None,
    energy_tolerance: float | None = None,
    tolerance: float | Literal["auto"] | None = None,
    leakage: bool | None = None,
    threads: int | None = None,
    memory_limit: int | str | None = None,
    out: Path | None = None,
    resume: bool = False,
    strict: bool = False,
) -> Study:
    """Solve one measured map with one treatment changed at a time, as ``rc study`` does.

    Parameters
    ----------
    path : path
        The map as it was measured, of any format.
    pressures : sequence of float, or str
        Mean pressures (Pa), or text such as ``"1MPa,3MPa"`` or ``"1e4:1e6:3"`` (geometric).
    cell, cell_y, unit, height_unit, height_scale, channel, layout, missing, mask : optional
        How the file is read, as for :func:`solve` and :func:`read`.
    crop, flip, despike, level, fill, high_pass, periodic, taper, low_pass, resample : optional
        What all rows have in common instead of the usual treatments, or besides, as for :func:`prepare`. False leaves a
        usual one out.
    young, poisson, young2, poisson2, e_star, hardness, conductivity, jump_distance, kernel, boundary, layer_thickness, layer_poisson, substrate_young, substrate_poisson : optional
        The solids, as for :func:`solve`. The load is ``pressures``.
    method, energy_tolerance, tolerance, leakage, memory_limit : optional
        As for :func:`solve`.
    threads : int, optional
        Worker threads. Default: all cores.
    out : path, optional
        A folder that keeps the rows, the tables and the page ``report.html``.
    resume : bool, default False
        Continue the study in ``out``, or start it.
    strict : bool, default False
        Raise ``ValueError`` where the unchanged treatments give a warning.

    Returns
    -------
    Study

    Raises
    ------
    KeyboardInterrupt
        After Ctrl-C. The rows in ``out`` are kept.
    ValueError
        For input that cannot be used.
    """
    given = locals()
    flags = plain({name: value for name, value in given.items() if name not in _OPTIONS})
    words = [*_words(flags), "--pressures", _list(pressures)]
    words += [flag for flag, is_set in (("--resume", resume), ("--strict", strict)) if is_set]
    if out is None and resume:
        raise ValueError("resume: the rows are kept in a folder; give out=FOLDER")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        place = os.path.join(folder, "study") if out is None else os.fspath(out)
        text, doubts = _core.study([os.fspath(path), *words, "--quiet", "--out", place], threads)
    tell([of_keywords(doubt) for doubt in doubts], strict=False)
    return _of_record(json.loads(text))


def _list(pressures: Loads) -> str:
    if isinstance(pressures, str):
        return pressures
    return ",".join(repr(float(pressure)) for pressure in np.asarray(pressures, float).ravel())


def _words(flags: dict[str, Any]) -> list[str]:
    words = []
    for name, value in flags.items():
        flag = name.replace("_", "-")
        if value is False:
            words += [f"--no-{flag}"] if name in _USUAL else []
        elif value is True:
            words.append(f"--{flag}")
        else:
            text = value if isinstance(value, str) or not isinstance(value, Sequence) else ",".join(map(str, value))
            words.append(f"--{flag}={text}")
    return words


def _of_record(record: dict[str, Any]) -> Study:
    rows = Table(record["rows"])
    ranges = [{"pressure": load["pressure"], **result} for load in record["loads"] for result in load["results"]]
    failed = sum(row["status"] == "not_converged" for row in rows)
    if failed:
        warnings.warn(f"{failed} of {len(rows)} rows did not converge", NotConvergedWarning, stacklevel=3)
    return Study(rows, Table(ranges), record["treatments"], record["skipped"])
