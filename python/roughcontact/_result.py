"""A solved contact problem: numbers, fields and files."""

from __future__ import annotations

import io
import json
import os
import pathlib
import tempfile
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from roughcontact import _core
from roughcontact._display import figure, html
from roughcontact._foreign import of_keywords
from roughcontact._keys import Path
from roughcontact._records import Certificate, ContactSpot, Elements, Floats, Leakage, StressDistribution
from roughcontact._stored import FILES, Source, Stored, files_in

if TYPE_CHECKING:
    from matplotlib.figure import Figure

def _locked(field: Floats) -> Floats:
    """The field, not to be changed: spots and distributions are computed from it."""
    field.flags.writeable = False
    return field


def told(result: Result) -> list[str]:
    """The texts of what the solve warned of, as far as they are known without the summary, which takes longer."""
    warnings_of = getattr(result._source, "warnings", None)
    return [] if warnings_of is None else [of_keywords(text) for _, text in warnings_of()]


class Result:
    """A solved contact problem.

    Every key of the summary is an attribute. Pressures are in Pa, lengths in m, and areas relative to the nominal area.
    Arrays have the shape (ny, nx), and are computed at first use.
    """

    #: ``converged``, ``full_contact`` or ``not_converged``.
    status: str
    #: What was prescribed: ``pressure``, ``penetration`` or ``force``. The summary then has the ``force`` (N).
    control: str
    #: ``love``, ``spectral``, or ``own`` for a function.
    kernel: str
    #: ``adaptive``, ``uniform`` or ``gauss-seidel``.
    method: str
    #: The reason for this method.
    method_reason: str
    #: Elements along x and y.
    grid: list[int]
    #: How often elements at edges were halved beyond the grid.
    border_level: int
    #: Elements in contact on an adaptive mesh, whose values are in :attr:`mesh`. All elements for the uniform method.
    elements: int
    #: Nested levels.
    levels: int
    #: Mean pressure σ0 (Pa).
    mean_pressure: float
    #: Estimated error of ``mean_pressure`` (Pa). ``None`` under a given load.
    mean_pressure_error_bar: float | None
    #: Penetration Δ (m).
    penetration: float
    #: Estimated error of ``penetration`` at this load (m). It contains the height of the surface's maximum above the
    #: highest sample.
    penetration_error_bar: float
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
    #: Rms pressure of the elements over the cell (Pa).
    rms_pressure: float
    #: Rms pressure (Pa), best estimate.
    rms_pressure_corrected: float
    #: Estimated error of ``rms_pressure_corrected`` (Pa). ``None`` where contact reaches a free border, because the
    #: rms of the singular pressure has no limit. ``None`` in full contact on one grid with the kernel ``spectral``.
    rms_pressure_error: float | None
    #: Maximum pressure (Pa).
    max_pressure: float
    #: Mean gap (m).
    mean_gap: float
    #: Estimated error of ``mean_gap`` (m).
    mean_gap_error: float
    #: dσ0/dΔ (Pa/m); None in full contact.
    contact_stiffness: float | None
    #: Electrical or thermal conductance of the contact spots, per nominal area and conductivity (1/m); None in full contact.
    contact_conductance: float | None
    #: Estimated error of ``contact_conductance`` (1/m).
    contact_conductance_error: float | None
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
    #: Elements whose gap the certificate computed. With border levels, they have several sizes.
    cells_evaluated: int
    #: Elements of the smallest size that are proven to be out of contact.
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

    def __init__(self, source: Source) -> None:
        self._source = source

    @cached_property
    def summary(self) -> dict[str, Any]:
        """All numbers, as in ``summary.json``."""
        summary: dict[str, Any] = json.loads(self._source.summary_json())
        return summary

    @cached_property
    def warnings(self) -> list[dict[str, str]]:
        """What is in doubt about input and result: ``code`` and ``text`` of each, as in ``summary.json``."""
        return list(self.summary.get("warnings") or [])

    @property
    def cells(self) -> dict[str, Any]:
        """The summary as a row of a sweep's table, by column. From ``leakage`` it takes the permeances, their errors and ``percolates``."""
        cells: dict[str, Any] = json.loads(_core.cells(self._source.summary_json(), self.scene))
        return cells

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
        """A sentence that says why the result did not converge. None if it did.

        A result that was loaded or unpickled says only "not converged".
        """
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
        """Seed of a random surface. None for a height map."""
        return self._numbers[2]

    @cached_property
    def pressure(self) -> Floats:
        """Pressure (Pa), shape (ny, nx), ≥ 0, read-only. That of a fluid is not in it: :attr:`fluid_pressure`."""
        return _locked(self._source.pressure())

    @cached_property
    def gap(self) -> Floats:
        """Gap (m), shape (ny, nx), read-only. Its pressure-weighted mean is zero; in contact it is zero within the tolerance."""
        return _locked(self._source.gap())

    @cached_property
    def plastic_gap(self) -> Floats | None:
        """Overlap that plastic flow has removed (m), shape (ny, nx), ≥ 0, read-only. None without a hardness."""
        field = self._source.plastic_gap()
        return None if field is None else _locked(field)

    @cached_property
    def residual(self) -> Floats | None:
        """Heights of the unloaded surface after ``history`` (m), shape (ny, nx), read-only. None without it, and if it did not converge."""
        field = self._source.residual()
        return None if field is None else _locked(field)

    @cached_property
    def fluid_pressure(self) -> Floats | None:
        """Pressure of the fluid (Pa) that was given, shape (ny, nx), read-only. None without one. It adds to :attr:`pressure`."""
        field = self._source.fluid_pressure()
        return None if field is None else _locked(field)

    @property
    def mean_fluid_pressure(self) -> float | None:
        """Mean pressure of the fluid (Pa). None without ``fluid_pressure``."""
        return self.summary.get("mean_fluid_pressure")

    @property
    def mean_contact_pressure(self) -> float | None:
        """Mean of :attr:`pressure`, which the contact bears beside the fluid (Pa). None without ``fluid_pressure``."""
        return self.summary.get("mean_contact_pressure")

    @property
    def force(self) -> float | None:
        """The force that was prescribed (N). None if pressure or penetration was."""
        return self.summary.get("force")

    @property
    def second_body(self) -> dict[str, float] | None:
        """``young`` (Pa) and ``poisson`` of the other body. None if it is rigid, or if only E* is known."""
        return self.summary.get("second_body")

    @property
    def hardness(self) -> float | None:
        """Maximum pressure that the contact bears (Pa). None for an elastic contact."""
        return self.summary.get("hardness")

    @property
    def plastic_area_fraction(self) -> float | None:
        """Area where the pressure equals the hardness, best estimate. None without a hardness."""
        return self.summary.get("plastic_area_fraction")

    @property
    def plastic_area_fraction_error(self) -> float | None:
        """Estimated error of ``plastic_area_fraction``."""
        return self.summary.get("plastic_area_fraction_error")

    @property
    def mean_plastic_gap(self) -> float | None:
        """Mean over the cell of the overlap that plastic flow has removed (m). None without a hardness."""
        return self.summary.get("mean_plastic_gap")

    @property
    def residual_rms_height(self) -> float | None:
        """Rms height of :attr:`residual` (m). None without ``history``."""
        return self.summary.get("residual_rms_height")

    @property
    def path_difference(self) -> dict[str, float] | None:
        """Relative changes by ``history_steps``: ``area_fraction``, ``removed_volume``, ``residual_rms_height``. None without it."""
        return self.summary.get("path_difference")

    @property
    def friction(self) -> float | None:
        """Friction coefficient of a surface that slides, from what the solid dissipates. None without ``speed``."""
        return self.summary.get("friction")

    @property
    def friction_error(self) -> float | None:
        """Estimated error of ``friction``, of the mesh and the iteration."""
        return self.summary.get("friction_error")

    @property
    def friction_bound(self) -> float | None:
        """Proven bound of the error of ``friction`` that the iteration leaves on this grid."""
        return self.summary.get("friction_bound")

    @property
    def lateral_friction(self) -> float | None:
        """Force on the solid to the left of the velocity, relative to the load. None without ``speed``.

        The force on the surface is the opposite one: a positive value pushes it to the right.
        """
        return self.summary.get("lateral_friction")

    @property
    def dissipated_power(self) -> float | None:
        """Power that the solid dissipates, per nominal area (W/m²). None without ``speed``."""
        return self.summary.get("dissipated_power")

    @property
    def max_loss_tangent(self) -> float | None:
        """Maximum loss tangent of the waves of the grid at this speed. None without ``speed``."""
        return self.summary.get("max_loss_tangent")

    @property
    def coulomb_friction(self) -> float | None:
        """Coulomb's coefficient ``friction`` of a sheared contact. None without a shear."""
        return self.summary.get("coulomb_friction")

    @property
    def shear_pressure(self) -> float | None:
        """Shear force per nominal area (Pa). None without a shear."""
        return self.summary.get("shear_pressure")

    @property
    def shear_force(self) -> float | None:
        """Shear force on the cell (N). None without a shear."""
        return self.summary.get("shear_force")

    @property
    def shear_displacement(self) -> float | None:
        """Tangential displacement of the bodies far from the contact (m). None without a shear."""
        return self.summary.get("shear_displacement")

    @property
    def stick_area_fraction(self) -> float | None:
        """Area where the surfaces stick, relative to the nominal area. None without a shear."""
        return self.summary.get("stick_area_fraction")

    @property
    def slip_area_fraction(self) -> float | None:
        """Area where the surfaces slip, relative to the nominal area. None without a shear."""
        return self.summary.get("slip_area_fraction")

    @property
    def tangential_stiffness(self) -> float | None:
        """Stiffness dτ/dd before slip (Pa/m). None without a shear and in full contact."""
        return self.summary.get("tangential_stiffness")

    @property
    def slip_work(self) -> float | None:
        """Energy of the cell that slip dissipates (J). None without a shear."""
        return self.summary.get("slip_work")

    @property
    def shear_error(self) -> float | None:
        """Bound of the relative error of the tractions in the energy norm. None without a shear."""
        return self.summary.get("shear_error")

    @property
    def shear_rounds(self) -> int | None:
        """Rounds that corrected the tractions. None without a shear."""
        return self.summary.get("shear_rounds")

    @property
    def shear_note(self) -> str | None:
        """What the shear neglects. None if nothing, and without ``friction``."""
        return self.summary.get("shear_note")

    @cached_property
    def _shear(self) -> tuple[Floats, ...] | None:
        fields = self._source.shear()
        return None if fields is None else tuple(_locked(field) for field in fields)

    @property
    def shear_x(self) -> Floats | None:
        """Traction on the elastic body along x (Pa), shape (ny, nx), read-only. None without a shear."""
        return None if self._shear is None else self._shear[0]

    @property
    def shear_y(self) -> Floats | None:
        """Traction on the elastic body along y (Pa), shape (ny, nx), read-only. None without a shear."""
        return None if self._shear is None else self._shear[1]

    @property
    def slip(self) -> Floats | None:
        """Length of the slip (m), shape (ny, nx), 0 where it sticks, read-only. None without a shear."""
        return None if self._shear is None else self._shear[2]

    @property
    def conductance(self) -> float | None:
        """Conductance per nominal area (S/m² or W/(m² K)). None without ``conductivity`` and in full contact."""
        return self.summary.get("conductance")

    @property
    def conductance_error(self) -> float | None:
        """Estimated error of ``conductance``, in its unit."""
        return self.summary.get("conductance_error")

    @property
    def mean_inverse_gap(self) -> float | None:
        """Mean of 1/(gap + ``jump_distance``) over the nominal area (1/m). None without ``jump_distance``."""
        return self.summary.get("mean_inverse_gap")

    @cached_property
    def displacement(self) -> Floats:
        """Displacement v of the elastic surface (m), shape (ny, nx), positive away from the rough surface, read-only.

        In contact, ``displacement - heights`` is constant, and elsewhere it is larger by the gap. The displacement of a
        periodic half-space has mean zero, that of a layer the mean by which the mean pressure compresses it, and that of a
        patch with free borders is relative to points far away. The first access takes one application of the operator.
        """
        return _locked(self._source.displacement())

    @property
    def leakage(self) -> Leakage | None:
        """Flow through the gap. None without ``leakage=True``, and if the flow did not converge."""
        flow = self.summary.get("leakage")
        return None if flow is None else Leakage(**flow)

    @cached_property
    def flux(self) -> tuple[Floats, Floats] | None:
        """Components along x and y of the flux (m²), shape (ny, nx), read-only.

        They belong to one flow, that along ``leakage.flow_direction``, for ΔP = 1 across the cell and 12 η = 1. None if nothing flows, or without
        ``leakage=True``.
        """
        fields = self._source.flux()
        if fields is None:
            return None
        x, y = fields
        return _locked(x), _locked(y)

    @property
    def contact(self) -> NDArray[np.bool_]:
        """Where the surfaces touch, shape (ny, nx).

        With the border level n it is on the grid of the smallest elements, shape (ny 2ⁿ, nx 2ⁿ).
        """
        return self._finest_pressure("contact") > 0.0

    def _finest_pressure(self, wanted: str) -> Floats:
        """Pressure on the grid of the smallest elements. All parts of a larger element have its pressure."""
        nx, ny = self.grid
        finer = 2**self.border_level
        if finer > 1 and self.mesh is not None:
            x, y, size, pressure = self.mesh
            side = self.sides[0] / (nx * finer)
            field = np.zeros((ny * finer, nx * finer))
            across = np.rint(size / side).astype(np.intp)
            for n in np.unique(across):
                of = across == n
                ix, iy = (np.rint(centre[of] / side - n / 2).astype(np.intp) for centre in (x, y))
                for dy, dx in np.ndindex(n, n):
                    field[iy + dy, ix + dx] = pressure[of]
            return field
        if self.pressure.shape != (ny, nx):
            height, width = self.pressure.shape
            means = f"{width} x {height} means over blocks (output_grid) instead of {nx} x {ny} elements"
            raise ValueError(f"{wanted}: needs the elements, and the folder has {means}; solve again without output_grid")
        return self.pressure

    @cached_property
    def mesh(self) -> Elements | None:
        """The elements in contact, and their pressures. None if the elements are those of the grid (uniform method)."""
        columns = self._source.elements()
        return None if columns is None else Elements(*columns)

    @property
    def certificate(self) -> Certificate:
        """How far the pressure is from solving the discrete problem."""
        return Certificate(**{name: self.summary[name] for name in Certificate._fields})

    @cached_property
    def spots(self) -> list[ContactSpot]:
        """Contact spots, largest first. With a border level they consist of the smallest elements."""
        if isinstance(self._source, Stored) and self._source.spots is not None:
            return self._source.spots
        pressure = self._finest_pressure("spots")
        gap = self._source.finest_gap() if self.border_level else None
        if gap is None:
            # With a hardness, edges follow from the overlap that plastic flow has removed.
            gap = self.gap if self.plastic_gap is None else self.gap - self.plastic_gap
        found = _core.spots((pressure, gap), (self.sides, self.e_star), self.scene, self.area_fraction)
        return [ContactSpot(*spot) for spot in found]

    def stress_distribution(self, bins: int | Sequence[float] | Floats = 50) -> StressDistribution:
        """The density P(σ) of the interfacial stress. Its area is the contact area :attr:`area_fraction`.

        With a border level it is computed from the smallest elements.

        Parameters
        ----------
        bins : int or sequence of float, default 50
            Number of equal bins from 0 to the maximum pressure, or the increasing ends of the bins (Pa).
        """
        wrong = ValueError("bins: must be a whole number above 0, or ends of bins (Pa) that are finite, not negative, and increasing")
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
        pressure = self._finest_pressure("stress_distribution")
        density, area = _core.stress_distribution(pressure, self.e_star, edges.tolist(), self.area_fraction)
        return StressDistribution(edges, density, area)

    def gradient(self, name: str, fixed: str | None = None) -> Floats:
        """Derivatives of a number with respect to the height of each element, shape (ny, nx).

        The elements in contact are held fixed, so the derivatives are exact unless an element is just about to touch or to
        part. Their errors are those of the pressure. The penetration is measured from the highest element, which therefore
        has a derivative of its own; of several highest elements, the first has it. A call takes one linear solve.

        Parameters
        ----------
        name : {"elastic_energy", "mean_pressure", "penetration", "mean_gap"}
            The number. The unit of the derivatives is its SI unit per m.
        fixed : {"pressure", "penetration"}, optional
            What stays the same. Default: what the solve was given.

        Raises
        ------
        ValueError
            Unless the contact is elastic, in a periodic cell, and on elements of one size.
        """
        return self._source.gradient(name, fixed)

    def gradient_of(self, df_dp: Any, fixed: str | None = None) -> Floats:
        """Derivatives with respect to the heights of any function f of the pressures, in the unit of f per m.

        It is :meth:`gradient` for functions of your own: the product of ``df_dp`` with the derivatives of the pressures,
        for the reverse mode of automatic differentiation.

        Parameters
        ----------
        df_dp : array
            Derivatives of f with respect to the pressure of each element (1/Pa), shape (ny, nx). Those out of contact do not
            count.
        fixed : {"pressure", "penetration"}, optional
            As in :meth:`gradient`.
        """
        derivatives = np.ascontiguousarray(df_dp, dtype=np.float64)
        nx, ny = self.grid
        if derivatives.shape != (ny, nx):
            raise ValueError(f"df_dp: must have the shape of the pressure, {(ny, nx)}, not {derivatives.shape}")
        return self._source.gradient_of(derivatives, fixed)

    def save(self, folder: Path) -> None:
        """Write the files of ``rc solve --out``: summary, scene, fields and a picture of the contact."""
        self._source.save(os.fspath(folder))

    def report(self, path: Path) -> None:
        """Write the page of ``rc report``, one HTML file that needs no network."""
        target = os.path.abspath(os.fspath(path))
        with tempfile.TemporaryDirectory() as folder:
            stored = os.path.join(folder, pathlib.Path(target).stem)
            self.save(stored)
            _core.run(["rc", "report", stored, "--out", target, "--quiet"])

    def plot(self) -> Figure:
        """Maps of pressure and gap, and the stress distribution, as a figure of matplotlib."""
        return figure(self)

    def _repr_html_(self) -> str:
        return html(self)

    def __repr__(self) -> str:
        nx, ny = self.grid
        return (
            f"Result({self.status}, {nx} x {ny}, {self.method}: area_fraction={self.area_fraction:.6g} "
            f"± {self.area_fraction_error:.1g}, mean_pressure={self.mean_pressure:.6g} Pa, "
            f"penetration={self.penetration:.6g} m)"
        )

    def __copy__(self) -> Result:
        # Nothing in it changes.
        return Result(self._source)

    def __deepcopy__(self, memo: dict[int, Any]) -> Result:
        return Result(self._source)

    def __reduce__(self) -> tuple[Any, ...]:
        if isinstance(self._source, Stored):
            return _stored, (self._source.files, self._source.fields, self._source.spots)
        with tempfile.TemporaryDirectory() as folder:
            self.save(folder)
            files = files_in(folder)
        # With an output grid, the files have means, and with single precision other numbers.
        written = np.load(io.BytesIO(files["pressure.npy"]))
        differ = written.shape != self.pressure.shape or written.dtype != self.pressure.dtype
        fields = {"pressure": self.pressure, "gap": self.gap} if differ else {}
        if differ and (plastic := self.plastic_gap) is not None:
            fields["plastic_gap"] = plastic
        if differ and (shear := self._shear) is not None:
            fields["shear"] = np.array(shear)
        if "elements.csv" not in files and (columns := self._source.elements()) is not None:
            fields["elements"] = np.array(columns)
        return _stored, (files, fields, self.spots if self.border_level else None)


def _stored(files: dict[str, bytes], fields: dict[str, Floats], spots: list[ContactSpot] | None) -> Result:
    return Result(Stored(files, fields, spots))


def load(folder: Path) -> Result:
    """Read a result folder, as ``rc solve --out`` and :meth:`Result.save` write it.

    Raises
    ------
    ValueError
        For any other folder, with the message that the command line prints.
    """
    folder = os.fspath(folder)
    _core.inspect_result(folder)
    return _stored({name: data for name, data in files_in(folder).items() if name in FILES}, {}, None)
