"""From finished runs to emulators."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.emulator.checks import fewest_points
from calibrate.emulator.emulator import TrainedEmulator, train_emulator
from calibrate.emulator.types import Inputs
from calibrate.errors import CalibrationError
from calibrate.questions.core.forms import Form, FormKey
from calibrate.questions.core.outputs import outputs_of
from calibrate.questions.core.runs import Runs

__all__ = ["Emulators", "Trained", "emulators_of", "training_arrays"]

ROUNDING: Final = 1e-6
"""Part of a range by which a run may lie outside it: numbers in cases are rounded."""
LEAST_SHARE: Final = 0.5
"""Of the runs of an experiment must have given a number: failures are data, but not all of them."""


@dataclass(frozen=True)
class Trained:
    """One emulator and what it was made of.

    Attributes
    ----------
    form : Form
    emulator : TrainedEmulator
    inputs : Inputs
        Its n runs.
    """

    form: Form
    emulator: TrainedEmulator
    inputs: Inputs


@dataclass(frozen=True)
class Emulators:
    """All emulators of a study.

    Attributes
    ----------
    trained : mapping
        By experiment and kind of surface.
    """

    trained: Mapping[FormKey, Trained]

    @property
    def quality(self) -> pd.DataFrame:
        """How well each output of each emulator predicts runs that it has not seen."""
        parts = []
        for (experiment, kind), one in self.trained.items():
            table = one.emulator.quality.copy()
            table.insert(0, "experiment", experiment)
            table.insert(1, "kind", kind)
            parts.append(table)
        return pd.concat(parts, ignore_index=True)


def training_arrays(form: Form, runs: Runs) -> tuple[Inputs, Array]:
    """Return the runs of a form as arrays.

    Parameters
    ----------
    form : Form
    runs : Runs
        Any; those of other experiments, outside the ranges or without a parameter are left out.

    Returns
    -------
    inputs : Inputs
        n runs.
    y : (n, M) float64
        Outputs on their model scales, see `outputs_of`; nan where a run failed.
    """
    rows = np.flatnonzero(runs.of(form.key))
    placed = [form.place_in(runs.specs[i]) for i in rows]
    u = np.array([p[0] for p in placed]).reshape(len(rows), len(form.axes))
    strengths = np.array([p[1] for p in placed]).reshape(len(rows), len(form.switches))
    inside = np.all(np.abs(u - 0.5) <= 0.5 + ROUNDING, axis=1)
    seeds = np.array([runs.specs[i].seed for i in rows], dtype=float)
    inputs = Inputs(np.clip(u, 0.0, 1.0), strengths, seeds).rows(inside)
    table = runs.table.iloc[rows[inside]]
    return inputs, outputs_of(form, table)


def emulators_of(forms: Mapping[FormKey, Form], runs: Runs) -> Emulators:
    """Train an emulator for each form.

    Parameters
    ----------
    forms : mapping
        Form by key.
    runs : Runs

    Raises
    ------
    CalibrationError
        Naming the experiment, how many of its runs gave a number, and why the others did not.
    """
    trained = {}
    for key, form in forms.items():
        inputs, y = training_arrays(form, runs)
        _enough(form, y, runs)
        emulator = train_emulator(inputs, form.emulator_outputs(), y)
        trained[key] = Trained(form, emulator, inputs)
    return Emulators(trained)


def _enough(form: Form, y: Array, runs: Runs) -> None:
    """Refuse to learn from too few runs, or from the lucky part of many."""
    for one in form.outputs:
        good = int(np.isfinite(y[:, one.columns]).all(axis=1).sum())
        least = fewest_points(len(form.axes) + len(form.switches))
        if good >= max(least, LEAST_SHARE * len(y)):
            continue
        table = runs.table[runs.of(form.key) & (runs.table["status"] != "ok").to_numpy()]
        why = table["reason"].value_counts()
        reason = f"; most often: {why.index[0]}" if len(why) else ""
        msg = (
            f"{form.experiment} on a {form.kind} surface: {good} of {len(y)} runs gave "
            f"{one.name}, too few to learn from (at least {least}, and half of them){reason}; "
            "narrow the ranges of the parameters, or change the apparatus"
        )
        raise CalibrationError(msg)
