"""Rows in the workers of other programs: the digits, the journal, and workers that are killed."""

import concurrent.futures
import csv
import json
import multiprocessing
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import textwrap
import threading
import time
import zlib

import numpy as np
import pytest
from conftest import OF_THE_RUN

import roughcontact as rc

#: Rows of some tenths of a second, so that workers are killed in the middle of them.
KEYS = {"waves": 24, "grid": 384, "method": "uniform", "tolerance": 1e-8, "pressures": [1e5, 2e5, 3e5], "seeds": "1..3"}
FLAGS = ("--waves", 24, "--grid", 384, "--method", "uniform", "--tolerance", 1e-8, "--pressures", "1e5,2e5,3e5", "--seeds", "1..3")
#: Rows that take no time.
SMALL = {"waves": 8, "grid": 64, "pressures": [1e5, 2e5], "seeds": [1, 2]}


def spawned(workers=2):
    """A pool of processes that inherit nothing."""
    return concurrent.futures.ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn"))


def cells(folder):
    """The text of each cell of a table, without those of the run."""
    with open(pathlib.Path(folder) / "sweep.csv", newline="") as file:
        return [{name: cell for name, cell in row.items() if name not in OF_THE_RUN} for row in csv.DictReader(file)]


def settings(folder):
    return (pathlib.Path(folder) / "sweep.jsonl").read_text().splitlines()[0]


def finished(folder):
    """Rows that are in a journal."""
    try:
        return len((pathlib.Path(folder) / "sweep.jsonl").read_text().splitlines()) - 1
    except FileNotFoundError:
        return 0


@pytest.fixture(scope="module")
def swept(command, tmp_path_factory):
    """The folder of `rc sweep`."""
    folder = tmp_path_factory.mktemp("swept") / "rc"
    done = command("sweep", *FLAGS, "--out", folder, "--quiet")
    assert done.returncode == 0, done.stderr
    return folder


def killing(pids, folder):
    """A thread that kills a process when the first row is in the journal of `folder`, and the list with what it killed."""
    killed = []

    def kill():
        while finished(folder) < 1:
            time.sleep(0.01)
        killed.append(pids()[0])
        os.kill(killed[0], signal.SIGKILL)

    thread = threading.Thread(target=kill, daemon=True)
    thread.start()
    return thread, killed


def test_journal_and_table_are_those_of_the_command_line(swept, tmp_path):
    with spawned() as pool:
        table = rc.sweep(**KEYS, out=tmp_path / "py", executor=pool)
    assert cells(tmp_path / "py") == cells(swept)
    assert settings(tmp_path / "py") == settings(swept)
    assert [row["seed"] for row in table] == [1, 1, 1, 2, 2, 2, 3, 3, 3]
    # Every column of the table, also in the order of the file.
    assert table.columns == list(csv.DictReader(open(swept / "sweep.csv")).fieldnames)


def test_either_program_goes_on_with_the_rows_of_the_other(swept, command, tmp_path):
    journal = (swept / "sweep.jsonl").read_bytes().splitlines(keepends=True)
    for name in ("py", "rc"):
        (tmp_path / name).mkdir()
        # As if it was killed while it wrote its fifth row.
        (tmp_path / name / "sweep.jsonl").write_bytes(b"".join(journal[:5]) + journal[5][:40])
    table = rc.sweep(**KEYS, out=tmp_path / "py", resume=True)
    assert len(table) == 9 and cells(tmp_path / "py") == cells(swept)
    done = command("sweep", *FLAGS, "--out", tmp_path / "rc", "--resume", "--quiet")
    assert done.returncode == 0, done.stderr
    # What is there already is read, not solved.
    again = rc.sweep(**KEYS, out=tmp_path / "rc", resume=True, executor=Refusing())
    assert again["penetration"].tolist() == table["penetration"].tolist()
    with pytest.raises(ValueError, match="holds a sweep already; continue it with resume=True, or give another out"):
        rc.sweep(**KEYS, out=tmp_path / "rc")
    with pytest.raises(ValueError, match="holds another sweep: .*loads"):
        rc.sweep(**{**KEYS, "pressures": [1e5]}, out=tmp_path / "rc", resume=True)


def test_a_process_that_is_killed_leaves_its_rows(swept, tmp_path):
    program = f"""
        import concurrent.futures, os, signal, threading, time
        import roughcontact as rc
        def kill():
            while not os.path.exists({str(tmp_path / "s/sweep.jsonl")!r}) or open({str(tmp_path / "s/sweep.jsonl")!r}).read().count("\\n") < 4:
                time.sleep(0.01)
            os.kill(os.getpid(), signal.SIGKILL)
        threading.Thread(target=kill).start()
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            rc.sweep(**{KEYS!r}, out={str(tmp_path / "s")!r}, executor=pool)
    """
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(program)], check=False)
    assert done.returncode == -signal.SIGKILL
    kept = finished(tmp_path / "s")
    assert 3 <= kept < 9
    with spawned() as pool:
        rc.sweep(**KEYS, out=tmp_path / "s", resume=True, executor=pool)
    assert cells(tmp_path / "s") == cells(swept)


