"""Solves contact problems with one peer, for `cargo xtask bench --peers`.

usage: peers.py aspher | tamaas | contactmechanics

Writes one line that says which program and version it is. Then, for each line {"heights": FILE, "stride": 1, "load":
sigma0/E*, "tolerance": number or null} on standard input, solves once and writes one JSON line. The heights are those of the rigid
surface in a cell of side 1, positive towards the half-space; E* = 1. Seconds are those of the solve alone.
"""

import json
import os
import resource
import sys
import time
from importlib.metadata import version

# Peers print; only answers may reach the standard output.
answers = os.fdopen(os.dup(1), "w", buffering=1)
os.dup2(2, 1)

import numpy as np


def aspher():
    """Nested grids, preconditioned, doubly periodic, certified, in the fastest precision that reaches the tolerance."""
    import aspher

    # Below this, `float` alone stagnates; then a start in float is polished in double.
    float_floor = 2e-6

    def solve(heights, load, tolerance):
        n = len(heights)
        gap = -heights.ravel()
        # Nested grids halve down to the coarsest.
        coarsest = n
        while coarsest % 2 == 0 and coarsest > 64:
            coarsest //= 2
        precision = "float" if tolerance >= float_floor else "float_then_double"
        options = {"backend": "periodic", "E_star": 1.0, "tol": tolerance, "precision": precision, "light_result": True}
        start = time.perf_counter()
        result = aspher.solve_nested(grid_size=n, gap=gap, p_nominal=load, coarsest=coarsest, **options)
        seconds = time.perf_counter() - start
        pressure = np.asarray(result.pressure).reshape(heights.shape)
        return {
            "seconds": seconds,
            "status": str(result.status),
            "iterations": int(result.iterations),
            "applications": int(result.matvec_count),
        }, pressure, None

    return solve


def tamaas():
    """Polonsky and Keer's method on one grid."""
    import tamaas

    tamaas.set_log_level(tamaas.LogLevel.error)

    def solve(heights, load, tolerance):
        shape = list(heights.shape)
        model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [1.0, 1.0], shape)
        model.E, model.nu = 1.0, 0.0
        solver = tamaas.PolonskyKeerRey(model, heights, tolerance)
        start = time.perf_counter()
        error = solver.solve(load)
        seconds = time.perf_counter() - start
        status = "converged" if error < tolerance else "not converged"
        return {"seconds": seconds, "status": status}, np.array(model.traction), np.array(model.displacement)

    return solve


def contactmechanics():
    """Polonsky and Keer's method on one grid, with its own tolerance."""
    from ContactMechanics import PeriodicFFTElasticHalfSpace
    from ContactMechanics.Factory import make_system
    from SurfaceTopography import Topography

    def solve(heights, load, _tolerance):
        shape = heights.shape
        half_space = PeriodicFFTElasticHalfSpace(shape, 1.0, (1.0, 1.0))
        surface = Topography(heights, (1.0, 1.0), periodic=True)
        system = make_system(interaction="hardwall", substrate=half_space, surface=surface)
        start = time.perf_counter()
        result = system.minimize_proxy(external_force=load)
        seconds = time.perf_counter() - start
        # Forces are per grid point.
        pressure = np.asarray(system.force) * heights.size
        status = "converged" if result.success else str(result.message)
        iterations = {"iterations": int(result.nit), "applications": int(result.nfev)}
        return {"seconds": seconds, "status": status, **iterations}, pressure, np.asarray(system.disp)

    return solve


PEERS = {"aspher": (aspher, "aspher"), "tamaas": (tamaas, "tamaas"), "contactmechanics": (contactmechanics, "ContactMechanics")}


def peak_mb():
    """Peak memory of this process: Linux counts in KiB, Apple's systems in bytes."""
    unit = 1e-6 if sys.platform == "darwin" else 1.024e-3
    return unit * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def displacement_of(pressure):
    """What a light result leaves out: the displacement under the pressure, 2/(E* q) for each wave, of zero mean."""
    n_y, n_x = pressure.shape
    q_y, q_x = 2 * np.pi * np.fft.fftfreq(n_y, 1 / n_y), 2 * np.pi * np.fft.rfftfreq(n_x, 1 / n_x)
    q = np.hypot(q_y[:, None], q_x)
    q[0, 0] = np.inf
    return np.fft.irfft2(2 * np.fft.rfft2(pressure) / q, pressure.shape)


def observables(heights, pressure, displacement):
    """Counted area, edges between elements in and out of contact, rms pressure, mean gap."""
    if displacement is None:
        displacement = displacement_of(pressure)
    contact = pressure > 0
    edges = sum(int(np.count_nonzero(contact != np.roll(contact, 1, axis))) for axis in (0, 1))
    # The gap's pressure-weighted mean is zero, whatever zero the peer's displacements have.
    gap = displacement - heights
    return {
        "area_counted": float(contact.mean()),
        "edges": edges,
        "elements": int(contact.sum()),
        "rms_pressure": float(np.sqrt((pressure * pressure).mean())),
        "mean_gap": float(gap.mean() - (pressure * gap).sum() / pressure.sum()),
        # Peers state no best estimates and no errors.
        **dict.fromkeys(["area", "area_bar", "rms_pressure_bar", "mean_gap_bar", "cells_evaluated"]),
    }


def main():
    make, package = PEERS[sys.argv[1]]
    solve = make()
    # Part of the build that changes the speed.
    fftw = os.path.exists("/proc/self/maps") and "libfftw3" in open("/proc/self/maps").read()
    answers.write(json.dumps({"version": version(package), "fftw": fftw}) + "\n")
    before = peak_mb()
    for line in sys.stdin:
        job = json.loads(line)
        heights = np.ascontiguousarray(np.load(job["heights"])[:: job["stride"], :: job["stride"]])
        measured, pressure, displacement = solve(heights, job["load"], job["tolerance"])
        measured["memory_mb"] = peak_mb() - before
        none = {"iterations": None, "applications": None, "observables_seconds": 0.0}
        answers.write(json.dumps({**none, **measured, **observables(heights, pressure, displacement)}) + "\n")


main()
