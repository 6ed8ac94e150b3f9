"""Runs that a stage plans, and the samples of its observables that they give."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.inference import Prior
from calibrate.inference.priors import from_unit, to_unit
from calibrate.questions.core.forms import Emulated
from calibrate.questions.core.from_study import levels_of, place_of
from calibrate.questions.core.problem import prior_of
from calibrate.scales import forward
from calibrate.staged.surrogates.samples import Samples
from calibrate.study.data import StudyData
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
    priors : tuple of Prior
        Their limits in this stage, how they are spaced, and what is believed of them before.
    """

    keys: tuple[tuple[str, str], ...]
    priors: tuple[Prior, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters; a stage frees one instance of each."""
        return tuple(name for name, _ in self.keys)

    @property
    def bounds(self) -> Array:
        """Limits, (d, 2)."""
        return np.array([(one.low, one.high) for one in self.priors])

    def values(self, u: Array) -> Array:
        """Return the values of points of the unit cube, (n, d)."""
        columns = zip(u.T, self.priors, strict=True)
        return np.column_stack([from_unit(x, p.low, p.high, p.spacing) for x, p in columns])

    def units(self, values: Array) -> Array:
        """Undo `values`."""
        columns = zip(values.T, self.priors, strict=True)
        return np.column_stack([to_unit(x, p.low, p.high, p.spacing) for x, p in columns])


def freed_by(study: Study, stage: Stage) -> Freed:
    """Return what a stage frees and between which limits."""
    keys = tuple(study.freed(stage).items())
    return Freed(
        keys, tuple(prior_of(study, name, study.range_of(name, one, stage)) for name, one in keys)
    )


@dataclass(frozen=True)
class Planned:
    """A case and where it stands in a stage.

    Attributes
    ----------
    place : Place
        Where in the study; surfaces of one kind have equal cases.
    spec : CaseSpec
    u : (d,) float64
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


def samples_of(
    data: StudyData, target: Target, planned: Sequence[Planned], runs: pd.DataFrame
) -> Samples:
    """Return the usable samples of a target; failed runs and missing values are left out.

    Parameters
    ----------
    data : StudyData
    target : Target
        Which observable or curve, and on which scale its surrogate works.
    planned : sequence of Planned
        What was run.
    runs : DataFrame
        Results in the same order, curves in columns ``NAME@LEVEL``.
    """
    levels = levels_of(data, target)
    where = Emulated(target.observable, target.model_scale, slice(0, max(len(levels), 1)), levels)
    raw = runs.reindex(columns=where.table_columns).to_numpy(float)
    y = forward(target.model_scale, raw)
    here = np.array([one.place == place_of(target) for one in planned])
    good = here & (runs["status"] == "ok").to_numpy() & np.isfinite(y).all(axis=1)
    return Samples(
        x=np.array([one.u for one in planned])[good],
        y=y[good],
        nuisance=np.array([one.nuisance for one in planned])[good],
    )
