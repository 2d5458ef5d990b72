"""What several tests need."""

from __future__ import annotations

import json
import pathlib
import signal
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import roughcontact as rc

# A shell starts commands in the background with interrupts ignored, and their programs inherit this. The tests send some.
signal.signal(signal.SIGINT, signal.default_int_handler)

#: What a summary says of a run, not of the contact. An array has no file as its source.
OF_THE_RUN = {"wall_seconds", "peak_memory_bytes", "threads", "source"}

Command = Callable[..., "subprocess.CompletedProcess[str]"]


def of_the_contact(summary: dict[str, Any]) -> dict[str, Any]:
    """A summary without what depends on the run."""
    inner = {key: of_the_contact(value) if isinstance(value, dict) else value for key, value in summary.items()}
    return {key: value for key, value in inner.items() if key not in OF_THE_RUN}


@pytest.fixture(scope="session")
def command() -> Command:
    """Runs the command `rc` of the package."""

    def run(*words: object) -> subprocess.CompletedProcess[str]:
        line = [sys.executable, "-m", "roughcontact", *map(str, words)]
        return subprocess.run(line, capture_output=True, text=True, check=False)

    return run


@pytest.fixture(scope="session")
def solved_by_command(command: Command) -> Callable[..., tuple[dict[str, Any], pathlib.Path]]:
    """Runs `rc solve`, and returns its summary and its folder."""

    def run(folder: pathlib.Path, *words: object) -> tuple[dict[str, Any], pathlib.Path]:
        done = command("solve", *words, "--out", folder, "--quiet", "--json")
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout), folder

    return run


@pytest.fixture(scope="session")
def heights() -> np.ndarray:
    """Heights (m) of a random surface in a cell of 10 mm, 64 x 64."""
    return rc.surface(waves=8, grid=64, seed=2)


@pytest.fixture(scope="session")
def result(heights: np.ndarray) -> rc.Result:
    """A contact on these heights."""
    return rc.solve(heights, cell=0.01, e_star=1e9, pressure=1e6, method="uniform")
