"""Load curves over realisations."""

from __future__ import annotations

import json
import operator
import os
import warnings
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal, NamedTuple, Union

import numpy as np
from numpy.typing import NDArray

from roughcontact import _core
from roughcontact._foreign import tell
from roughcontact._keys import (
    Boundary,
    Conductivity,
    Fractional,
    Grid,
    Mask,
    Method,
    Missing,
    Path,
    Prony,
    Quantity,
    Shape,
    plain,
    with_absolute_files,
)
from roughcontact._maps import Heights, equal_spacings, of_parts
from roughcontact._result import Result
from roughcontact._rows import FieldsAt, Found, Job, Workers, by_workers, here
from roughcontact._run import NotConvergedError, NotConvergedWarning, ProgressOption, RowBar, checked
from roughcontact._solve import Kernel, surface_of
from roughcontact._surface import Surface
from roughcontact._table import Table

#: Loads one by one, or text as on the command line: ``"1e4:1e6:8"`` (geometric), ``"1e-6:3e-5:8:linear"``.
Loads = Union[Sequence[float], NDArray[np.float64], str]
#: Seeds one by one, or text such as ``"1..7"`` (both included).
Seeds = Union[Iterable[int], str]

#: Values of keys by their names, one by one, or as text of the command line: ``"5MPa,10MPa"``, ``"1e-5:1e-3:8"``.
Vary = Mapping[str, Union[Sequence[Any], NDArray[np.float64], str]]

#: Speeds or times one by one, with or without units, or text of the command line: ``"1mm/s:1m/s:4"`` (geometric).
Swept = Union[Sequence[Union[float, str]], NDArray[np.float64], str]

#: Arguments that are no keys of a scene.
_OPTIONS = frozenset(
    {
        *("heights", "scene", "kernel", "pressures", "penetrations", "seeds", "vary", "speeds", "times"),
        *("out", "resume", "fields", "executor", "keep_results", "progress", "check", "strict"),
    }
)


