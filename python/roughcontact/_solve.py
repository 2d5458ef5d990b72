"""One contact problem."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable
from typing import Any, Literal, Union

import numpy as np
from numpy.typing import NDArray

from roughcontact import _core
from roughcontact._keys import Boundary, Grid, LengthUnit, Method, Path, plain
from roughcontact._maps import Heights, map_parts
from roughcontact._result import Result
from roughcontact._run import Bar, Interrupted, NotConvergedError, NotConvergedWarning, ProgressOption, callback, checked
from roughcontact._surface import Surface

#: A discretisation by its name, or the symbol of a half-space as a function of arrays of wavenumbers (rad/m).
Kernel = Union[Literal["love", "spectral"], Callable[[NDArray[np.float64], NDArray[np.float64]], Any]]

#: Arguments that are no keys of a scene.
_OPTIONS = ("heights", "scene", "kernel", "progress", "check")


def solve(
    heights: Heights | None = None,
    *,
    scene: Path | None = None,
    cell: float | None = None,
    cell_y: float | None = None,
    spectrum: Path | None = None,
    unit: LengthUnit | None = None,
    height_scale: float | None = None,
    channel: str | None = None,
    layout: Literal["matrix", "xyz"] | None = None,
    waves: int | None = None,
    hurst: float | None = None,
    rms: float | None = None,
    rms_slope: float | None = None,
    c0: float | None = None,
    seed: int | None = None,
    truncation: Literal["disc", "square"] | None = None,
    roll_off: float | None = None,
    low_cut: float | None = None,
    amplitudes: Literal["fixed", "random"] | None = None,
    grid: Grid | None = None,
    young: float | None = None,
    poisson: float | None = None,
    e_star: float | None = None,
    pressure: float | None = None,
    penetration: float | None = None,
    hardness: float | None = None,
    kernel: Kernel | None = None,
    boundary: Boundary | None = None,
    layer_thickness: float | None = None,
    layer_poisson: float | None = None,
    method: Method | None = None,
    border_level: int | None = None,
    energy_tolerance: float | None = None,
    tolerance: float | Literal["auto"] | None = None,
    leakage: bool | None = None,
    area_error: float | str | None = None,
    output_grid: Grid | None = None,
    threads: int | None = None,
    memory_limit: int | str | None = None,
    time_limit: float | str | None = None,
    progress: ProgressOption = False,
    check: bool = False,
) -> Result:
    """Solve one contact problem, as ``rc solve`` does: the numbers are the same, bit by bit.

    Parameters
    ----------
    heights : array_like of shape (ny, nx), HeightMap, Surface or path, optional
        The rough surface, in m, positive towards the half-space. Arrays of float64, row by row, are read in place; others
        are converted. A topography of SurfaceTopography and a map from :func:`read` bring their size along. A
        :class:`Surface` is evaluated where the solver needs it, never as a whole array. A path is a height map. Default: a
        random surface of the keywords, which are those of :class:`Surface`.
    scene : path, optional
        A scene file; keywords override it.
    cell, cell_y : float, optional
        Sides of the periodic cell along x and y (m). An array needs ``cell``. Default of ``cell_y``: ``cell``.
    unit, height_scale, channel, layout : optional
        Of a file, as for :func:`read`.
    spectrum, waves, hurst, rms, rms_slope, c0, seed, truncation, roll_off, low_cut, amplitudes : optional
        A random surface instead of ``heights``, as for :class:`Surface`.
    grid : int, (int, int) or str, optional
        Finest elements along x and y. Default: 32 per shortest wave; a map has its own.
    young, poisson : float, optional
        Young's modulus (Pa) and Poisson's ratio. A map needs them, or ``e_star``. Default of a random surface: those of the
        paper, 0.4 GPa and 0.45.
    e_star : float, optional
        E* = E/(1-ν²) (Pa), instead of ``young`` and ``poisson``.
    pressure, penetration : float
        Mean pressure (Pa) or penetration (m): exactly one.
    hardness : float, optional
        No pressure (Pa) is greater, the usual first model of plastic contact. Default: none, an elastic contact.
    kernel : {"love", "spectral"} or callable, default "love"
        Discretisation of the half-space. A function ``f(kx, ky)`` of two arrays of wavenumbers (rad/m) returns the
        displacement (m) of a pressure wave of 1 Pa, ``2 / (E* |k|)`` for a half-space: it must be positive, and even in kx and ky; on
        a square grid also that of kx and ky exchanged. E* must be that of its shortest waves, since contact edges are located with it; a warning names another one. It
        is called once, with all waves of the grid but the zero wave, and with mirror images of some.
    boundary : {"periodic", "free"}, default "periodic"
        What is beyond the heights: the same heights again, or the free surface of the half-space. With "free" the heights are a patch
        of sides ``cell`` and ``cell_y``, ``pressure`` is the load over its area, and the penetration is the displacement of a rigid
        body since first touch (kernel love).
    layer_thickness, layer_poisson : float, optional
        An elastic layer of this thickness (m) on a rigid base to which it sticks, instead of the half-space. Its Poisson's ratio is
        ``poisson``; with ``e_star`` it must be given (uniform method).
    method : {"adaptive", "uniform", "gauss-seidel"}, optional
        Default: adaptive, or uniform where that is cheaper.
    border_level : int, default 0
        Halve elements at the edges of contacts this many times beyond the grid (adaptive method, random surfaces).
    energy_tolerance : float, default 0.01
        Certified relative error of the pressure in the energy norm.
    tolerance : float or "auto", optional
        Instead: relative to the peak-to-valley height; or an energy error well below the error of the grid.
    leakage : bool, optional
        Compute the flow of a thin film through the gap too: :attr:`Result.leakage` and :attr:`Result.flux`.
    area_error : float or str, optional
        Choose the grid so that the relative error of the contact area is at most this (random surfaces).
    output_grid : int, (int, int) or str, optional
        :meth:`Result.save` writes pressure and gap averaged to so many elements.
    threads : int, optional
        Worker threads of this call. Default: all cores. No result depends on it.
    memory_limit : int or str, optional
        Most memory, in bytes or as ``"2GB"``.
    time_limit : float or str, optional
        Most time, in seconds or as ``"5min"``; a solve that takes longer is not converged.
    progress : bool or callable, default False
        True draws a bar of tqdm if it is installed; a function is called with :class:`Progress`.
    check : bool, default False
        Raise :class:`NotConvergedError` instead of warning with :class:`NotConvergedWarning`.

    Returns
    -------
    Result

    Raises
    ------
    ValueError
        For input that cannot be used, with the sentence of the command line.
    NotConvergedError
        With ``check=True``.
    KeyboardInterrupt
        After Ctrl-C, within 0.2 s: an :class:`Interrupted`, whose attribute ``result`` is what was found so far.
    """
    given = locals()
    keys = plain({name: value for name, value in given.items() if name not in _OPTIONS})
    result = solve_keys(heights, keys, scene=scene, kernel=kernel, progress=progress)
    if result.failure is not None:
        if check:
            raise NotConvergedError(result.failure, result)
        warnings.warn(result.failure, NotConvergedWarning, stacklevel=2)
    return result


def solve_keys(
    heights: Any,
    keys: dict[str, Any],
    *,
    scene: Path | None = None,
    kernel: Kernel | None = None,
    progress: ProgressOption = False,
    is_row: bool = False,
) -> Result:
    """Solves the problem of these keys, whether or not it converges."""
    keys, array, sides = surface_of(heights, keys)
    symbol = kernel if callable(kernel) else None
    if kernel is not None and symbol is None:
        keys["kernel"] = kernel
    progress = checked(progress)
    bar = Bar() if progress is True else None
    function = bar or (progress if callable(progress) else None)
    given: _core.Given = {
        "heights": array,
        "sides": sides,
        "scene": None if scene is None else os.fspath(scene),
        "kernel": symbol,
        "progress": None if function is None else callback(function),
        "is_row": is_row,
    }
    try:
        solved, unfinished, ended = _core.solve(keys, given)
    finally:
        if bar is not None:
            bar.close()
    if ended is None and solved is not None:
        return Result(solved)
    raise _early(ended, solved, unfinished)


def _early(
    ended: BaseException | None, solved: _core.Solved | None, unfinished: _core.Unfinished | None
) -> BaseException:
    """What ended a solve early, with what was found so far."""

    def find() -> Result:
        if unfinished is not None:
            return Result(unfinished.wait())
        if solved is None:
            raise RuntimeError("the solve ended without a result")
        return Result(solved)

    if ended is None or type(ended) is KeyboardInterrupt:
        return Interrupted(find)
    if solved is not None:
        ended.result = Result(solved)  # type: ignore[attr-defined]
    return ended


def surface_of(heights: Any, keys: dict[str, Any]) -> tuple[dict[str, Any], Any, Any]:
    """The keys with those of the surface, and array and size where heights are an array."""
    if heights is None:
        return keys, None, None
    if isinstance(heights, Surface):
        return {**heights.keys(), **keys}, None, None
    if isinstance(heights, (str, os.PathLike)):
        return {**keys, "heights": os.fspath(heights)}, None, None
    for name in ("unit", "height_scale", "channel", "layout", "spectrum"):
        if name in keys:
            raise ValueError(f"{name}: is for files; heights that are an array are in metres, so omit it")
    return keys, *map_parts(heights)
