"""What a call costs beside the solver."""

import time

import numpy as np

import roughcontact as rc


def test_a_small_solve_spends_little_outside_of_the_solver():
    heights = rc.surface(waves=8, grid=64, seed=2)
    keys = {"cell": 0.01, "e_star": 1e9, "pressure": 1e5, "threads": 1}
    outside = []
    for _ in range(1000):
        started = time.perf_counter()
        result = rc.solve(heights, **keys)
        outside.append(time.perf_counter() - started - result._source.wall_seconds)
    # Half of the calls, since others may use the machine: waiting for a processor is no work.
    median = np.median(outside)
    assert median < 0.3e-3, f"{1e3 * median:.3f} ms"


def test_heights_are_not_kept_twice():
    """The solver's own heights, in units of the cell, are gone with the solve; what stays are pressure and gap."""
    import resource

    heights = rc.surface(waves=8, grid=2048, seed=2)
    keys = {"cell": 0.01, "e_star": 1e9, "pressure": 1e5, "method": "uniform", "tolerance": 0.1}
    rc.solve(heights, **keys)

    def resident():
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * resource.getpagesize()

    before = resident()
    result = rc.solve(heights, **keys)
    kept = resident() - before
    assert result.converged
    # Two fields and the scratch of an allocator; a third field would be a copy.
    assert kept < 2.6 * heights.nbytes, f"{kept / heights.nbytes:.2f} fields"
