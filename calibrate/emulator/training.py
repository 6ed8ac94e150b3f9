"""From runs of one number to a trained process: scales, hyperparameters, outliers."""

from __future__ import annotations

from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.emulator.covariance import Design, Hyper
from calibrate.emulator.process import Form, Process, Runs, condition
from calibrate.emulator.search import search
from calibrate.emulator.types import Inputs

__all__ = ["train_process"]

OUTLIER: Final = 5.0
"""A run this many expected errors from what the others say is not believed."""
MOST_OUTLIERS: Final = 0.02
"""Share of runs that may be left out as outliers; where there are more, they are the rule."""
CONSTANT: Final = 1e-12
"""An output that scatters by less than this part of itself does not change."""


def train_process(inputs: Inputs, y: Array) -> Process:
    """Train a process.

    Parameters
    ----------
    inputs : Inputs
        n runs.
    y : (n,) float64
        One number on its model scale, no nan.
    """
    first = process = _trained(Runs(inputs, y, np.full(len(y), fill_value=True)))
    for left in range(max(1, int(MOST_OUTLIERS * len(y))), -1, -1):
        size = np.where(process.runs.believed, np.abs(process.left_out.z), 0.0)
        worst = int(size.argmax())
        if size[worst] < OUTLIER:
            return process
        if left:
            believed = process.runs.believed.copy()
            believed[worst] = False
            process = _trained(Runs(inputs, y, believed))
    return first


def _trained(runs: Runs) -> Process:
    y, strengths = runs.y[runs.believed], runs.inputs.strengths[runs.believed]
    shift, scale = float(y.mean()), float(y.std())
    acting = np.flatnonzero(strengths.any(axis=0))
    on = strengths[:, acting]
    unit = np.sqrt(np.sum(on**2, axis=0) / np.count_nonzero(on, axis=0))
    if scale <= CONSTANT * float(np.abs(y).max()):
        hyper = Hyper(np.ones(runs.inputs.u.shape[1]), 1.0, np.zeros(len(acting)), 0.0, 1.0)
        return condition(Form(hyper, shift, 0.0, acting, unit), runs)
    trusted = runs.inputs.rows(runs.believed)
    hyper = search(Design(trusted.u, on / unit, trusted.seeds), (y - shift) / scale)
    return condition(Form(hyper, shift, scale, acting, unit), runs)
