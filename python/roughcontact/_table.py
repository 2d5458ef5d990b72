"""The rows of a sweep as a table."""

from __future__ import annotations

import csv
import html as text
import os
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from roughcontact._keys import Path
from roughcontact._result import Result
from roughcontact._rows import FieldsAt

if TYPE_CHECKING:
    import pandas


class Table:
    """Rows of a sweep: seed, load (``control_value``, Pa or m), and the keys of the summary.

    ``table["area_fraction"]`` is a column as an array, ``table[0]`` a row as a dict.
    """

    __slots__ = ("fields", "results", "rows")

    #: A dict for each solve, by seed, then load.
    rows: list[dict[str, Any]]
    #: The results of the rows. None without ``keep_results=True``.
    results: list[Result] | None
    #: The places of the rows' Zarr groups, with None for a row that an earlier run solved (``resume``). None without ``fields="DIR"``.
    fields: list[FieldsAt | None] | None

    def __init__(
        self,
        rows: list[dict[str, Any]],
        results: list[Result] | None = None,
        fields: list[FieldsAt | None] | None = None,
    ) -> None:
        self.rows = rows
        self.results = results
        self.fields = fields

    @property
    def columns(self) -> list[str]:
        """Names of the columns."""
        return list(self.rows[0]) if self.rows else []

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return iter(self.rows)

    def __getitem__(self, key: Any) -> Any:
        if isinstance(key, str):
            if key not in self.columns:
                raise KeyError(f"a Table has no column '{key}'; its columns are {', '.join(self.columns)}")
            values = [row[key] for row in self.rows]
            if any(isinstance(value, list) for value in values):
                array = np.empty(len(values), object)
                array[:] = values
                return array
            return np.array([np.nan if value is None else value for value in values])
        return self.rows[key]

    def mean(self, column: str) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Return the loads, the mean of a column over the seeds at each load, and its standard error (NaN for one seed)."""
        loads, place = np.unique(self["control_value"], return_inverse=True)
        groups = [self[column][place == k] for k in range(len(loads))]
        means = np.array([group.mean() for group in groups])
        errors = [group.std(ddof=1) / np.sqrt(len(group)) if len(group) > 1 else np.nan for group in groups]
        return loads, means, np.array(errors)

    def to_csv(self, path: Path) -> None:
        """Write the table as CSV. Numbers read back without loss."""
        with open(os.fspath(path), "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, self.columns)
            writer.writeheader()
            writer.writerows(self.rows)

    def to_pandas(self) -> pandas.DataFrame:
        """The table as a DataFrame of pandas."""
        import pandas

        return pandas.DataFrame(self.rows)

    def __repr__(self) -> str:
        return f"Table({len(self)} rows, {len(self.columns)} columns)"

    def _repr_html_(self) -> str:
        known = ("seed", "control_value", "area_fraction", "area_fraction_error", "penetration", "mean_gap", "status")
        names = [name for name in known if name in self.columns]
        head = "".join(f"<th>{name}</th>" for name in names)
        body = "".join(
            "<tr>" + "".join(f"<td>{text.escape(_short(row[name]))}</td>" for name in names) + "</tr>" for row in self.rows
        )
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _short(value: Any) -> str:
    return f"{value:.5g}" if isinstance(value, float) else str(value)
