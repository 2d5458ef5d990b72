"""Surfaces as sums of waves: random ones with a power-law spectrum, and given Fourier coefficients."""

from __future__ import annotations

import json
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from roughcontact import _core
from roughcontact._keys import Grid, LengthUnit, Path, Quantity, Shape, plain, with_absolute_files

_KEYS = (
    "cell",
    "cell_y",
    "spectrum",
    "psd",
    "psd_convention",
    "like",
    "heights_like",
    "unit",
    "height_scale",
    "waves",
    "hurst",
    "rms",
    "rms_slope",
    "c0",
    "seed",
    "truncation",
    "roll_off",
    "low_cut",
    "amplitudes",
    "shape",
    "radius",
    "angle",
    "wavelength",
    "wave_amplitude",
    "add",
    "grid",
)


class Surface:
    """A random surface (Eq. 9-14 of the paper), or a sum of given waves, evaluated only where a solver needs it.

    Missing parameters have the values of the paper's surface.

    Parameters
    ----------
    cell : float, default 0.01
        Side of the periodic cell (m).
    spectrum : path, optional
        A file of Fourier coefficients, instead of a random surface. It has a line of kx, ky, Re and Im for each wave, and
        needs ``cell``.
    psd : path, optional
        A table of an isotropic spectrum, with lines of q (rad/m) and C (m⁴). It needs ``cell``. There are no waves outside
        the table.
    psd_convention : {"plain", "fourier"}, default "plain"
        The mean square height is the integral of C over both components of q, or this divided by 4π².
    like : path, optional
        A map, or a folder with one: a twin with its spectrum, heights and roughness at each height. Or a profile, a text of
        lines x z: an isotropic surface with its spectrum. Default of the cell and the grid: those of the map.
    heights_like : {"map", "gaussian"}, default "map"
        Height distribution of a twin.
    cell_y : float, optional
        Side of a twin along y (m).
    unit, height_scale : optional
        Unit of the coefficients, m by default, or the height (m) of the value 1 in them.
    waves : int, default 64
        N: the shortest wavelength is 1/N of the cell side.
    hurst : float, default 0.8
        Hurst exponent, above 0 and at most 1.
    rms, rms_slope, c0 : float, optional
        Rms height (m), rms slope, or C0 of Eq. 9 (m⁴). Give at most one. Default: an rms height of 13 µm.
    seed : int, default 1
        Seed of the random phases.
    truncation : {"disc", "square"}, default "disc"
        Which waves there are: ``|k| <= N``, or ``max(|kx|, |ky|) <= N``.
    roll_off : float, default 1
        Number of waves per cell below which the spectrum is flat.
    low_cut : float, optional
        Number of waves per cell below which there are no waves.
    amplitudes : {"fixed", "random"}, default "fixed"
        Amplitudes exactly those of the spectrum, or Gaussian about it.
    shape : {"sphere", "cylinder", "cone", "wave", "flat"}, optional
        A shape whose highest point is at the centre of the cell. It is added to the waves, or is the whole surface if no
        parameter of the waves is given. It then needs ``cell``.
    radius : float or str, optional
        Radius R (m) of the sphere, the paraboloid -r²/2R, or of the cylinder -x²/2R.
    angle : float or str, optional
        Angle of the flank of the cone to the plane (degrees).
    wavelength, wave_amplitude : float or str, optional
        Length and amplitude (m) of the wave along x.
    add : path, optional
        Height map of the other body, which is mirrored along x and added. It has the same grid and cell.
    grid : int, (int, int) or str, optional
        Finest elements along x and y. Default: 32 per shortest wave, 512 for a shape.
    """

    __slots__ = ("_keys",)

    def __init__(
        self,
        *,
        cell: Quantity | None = None,
        cell_y: Quantity | None = None,
        spectrum: Path | None = None,
        psd: Path | None = None,
        psd_convention: Literal["plain", "fourier"] | None = None,
        like: Path | None = None,
        heights_like: Literal["gaussian", "map"] | None = None,
        unit: LengthUnit | None = None,
        height_scale: Quantity | None = None,
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
        add: Path | None = None,
        grid: Grid | None = None,
    ) -> None:
        given = locals()
        self._keys = plain({name: given[name] for name in _KEYS})
        self._keys = with_absolute_files(self._keys)
        # Refuses what is wrong now, not when it is solved.
        _core.resolved_surface(self._keys)

    def keys(self) -> dict[str, Any]:
        """The parameters that were given."""
        return dict(self._keys)

    def resolved(self) -> dict[str, Any]:
        """All parameters, with their defaults."""
        keys: dict[str, Any] = json.loads(_core.resolved_surface(self._keys))
        return {name: value for name, value in keys.items() if value is not None}

    def heights(self, *, threads: int | None = None) -> NDArray[np.float64]:
        """Heights (m) on the grid, shape (ny, nx)."""
        return _core.surface({**self._keys, **plain({"threads": threads})})[0]

    def __eq__(self, other: object) -> bool:
        return self._keys == other._keys if isinstance(other, Surface) else NotImplemented

    def __hash__(self) -> int:
        return hash(tuple(sorted(self._keys.items())))

    def __repr__(self) -> str:
        return f"Surface({', '.join(f'{name}={value!r}' for name, value in self._keys.items())})"

    def __reduce__(self) -> tuple[Any, ...]:
        return _surface_of, (self._keys,)


def _surface_of(keys: dict[str, Any]) -> Surface:
    return Surface(**keys)


def surface(
    *,
    cell: Quantity | None = None,
    cell_y: Quantity | None = None,
    spectrum: Path | None = None,
    psd: Path | None = None,
    psd_convention: Literal["plain", "fourier"] | None = None,
    like: Path | None = None,
    heights_like: Literal["gaussian", "map"] | None = None,
    unit: LengthUnit | None = None,
    height_scale: Quantity | None = None,
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
    add: Path | None = None,
    grid: Grid | None = None,
    threads: int | None = None,
) -> NDArray[np.float64]:
    """Heights (m) of a random surface on its grid, as ``rc surface --out heights.npy`` writes them.

    The parameters are those of :class:`Surface`, and ``threads``, the worker threads (default: all cores).

    Returns
    -------
    ndarray, shape (ny, nx)
    """
    given = locals()
    return Surface(**{name: given[name] for name in _KEYS}).heights(threads=threads)
