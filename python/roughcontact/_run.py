"""Progress of a solve, and the ways in which it may end."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, Union

import numpy as np

if TYPE_CHECKING:
    from roughcontact._result import Result


class NotConvergedWarning(UserWarning):
    """A solve ended above its tolerance. Its result has ``converged = False``."""


class NotConvergedError(RuntimeError):
    """A solve with ``check=True`` ended above its tolerance.

    Attributes
    ----------
    result : Result
        The best solution that was found.
    """

    result: Result

    def __init__(self, message: str, result: Result) -> None:
        super().__init__(message)
        self.result = result

    def __reduce__(self) -> tuple[Any, ...]:
        return NotConvergedError, (self.args[0], self.result)


class Interrupted(KeyboardInterrupt):
    """Ctrl-C during a solve. It is raised within 0.2 s, even if the solve itself takes longer to stop."""

    def __init__(self, find: Callable[[], Result]) -> None:
        super().__init__()
        self._find = find

    @cached_property
    def result(self) -> Result:
        """The solution so far, not converged. Waits until the solve has stopped; Ctrl-C ends the wait."""
        return self._find()

    def __reduce__(self) -> tuple[Any, ...]:
        # What was found stays in the process that found it.
        return KeyboardInterrupt, ()


class Progress(NamedTuple):
    """The progress of a solve."""

    #: Number of the level, from 1.
    level: int
    #: Number of levels.
    levels: int
    #: Elements along x and y of this level.
    grid: tuple[int, int]
    #: Iterations on this level; 0 when it starts.
    iteration: int
    #: Estimated error, in the units of the tolerance. NaN when a level starts.
    error: float
    #: Tolerance of the error on this level. NaN when a level starts.
    tolerance: float
    #: Elements in contact.
    in_contact: int


#: False, True for a bar, or a function that is called with :class:`Progress`.
ProgressOption = Union[bool, Callable[[Progress], object]]
_Callback = Callable[[int, int, int, int, int, float, float, int], object]

_STEPS = 1000


def checked(progress: ProgressOption) -> ProgressOption:
    """The option, if it is one."""
    if isinstance(progress, np.bool_):
        return bool(progress)
    if isinstance(progress, bool) or callable(progress):
        return progress
    raise ValueError(f"progress: must be True, False or a function, not {progress!r}")


class Bar:
    """A bar of tqdm. Does nothing if tqdm is not installed."""

    def __init__(self) -> None:
        try:
            from tqdm.auto import tqdm
        except ImportError:
            self._bar = None
        else:
            self._bar = tqdm(total=_STEPS, leave=False, bar_format="{desc} {bar} {postfix}")

    def __call__(self, progress: Progress) -> None:
        if self._bar is None:
            return
        self._bar.set_description_str(f"level {progress.level}/{progress.levels}", refresh=False)
        self._bar.n = round(_STEPS * _fallen(progress.error, progress.tolerance))
        self._bar.set_postfix_str(f"error {progress.error:.0e}, tolerance {progress.tolerance:.0e}", refresh=False)
        self._bar.update(0)
        self._bar.refresh()

    def close(self) -> None:
        """Removes the bar."""
        if self._bar is not None:
            self._bar.close()


class RowBar:
    """A bar of tqdm over rows. Does nothing if tqdm is not installed."""

    def __init__(self, done: int, rows: int) -> None:
        try:
            from tqdm.auto import tqdm
        except ImportError:
            self._bar = None
        else:
            self._bar = tqdm(total=rows, initial=done, leave=False, unit="row")

    def one_more(self) -> None:
        """A row is finished."""
        if self._bar is not None:
            self._bar.update(1)

    def close(self) -> None:
        """Removes the bar."""
        if self._bar is not None:
            self._bar.close()


def _fallen(error: float, tolerance: float) -> float:
    """The progress on a logarithmic scale: 0 for an error of 1, and 1 for the tolerance."""
    if not (error > 0.0 and tolerance < 1.0):
        return 0.0
    return min(max(math.log(error) / math.log(tolerance), 0.0), 1.0)


def callback(function: Callable[[Progress], object]) -> _Callback:
    """The function as the extension module calls it."""

    def call(
        level: int, levels: int, nx: int, ny: int, iteration: int, error: float, tolerance: float, n: int
    ) -> object:
        return function(Progress(level, levels, (nx, ny), iteration, error, tolerance, n))

    return call
