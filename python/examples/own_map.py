"""A measured map: read or made, treated, solved."""

import numpy as np

import roughcontact as rc

# In place of `rc.read("map.sdf")`: a map of 1 mm with a tilt and a hole.
rng = np.random.default_rng(1)
y, x = np.mgrid[0:100, 0:128]
heights = 1e-6 * (np.sin(0.3 * x) + np.cos(0.2 * y) + 0.2 * rng.standard_normal((100, 128)) + 0.05 * x)
heights[10:14, 20:25] = np.nan

measured = rc.HeightMap(heights, sides=(1.28e-3, 1.0e-3))
treated = rc.prepare(measured, crop="64", level="plane", fill="laplace", periodic="mirror", low_pass=50e-6)
print(measured, treated, sep="\n")

result = rc.solve(treated, e_star=200e9, pressure=50e6)
print(result)
assert result.converged
