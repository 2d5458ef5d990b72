"""Ctrl-C during work that cannot look for it: the call ends, the work ends by itself."""

import os
import subprocess
import sys
import textwrap

import pytest

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")

#: Work of seconds on any machine, on arrays that are made before.
WORK = {
    "synthesis": "rc.surface(waves=2000, grid=6144)",
    "statistics": "rc.inspect(heights, cell=1.0)",
    "treatment": "rc.prepare(heights, cell=1.0, periodic='mirror', low_pass=1e-3)",
    "spots": "roughcontact._core.stress_distribution(heights, 1.0, [0.0, 1.0])",
}

PROGRAM = """
    import os, signal, threading, time
    import numpy as np
    import roughcontact, roughcontact as rc
    heights = np.random.default_rng(1).random((4096, 4096))
    times = []
    def interrupt():
        times.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)
    timer = threading.Timer(0.05, interrupt)
    try:
        timer.start()
        {work}
        timer.join()
        print("it ended before the interrupt")
    except KeyboardInterrupt:
        seconds, before = time.monotonic() - times[0], time.process_time()
        time.sleep(0.5)
        # The threads of the work are still at it: nobody waited for them.
        print("went on" if time.process_time() > before + 0.005 else "was waited for", seconds)
"""


def run(program):
    line = [sys.executable, "-c", textwrap.dedent(program)]
    return subprocess.run(line, capture_output=True, text=True, check=True, timeout=300).stdout


@pytest.mark.parametrize("name", WORK)
def test_an_interrupt_does_not_wait_for_work_that_cannot_look_for_it(name):
    assert run(PROGRAM.format(work=WORK[name])).startswith("went on")


def test_an_interrupt_before_the_first_iteration_still_carries_a_result():
    said = run("""
        import os, signal, threading
        import roughcontact as rc
        threading.Timer(0.05, os.kill, (os.getpid(), signal.SIGINT)).start()
        try:
            rc.solve(waves=1000, grid=3072, pressure=2e5, method="uniform", tolerance=1e-9, threads=1)
        except KeyboardInterrupt as interrupt:
            assert isinstance(interrupt, rc.Interrupted)
            result = interrupt.result
            assert result is interrupt.result
            print(result.status, result.pressure.shape, result.pressure.mean() > 0)
        # The next call has threads of its own.
        print(rc.solve(waves=8, grid=64, pressure=1e5).converged)
    """)
    assert said == "not_converged (3072, 3072) True\nTrue\n"


def test_a_second_interrupt_ends_the_wait_for_the_result():
    said = run("""
        import os, signal, threading
        import roughcontact as rc
        interrupt_after = lambda seconds: threading.Timer(seconds, os.kill, (os.getpid(), signal.SIGINT)).start()
        interrupt_after(0.05)
        try:
            rc.solve(waves=1000, grid=4096, pressure=2e5, method="uniform", tolerance=1e-9, threads=1)
        except KeyboardInterrupt as interrupt:
            interrupt_after(0.05)
            try:
                interrupt.result
            except KeyboardInterrupt:
                print("not waited for")
            print(interrupt.result.status)
    """)
    assert said == "not waited for\nnot_converged\n"
