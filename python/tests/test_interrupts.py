"""Ctrl-C during work that cannot look for it: the call ends, the work ends by itself."""

import os
import subprocess
import sys
import textwrap

import pytest

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="threads of a process are seen in /proc")

#: Work of a second and more on one thread of any machine.
WORK = {
    "synthesis": "rc.surface(waves=1500, grid=4096, threads=1)",
    "statistics": "rc.inspect(heights, cell=1.0)",
    "treatment": "rc.prepare(heights, cell=1.0, periodic='mirror', low_pass=1e-3)",
    "stress": "roughcontact._core.stress_distribution(heights, 1.0, [0.0, 1.0])",
}

#: Interrupts as soon as the first call has threads, which is when its work begins.
BEGIN = """
import os, signal, threading, time
import numpy as np
import roughcontact, roughcontact as rc

def kill():
    os.kill(os.getpid(), signal.SIGINT)

def threads():
    return len(os.listdir("/proc/self/task"))

# The threads before the call, with the one that interrupts: it may begin when the call has its threads already.
n_quiet = threads() + 1

def interrupt():
    end = time.monotonic() + 60
    while threads() <= n_quiet and time.monotonic() < end:
        time.sleep(0.001)
    time.sleep(0.03)
    kill()

watch = threading.Thread(target=interrupt, daemon=True)
"""


def run(program):
    line = [sys.executable, "-c", BEGIN + textwrap.dedent(program)]
    environment = {**os.environ, "RAYON_NUM_THREADS": "1"}
    done = subprocess.run(line, capture_output=True, text=True, check=False, timeout=300, env=environment)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("name", WORK)
def test_an_interrupt_does_not_wait_for_work_that_cannot_look_for_it(name):
    said = run(f"""
        heights = np.random.default_rng(1).random((4096, 4096))
        watch.start()
        try:
            {WORK[name]}
            watch.join()
            print("it ended before the interrupt")
        except KeyboardInterrupt:
            before = time.process_time()
            time.sleep(0.5)
            # The thread of the work is still at it: nobody waited for it.
            print("went on" if time.process_time() > before + 0.005 else "was waited for")
    """)
    assert said == "went on\n"


def test_an_interrupt_before_the_first_iteration_still_carries_a_result():
    said = run("""
        watch.start()
        try:
            rc.solve(waves=600, grid=2048, pressure=2e5, method="uniform", tolerance=1e-9)
        except KeyboardInterrupt as interrupt:
            assert isinstance(interrupt, rc.Interrupted)
            result = interrupt.result
            assert result is interrupt.result
            print(result.status, result.pressure.shape, result.pressure.mean() > 0)
        # The next call has threads of its own.
        print(rc.solve(waves=8, grid=64, pressure=1e5).converged)
    """)
    assert said == "not_converged (2048, 2048) True\nTrue\n"


def test_a_second_interrupt_ends_the_wait_for_the_result():
    said = run("""
        watch.start()
        try:
            rc.solve(waves=900, grid=3072, pressure=2e5, method="uniform", tolerance=1e-9)
        except KeyboardInterrupt as interrupt:
            try:
                threading.Timer(0.05, kill).start()
                interrupt.result
            except KeyboardInterrupt:
                print("not waited for")
            print(interrupt.result.status)
    """)
    assert said == "not waited for\nnot_converged\n"


@pytest.mark.parametrize("method", ["uniform", "adaptive"])
def test_the_result_of_an_interrupt_is_there_promptly(method):
    said = run(f"""
        def see(progress):
            # In the middle of the finest level.
            if progress.grid[0] == 2048 and progress.iteration == 2:
                see.at = see.at or time.monotonic()
                kill()
        see.at = None
        started = time.monotonic()
        rc.solve(waves=64, grid=2048, pressure=4e5, method={method!r}, tolerance=1e-9)
        whole = time.monotonic() - started
        try:
            rc.solve(waves=64, grid=2048, pressure=4e5, method={method!r}, tolerance=1e-9, progress=see)
        except KeyboardInterrupt as interrupt:
            result = interrupt.result
            late = time.monotonic() - see.at
            # What is left is a fresh application of the operator, not an iteration or a coarser level.
            print(result.converged, late < 1.0 + 0.5 * whole)
    """)
    assert said == "False True\n"
