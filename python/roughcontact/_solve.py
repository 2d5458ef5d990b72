"""One contact problem."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable
from typing import Any, Literal, NamedTuple, Union

import numpy as np
from numpy.typing import NDArray

from roughcontact import _core
from roughcontact._foreign import tell
from roughcontact._keys import (
    SURFACE_FILES,
    Boundary,
    Conductivity,
    Fractional,
    Grid,
    History,
    LengthUnit,
    Mask,
    Method,
    Missing,
    Path,
    Prony,
    Quantity,
    Shape,
    plain,
)
from roughcontact._maps import Heights, as_field, as_heights, as_profile, map_parts
from roughcontact._result import Result, told
from roughcontact._run import Bar, Interrupted, NotConvergedError, NotConvergedWarning, ProgressOption, callback, checked
from roughcontact._surface import Surface

#: A discretisation by its name, or the symbol of a half-space as a function of arrays of wavenumbers (rad/m).
Kernel = Union[Literal["love", "spectral"], Callable[[NDArray[np.float64], NDArray[np.float64]], Any]]

#: Arguments that are no keys of a scene.
_OPTIONS = ("heights", "scene", "kernel", "progress", "check", "strict")


def solve(
    heights: Heights | None = None,
    *,
    scene: Path | None = None,
    cell: Quantity | None = None,
    cell_y: Quantity | None = None,
    line: bool | None = None,
    spectrum: Path | None = None,
    psd: Path | None = None,
    psd_convention: Literal["plain", "fourier"] | None = None,
    like: Path | None = None,
    heights_like: Literal["gaussian", "map"] | None = None,
    unit: LengthUnit | None = None,
    height_unit: LengthUnit | None = None,
    height_scale: Quantity | None = None,
    channel: str | None = None,
    layout: Literal["matrix", "xyz"] | None = None,
    missing: Missing | None = None,
    mask: Mask | None = None,
    waves: int | None = None,
    hurst: float | None = None,
    rms: Quantity | None = None,
    rms_slope: float | None = None,
    c0: float | None = None,
    seed: int | None = None,
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
    pressure: Quantity | None = None,
    penetration: Quantity | None = None,
    force: Quantity | None = None,
    hardness: Quantity | None = None,
    history: History | None = None,
    history_steps: int | None = None,
    fluid_pressure: Path | NDArray[np.float64] | None = None,
    speed: Quantity | None = None,
    direction: Quantity | None = None,
    prony: Prony | None = None,
    glassy_ratio: float | None = None,
    relaxation_time: Quantity | None = None,
    fractional: Fractional | None = None,
    friction: float | None = None,
    shear_pressure: Quantity | None = None,
    shear_displacement: Quantity | None = None,
    shear_angle: Quantity | None = None,
    uncoupled: bool | None = None,
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
    area_error: float | str | None = None,
    output_grid: Grid | None = None,
    precision: Literal["single", "double"] | None = None,
    elements: bool | None = None,
    threads: int | None = None,
    memory_limit: int | str | None = None,
    time_limit: float | str | None = None,
    progress: ProgressOption = False,
    check: bool = False,
    strict: bool = False,
) -> Result:
    """Solve one contact problem. The numbers are those of ``rc solve``, bit for bit.

    Parameters
    ----------
    heights : array_like of shape (ny, nx), HeightMap, Surface or path, optional
        The rough surface (m), positive towards the half-space. Arrays of float64, row by row, are read in place. Other
        arrays are converted. A topography of SurfaceTopography and a map from :func:`read` bring their size along, and so do
        arrays of xarray with coordinates and points, as for :class:`HeightMap`. A :class:`Surface` is evaluated only where the solver needs it. A path names the file of a height map. Default: the
        random surface of the keywords below, as for :class:`Surface`.
    scene : path, optional
        A scene file. Keywords override its keys.
    cell, cell_y : float, optional
        Sides of the periodic cell along x and y (m). An array needs ``cell``. Without ``cell_y``, spacings of a map are equal
        along x and y, and the cell of other surfaces is a square.
    line : bool, optional
        The line contact of a profile in plane strain. ``heights`` is then an array of shape (n,) or (1, n), or the file of a
        profile, and ``cell`` is its length. Fields have the shape (1, n).
    unit, height_unit, height_scale, channel, layout, missing, mask : optional
        How a file is read, as for :func:`read`.
    spectrum, psd, psd_convention, like, heights_like, waves, hurst, rms, rms_slope, c0, seed, truncation, roll_off, low_cut, amplitudes : optional
        A generated surface instead of ``heights``, as for :class:`Surface`.
    shape, radius, angle, wavelength, wave_amplitude, add : optional
        A shape, and the map of the other body, that are added to the surface, or a shape alone, as for :class:`Surface`.
        Beside an array of ``heights`` (m), ``add`` may be an array too.
    grid : int, (int, int) or str, optional
        Finest elements along x and y. Default: 32 per shortest wave, or the points of a map.
    young, poisson : float, optional
        Young's modulus (Pa) and Poisson's ratio. A map needs them, or ``e_star``. Default of a random surface: 0.4 GPa and
        0.45, as in the paper.
    e_star : float, optional
        E* = E/(1-ν²) (Pa), instead of ``young`` and ``poisson``.
    young2, poisson2 : float, optional
        Young's modulus (Pa) and Poisson's ratio of the other body: 1/E* is the sum of (1-ν²)/E of both. Default: it is rigid.
    pressure, penetration, force : float or str
        Mean pressure (Pa), penetration (m), or force (N), which is the mean pressure times the area of the cell. Give exactly
        one. These and all other lengths, pressures and forces may be text with a unit, such as ``"10kPa"``.
    hardness : float, optional
        Upper limit of the pressure (Pa), the usual first model of plastic contact. Default: no limit, an elastic contact.
    history : sequence of float or str, optional
        Mean pressures (Pa) one after the other, such as ``[1e7, 0]``, instead of ``pressure`` and with ``hardness``. Each
        finds the surface that plastic flow under those before it has left. The result is that of the last one above 0, and
        :attr:`Result.residual` is the unloaded surface after the last.
    history_steps : int, optional
        Reach each higher load of ``history`` in this many equal steps, for :attr:`Result.path_difference`.
    fluid_pressure : array or path, optional
        Pressure of a fluid (Pa), one value for each element, which the pressure is nowhere below. The load is that of both.
        The pressures of the result are those that the contact bears beside it.
    speed, direction : float or str, optional
        Speed (m/s) of the surface that slides steadily over a solid that relaxes, and its direction: 0 degrees, the default,
        is along +x, 90 along +y. The moduli are the relaxed ones. Adds :attr:`Result.friction`.
    prony : path, sequence of (g, tau), or a tuple of two arrays, optional
        The solid as a Prony series, with g relative to the relaxed modulus and tau in s. A file may have moduli in Pa, under
        the title E.
    glassy_ratio, relaxation_time : float, optional
        Instead of ``prony``: one relaxation time (s), with the ratio of the glassy to the relaxed modulus.
    fractional : mapping, optional
        Instead of ``prony``: a fractional Zener solid, ``{"alpha": 0.2, "glassy_ratio": 10, "tau": 1e-3}``.
    friction : float, optional
        Coulomb's coefficient of a shear with partial slip, after the normal solve: :attr:`Result.shear_x`, :attr:`Result.slip`.
    shear_pressure, shear_displacement : float or str, optional
        Shear force per nominal area (Pa), or tangential displacement (m) of the rough surface. ``friction`` needs one.
    shear_angle : float or str, optional
        Direction of the shear: 0 degrees, the default, is along +x, 90 along +y.
    uncoupled : bool, optional
        Neglect that unlike bodies couple pressure and shear. Otherwise Poisson's ratios above 0 are refused, unless the
        bodies are alike, or one is rigid and the other incompressible.
    conductivity : float, (float, float) or str, optional
        Electrical (S/m) or thermal (W/(m K)) conductivity of both bodies, or of each, for :attr:`Result.conductance`.
    jump_distance : float or str, optional
        Jump distance (m) of a gas in the gap, for :attr:`Result.mean_inverse_gap`.
    kernel : {"love", "spectral"} or callable, default "love"
        Discretisation of the half-space. A function ``f(kx, ky)`` of two arrays of wavenumbers (rad/m) returns the
        displacement (m) of a pressure wave of 1 Pa, which is ``2 / (E* |k|)`` for a half-space. The displacement must be
        positive, and even in kx and in ky. On a square grid it must also stay the same when kx and ky are exchanged. The
        function is called once, with all waves of the grid except the zero wave, and with mirror images of some. Contact
        edges are located with E*, so E* must agree with the function at the shortest waves of the grid:
        ``E* = 2 / (|k| f)``. Otherwise a warning gives the value that agrees.
    boundary : {"periodic", "free"}, default "periodic"
        What is beyond the heights: the same heights again, or the free surface of the half-space. With "free" the heights are
        a patch with the sides ``cell`` and ``cell_y``. Then ``pressure`` is the load divided by its area, and the penetration
        is the displacement of a rigid body since first touch. Only the kernel love has free borders.
    layer_thickness, layer_poisson : float, optional
        An elastic layer of this thickness (m), bonded to a rigid base, instead of the half-space. ``layer_poisson``
        is Poisson's ratio of the layer. Default: ``poisson``. With ``e_star`` it must be given.
    substrate_young, substrate_poisson : float, optional
        Young's modulus (Pa) and Poisson's ratio of an elastic half-space below the layer, instead of the rigid base. The layer
        is then a coating.
    method : {"adaptive", "uniform", "gauss-seidel"}, optional
        How the problem is solved. Default: adaptive, or uniform where that is cheaper.
    border_level : int, default 0
        How often elements at the edges of contacts are halved beyond the grid (adaptive method, random surfaces).
    energy_tolerance : float, default 0.01
        Certified relative error of the pressure in the energy norm.
    tolerance : float or "auto", optional
        Instead of ``energy_tolerance``: a tolerance relative to the peak-to-valley height. With "auto", the energy error is
        well below the error of the grid.
    leakage : bool, optional
        Also compute the flow of a thin film through the gap: :attr:`Result.leakage` and :attr:`Result.flux`.
    viscosity, pressure_drop : float or str, optional
        Viscosity (Pa s) of the film, and the pressure (Pa) that drives it across the cell or patch: adds ``leakage.flow`` (m³/s).
    area_error : float or str, optional
        Wanted relative error of the contact area, which chooses the grid (random surfaces).
    output_grid : int, (int, int) or str, optional
        Elements along x and y to which :meth:`Result.save` averages pressure and gap.
    precision : "single" or "double", optional
        Type of the numbers in the files of :meth:`Result.save`. Default: "double".
    elements : bool, optional
        Whether :meth:`Result.save` also writes the elements of the adaptive mesh, :attr:`Result.mesh`, to elements.csv.
    threads : int, optional
        Worker threads of this call. Results do not depend on it. Default: all cores.
    memory_limit : int or str, optional
        Maximum memory, in bytes, or as text such as ``"2GB"``. What is estimated to need more is refused.
    time_limit : float or str, optional
        Maximum time, in seconds, or as text such as ``"5min"``. A solve that takes longer is not converged.
    progress : bool or callable, default False
        True draws a bar, if tqdm is installed. A function is called with :class:`Progress`.
    check : bool, default False
        Raise :class:`NotConvergedError` instead of warning with :class:`NotConvergedWarning`.
    strict : bool, default False
        Raise ``ValueError`` instead of warning with :class:`InputWarning`. What only the solution shows is raised after the
        solve, and the attribute ``result`` of the error is the solution.

    Returns
    -------
    Result

    Raises
    ------
    ValueError
        For input that cannot be used, with the message that the command line prints.
    NotConvergedError
        With ``check=True``.
    KeyboardInterrupt
        After Ctrl-C, within 0.2 s. It is an :class:`Interrupted`, whose attribute ``result`` is the solution so far.
    """
    given = locals()
    keys = plain({name: value for name, value in given.items() if name not in _OPTIONS})
    if strict:
        keys["strict"] = True
    fluid = None
    if not isinstance(keys.get("fluid_pressure", ""), str):
        fluid = as_field("fluid_pressure", keys.pop("fluid_pressure"))
    problem = surface_of(heights, keys)
    tell(problem.doubts, strict)
    result = solve_keys(problem, scene=scene, fluid=fluid, kernel=kernel, progress=progress)
    _tell_of(result, strict)
    if result.failure is not None:
        if check:
            raise NotConvergedError(result.failure, result)
        warnings.warn(result.failure, NotConvergedWarning, stacklevel=2)
    return result


def _tell_of(result: Result, strict: bool) -> None:
    """Warns of what the solve told, or raises it with ``strict``."""
    try:
        tell(told(result), strict, stacklevel=4)
    except ValueError as error:
        error.result = result  # type: ignore[attr-defined]
        raise


class Problem(NamedTuple):
    """Keys with those of the surface, and array and size where heights are an array."""

    keys: dict[str, Any]
    heights: Any = None
    sides: Any = None
    #: What was assumed.
    doubts: tuple[str, ...] = ()


def solve_keys(
    problem: Problem,
    *,
    scene: Path | None = None,
    fluid: NDArray[np.float64] | None = None,
    kernel: Kernel | None = None,
    progress: ProgressOption = False,
    is_row: bool = False,
    creep: float | None = None,
) -> Result:
    """Solves the problem of these keys, whether or not it converges."""
    keys, array, sides, _ = problem
    symbol = kernel if callable(kernel) else None
    if kernel is not None and symbol is None:
        keys["kernel"] = kernel
    progress = checked(progress)
    bar = Bar() if progress is True else None
    function = bar or (progress if callable(progress) else None)
    given: _core.Given = {
        "heights": array,
        "sides": sides,
        "fluid": fluid,
        "scene": None if scene is None else os.fspath(scene),
        "kernel": symbol,
        "progress": None if function is None else callback(function),
        "is_row": is_row,
        "creep": creep,
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


def surface_of(heights: Any, keys: dict[str, Any]) -> Problem:
    """The problem of these keys on this surface."""
    if heights is None:
        return Problem(keys)
    if isinstance(heights, Surface):
        return Problem({**heights.keys(), **keys})
    if isinstance(heights, (str, os.PathLike)):
        return Problem({**keys, "heights": os.fspath(heights)})
    of_files = ("unit", "height_unit", "height_scale", "channel", "layout", "missing", "mask")
    for name in (*of_files, *SURFACE_FILES, "psd_convention", "heights_like"):
        if name in keys:
            raise ValueError(f"{name}: is for files; omit it, because the heights are an array (m)")
    if keys.get("line"):
        return Problem(keys, as_profile(heights))
    array, sides, doubts = map_parts(heights)
    other = keys.get("add")
    if other is not None and not isinstance(other, (str, os.PathLike)):
        second = as_heights(other)
        if second.shape != array.shape:
            raise ValueError(f"add: must have the shape of the heights, {array.shape}, not {second.shape}")
        array = array + second[:, ::-1]
        keys = {name: value for name, value in keys.items() if name != "add"}
    return Problem(keys, array, sides, doubts)
