"""Contacts as functions of heights that programs differentiate: what the wrappers of PyTorch and JAX share."""

from __future__ import annotations

import importlib
from collections import OrderedDict
from typing import Any

import numpy as np

from roughcontact._records import Floats
from roughcontact._result import Result
from roughcontact._solve import solve

#: Number of results that are kept for their derivatives.
_KEPT = 4


def needed(framework: str) -> Any:
    """The module of a framework, which is imported at first use.

    Raises
    ------
    ImportError
        With what to install.
    """
    try:
        return importlib.import_module(framework)
    except ImportError as cause:
        raise ImportError(f"roughcontact.{framework}: needs {framework}; install it with: pip install {framework}") from cause


class Contact:
    """A number or the pressures of a contact as a function of the heights, with its vector-Jacobian product."""

    def __init__(self, name: str, keywords: dict[str, Any]) -> None:
        self.name = name
        self._keywords = {"method": "uniform", **keywords}
        self._results: OrderedDict[bytes, Result] = OrderedDict()

    def result(self, heights: Any) -> Result:
        """The result on these heights: that of an earlier call if it is still kept, which is the same."""
        array = np.array(heights, dtype=np.float64, order="C")
        key = array.tobytes()
        if key not in self._results:
            self._results[key] = solve(array, **self._keywords)
            while len(self._results) > _KEPT:
                self._results.popitem(last=False)
        return self._results[key]

    def value(self, heights: Any) -> Floats:
        """The value on these heights: an array of shape (), or (ny, nx) for pressures."""
        return np.array(getattr(self.result(heights), self.name), dtype=np.float64)

    def pulled_back(self, heights: Any, cotangent: Any) -> Floats:
        """The derivatives with respect to the heights of a function of the value, from those with respect to the value."""
        result = self.result(heights)
        if self.name == "pressure":
            return result.gradient_of(cotangent)
        return float(cotangent) * result.gradient(self.name)
