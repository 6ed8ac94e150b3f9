"""Runs that a stage plans, and the samples of its observables that they give."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.scales import forward
from calibrate.staged.surface import Samples
from calibrate.study.model import Stage, Target
from liggghts_io import CaseSpec

__all__ = ["Planned", "samples_of", "stage_bounds"]


@dataclass(frozen=True)
class Planned:
    """A case and where it stands in a stage.

    Attributes
    ----------
    spec : CaseSpec
    u : (2,) float64
        Free parameters in [0, 1].
    nuisance : (m,) float64
        Parameters of earlier stages, in standard deviations from their chosen values.
    kind : {"design", "repeat", "infill"}
        What it is run for.
    """

    spec: CaseSpec
    u: Array
    nuisance: Array
    kind: str


def samples_of(target: Target, planned: Sequence[Planned], runs: pd.DataFrame) -> Samples:
    """Return the usable samples of a target; failed runs and missing values are left out.

    Parameters
    ----------
    target : Target
        Which observable, and on which scale its surrogate works.
    planned : sequence of Planned
        What was run.
    runs : DataFrame
        Results in the same order.
    """
    place = (target.experiment, target.surface)
    here = np.array([(p.spec.experiment, p.spec.surface) == place for p in planned])
    known = target.observable in runs.columns
    raw = runs[target.observable].to_numpy() if known else np.full(len(runs), np.nan)
    y = forward(target.scale, np.asarray(raw, float))
    good = here & (runs["status"] == "ok").to_numpy() & np.isfinite(y)
    chosen = [p for p, keep in zip(planned, good, strict=True) if keep]
    if not chosen:
        empty = np.empty((0, 0))
        return Samples(empty, np.empty(0), empty)
    return Samples(
        x=np.array([p.u for p in chosen]),
        y=y[good],
        nuisance=np.array([p.nuisance for p in chosen]),
    )


def stage_bounds(stage: Stage) -> Array:
    """Return the limits of a stage's free parameters, (2, 2)."""
    return np.array(list(stage.free.values()), dtype=float)