def test_a_killed_process_of_a_pool_costs_its_row_alone(swept, tmp_path):
    with spawned() as pool:
        thread, killed = killing(lambda: list(pool._processes), tmp_path / "s")
        rc.sweep(**KEYS, out=tmp_path / "s", executor=pool)
        thread.join()
        # It takes no more work: the rest was done by a pool like it.
        with pytest.raises(concurrent.futures.process.BrokenProcessPool):
            pool.submit(os.getpid)
    assert killed and cells(tmp_path / "s") == cells(swept)


def test_pools_are_made_anew_by_the_function_of_the_caller(swept, tmp_path):
    pools = []

    def another():
        pools.append(spawned())
        return pools[-1]

    thread, killed = killing(lambda: list(pools[-1]._processes), tmp_path / "s")
    rc.sweep(**KEYS, out=tmp_path / "s", executor=another)
    thread.join()
    assert killed and len(pools) == 2 and cells(tmp_path / "s") == cells(swept)
    for pool in pools:
        with pytest.raises(RuntimeError, match="shutdown|terminated abruptly"):
            pool.submit(os.getpid)


@pytest.mark.filterwarnings("ignore")
def test_a_killed_worker_of_dask_costs_its_row_alone(swept, tmp_path):
    distributed = pytest.importorskip("distributed")
    import dask

    # Without further attempts of its own, so that ours are seen.
    with dask.config.set({"distributed.scheduler.allowed-failures": 0, "distributed.comm.timeouts.connect": "60s"}):
        cluster = distributed.LocalCluster(2, threads_per_worker=1, processes=True, dashboard_address=None)
        with cluster, distributed.Client(cluster) as client:
            pids = lambda: list(client.run(os.getpid).values())  # noqa: E731
            thread, killed = killing(pids, tmp_path / "s")
            rc.sweep(**KEYS, out=tmp_path / "s", executor=client.get_executor())
            thread.join()
    assert killed and cells(tmp_path / "s") == cells(swept)


def test_ranks_of_mpi_solve_rows(swept, tmp_path):
    mpirun = shutil.which("mpirun")
    if mpirun is None:
        pytest.skip("mpirun is not installed")
    if subprocess.run([sys.executable, "-c", "from mpi4py import MPI"], capture_output=True, check=False).returncode:
        pytest.skip("mpi4py is not installed, or finds no MPI")
    (tmp_path / "program.py").write_text(
        textwrap.dedent(f"""
            from mpi4py.futures import MPIPoolExecutor
            import roughcontact as rc

            if __name__ == "__main__":
                with MPIPoolExecutor() as pool:
                    table = rc.sweep(**{KEYS!r}, out={str(tmp_path / "s")!r}, executor=pool)
                    print(pool.num_workers, len(table))
        """)
    )
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    environment |= {"OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_hwloc_base_binding_policy": "none"}
    line = [mpirun, "-n", "3", sys.executable, "-m", "mpi4py.futures", str(tmp_path / "program.py")]
    done = subprocess.run(line, capture_output=True, text=True, check=False, env=environment, timeout=300)
    assert done.returncode == 0 and done.stdout == "2 9\n", done
    assert cells(tmp_path / "s") == cells(swept)


class Refusing(concurrent.futures.Executor):
    """Has nothing to do."""

    def submit(self, *arguments):
        raise AssertionError("a row was solved that is there")


class KilledWorker(Exception):
    """As that of Dask: known by its name."""


class Losing(concurrent.futures.Executor):
    """Solves at once, but loses the worker of each row the first `losses` times."""

    def __init__(self, losses, rows=None):
        self.losses, self.rows, self.counts = losses, rows, {}

    def submit(self, function, job):
        future: concurrent.futures.Future = concurrent.futures.Future()
        self.counts[job.row] = count = self.counts.get(job.row, 0) + 1
        if count <= self.losses and (self.rows is None or job.row in self.rows):
            future.set_exception(KilledWorker("a worker"))
            return future
        try:
            future.set_result(function(job))
        except BaseException as error:
            future.set_exception(error)
        return future


def test_rows_whose_worker_ends_are_solved_again_but_not_for_ever(tmp_path):
    alone = rc.sweep(**SMALL)
    losing = Losing(2)
    assert rc.sweep(**SMALL, executor=losing)["penetration"].tolist() == alone["penetration"].tolist()
    assert set(losing.counts.values()) == {3}
    # A row that ends its worker each time keeps no other from being solved.
    with pytest.raises(RuntimeError, match=r"1 of the rows could not be solved, .*KilledWorker\('a worker'\)") as given_up:
        rc.sweep(**SMALL, executor=Losing(100, rows={1}), out=tmp_path / "s")
    assert given_up.value.table["control_value"].tolist() == [1e5, 1e5, 2e5]
    assert finished(tmp_path / "s") == 3
    table = rc.sweep(**SMALL, out=tmp_path / "s", resume=True)
    assert table["penetration"].tolist() == alone["penetration"].tolist()


