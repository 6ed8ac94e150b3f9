"""Finished runs with their specifications, and with their curves at the levels that are asked."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeAlias

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.questions.core.forms import Form, FormKey
from calibrate.runs.runner import Runner
from liggghts_io import CaseSpec, experiment_of, load_result, read_curve
from liggghts_io.materials import kind_of

__all__ = ["CurveReader", "Runs", "make_runs", "read_stored_curve", "with_curves"]

CurveReader: TypeAlias = Callable[[CaseSpec, Path, str, Sequence[float]], Array]
"""Case, its directory, curve and levels to its values there, nan where not reached."""


@dataclass(frozen=True)
class Runs:
    """Finished runs.

    Attributes
    ----------
    specs : tuple of CaseSpec
    table : DataFrame
        A row for each, as a campaign gives it; curves in columns ``NAME@LEVEL``.
    """

    specs: tuple[CaseSpec, ...]
    table: pd.DataFrame

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self.specs)

    def joined(self, other: Runs) -> Runs:
        """Return these runs and others, each case once."""
        table = (
            pd.concat([self.table, other.table], ignore_index=True) if len(self) else other.table
        )
        specs = (*self.specs, *other.specs)
        fresh = ~table["case_id"].duplicated().to_numpy()
        kept = tuple(spec for spec, keep in zip(specs, fresh, strict=True) if keep)
        return Runs(kept, table[fresh].reset_index(drop=True))

    def where(self, keep: Sequence[bool]) -> Runs:
        """Return those for which `keep`, (n,), says so."""
        kept = tuple(spec for spec, one in zip(self.specs, keep, strict=True) if one)
        return Runs(kept, self.table[np.array(keep, dtype=bool)].reset_index(drop=True))

    def of(self, key: FormKey) -> Array:
        """Return which runs are of an experiment on a kind of surface, (n,) bool."""
        return np.array(
            [(one.experiment, kind_of(one.surface)) == key for one in self.specs], dtype=bool
        )


def read_stored_curve(spec: CaseSpec, path: Path, name: str, levels: Sequence[float]) -> Array:
    """Return a curve of a finished case at other levels than the experiment's own.

    Parameters
    ----------
    spec : CaseSpec
    path : Path
        Its directory.
    name : str
        Of the curve.
    levels : sequence of float
    """
    curve = next(one for one in experiment_of(spec).curves if one.name == name)
    return read_curve(load_result(path), replace(curve, levels=tuple(levels)))


def make_runs(
    specs: Sequence[CaseSpec],
    label: str,
    runner: Runner,
    forms: Mapping[FormKey, Form],
    read: CurveReader = read_stored_curve,
) -> Runs:
    """Run cases and read the curves that their forms ask for.

    Parameters
    ----------
    specs : sequence of CaseSpec
    label : str
        Shown with the progress.
    runner : Runner
    forms : mapping
        Form by key.
    read : CurveReader
    """
    return with_curves(specs, runner(specs, label), forms, read)


def with_curves(
    specs: Sequence[CaseSpec],
    table: pd.DataFrame,
    forms: Mapping[FormKey, Form],
    read: CurveReader = read_stored_curve,
) -> Runs:
    """Return finished runs with the curves that their forms ask for.

    Parameters
    ----------
    specs : sequence of CaseSpec
    table : DataFrame
        A row for each, as a campaign gives it.
    forms : mapping
        Form by key.
    read : CurveReader
    """
    columns: dict[str, Array] = {}
    for row, spec in enumerate(specs):
        form = forms.get((spec.experiment, kind_of(spec.surface)))
        for one in form.outputs if form else ():
            if one.levels and table["status"].iloc[row] == "ok":
                values = read(spec, Path(table["path"].iloc[row]), one.name, one.levels)
                for name, value in zip(one.table_columns, values, strict=True):
                    columns.setdefault(name, np.full(len(specs), np.nan))[row] = value
    return Runs(tuple(specs), table.assign(**columns))
