"""A soft layer on a rigid base: by its keywords, and by the symbol of the solid as a function."""

import numpy as np
from numpy.typing import NDArray

import roughcontact as rc

E_STAR, POISSON, THICKNESS = 5e6, 0.4, 2e-4


def layer(kx: NDArray[np.float64], ky: NDArray[np.float64]) -> NDArray[np.float64]:
    """Displacement (m) of a wave of 1 Pa on a bonded elastic layer on a rigid base."""
    k = np.hypot(kx, ky)
    # Beyond 300, hyperbolic functions overflow, and the layer is a half-space.
    x = np.minimum(2 * k * THICKNESS, 300.0)
    kappa = 3 - 4 * POISSON
    factor = (kappa * np.sinh(x) - x) / (kappa * np.cosh(x) + 0.5 * (1 + kappa**2) + 0.5 * x**2)
    symbol: NDArray[np.float64] = 2 * factor / (E_STAR * k)
    return symbol


surface = rc.Surface(cell=0.01, waves=16, rms=13e-6, grid=128)
on_layer = rc.solve(surface, e_star=E_STAR, pressure=2e4, kernel=layer)
alone = rc.solve(surface, e_star=E_STAR, pressure=2e4, kernel="spectral")
# The same by keywords, with the compression under the mean pressure.
named = rc.solve(
    surface, e_star=E_STAR, pressure=2e4, kernel="spectral", layer_thickness=THICKNESS, layer_poisson=POISSON
)
compressed = 2e4 * THICKNESS * (1 - 2 * POISSON) / (E_STAR * (1 - POISSON) ** 2)
print(f"contact area {on_layer.area_fraction:.4f} on the layer, {alone.area_fraction:.4f} on a half-space")
assert on_layer.area_fraction < alone.area_fraction
# Of elements: edges of the named kernel are located with its own constants.
assert abs(named.area_fraction_cells / on_layer.area_fraction_cells - 1) < 1e-9
assert abs(named.penetration / (on_layer.penetration + compressed) - 1) < 1e-9