def test_a_load_that_cannot_be_carried_costs_its_row_alone(tmp_path):
    loads = {"penetrations": [1e-6, 1.0], "waves": 8, "grid": 64}
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for executor in (None, pool):
            with pytest.raises(ValueError, match=r"^row 2 \(seed 1, penetration 1e0\): .*; 1 row could not be solved, and .* has the other 1") as refused:
                rc.sweep(**loads, executor=executor)
            assert refused.value.table["control_value"].tolist() == [1e-6]
    with pytest.raises(ValueError, match="^row 1 "):
        rc.sweep(**{**loads, "penetrations": [1.0]}, out=tmp_path / "s")
    assert not (tmp_path / "s").exists(), "a sweep without rows left something behind"


def test_maps_are_recognised_by_their_values(heights, tmp_path, command):
    keys = {"cell": 0.01, "e_star": 1e9, "pressures": [1e5, 1e6], "out": tmp_path / "s"}
    table = rc.sweep(rc.HeightMap(heights), **keys)
    again = rc.sweep(heights.copy(order="F"), **keys, resume=True, executor=Refusing())
    assert again.rows == table.rows and "seed" not in table.columns
    with pytest.raises(ValueError, match="holds another sweep: checksum of the file of surface 1 is "):
        rc.sweep(heights + 1e-9, **keys, resume=True)
    # A map in a file is that of the command line.
    np.save(tmp_path / "map.npy", heights)
    keys["out"] = tmp_path / "of a file"
    rc.sweep(tmp_path / "map.npy", **keys)
    line = ("sweep", "--heights", tmp_path / "map.npy", "--cell", 0.01, "--e-star", 1e9, "--pressures", "1e5,1e6")
    assert command(*line, "--out", tmp_path / "rc", "--quiet").returncode == 0
    assert cells(tmp_path / "rc") == cells(tmp_path / "of a file")
    assert settings(tmp_path / "rc") == settings(tmp_path / "of a file")


def test_fields_stay_where_they_are_solved(command, tmp_path):
    with spawned() as pool:
        table = rc.sweep(**SMALL, out=tmp_path / "s", fields=tmp_path / "fields", executor=pool)
    results = rc.sweep(**SMALL, keep_results=True).results
    assert [pathlib.Path(row.path).name for row in table.fields] == ["0001.zarr", "0002.zarr", "0003.zarr", "0004.zarr"]
    assert len({row.host for row in table.fields}) == 1
    for row, result in zip(table.fields, results, strict=True):
        array = pathlib.Path(row.path) / "pressure"
        assert json.loads((array / ".zarray").read_text())["shape"] == [64, 64]
        values = np.frombuffer(zlib.decompress((array / "0.0").read_bytes()))
        assert values.tobytes() == result.pressure.tobytes()
    assert sorted(path.name for path in (tmp_path / "fields").iterdir()) == [f"000{i}.zarr" for i in range(1, 5)]


def test_result_folders_of_rows_are_those_of_the_command_line(command, tmp_path):
    with spawned() as pool:
        rc.sweep(**SMALL, out=tmp_path / "py", fields=True, executor=pool)
    line = ("sweep", "--waves", 8, "--grid", 64, "--pressures", "1e5,2e5", "--seeds", "1,2", "--fields")
    assert command(*line, "--out", tmp_path / "rc", "--quiet").returncode == 0
    for path in sorted((tmp_path / "rc/rows").rglob("*.*")):
        ours = tmp_path / "py/rows" / path.relative_to(tmp_path / "rc/rows")
        assert path.name == "summary.json" or ours.read_bytes() == path.read_bytes(), ours
    # A folder that is gone is made again.
    shutil.rmtree(tmp_path / "py/rows/0002")
    rc.sweep(**SMALL, out=tmp_path / "py", fields=True, resume=True)
    assert (tmp_path / "py/rows/0002/summary.json").exists()


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ({"resume": True}, "^resume: the rows are kept in a folder; give out"),
        ({"fields": True}, "^fields: the rows are kept in a folder; give out"),
        ({"out": "s", "kernel": lambda kx, ky: kx}, "^out: a journal cannot tell"),
        ({"executor": Refusing(), "progress": print}, "^progress: a function sees solves of this process alone"),
        ({"executor": 3}, r"^executor: must be an executor \(with a method submit\), or a function that makes one, not 3"),
        ({"progress": 3}, "^progress: must be True, False or a function, not 3"),
        ({"seeds": 3}, "^seeds: must be whole numbers such as range"),
        ({"seeds": [1.5]}, "^seeds: must be whole numbers such as range"),
        ({"seeds": []}, "^seeds: none is given"),
        ({"seeds": [-1]}, "^seeds: must be whole numbers from 0"),
        ({"seeds": [2**64]}, "^seeds: must be whole numbers from 0"),
    ],
)
def test_what_a_sweep_cannot_do_is_refused_before_it_begins(keys, sentence, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match=sentence):
        rc.sweep(**{**SMALL, **keys})
    assert not any(tmp_path.iterdir())
