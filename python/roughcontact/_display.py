"""How results look: a figure of matplotlib, and HTML for notebooks."""

from __future__ import annotations

import base64
import html as text
import struct
import zlib
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from roughcontact._records import Floats, StressDistribution

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Viridis at nine places.
_VIRIDIS = np.array(
    [
        (68, 1, 84),
        (71, 44, 122),
        (59, 81, 139),
        (44, 113, 142),
        (33, 144, 141),
        (39, 173, 129),
        (92, 200, 99),
        (170, 220, 50),
        (253, 231, 37),
    ],
    float,
)

#: Pixels of a small map along its longer side, at most.
_PIXELS = 192

_PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}


class Shown(Protocol):
    """What is shown of a result. ``Result`` has it, and this module does not know ``Result``, which uses it."""

    @property
    def status(self) -> str: ...

    @property
    def method(self) -> str: ...

    @property
    def kernel(self) -> str: ...

    @property
    def grid(self) -> list[int]: ...

    @property
    def sides(self) -> tuple[float, float]: ...

    @property
    def area_fraction(self) -> float: ...

    @property
    def area_fraction_error(self) -> float: ...

    @property
    def mean_pressure(self) -> float: ...

    @property
    def penetration(self) -> float: ...

    @property
    def mean_gap(self) -> float: ...

    @property
    def rms_pressure(self) -> float: ...

    @property
    def max_pressure(self) -> float: ...

    @property
    def energy_error(self) -> float: ...

    @property
    def wall_seconds(self) -> float: ...

    @property
    def threads(self) -> int: ...

    @property
    def pressure(self) -> Floats: ...

    @property
    def gap(self) -> Floats: ...

    def stress_distribution(self) -> StressDistribution: ...


def scale(value: float, unit: str) -> tuple[str, float]:
    """The unit with a prefix that suits the value, and the factor of this prefix."""
    if value == 0.0 or not np.isfinite(value):
        return unit, 1.0
    power = int(np.clip(3 * np.floor(np.log10(abs(value)) / 3), -12, 9))
    return f"{_PREFIXES[power]}{unit}", 10.0**power


def quantity(value: float, unit: str) -> str:
    """A number with a prefix before its unit."""
    name, size = scale(value, unit)
    return f"{value / size:.4g} {name}"


def figure(result: Shown) -> Figure:
    """Maps of pressure and gap, and the stress distribution."""
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise ImportError("plot needs matplotlib: pip install roughcontact[plot]") from None
    drawing = Figure(figsize=(13.0, 3.6), layout="constrained")
    # Means over blocks have no distribution of the stress.
    stress = result.stress_distribution() if result.pressure.shape == tuple(result.grid[::-1]) else None
    axes: Any = drawing.subplots(1, 2 if stress is None else 3)
    (length, metres), (stress_unit, pascals) = scale(max(result.sides), "m"), scale(result.max_pressure, "Pa")
    gap_unit, gap_metres = scale(float(result.gap.max()), "m")
    # The first row is at the bottom, as in the pictures of the command line.
    extent = (0.0, result.sides[0] / metres, 0.0, result.sides[1] / metres)
    pressure = np.ma.masked_equal(result.pressure, 0.0) / pascals
    for axis, field, title, colours in (
        (axes[0], pressure, f"Pressure ({stress_unit})", "viridis"),
        (axes[1], np.maximum(result.gap, 0.0) / gap_metres, f"Gap ({gap_unit})", "cividis"),
    ):
        image = axis.imshow(field, cmap=colours, origin="lower", extent=extent, interpolation="nearest")
        axis.set(title=title, xlabel=f"x ({length})", ylabel=f"y ({length})")
        drawing.colorbar(image, ax=axis)
    if stress is None:
        return drawing
    axes[2].stairs(stress.density * pascals, stress.edges / pascals, fill=True)
    labels = {"xlabel": f"σ ({stress_unit})", "ylabel": f"P(σ) (1/{stress_unit})"}
    axes[2].set(title="Stress distribution", xlim=(0.0, stress.edges[-1] / pascals), **labels)
    return drawing


def html(result: Shown) -> str:
    """Numbers and small maps."""
    nx, ny = result.grid
    rows = [
        ("status", result.status.replace("_", " ")),
        ("contact area", f"{100 * result.area_fraction:.4g} % ± {100 * result.area_fraction_error:.1g} %"),
        ("mean pressure", quantity(result.mean_pressure, "Pa")),
        ("penetration", quantity(result.penetration, "m")),
        ("mean gap", quantity(result.mean_gap, "m")),
        ("rms, max pressure", f"{quantity(result.rms_pressure, 'Pa')}, {quantity(result.max_pressure, 'Pa')}"),
        ("energy error", f"{result.energy_error:.1e}"),
        ("grid, method", f"{nx} x {ny}, {result.method}, kernel {result.kernel}"),
        ("time", f"{result.wall_seconds:.3g} s, {result.threads} threads"),
    ]
    cells = "".join(
        f"<tr><th style='text-align:left'>{name}</th><td style='text-align:left'>{text.escape(value)}</td></tr>"
        for name, value in rows
    )
    maps = "".join(
        f"<td style='text-align:center'>{name}<br>"
        f"<img alt='{name}' style='image-rendering:pixelated' src='data:image/png;base64,{picture(field)}'></td>"
        for name, field in (("pressure", result.pressure), ("gap", np.maximum(result.gap, 0.0)))
    )
    return f"<table><tr><td><table>{cells}</table></td>{maps}</tr></table>"


def picture(field: Floats) -> str:
    """A small picture of a field, its first row at the bottom, as PNG in base64."""
    ny, nx = field.shape
    step = -(-max(nx, ny) // _PIXELS)
    rows, columns = np.arange(0, ny, step), np.arange(0, nx, step)
    means = np.add.reduceat(np.add.reduceat(field, rows, axis=0), columns, axis=1)
    means /= np.outer(np.diff([*rows, ny]), np.diff([*columns, nx]))
    least, greatest = means.min(), means.max()
    place = (means[::-1] - least) / (greatest - least if greatest > least else 1.0) * (len(_VIRIDIS) - 1)
    known = np.arange(len(_VIRIDIS))
    pixels = np.stack([np.interp(place, known, channel) for channel in _VIRIDIS.T], axis=-1).round().astype(np.uint8)
    return base64.b64encode(_png(pixels)).decode()


def _png(pixels: NDArray[np.uint8]) -> bytes:
    height, width, _ = pixels.shape

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    # Each row begins with the number of its filter: none.
    lines = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, -1)], axis=1)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    parts = (chunk(b"IHDR", header), chunk(b"IDAT", zlib.compress(lines.tobytes(), 9)), chunk(b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts)
