"""Contact area against load, over three surfaces, with Persson's curve."""

import math

import numpy as np

import roughcontact as rc

YOUNG, POISSON = 0.4e9, 0.45
E_STAR = YOUNG / (1 - POISSON**2)

table = rc.sweep(
    rc.Surface(waves=8, grid=128), pressures="1e4:1e6:5", seeds="1..3", young=YOUNG, poisson=POISSON, energy_tolerance=0.03
)
loads, area, error = table.mean("area_fraction")
slope = float(np.mean(table["rms_slope"]))
for load, mean, spread in zip(loads, area, error, strict=True):
    persson = math.erf(load * math.sqrt(2) / (E_STAR * slope))
    print(f"{load:9.3g} Pa: area {mean:.4f} ± {spread:.4f}, Persson {persson:.4f}")
assert np.all(np.diff(area) > 0)
