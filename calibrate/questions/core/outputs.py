"""What runs gave, as an emulator takes it."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.questions.core.forms import Form
from calibrate.scales import forward

__all__ = ["drawn_on", "outputs_of"]

REACHED: Final = 0.5
"""Part of its levels that a curve must have reached to be drawn on to the others."""
FEWEST: Final = 3
"""Whole curves for each level of one, from which it is learnt how curves go on."""
ALONE: Final = 1e-6
"""Part of the variance of the levels that each has for itself: neighbours are nearly the same."""


def outputs_of(form: Form, table: pd.DataFrame) -> Array:
    """Return the outputs of runs of a form.

    Parameters
    ----------
    form : Form
    table : DataFrame
        Its n runs, with ``status``; columns of outputs that no run gave may be missing.

    Returns
    -------
    (n, M) float64
        On their model scales, nan where a run failed. A curve that a run did not end is drawn on,
        see `drawn_on`.
    """
    y = np.full((len(table), form.width), np.nan)
    for one in form.outputs:
        for column, name in zip(range(form.width)[one.columns], one.table_columns, strict=True):
            if name in table:
                y[:, column] = forward(one.scale, table[name].to_numpy(float))
    y[(table["status"] != "ok").to_numpy()] = np.nan
    for one in form.outputs:
        if one.levels:
            y[:, one.columns] = drawn_on(y[:, one.columns])
    return y


def drawn_on(curves: Array) -> Array:
    """Return curves with what they would be expected to do beyond the end of their runs.

    Who leaves out the runs that ended too early keeps, near that end, the lucky ones: of slow
    grains the emulator then expects too little (`docs/diagnosis.md` has by how much). What a curve
    does at its last levels follows from its first ones as it does, straight, in whole curves.

    Parameters
    ----------
    curves : (n, L) float64
        On the model scale; nan from where a run ended.

    Returns
    -------
    (n, L) float64
        Curves that reached half of the levels are whole. The others stay, and so do all where
        there are too few whole ones.
    """
    finite = np.isfinite(curves)
    reached = np.cumprod(finite, axis=1).sum(axis=1)
    levels, whole = curves.shape[1], curves[finite.all(axis=1)]
    found = curves.copy()
    if len(whole) < FEWEST * levels:
        return found
    middle, covariance = whole.mean(axis=0), np.cov(whole.T)
    covariance[np.diag_indices(levels)] += ALONE * np.trace(covariance) / levels
    for k in range(max(1, int(np.ceil(REACHED * levels))), levels):
        rows = (reached == k) & ~finite[:, k:].any(axis=1)
        turned = np.linalg.solve(covariance[:k, :k], covariance[:k, k:])
        found[rows, k:] = middle[k:] + (curves[rows, :k] - middle[:k]) @ turned
    return found