def sweep(
    heights: Heights | None = None,
    *,
    scene: Path | None = None,
    pressures: Loads | None = None,
    penetrations: Loads | None = None,
    seeds: Seeds | None = None,
    vary: Vary | None = None,
    speeds: Swept | None = None,
    times: Swept | None = None,
    cell: Quantity | None = None,
    cell_y: Quantity | None = None,
    line: bool | None = None,
    spectrum: Path | None = None,
    psd: Path | None = None,
    psd_convention: Literal["plain", "fourier"] | None = None,
    like: Path | None = None,
    heights_like: Literal["gaussian", "map"] | None = None,
    missing: Missing | None = None,
    mask: Mask | None = None,
    waves: int | None = None,
    hurst: float | None = None,
    rms: Quantity | None = None,
    rms_slope: float | None = None,
    c0: float | None = None,
    truncation: Literal["disc", "square"] | None = None,
    roll_off: float | None = None,
    low_cut: float | None = None,
    amplitudes: Literal["fixed", "random"] | None = None,
    shape: Shape | None = None,
    radius: Quantity | None = None,
    angle: Quantity | None = None,
    wavelength: Quantity | None = None,
    wave_amplitude: Quantity | None = None,
    add: Path | Heights | None = None,
    grid: Grid | None = None,
    young: Quantity | None = None,
    poisson: float | None = None,
    young2: Quantity | None = None,
    poisson2: float | None = None,
    e_star: Quantity | None = None,
    force: Quantity | None = None,
    hardness: Quantity | None = None,
    speed: Quantity | None = None,
    direction: Quantity | None = None,
    prony: Prony | None = None,
    glassy_ratio: float | None = None,
    relaxation_time: Quantity | None = None,
    fractional: Fractional | None = None,
    conductivity: Conductivity | None = None,
    jump_distance: Quantity | None = None,
    kernel: Kernel | None = None,
    boundary: Boundary | None = None,
    layer_thickness: Quantity | None = None,
    layer_poisson: float | None = None,
    substrate_young: Quantity | None = None,
    substrate_poisson: float | None = None,
    method: Method | None = None,
    border_level: int | None = None,
    energy_tolerance: float | None = None,
    tolerance: float | Literal["auto"] | None = None,
    leakage: bool | None = None,
    viscosity: Quantity | None = None,
    pressure_drop: Quantity | None = None,
    threads: int | None = None,
    memory_limit: int | str | None = None,
    time_limit: float | str | None = None,
    out: Path | None = None,
    resume: bool = False,
    fields: Path | bool = False,
    executor: Workers | None = None,
    keep_results: bool = False,
    progress: ProgressOption = False,
    check: bool = False,
    strict: bool = False,
) -> Table:
    """Solve a list of loads on one surface, or on one for each seed, as ``rc sweep`` does.

    Parameters
    ----------
    heights, scene, and all keywords that are not below
        As for :func:`solve`.
    pressures, penetrations : sequence of float, or str
        Mean pressures (Pa) or penetrations (m), rising or falling. A range is text: ``"1e4:1e6:8"`` is geometric,
        ``"1e-6:3e-5:8:linear"`` is linear. Give exactly one of the two, or ``force``. Numbers in text may have units.
    seeds : iterable of int, or str, optional
        A random surface, or a twin, for each seed: ``range(1, 8)`` or ``"1..7"``. Default: the seed of the surface.
    vary : mapping of str to a sequence or str, optional
        Values of other keywords, such as ``{"hardness": ["5MPa", 1e7]}``. Each row has a column with the name of the
        keyword. Several keywords give all combinations.
    speeds : sequence of float or str, or str, optional
        Speeds (m/s) of a surface that slides, in the column ``speed``. Text is as for ``rc sweep --speeds``: ``"1e-6:1e1:20"``.
    times : sequence of float or str, or str, optional
        Times (s) of creep at rest under one pressure, in the column ``time``, as for ``rc sweep --times``. The load is
        ``pressures=[...]`` of one value, or ``force``.
    force : float or str, optional
        Force (N) instead of the list of loads. A list of forces is ``vary={"force": [...]}``.
    threads : int, optional
        Worker threads of each solve. Default: all cores, or one with an executor.
    time_limit : float or str, optional
        Maximum time of each solve. (``rc sweep --time-limit`` limits the whole sweep.)
    out : path, optional
        A folder that keeps each row as soon as it is finished. Journal and table are those of ``rc sweep --out``, and each
        program continues the sweeps of the other.
    resume : bool, default False
        Continue the sweep in ``out``, also with more loads, seeds or variations, or start it.
    fields : bool or path, default False
        True keeps a result folder for each row in ``out``. A path is a folder for a Zarr group of each row, ``0001.zarr`` and
        so on. The groups stay on the machines that solved them, and :attr:`Table.fields` says where.
    executor : concurrent.futures.Executor or callable, optional
        Solves rows side by side. It may be anything with ``submit``: a pool of processes or threads,
        ``Client.get_executor()`` of Dask, or ``MPIPoolExecutor`` of mpi4py. It may also be a function without arguments that
        makes one. The digits do not depend on it. Rows whose worker was killed are solved again. A pool of processes breaks
        when it loses a worker, and is then replaced by a new one.
    keep_results : bool, default False
        Keep the :class:`Result` of each row in :attr:`Table.results`.
    progress : bool or callable, default False
        As for :func:`solve`, for each row. With an executor, True is a bar over rows.
    check : bool, default False
        Raise :class:`NotConvergedError` at the first row that does not converge, instead of warning at the end.
    strict : bool, default False
        Raise ``ValueError`` instead of warning of the surface with :class:`InputWarning`.

    Returns
    -------
    Table

    Raises
    ------
    KeyboardInterrupt
        After Ctrl-C. Its attribute ``table`` has the rows so far. Other exceptions have it too once rows are solved.
    ValueError
        For input that cannot be used. For a load that a surface cannot carry, it is raised after all other rows are solved.
    RuntimeError
        When workers of an executor end three times without a finished row, or when an executor breaks that cannot be made again.
    """
    given = locals()
    keys = plain({name: value for name, value in given.items() if name not in _OPTIONS})
    if executor is not None:
        keys.setdefault("threads", 1)
    progress = _progress(progress, executor is not None)
    varied = _varied(vary)
    has_force = "force" in keys or any(name == "force" for name, _ in varied)
    control, loads = _control(pressures, penetrations, has_force)
    places = _places(out, fields, resume, kernel)
    if strict:
        keys["strict"] = True
    problem = _anywhere(heights, keys, scene, strict)
    if speeds is not None and "speed" in keys:
        raise ValueError("speeds: is given with speed; give one of them")
    if times is not None and (keep_results or fields):
        raise ValueError("times: the pressure after a time is not that of an elastic contact; omit fields and keep_results")
    swept = (_swept("speeds", speeds), _swept("times", times))
    planned = _plan(problem, kernel, (control, loads, _seeds(seeds, heights), varied), swept, places)
    kept = planned.kept()
    if kept and keep_results:
        planned.end()
        raise ValueError(f"keep_results: {len(kept)} rows are kept from before, without results; omit keep_results")
    collected = _Collected(planned, keep_results, places.groups is not None)
    jobs = _jobs(planned, problem, kernel, (control, progress if executor is None else False, keep_results, places))
    bar = RowBar(len(collected), len(planned.rows())) if executor is not None and progress is True else None
    try:
        for index, found in here(jobs) if executor is None else by_workers(executor, jobs):
            collected.add(index, found, check)
            if bar is not None:
                bar.one_more()
    except BaseException as error:
        error.table = collected.table()  # type: ignore[attr-defined]
        raise
    finally:
        if bar is not None:
            bar.close()
        planned.end()
    return collected.finish()


