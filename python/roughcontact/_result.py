"""A solved contact problem: numbers, fields and files."""

from __future__ import annotations

import io
import json
import os
import pathlib
import tempfile
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from roughcontact import _core
from roughcontact._keys import Path

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]


class Certificate(NamedTuple):
    """How far the pressure is from solving the discrete problem, from a fresh application of the operator."""

    #: Bound on the relative error of the pressure in the energy norm.
    energy_error: float
    #: Σ p (g - min g) / (H Σ p), with the height range H.
    complementarity_error: float
    #: max(-g) / H.
    penetration_error: float
    #: Relative deviation of the mean pressure, or of the penetration over H.
    load_error: float
    #: What ``energy_error`` was to reach, or None.
    energy_tolerance: float | None
    #: What ``complementarity_error`` and ``penetration_error`` were to reach, or None.
    tolerance: float | None


class ContactSpot(NamedTuple):
    """One connected part of the contact."""

    #: Elements of it.
    elements: int
    #: Its part of the nominal area.
    area_fraction: float
    #: Length of its edge (m).
    perimeter: float
    #: 1 minus the number of its holes.
    euler_number: float
    #: Its part of the mean pressure (Pa).
    mean_pressure: float


class StressDistribution(NamedTuple):
    """The density of the interfacial stress over the nominal area."""

    #: Ends of the bins (Pa), one more than bins.
    edges: Floats
    #: P(σ) (1/Pa), the mean over each bin.
    density: Floats
    #: Part of the nominal area under stress, the integral of P over all σ > 0.
    area_fraction: float


class Elements(NamedTuple):
    """Elements in contact of a mesh that is not the grid."""

    #: Centres (m).
    x: Floats
    #: Centres (m).
    y: Floats
    #: Sides (m).
    size: Floats
    #: Pressures (Pa).
    pressure: Floats


class _Source(Protocol):
    """Where a result comes from: a solve, or the files of one."""

    @property
    def failure(self) -> str | None: ...
    def summary_json(self) -> str: ...
    def scene(self) -> str: ...
    def pressure(self) -> Floats: ...
    def gap(self) -> Floats: ...
    def displacement(self) -> Floats: ...
    def elements(self) -> list[Floats] | None: ...
    def save(self, folder: str) -> None: ...


def _locked(field: Floats) -> Floats:
    """The field, not to be changed: spots and distributions are computed from it."""
    field.flags.writeable = False
    return field


class _Stored:
    """The files of a result, byte by byte: what a pickle holds."""

    def __init__(self, files: dict[str, bytes]) -> None:
        self.files = files

    @property
    def failure(self) -> str | None:
        status = json.loads(self.summary_json())["status"]
        return "not converged" if status == "not_converged" else None

    def summary_json(self) -> str:
        return self.files["summary.json"].decode()

    def scene(self) -> str:
        return self.files["scene.toml"].decode()

    def pressure(self) -> Floats:
        return self._array("pressure.npy")

    def gap(self) -> Floats:
        return self._array("gap.npy")

    def displacement(self) -> Floats:
        raise ValueError("displacement: a result that was read or unpickled does not have it; solve again")

    def elements(self) -> list[Floats] | None:
        text = self.files.get("elements.csv")
        if text is None:
            return None
        return list(np.loadtxt(io.BytesIO(text), delimiter=",", skiprows=1, ndmin=2).reshape(-1, 4).T)

    def save(self, folder: str) -> None:
        os.makedirs(folder, exist_ok=True)
        for name, data in self.files.items():
            final = pathlib.Path(folder, name)
            partial = final.with_name(final.name + ".partial")
            partial.write_bytes(data)
            os.replace(partial, final)

    def _array(self, name: str) -> Floats:
        array: Floats = np.load(io.BytesIO(self.files[name]))
        return array


