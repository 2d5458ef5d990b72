"""Line contact of profiles."""

from __future__ import annotations

import math

import numpy as np
import pytest

import roughcontact as rc

N = 1024
WAVE = 1e-6 * np.cos(2 * np.pi * (np.arange(N) + 0.5) / N)
CONTACT = {"e_star": 1e9, "pressure": 0.5 * math.pi * 1e9 * 1e-3}


def test_half_of_westergaards_wave_touches_as_in_the_command(command, tmp_path):
    result = rc.solve(WAVE, line=True, cell=1e-3, **CONTACT)
    assert abs(result.area_fraction - 0.5) < result.area_fraction_error < 2e-3
    assert result.pressure.shape == (1, N)
    np.savetxt(tmp_path / "wave.csv", np.c_[(np.arange(N) + 0.5) * 1e-3 / N, WAVE], delimiter=",")
    flags = ["--line", "--e-star", 1e9, "--pressure", CONTACT["pressure"], "--quiet", "--out", tmp_path / "rc"]
    done = command("solve", tmp_path / "wave.csv", *flags)
    assert done.returncode == 0, done.stderr
    assert np.allclose(result.pressure, np.load(tmp_path / "rc/pressure.npy"), rtol=1e-6, atol=1.0)
    with pytest.raises(ValueError, match="must be a profile"):
        rc.solve(np.zeros((4, 4)), line=True, cell=1e-3, **CONTACT)