def _progress(progress: ProgressOption, has_workers: bool) -> ProgressOption:
    progress = checked(progress)
    if has_workers and not isinstance(progress, bool):
        raise ValueError("progress: a function sees solves of this process alone; with an executor give True, for a bar over rows")
    return progress


def _varied(vary: Vary | None) -> list[tuple[str, Any]]:
    if vary is None:
        return []
    return [(name, list_ if isinstance(list_, str) else [plain({name: value}).get(name) for value in list_]) for name, list_ in vary.items()]


def _swept(name: str, values: Swept | None) -> str | None:
    """A list of speeds or times as on the command line."""
    if values is None or isinstance(values, str):
        return values
    words = [value if isinstance(value, str) else repr(float(value)) for value in values]
    if not words:
        raise ValueError(f"{name}: none is given")
    return ",".join(words)


def _control(pressures: Loads | None, penetrations: Loads | None, has_force: bool) -> tuple[str, list[float]]:
    if has_force and pressures is None and penetrations is None:
        # The mean pressure follows from the cell.
        return "pressure", []
    if has_force:
        raise ValueError("force: give it or a list of loads, not both")
    if (pressures is None) == (penetrations is None):
        raise ValueError("give exactly one of pressures (Pa) and penetrations (m)")
    name, loads = ("pressure", pressures) if penetrations is None else ("penetration", penetrations)
    if isinstance(loads, str):
        return name, _core.loads(loads, name == "penetration")
    values = [float(load) for load in np.asarray(loads, float).ravel()]
    if not values:
        raise ValueError(f"{name}s: no load is given")
    return name, _core.loads(",".join(map(repr, values)), name == "penetration")


def _seeds(seeds: Seeds | None, heights: Any) -> list[int] | None:
    if seeds is None:
        return None
    if heights is not None and not isinstance(heights, Surface):
        raise ValueError("seeds: the height map has none; omit seeds")
    if isinstance(seeds, str):
        return list(_core.seeds(seeds))
    try:
        numbers = [operator.index(seed) for seed in seeds]
    except TypeError:
        raise ValueError(f"seeds: must be whole numbers such as range(1, 8), or text such as '1..7', not {seeds!r}") from None
    if not numbers:
        raise ValueError("seeds: none is given")
    for seed in numbers:
        if not 0 <= seed < 2**63:
            raise ValueError(f"seeds: must be whole numbers from 0 to {2**63 - 1}, not {seed}")
    return list(_core.seeds(",".join(map(str, numbers))))


class _Places(NamedTuple):
    """Where a sweep writes, and whether it continues an earlier one."""

    out: str | None
    resume: bool
    #: Whether each row has a result folder in ``out``.
    in_out: bool
    #: The folder for Zarr groups.
    groups: str | None


def _places(out: Path | None, fields: Path | bool, resume: bool, kernel: Any) -> _Places:
    in_out = fields is True
    groups = None if isinstance(fields, bool) else os.path.abspath(os.fspath(fields))
    if out is None and (resume or in_out):
        raise ValueError(f"{'resume' if resume else 'fields'}: the rows are kept in a folder; give out=FOLDER")
    if out is not None and callable(kernel):
        raise ValueError("out: a journal cannot tell one function for a kernel from another; omit out")
    return _Places(None if out is None else os.path.abspath(os.fspath(out)), bool(resume), in_out, groups)


class _Problem(NamedTuple):
    """What is the same for all rows, wherever they are solved."""

    #: A map, a surface, or the path of a map.
    heights: Any
    keys: dict[str, Any]
    scene: str | None


def _anywhere(heights: Any, keys: dict[str, Any], scene: Path | None, strict: bool) -> _Problem:
    """Workers may have another working directory."""
    keys = with_absolute_files(keys)
    scene = None if scene is None else os.path.abspath(os.fspath(scene))
    if isinstance(heights, (str, os.PathLike)):
        heights = os.path.abspath(os.fspath(heights))
    elif heights is not None and not isinstance(heights, Surface):
        keys, array, sides, doubts = surface_of(heights, keys)
        side = _length_of(keys.get("cell"))
        if sides is None and "cell_y" not in keys and not keys.get("line") and side is not None and array.size:
            # The rows take the same, but do not warn.
            doubts += equal_spacings(array.shape, side)[1]
        tell(doubts, strict, stacklevel=4)
        heights = of_parts(array, sides)
    return _Problem(heights, keys, scene)