class Result:
    """A solved contact problem.

    Every key of the summary is an attribute: pressures in Pa, lengths in m, areas as parts of the nominal area. Arrays have
    the shape (ny, nx), and are made when they are first asked for.
    """

    #: ``converged``, ``full_contact`` or ``not_converged``.
    status: str
    #: What was prescribed: ``pressure`` or ``penetration``.
    control: str
    #: ``love``, ``spectral``, or ``own`` for a function.
    kernel: str
    #: ``adaptive``, ``uniform`` or ``gauss-seidel``.
    method: str
    #: Why it was this method.
    method_reason: str
    #: Elements along x and y.
    grid: list[int]
    #: How often elements at edges were halved beyond the grid.
    border_level: int
    #: Elements in contact on an adaptive mesh; all for the uniform method. Their values are in :attr:`mesh`.
    elements: int
    #: Nested levels.
    levels: int
    #: Mean pressure σ0 (Pa).
    mean_pressure: float
    #: Penetration Δ (m).
    penetration: float
    #: Penetration of full contact (m).
    penetration_full_contact: float
    #: Contact area, best estimate.
    area_fraction: float
    #: Contact area by counting elements.
    area_fraction_cells: float
    #: Estimated error of ``area_fraction``.
    area_fraction_error: float
    #: Length of the edges of all contacts (m).
    contact_perimeter: float
    #: Rms pressure over the cell (Pa), of the elements.
    rms_pressure: float
    #: Rms pressure (Pa), best estimate.
    rms_pressure_corrected: float
    #: Estimated error of ``rms_pressure_corrected`` (Pa).
    rms_pressure_error: float | None
    #: Maximum pressure (Pa).
    max_pressure: float
    #: Mean gap (m).
    mean_gap: float
    #: Estimated error of ``mean_gap`` and ``penetration`` (m).
    mean_gap_error: float
    #: dσ0/dΔ (Pa/m); None in full contact.
    contact_stiffness: float | None
    #: Elastic energy of the cell (J).
    elastic_energy: float
    #: Rms height about the mean (m).
    rms_height: float
    #: Rms slope.
    rms_slope: float
    #: Maximum height on the grid (m).
    h_max: float
    #: See :class:`Certificate`.
    complementarity_error: float
    #: See :class:`Certificate`.
    penetration_error: float
    #: See :class:`Certificate`.
    energy_error: float
    #: See :class:`Certificate`.
    load_error: float
    #: See :class:`Certificate`.
    tolerance: float | None
    #: See :class:`Certificate`.
    energy_tolerance: float | None
    #: Elements whose gap the certificate computed.
    cells_evaluated: int
    #: Elements that are proven to be out of contact.
    cells_proven: int
    #: Iterations on each level, coarsest first.
    level_iterations: list[int]
    #: Iterations on the finest level.
    iterations: int
    #: Applications of the operator on the finest level.
    operator_applications: int
    #: Seconds from the checked scene to the certified solution.
    wall_seconds: float
    #: Peak memory of the process.
    peak_memory_bytes: int | None
    #: Worker threads.
    threads: int
    #: Version of the package.
    version: str

    def __init__(self, source: _Source) -> None:
        self._source = source

    @cached_property
    def summary(self) -> dict[str, Any]:
        """All numbers, as in ``summary.json``."""
        summary: dict[str, Any] = json.loads(self._source.summary_json())
        return summary

    def __getattr__(self, name: str) -> Any:
        # Only for what is not found otherwise: the keys of the summary.
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self.summary[name]
        except KeyError:
            raise AttributeError(f"a Result has no '{name}'") from None

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self.summary})

    @property
    def failure(self) -> str | None:
        """What is to be said of a result that did not converge; None of one that did."""
        return self._source.failure

    @property
    def converged(self) -> bool:
        """Whether the tolerance was reached."""
        return self._source.failure is None

    @property
    def scene(self) -> str:
        """The scene as it was solved, as in ``scene.toml``."""
        return self._source.scene()

    @cached_property
    def _numbers(self) -> tuple[list[float], float, int | None]:
        return _core.scene_numbers(self.scene)

    @property
    def sides(self) -> tuple[float, float]:
        """Sides of the cell along x and y (m)."""
        x, y = self._numbers[0]
        return x, y

    @property
    def e_star(self) -> float:
        """E* (Pa)."""
        return self._numbers[1]

    @property
    def seed(self) -> int | None:
        """Seed of a random surface; None of a height map."""
        return self._numbers[2]

    @cached_property
    def pressure(self) -> Floats:
        """Pressure (Pa), shape (ny, nx), ≥ 0; read-only."""
        return _locked(self._source.pressure())

    @cached_property
    def gap(self) -> Floats:
        """Gap (m), shape (ny, nx), with its pressure-weighted mean at zero; zero in contact within the tolerance; read-only."""
        return _locked(self._source.gap())

    @cached_property
    def displacement(self) -> Floats:
        """Displacement of the elastic surface (m), shape (ny, nx), of mean zero; read-only."""
        return _locked(self._source.displacement())

    @property
    def contact(self) -> NDArray[np.bool_]:
        """Where the surfaces touch, shape (ny, nx)."""
        return self.pressure > 0.0

    @cached_property
    def mesh(self) -> Elements | None:
        """Elements in contact with their pressures; None where the elements are those of the grid (uniform method)."""
        columns = self._source.elements()
        return None if columns is None else Elements(*columns)

    @property
    def certificate(self) -> Certificate:
        """How far the pressure is from solving the discrete problem."""
        return Certificate(**{name: self.summary[name] for name in Certificate._fields})

    @cached_property
    def spots(self) -> list[ContactSpot]:
        """Contact spots, largest first."""
        found = _core.spots(self.pressure, self.gap, self.sides, self.e_star, self.scene)
        return [ContactSpot(*spot) for spot in found]

    def stress_distribution(self, bins: int | Sequence[float] | Floats = 50) -> StressDistribution:
        """The density P(σ) of the interfacial stress, resolved below the element at contact edges.

        With a border level it is that of the mean pressures on the grid.

        Parameters
        ----------
        bins : int or sequence of float, default 50
            Number of equal bins from 0 to the maximum pressure, or the ends of the bins (Pa), increasing.
        """
        wrong = ValueError("bins: must be a positive number, or increasing and finite ends of bins (Pa) from 0 on")
        if isinstance(bins, (int, np.integer)):
            if isinstance(bins, bool) or bins < 1:
                raise wrong
            edges = np.linspace(0.0, self.max_pressure, int(bins) + 1)
        else:
            edges = np.asarray(bins, float)
        if edges.ndim != 1 or edges.size < 2 or not np.all(np.isfinite(edges)):
            raise wrong
        if not np.all(np.diff(edges) > 0) or edges[0] < 0:
            raise wrong
        density, area = _core.stress_distribution(self.pressure, self.e_star, edges.tolist())
        return StressDistribution(edges, density, area)

    def save(self, folder: Path) -> None:
        """Write the files of ``rc solve --out``: summary, scene, fields, elements and the picture of the contact."""
        self._source.save(os.fspath(folder))

    def report(self, path: Path) -> None:
        """Write the page of ``rc report``: one HTML file that needs no network."""
        target = os.path.abspath(os.fspath(path))
        with tempfile.TemporaryDirectory() as folder:
            stored = os.path.join(folder, pathlib.Path(target).stem)
            self.save(stored)
            _core.run(["rc", "report", stored, "--out", target, "--quiet"])

    def plot(self) -> Figure:
        """Maps of pressure and gap, and the stress distribution, as a figure of matplotlib."""
        from roughcontact._display import figure

        return figure(self)

    def _repr_html_(self) -> str:
        from roughcontact._display import html

        return html(self)

    def __repr__(self) -> str:
        nx, ny = self.grid
        return (
            f"Result({self.status}, {nx} x {ny}, {self.method}: area_fraction={self.area_fraction:.6g} "
            f"± {self.area_fraction_error:.1g}, mean_pressure={self.mean_pressure:.6g} Pa, "
            f"penetration={self.penetration:.6g} m)"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        if isinstance(self._source, _Stored):
            return _stored, (self._source.files,)
        with tempfile.TemporaryDirectory() as folder:
            self.save(folder)
            return _stored, (_files_in(folder),)


def _stored(files: dict[str, bytes]) -> Result:
    return Result(_Stored(files))


def _files_in(folder: str) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(pathlib.Path(folder).iterdir()) if path.is_file()}


#: Files of a result folder; the others there belong to somebody else.
_FILES = ("summary.json", "scene.toml", "pressure.npy", "gap.npy", "contact.png", "elements.csv", "heights.npy")


def load(folder: Path) -> Result:
    """Read a result folder, as ``rc solve --out`` and :meth:`Result.save` write it.

    Raises
    ------
    ValueError
        For a folder that is not one, with the sentence of the command line.
    """
    folder = os.fspath(folder)
    _core.inspect_result(folder)
    return _stored({name: data for name, data in _files_in(folder).items() if name in _FILES})
