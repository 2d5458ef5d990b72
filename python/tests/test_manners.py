"""How calls behave: threads, signals, progress, warnings."""

import concurrent.futures
import multiprocessing
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
import warnings

import numpy as np
import pytest

import roughcontact as rc

KEYS = {"waves": 16, "grid": 256, "pressure": 2e5, "method": "uniform"}


def solve_pressure(keys):
    """The bytes of a pressure; workers of other processes call it."""
    return rc.solve(**keys).pressure.tobytes()


@pytest.fixture(scope="module")
def reference():
    return solve_pressure(KEYS)


def test_any_number_of_threads_gives_the_same_digits(reference):
    for threads in (1, 2, 3):
        result = rc.solve(**KEYS, threads=threads)
        assert (result.threads, result.pressure.tobytes()) == (threads, reference)


def test_two_solves_at_once_give_the_digits_of_one_after_the_other(reference):
    other = {**KEYS, "pressure": 4e5}
    alone = solve_pressure(other)
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        assert list(pool.map(solve_pressure, [KEYS, other, KEYS, other])) == [reference, alone] * 2


@pytest.mark.parametrize("method", ["fork", "spawn"])
@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded:DeprecationWarning")
def test_workers_in_other_processes_give_the_same_digits(method, reference):
    context = multiprocessing.get_context(method)
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as pool:
        assert list(pool.map(solve_pressure, [KEYS, KEYS])) == [reference] * 2


def test_a_sweep_by_an_executor_is_the_sweep():
    keys = {"waves": 8, "grid": 64, "pressures": [1e5, 2e5], "seeds": [1, 2]}
    alone = rc.sweep(**keys)
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as pool:
        table = rc.sweep(**keys, executor=pool, keep_results=True)
    for column in ("seed", "control_value", "area_fraction", "penetration", "energy_error"):
        assert table[column].tolist() == alone[column].tolist(), column
    assert [result.area_fraction for result in table.results] == alone["area_fraction"].tolist()


def test_other_threads_of_python_run_during_a_solve():
    count, done = 0, threading.Event()

    def run():
        nonlocal count
        while not done.is_set():
            count += 1
            time.sleep(0.001)

    thread = threading.Thread(target=run)
    thread.start()
    started = time.monotonic()
    rc.solve(waves=32, grid=512, pressure=2e5, method="uniform", tolerance=1e-9)
    seconds = time.monotonic() - started
    done.set()
    thread.join()
    # A lock that is held would leave a few at the ends; a free one hundreds a second.
    assert count > 20 * seconds, f"{count} turns in {seconds:.2f} s"


def test_an_interrupt_stops_and_carries_the_partial_result():
    program = """
        import os, signal
        import roughcontact as rc
        seen = []
        def see(progress):
            # In the middle of the work, whatever the machine does.
            if progress.iteration == 4 and progress.grid[0] == 512 and not seen:
                seen.append(progress)
                os.kill(os.getpid(), signal.SIGINT)
        try:
            rc.solve(waves=32, grid=512, pressure=2e5, method="uniform", tolerance=1e-12, progress=see)
        except KeyboardInterrupt as interrupt:
            result = interrupt.result
            print(result.status, result.pressure.shape, result.pressure.sum() > 0, type(interrupt).__name__)
    """
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(program)], capture_output=True, text=True, check=True)
    # How soon it is raised: test_interrupts.py.
    assert done.stdout == "not_converged (512, 512) True Interrupted\n", done


def test_an_interrupt_of_a_sweep_carries_its_rows():
    program = """
        import os, signal
        import roughcontact as rc
        rows = 0
        def see(progress):
            global rows
            rows += progress.error != progress.error
            if rows == 3:
                os.kill(os.getpid(), signal.SIGINT)
        try:
            rc.sweep(waves=8, grid=64, pressures="1e4:1e6:20", method="uniform", progress=see)
        except KeyboardInterrupt as interrupt:
            print(len(interrupt.table))
    """
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(program)], capture_output=True, text=True, check=True)
    assert done.stdout == "2\n", done


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_an_interrupt_ends_the_command(tmp_path):
    # A sweep that takes minutes on any machine, so that the interrupt never comes after its end.
    line = [sys.executable, "-m", "roughcontact", "sweep", "--waves", "16", "--grid", "128", "--method", "uniform"]
    line += ["--pressures", "1e3:1e6:100000", "--out", tmp_path / "r"]
    process = subprocess.Popen(line, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    # Before the command listens, the interrupt ends it at once.
    assert process.returncode in (130, -signal.SIGINT), errors


def test_progress_is_told_in_order_and_ends_on_the_finest_grid():
    seen = []
    result = rc.solve(**KEYS, progress=seen.append)
    assert [p.level for p in seen] == sorted(p.level for p in seen)
    assert seen[-1].level == seen[-1].levels == result.levels
    assert seen[-1].grid == (256, 256)
    assert seen[-1].error <= seen[-1].tolerance
    assert all(p.in_contact > 0 for p in seen if p.iteration)


def test_progress_draws_a_bar_where_there_is_tqdm(capsys):
    rc.solve(**KEYS, progress=True)
    shown = capsys.readouterr().err
    try:
        import tqdm  # noqa: F401
    except ImportError:
        assert shown == ""
    else:
        assert "level 1/" in shown


def test_an_error_of_the_function_that_sees_progress_ends_the_solve():
    def see(progress):
        raise LookupError("seen enough")

    with pytest.raises(LookupError, match="seen enough") as raised:
        rc.solve(**KEYS, progress=see)
    assert raised.value.result.status in ("converged", "not_converged")


def test_what_does_not_converge_is_marked_and_warned_of_or_an_error(tmp_path):
    # Ended by the limit of time, before its first iteration.
    late = {**KEYS, "tolerance": 1e-12, "time_limit": 1e-3}
    with pytest.warns(rc.NotConvergedWarning, match="not converged to"):
        result = rc.solve(**late)
    assert not result.converged and result.status == "not_converged"
    with pytest.raises(rc.NotConvergedError, match="not converged to") as raised:
        rc.solve(**late, check=True)
    assert raised.value.result.status == "not_converged"
    with pytest.warns(rc.NotConvergedWarning, match="1 of 1 rows"):
        del late["pressure"]
        rc.sweep(pressures=[2e5], **late)
    with pytest.warns(rc.NotConvergedWarning, match="1 of 1 rows did not converge; the first for this reason: not converged to"):
        rc.sweep(pressures=[2e5], out=tmp_path / "late", **late)
    with pytest.warns(rc.NotConvergedWarning, match="1 of 1 rows did not converge; the first was solved in an earlier run"):
        rc.sweep(pressures=[2e5], out=tmp_path / "late", resume=True, **late)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert rc.solve(**KEYS).converged


def test_numbers_of_numpy_are_numbers():
    keys = {"waves": np.int64(8), "grid": (64, np.int32(64)), "pressure": np.float32(1e5), "seed": np.uint8(3)}
    assert rc.solve(**keys).penetration == rc.solve(waves=8, grid=64, pressure=1e5, seed=3).penetration
