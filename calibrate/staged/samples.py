"""Runs that a stage plans, and the samples of its observables that they give."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.scales import forward
from calibrate.staged.surface import Samples
from calibrate.study.model import Study
from calibrate.study.places import Place
from calibrate.study.schema.stages import Stage
from calibrate.study.schema.targets import Target
from liggghts_io import CaseSpec

__all__ = ["Freed", "Planned", "freed_by", "samples_of"]


@dataclass(frozen=True)
class Freed:
    """What a stage frees.

    Attributes
    ----------
    keys : tuple of (str, str)
        Name and instance of each parameter.
    bounds : (d, 2) float64
        Their limits.
    """

    keys: tuple[tuple[str, str], ...]
    bounds: Array

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters; a stage frees one instance of each."""
        return tuple(name for name, _ in self.keys)


def freed_by(study: Study, stage: Stage) -> Freed:
    """Return what a stage frees and between which limits."""
    keys = tuple(study.freed(stage).items())
    ranges = [study.range_of(name, instance, stage) for name, instance in keys]
    return Freed(keys, np.array(ranges, dtype=float))


@dataclass(frozen=True)
class Planned:
    """A case and where it stands in a stage.

    Attributes
    ----------
    place : Place
        Where in the study; surfaces of one kind have equal cases.
    spec : CaseSpec
    u : (2,) float64
        Free parameters in [0, 1].
    nuisance : (m,) float64
        Parameters of earlier stages, in standard deviations from their chosen values.
    kind : {"design", "repeat", "infill"}
        What it is run for.
    """

    place: Place
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
    place = Place(target.material, target.surface, target.experiment)
    here = np.array([p.place == place for p in planned])
    known = target.observable in runs.columns
    raw = runs[target.observable].to_numpy() if known else np.full(len(runs), np.nan)
    y = forward(target.model_scale, np.asarray(raw, float))
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
