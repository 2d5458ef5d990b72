"""Where a result comes from: a solve, or the files of one."""

from __future__ import annotations

import io
import json
import os
import pathlib
from typing import Protocol

import numpy as np

from roughcontact._records import ContactSpot, Floats


#: Fluxes along x and y.
FLUX_FILES = ("flow_x.npy", "flow_y.npy")

#: Files of the tractions of a sheared contact and its slip.
SHEAR_FILES = ("shear_x.npy", "shear_y.npy", "slip.npy")


class Source(Protocol):
    """Where a result comes from: a solve, or the files of one."""

    @property
    def failure(self) -> str | None: ...
    def summary_json(self) -> str: ...
    def scene(self) -> str: ...
    def pressure(self) -> Floats: ...
    def gap(self) -> Floats: ...
    def displacement(self) -> Floats: ...
    def gradient(self, name: str, held: str | None) -> Floats: ...
    def gradient_of(self, derivatives: Floats, held: str | None) -> Floats: ...
    def finest_gap(self) -> Floats | None: ...
    def plastic_gap(self) -> Floats | None: ...
    def residual(self) -> Floats | None: ...
    def fluid_pressure(self) -> Floats | None: ...
    def shear(self) -> list[Floats] | None: ...
    def flux(self) -> list[Floats] | None: ...
    def elements(self) -> list[Floats] | None: ...
    def save(self, folder: str) -> None: ...


class Stored:
    """The files of a result, byte for byte, as a pickle holds them.

    Beside them are the fields of which the files hold only averages or single precision, the elements if no file holds
    them, and the spots, which do not follow from the files.
    """

    def __init__(self, files: dict[str, bytes], fields: dict[str, Floats], spots: list[ContactSpot] | None) -> None:
        self.files = files
        self.fields = fields
        self.spots = spots

    @property
    def failure(self) -> str | None:
        status = json.loads(self.summary_json())["status"]
        return "not converged" if status == "not_converged" else None

    def summary_json(self) -> str:
        return self.files["summary.json"].decode()

    def scene(self) -> str:
        return self.files["scene.toml"].decode()

    def pressure(self) -> Floats:
        return self._array("pressure")

    def gap(self) -> Floats:
        return self._array("gap")

    def plastic_gap(self) -> Floats | None:
        there = "plastic_gap" in self.fields or "plastic_gap.npy" in self.files
        return self._array("plastic_gap") if there else None

    def residual(self) -> Floats | None:
        return self._array("residual") if "residual.npy" in self.files else None

    def fluid_pressure(self) -> Floats | None:
        return self._array("fluid_pressure") if "fluid_pressure.npy" in self.files else None

    def shear(self) -> list[Floats] | None:
        if "shear" in self.fields:
            return list(self.fields["shear"])
        if SHEAR_FILES[0] not in self.files:
            return None
        return [_double(self.files[name]) for name in SHEAR_FILES]

    def flux(self) -> list[Floats] | None:
        if FLUX_FILES[0] not in self.files:
            return None
        return [_double(self.files[name]) for name in FLUX_FILES]

    def displacement(self) -> Floats:
        raise ValueError("displacement: a result that was read or unpickled does not have it; solve again")

    def gradient(self, name: str, held: str | None) -> Floats:
        raise ValueError("gradient: a result that was read or unpickled does not have it; solve again")

    def gradient_of(self, derivatives: Floats, held: str | None) -> Floats:
        return self.gradient("", held)

    def finest_gap(self) -> Floats | None:
        raise ValueError("spots: a result folder has no gap on the smallest elements (border_level); use spots of the result that solve returned")

    def elements(self) -> list[Floats] | None:
        if "elements" in self.fields:
            return list(self.fields["elements"])
        text = self.files.get("elements.csv")
        if text is None and json.loads(self.summary_json())["method"] != "uniform":
            raise ValueError("mesh: the folder has no elements.csv; solve again with elements=True (rc solve --elements)")
        if text is None:
            return None
        return list(np.loadtxt(io.BytesIO(text), delimiter=",", skiprows=1, ndmin=2).reshape(-1, 4).T)

    def save(self, folder: str) -> None:
        os.makedirs(folder, exist_ok=True)
        for name, data in self.files.items():
            final = pathlib.Path(folder, name)
            partial = final.with_name(final.name + ".partial")
            partial.write_bytes(data)
            os.replace(partial, final)

    def _array(self, name: str) -> Floats:
        if name in self.fields:
            return self.fields[name]
        return _double(self.files[name + ".npy"])


def _double(data: bytes) -> Floats:
    """The array of a file, in double precision."""
    array: Floats = np.load(io.BytesIO(data)).astype(np.float64, copy=False)
    return array


def files_in(folder: str) -> dict[str, bytes]:
    """The files in a folder, by name."""
    return {path.name: path.read_bytes() for path in sorted(pathlib.Path(folder).iterdir()) if path.is_file()}


#: Files of a result folder; the others there belong to somebody else.
FILES = (
    *("summary.json", "scene.toml", "pressure.npy", "gap.npy", "plastic_gap.npy", "residual.npy", "fluid_pressure.npy"),
    *("contact.png", "elements.csv", "heights.npy", "leakage.png"),
    *FLUX_FILES,
    *SHEAR_FILES,
)
