"""What a call costs beside the solver."""

import os
import subprocess
import sys
import textwrap
import time

import pytest

import roughcontact as rc

#: Time that a call may spend outside of the solver (s).
LIMIT = 0.3e-3


@pytest.mark.parametrize("method", ["uniform", "adaptive"])
def test_a_small_solve_spends_little_outside_of_the_solver(method):
    heights = rc.surface(waves=8, grid=64, seed=2)
    keys = {"cell": 0.01, "e_star": 1e9, "pressure": 1e5, "threads": 1, "method": method}

    def outside():
        started = time.perf_counter()
        result = rc.solve(heights, **keys)
        return time.perf_counter() - started - result._source.wall_seconds

    # The fastest call: where others use the machine, the rest is waiting for a processor. They may use it for seconds.
    seconds = min(outside() for _ in range(300))
    tries_end = time.perf_counter() + 20.0
    while seconds >= LIMIT and time.perf_counter() < tries_end:
        seconds = min(seconds, outside())
    assert seconds < LIMIT, f"{1e3 * seconds:.3f} ms"


@pytest.mark.skipif(sys.platform != "linux", reason="/proc/self/statm")
def test_a_result_keeps_pressure_and_gap_and_no_heights():
    program = """
        import resource
        import roughcontact as rc

        def resident():
            with open("/proc/self/statm") as file:
                return int(file.read().split()[1]) * resource.getpagesize()

        heights = rc.surface(waves=8, grid=1024, seed=2)
        for _ in range(2):
            before = resident()
            result = rc.solve(heights, cell=0.01, e_star=1e9, pressure=1e5, method="uniform", tolerance=0.1)
            kept = resident() - before
            del result
        print(kept / heights.nbytes)
    """
    # So that what is freed is given back at once.
    environment = {**os.environ, "MALLOC_MMAP_THRESHOLD_": "131072", "MALLOC_TRIM_THRESHOLD_": "0"}
    line = [sys.executable, "-c", textwrap.dedent(program)]
    done = subprocess.run(line, capture_output=True, text=True, check=True, env=environment)
    assert float(done.stdout) < 2.3, f"{done.stdout} fields"