def _length_of(value: Any) -> float | None:
    """A length with or without a unit; None for what is not one, which is refused later."""
    try:
        return None if value is None else _core.loads(str(value), True)[0]
    except ValueError:
        return None


def _plan(
    problem: _Problem,
    kernel: Kernel | None,
    lists: tuple[str, list[float], list[int] | None, list[tuple[str, Any]]],
    swept: tuple[str | None, str | None],
    places: _Places,
) -> _core.Planned:
    keys, array, sides, _ = surface_of(problem.heights, problem.keys)
    if isinstance(kernel, str):
        keys = {**keys, "kernel": kernel}
    control, loads, seeds, vary = lists
    wanted: _core.Wanted = {
        "penetrations": control == "penetration",
        "loads": loads,
        "seeds": seeds,
        "vary": vary,
        "speeds": swept[0],
        "times": swept[1],
        "heights": array,
        "sides": sides,
        "scene": problem.scene,
        "folder": places.out,
        "resume": places.resume,
        "fields": places.in_out,
    }
    return _core.plan_sweep(keys, wanted)


def _jobs(
    planned: _core.Planned,
    problem: _Problem,
    kernel: Kernel | None,
    others: tuple[str, ProgressOption, bool, _Places],
) -> list[Job]:
    control, progress, keeps_result, places = others
    options: dict[str, Any] = {"scene": problem.scene, "kernel": kernel, "progress": progress}
    rows, jobs = planned.rows(), []
    for index in planned.todo():
        seed, load, varied = rows[index]
        keys = {**problem.keys, **json.loads(varied), **({} if seed is None else {"seed": seed}), control: load}
        # The load of the row is its mean pressure. Its time is in this load.
        keys.pop("force", None)
        keys.pop("time", None)
        group = None if places.groups is None else os.path.join(places.groups, f"{index + 1:04}.zarr")
        row = {**options, "creep": planned.creep(index)}
        jobs.append(Job(index, problem.heights, keys, row, keeps_result, planned.fields_folder(index), group))
    return jobs


class _Collected:
    """Rows as they finish, in the journal and here."""

    def __init__(self, planned: _core.Planned, keeps_results: bool, names_fields: bool) -> None:
        self._planned = planned
        self._leading = planned.rows()
        self._results: dict[int, Result] | None = {} if keeps_results else None
        self._fields: dict[int, FieldsAt | None] | None = {} if names_fields else None
        kept = [(index, json.loads(cells)) for index, cells in planned.kept()]
        self._rows = {index: {key: cell for key, cell in row.items() if key != "seed" or cell is not None} for index, row in kept}
        self._failures: dict[int, str | None] = {index: None for index, row in kept if row["status"] == "not_converged"}
        self._refused: dict[int, ValueError] = {}

    def __len__(self) -> int:
        return len(self._rows)

    def add(self, index: int, found: Found, check: bool) -> None:
        """Keeps a row, or why it cannot be solved."""
        if isinstance(found, ValueError):
            self._refused[index] = found
            return
        self._planned.keep(index, found.cells)
        seed, load, varied = self._leading[index]
        first = {} if seed is None else {"seed": seed}
        self._rows[index] = {**first, "control_value": load, **json.loads(varied), **json.loads(found.cells)}
        if self._results is not None and found.result is not None:
            self._results[index] = found.result
        if self._fields is not None:
            self._fields[index] = found.fields
        if found.failure is not None:
            self._failures[index] = found.failure
            if check and found.result is not None:
                raise NotConvergedError(found.failure, found.result)

    def table(self) -> Table:
        """The rows so far."""
        order = sorted(self._rows)
        results = None if self._results is None else [self._results[index] for index in order]
        fields = None if self._fields is None else [self._fields.get(index) for index in order]
        return Table([self._rows[index] for index in order], results, fields)

    def finish(self) -> Table:
        """The whole table."""
        table = self.table()
        if self._refused:
            index = min(self._refused)
            message = f"{self._planned.describe(index)}: {self._refused[index]}"
            if len(table):
                n = len(self._refused)
                rows = "1 row" if n == 1 else f"{n} rows"
                message += f"; {rows} could not be solved, and the attribute table of this error has the other {len(table)}"
            error = ValueError(message)
            error.table = table  # type: ignore[attr-defined]
            raise error
        if self._failures:
            first = self._failures[min(self._failures)]
            reason = "was solved in an earlier run, and its reason was not stored" if first is None else f"for this reason: {first}"
            message = f"{len(self._failures)} of {len(table)} rows did not converge; the first {reason}"
            warnings.warn(message, NotConvergedWarning, stacklevel=3)
        return table
