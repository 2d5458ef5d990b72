"""A contact of a random surface: numbers, fields, files."""

import numpy as np

import roughcontact as rc

surface = rc.Surface(waves=16, hurst=0.8, seed=1, grid=256)
result = rc.solve(surface, pressure=4.5e5)

print(f"contact area {100 * result.area_fraction:.2f} % ± {100 * result.area_fraction_error:.2f} %")
print(f"penetration {1e6 * result.penetration:.2f} µm, {len(result.spots)} contact spots")

# Fields are arrays: the mean pressure is the load.
assert np.isclose(result.pressure.mean(), 4.5e5)
assert result.contact.shape == (256, 256)

result.save("first-contact")
