"""Records of a result: certificate, flow, spots, distribution, elements."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class Certificate(NamedTuple):
    """How far the pressure is from solving the discrete problem, from a fresh application of the operator."""

    #: Bound on the relative error of the pressure in the energy norm.
    energy_error: float
    #: Σ p (g - min g) / (H Σ p), with the height range H.
    complementarity_error: float
    #: max(-g) / H.
    penetration_error: float
    #: |mean p - σ0| / σ0 for a given mean pressure σ0; |Δ - Δ0| / H for a given penetration Δ0.
    load_error: float
    #: What ``energy_error`` was to reach, or None.
    energy_tolerance: float | None
    #: What ``complementarity_error`` and ``penetration_error`` were to reach, or None.
    tolerance: float | None


class Leakage(NamedTuple):
    """Flow of a thin film through the gap. Lists have a value for x and one for y."""

    #: K of the flow Q = K ΔP/(12 η) (m³). It is 0 where nothing percolates.
    permeance: list[float]
    #: Certified relative error of the solver. The exact K on these elements is at most ``permeance``, and at least
    #: ``permeance`` (1 - ``relative_error``).
    relative_error: list[float]
    #: Estimated error of the grid (m³).
    permeance_error: list[float | None]
    #: Axis with the larger permeance, ``x`` or ``y``, which :attr:`Result.flux` belongs to. None where nothing flows.
    flow_direction: str | None
    #: Whether the film connects opposite sides of the cell, along x and along y.
    percolates: list[bool]
    #: Gap of the narrowest place of the widest path (m).
    critical_gap: list[float | None]
    #: Place of the critical gap (m).
    critical_place: list[list[float] | None]
    #: Maximum relative difference between the flows through sections of the cell and their mean.
    conservation_error: list[float]
    #: Iterations.
    iterations: list[int]
    #: Seconds for both flows.
    wall_seconds: float
    #: Flow K ΔP/(12 η) (m³/s), with ``viscosity`` and ``pressure_drop``.
    flow: list[float] | None = None
    #: Estimated error of the flow (m³/s).
    flow_error: list[float | None] | None = None


class ContactSpot(NamedTuple):
    """One connected part of the contact."""

    #: Number of its elements.
    elements: int
    #: Its area, relative to the nominal area.
    area_fraction: float
    #: Length of its edge (m).
    perimeter: float
    #: 1 minus the number of its holes.
    euler_number: float
    #: Its load, divided by the nominal area (Pa).
    mean_pressure: float


class StressDistribution(NamedTuple):
    """The density of the interfacial stress over the nominal area."""

    #: Ends of the bins (Pa), one more than there are bins.
    edges: Floats
    #: P(σ) (1/Pa), the mean over each bin.
    density: Floats
    #: Area under stress, relative to the nominal area: the integral of P over all σ > 0.
    area_fraction: float


class Elements(NamedTuple):
    """Elements in contact of an adaptive mesh."""

    #: Centres (m).
    x: Floats
    #: Centres (m).
    y: Floats
    #: Sides (m).
    size: Floats
    #: Pressures (Pa).
    pressure: Floats
