"""Load curves over realisations."""

from __future__ import annotations

import csv
import html as text
import os
import operator
import warnings
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any, Literal, Union

import numpy as np
from numpy.typing import NDArray

from roughcontact import _core
from roughcontact._keys import Boundary, Grid, Method, Path, plain
from roughcontact._maps import Heights
from roughcontact._result import Result
from roughcontact._run import NotConvergedError, NotConvergedWarning, ProgressOption
from roughcontact._solve import Kernel, solve_keys
from roughcontact._surface import Surface

if TYPE_CHECKING:
    import pandas

#: Loads one by one, or text as on the command line: ``"1e4:1e6:8"`` (geometric), ``"1e-6:3e-5:8:linear"``.
Loads = Union[Sequence[float], NDArray[np.float64], str]
#: Seeds one by one, or text as ``"1..7"`` (both included).
Seeds = Union[Iterable[int], str]

_OPTIONS = ("heights", "scene", "kernel", "pressures", "penetrations", "seeds", "executor", "keep_results", "progress", "check")


class Table:
    """Rows of a sweep: seed, load (``control_value``, Pa or m), and the keys of the summary.

    ``table["area_fraction"]`` is a column as an array, ``table[0]`` a row as a dict.
    """

    __slots__ = ("results", "rows")

    #: A dict for each solve, by seed, then load.
    rows: list[dict[str, Any]]
    #: The results of the rows where ``keep_results=True``, else None.
    results: list[Result] | None

    def __init__(self, rows: list[dict[str, Any]], results: list[Result] | None = None) -> None:
        self.rows = rows
        self.results = results

    @property
    def columns(self) -> list[str]:
        """Names of the columns."""
        return list(self.rows[0]) if self.rows else []

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return iter(self.rows)

    def __getitem__(self, key: Any) -> Any:
        if isinstance(key, str):
            if key not in self.columns:
                raise KeyError(f"a Table has no column '{key}'; its columns are {', '.join(self.columns)}")
            values = [row[key] for row in self.rows]
            if any(isinstance(value, list) for value in values):
                array = np.empty(len(values), object)
                array[:] = values
                return array
            return np.array([np.nan if value is None else value for value in values])
        return self.rows[key]

    def mean(self, column: str) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Loads, mean of a column over the seeds at each load, and its standard error (NaN for one seed)."""
        loads, place = np.unique(self["control_value"], return_inverse=True)
        groups = [self[column][place == k] for k in range(len(loads))]
        means = np.array([group.mean() for group in groups])
        errors = [group.std(ddof=1) / np.sqrt(len(group)) if len(group) > 1 else np.nan for group in groups]
        return loads, means, np.array(errors)

    def to_csv(self, path: Path) -> None:
        """Write the table; numbers read back as they were."""
        with open(os.fspath(path), "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, self.columns)
            writer.writeheader()
            writer.writerows(self.rows)

    def to_pandas(self) -> pandas.DataFrame:
        """The table as a DataFrame of pandas."""
        import pandas

        return pandas.DataFrame(self.rows)

    def __repr__(self) -> str:
        return f"Table({len(self)} rows, {len(self.columns)} columns)"

    def _repr_html_(self) -> str:
        known = ("seed", "control_value", "area_fraction", "area_fraction_error", "penetration", "mean_gap", "status")
        names = [name for name in known if name in self.columns]
        head = "".join(f"<th>{name}</th>" for name in names)
        body = "".join(
            "<tr>" + "".join(f"<td>{text.escape(_short(row[name]))}</td>" for name in names) + "</tr>" for row in self.rows
        )
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _short(value: Any) -> str:
    return f"{value:.5g}" if isinstance(value, float) else str(value)


def sweep(
    heights: Heights | None = None,
    *,
    scene: Path | None = None,
    pressures: Loads | None = None,
    penetrations: Loads | None = None,
    seeds: Seeds | None = None,
    cell: float | None = None,
    cell_y: float | None = None,
    spectrum: Path | None = None,
    waves: int | None = None,
    hurst: float | None = None,
    rms: float | None = None,
    rms_slope: float | None = None,
    c0: float | None = None,
    truncation: Literal["disc", "square"] | None = None,
    roll_off: float | None = None,
    low_cut: float | None = None,
    amplitudes: Literal["fixed", "random"] | None = None,
    grid: Grid | None = None,
    young: float | None = None,
    poisson: float | None = None,
    e_star: float | None = None,
    kernel: Kernel | None = None,
    boundary: Boundary | None = None,
    layer_thickness: float | None = None,
    layer_poisson: float | None = None,
    method: Method | None = None,
    border_level: int | None = None,
    energy_tolerance: float | None = None,
    tolerance: float | Literal["auto"] | None = None,
    threads: int | None = None,
    memory_limit: int | str | None = None,
    time_limit: float | str | None = None,
    executor: Executor | None = None,
    keep_results: bool = False,
    progress: ProgressOption = False,
    check: bool = False,
) -> Table:
    """Solve a list of loads on one surface, or on one for each seed, as ``rc sweep`` does.

    Parameters
    ----------
    heights, scene, and all keywords that are not below
        As for :func:`solve`.
    pressures, penetrations : sequence of float, or str
        Mean pressures (Pa) or penetrations (m), rising or falling; or a range as ``"1e4:1e6:8"``, geometric, or
        ``"1e-6:3e-5:8:linear"``. Exactly one of the two.
    seeds : iterable of int, or str, optional
        A random surface for each seed: ``range(1, 8)`` or ``"1..7"``. Default: the seed of the surface.
    threads : int, optional
        Worker threads of each solve. Default: all cores; one with an executor.
    time_limit : float or str, optional
        Of each solve.
    executor : concurrent.futures.Executor, optional
        Solves rows side by side, in processes or threads. The digits do not depend on it.
    keep_results : bool, default False
        Keep the :class:`Result` of each row in :attr:`Table.results`.
    progress : bool or callable, default False
        As for :func:`solve`, for each row; not with an executor.
    check : bool, default False
        Raise :class:`NotConvergedError` at the first row that does not converge, instead of warning at the end.

    Returns
    -------
    Table

    Raises
    ------
    KeyboardInterrupt
        After Ctrl-C; its attribute ``table`` has the rows so far.
    """
    given = locals()
    keys = plain({name: value for name, value in given.items() if name not in _OPTIONS})
    if executor is not None:
        keys.setdefault("threads", 1)
    control, loads = _control(pressures, penetrations)
    found: Table = Table([], [] if keep_results else None)
    rows = [
        (load, heights, {**keys, **({} if seed is None else {"seed": seed}), control: load})
        for seed in _seeds(seeds, heights)
        for load in loads
    ]
    options = {"scene": scene, "kernel": kernel, "progress": progress if executor is None else False}
    jobs = [(job, options, keep_results) for job in rows]
    solved: Iterable[tuple[dict[str, Any], Result | None, str | None]]
    solved = map(_solve_row, jobs) if executor is None else executor.map(_solve_row, jobs)
    failures = []
    try:
        for row, result, failure in solved:
            found.rows.append(row)
            if found.results is not None and result is not None:
                found.results.append(result)
            if failure is not None:
                if check:
                    raise _not_converged(failure, result)
                failures.append(failure)
    except BaseException as error:
        error.table = found  # type: ignore[attr-defined]
        raise
    if failures:
        message = f"{len(failures)} of {len(found)} rows did not converge: {failures[0]}"
        warnings.warn(message, NotConvergedWarning, stacklevel=2)
    return found


def _not_converged(failure: str, result: Result | None) -> Exception:
    return RuntimeError(failure) if result is None else NotConvergedError(failure, result)


def _control(pressures: Loads | None, penetrations: Loads | None) -> tuple[str, list[float]]:
    if (pressures is None) == (penetrations is None):
        raise ValueError("give exactly one of pressures (Pa) and penetrations (m)")
    name, loads = ("pressure", pressures) if penetrations is None else ("penetration", penetrations)
    if isinstance(loads, str):
        return name, _core.loads(loads)
    values = [float(load) for load in np.asarray(loads, float).ravel()]
    if not values:
        raise ValueError(f"{name}s: no load is given")
    return name, _core.loads(",".join(map(repr, values)))


def _seeds(seeds: Seeds | None, heights: Any) -> list[int | None]:
    if seeds is None:
        return [None]
    if heights is not None and not isinstance(heights, Surface):
        raise ValueError("seeds: the height map has none; omit seeds")
    return list(_core.seeds(seeds if isinstance(seeds, str) else ",".join(str(operator.index(seed)) for seed in seeds)))


def _solve_row(job: Any) -> tuple[dict[str, Any], Result | None, str | None]:
    (load, heights, keys), options, keeps = job
    result = solve_keys(heights, keys, is_row=True, **options)
    seed = result.seed
    first = {} if seed is None else {"seed": seed}
    row = {**first, "control_value": load, **result.summary}
    return row, result if keeps or result.failure else None, result.failure
