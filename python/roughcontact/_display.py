"""How results look: a figure of matplotlib, and HTML for notebooks."""

from __future__ import annotations

import base64
import html as text
import struct
import zlib
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from roughcontact._result import Result

Floats = NDArray[np.float64]

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


def quantity(value: float, unit: str) -> str:
    """A number with a prefix before its unit."""
    if value == 0.0 or not np.isfinite(value):
        return f"{value:g} {unit}"
    power = int(np.clip(3 * np.floor(np.log10(abs(value)) / 3), -12, 9))
    return f"{value / 10.0**power:.4g} {_PREFIXES[power]}{unit}"


def figure(result: Result) -> Figure:
    """Maps of pressure and gap, and the stress distribution."""
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise ImportError("plot needs matplotlib: pip install roughcontact[plot]") from None
    drawing = Figure(figsize=(12.0, 3.6), layout="constrained")
    axes: Any = drawing.subplots(1, 3)
    side_x, side_y = result.sides
    # The first row is at the bottom, as in the pictures of the command line.
    place = {"origin": "lower", "extent": (0.0, side_x, 0.0, side_y), "interpolation": "nearest"}
    pressure = np.ma.masked_equal(result.pressure, 0.0)
    for axis, field, title, colours in (
        (axes[0], pressure, "Pressure (Pa)", "viridis"),
        (axes[1], np.maximum(result.gap, 0.0), "Gap (m)", "cividis"),
    ):
        image = axis.imshow(field, cmap=colours, **place)
        axis.set(title=title, xlabel="x (m)", ylabel="y (m)")
        drawing.colorbar(image, ax=axis)
    stress = result.stress_distribution()
    axes[2].stairs(stress.density, stress.edges, fill=True)
    axes[2].set(title="Stress distribution", xlabel="σ (Pa)", ylabel="P(σ) (1/Pa)", xlim=(0.0, stress.edges[-1]))
    return drawing


def html(result: Result) -> str:
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
