"""Rows of a sweep, solved here or in the workers of an executor."""

from __future__ import annotations

import os
import pathlib
import queue
import shutil
import socket
import tempfile
import uuid
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from typing import Any, NamedTuple, Union

from roughcontact import _core
from roughcontact._result import Result
from roughcontact._solve import solve_keys, surface_of

#: An executor, or a function that makes one. If a worker is killed and breaks the executor, the function makes another.
Workers = Union[Executor, Callable[[], Executor]]


class FieldsAt(NamedTuple):
    """Where the fields of a row are."""

    #: The machine that wrote them.
    host: str
    #: The Zarr group there.
    path: str


class Job(NamedTuple):
    """A row that is to be solved."""

    #: From 0.
    row: int
    heights: Any
    keys: dict[str, Any]
    options: dict[str, Any]
    #: Whether the result is returned too.
    keeps_result: bool
    #: The folder for the files of the result.
    folder: str | None
    #: The Zarr group for its fields.
    group: str | None
    #: A different text for each attempt. Dask would not repeat an identical call, even if the first one failed.
    attempt: str = ""


class Row(NamedTuple):
    """A row that was solved, small enough to send to another process."""

    #: The cells of the row, as JSON.
    cells: str
    failure: str | None
    result: Result | None
    fields: FieldsAt | None


#: A row, or why it cannot be solved, which says nothing about the others.
Found = Union[Row, ValueError]


def solve_row(job: Job) -> Row:
    """Solves a row in this process."""
    result = solve_keys(surface_of(job.heights, job.keys), is_row=True, **job.options)
    if job.folder is not None:
        _replace(job.folder, result.save)
    fields = None
    if job.group is not None:
        _replace(job.group, lambda path: _write_group(result, path))
        fields = FieldsAt(socket.gethostname(), job.group)
    keeps = job.keeps_result or result.failure is not None
    return Row(_core.cells(result._source.summary_json(), result.scene, job.options.get("creep")), result.failure, result if keeps else None, fields)


def _replace(final: str, write: Callable[[str], None]) -> None:
    """Writes a folder beside its place and then moves it there, so it is never half-written."""
    place = pathlib.Path(final)
    place.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=".rc-partial-", dir=place.parent) as hidden:
        partial = os.path.join(hidden, place.name)
        write(partial)
        if place.exists():
            shutil.rmtree(place)
        os.replace(partial, place)


def _write_group(result: Result, path: str) -> None:
    """The Zarr group of ``rc export --zarr``."""
    with tempfile.TemporaryDirectory(dir=os.path.dirname(path)) as folder:
        result.save(folder)
        _core.run(["rc", "export", folder, "--zarr", "--quiet"])
        os.replace(os.path.join(folder, "fields.zarr"), path)


def here(jobs: list[Job]) -> Iterator[tuple[int, Found]]:
    """Solves rows one after the other."""
    for job in jobs:
        try:
            row: Found = solve_row(job)
        except ValueError as error:
            row = error
        yield job.row, row


#: Rounds in which workers die and no row is finished, before the sweep gives up.
_ROUNDS = 3

#: Names of exceptions of executors whose worker ended while it solved a row.
_ENDED = frozenset({"KilledWorker", "WorkerCrashedError", "NodeDiedError", "RayActorError"})


def by_workers(workers: Workers, jobs: list[Job]) -> Iterator[tuple[int, Found]]:
    """Solves rows in the workers of an executor, and yields them as they finish. Rows whose worker ended are solved again."""
    pool = _Pool(workers)
    waiting = {job.row: job for job in jobs}
    rounds = 0
    try:
        while waiting:
            unfinished, cause = dict(waiting), None
            for index, found in _round(pool.executor, waiting):
                if isinstance(found, (Row, ValueError)):
                    del unfinished[index]
                    yield index, found
                else:
                    cause = found
            rounds = rounds + 1 if len(unfinished) == len(waiting) else 0
            if cause is not None and (rounds == _ROUNDS or not pool.renew(cause)):
                message = (
                    f"{len(unfinished)} of the rows could not be solved, because workers died while they solved them: {cause!r}; "
                    "if memory was short, use fewer workers or a coarser grid"
                )
                raise RuntimeError(message) from cause
            # What may have ended a worker comes last, so that it cannot keep the others from being solved.
            suspects = min(pool.size, len(unfinished) - 1)
            rows = list(unfinished.items())
            waiting = dict(rows[suspects:] + rows[:suspects])
    except BaseException:
        pool.close(wait=False)
        raise
    pool.close(wait=True)


def _round(executor: Executor, jobs: Mapping[int, Job]) -> Iterator[tuple[int, Found | Exception]]:
    """Hands every row to the executor once. Yields the row, the reason why it cannot be solved, or how its worker ended."""
    done: queue.SimpleQueue[Future[Row]] = queue.SimpleQueue()
    places: dict[Future[Row], int] = {}
    try:
        for index, job in jobs.items():
            try:
                future = executor.submit(solve_row, job._replace(attempt=uuid.uuid4().hex))
            except BrokenExecutor as error:
                yield index, error
                break
            places[future] = index
            future.add_done_callback(done.put)
        for _ in range(len(places)):
            future = _next(done)
            yield places[future], _found(future)
    finally:
        for future in places:
            future.cancel()


def _next(done: queue.SimpleQueue[Future[Row]]) -> Future[Row]:
    while True:
        try:
            # Not for ever: on some systems a wait without an end does not see Ctrl-C.
            return done.get(timeout=0.1)
        except queue.Empty:
            continue


def _found(future: Future[Row]) -> Found | Exception:
    try:
        return future.result()
    except ValueError as error:
        return error
    except Exception as error:
        if isinstance(error, BrokenExecutor) or _ENDED.intersection(kind.__name__ for kind in type(error).__mro__):
            return error
        raise


class _Pool:
    """An executor, and a way to replace it."""

    def __init__(self, workers: Workers) -> None:
        self._make: Callable[[], Executor] | None = None
        if hasattr(workers, "submit") and not isinstance(workers, type):
            self.executor: Executor = workers  # type: ignore[assignment]
        elif callable(workers):
            self._make = workers
            self.executor = workers()
        else:
            raise ValueError(f"executor: must be an executor (with a method submit), or a function that makes one, not {workers!r}")
        self._is_own = self._make is not None

    @property
    def size(self) -> int:
        """Number of rows that are solved at once, if it is known."""
        return int(getattr(self.executor, "_max_workers", None) or os.cpu_count() or 1)

    def renew(self, cause: Exception) -> bool:
        """Replaces an executor that takes no more work. Returns whether there is a usable one."""
        if not isinstance(cause, BrokenExecutor):
            return True
        another = _like(self.executor) if self._make is None else self._make()
        if another is None:
            return False
        self.close(wait=True)
        self.executor, self._is_own = another, True
        return True

    def close(self, *, wait: bool) -> None:
        """Ends an executor that is not the caller's."""
        if self._is_own:
            self.executor.shutdown(wait=wait, cancel_futures=True)


def _like(executor: Executor) -> Executor | None:
    """A new pool of processes like this one. A broken pool cannot be repaired."""
    if type(executor) is not ProcessPoolExecutor:
        return None
    known = vars(executor)
    return ProcessPoolExecutor(
        known.get("_max_workers"), known.get("_mp_context"), known.get("_initializer"), known.get("_initargs", ())
    )
