"""From parameters to case specifications, and from finished cases back to samples."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from calibrate.scales import forward
from calibrate.staged.surface import Samples
from calibrate.study.model import Stage, Study, Target
from liggghts_io import CaseSpec

__all__ = ["Planned", "Runner", "bench", "case_spec", "samples_of"]

Array = NDArray[np.float64]
Runner: TypeAlias = Callable[[Sequence[CaseSpec], str], pd.DataFrame]
"""Runs cases under a label and returns one row per case in their order (see `campaign`)."""


@dataclass(frozen=True)
class Planned:
    """A case and where it stands in a stage: free parameters in [0, 1], earlier ones in sd."""

    spec: CaseSpec
    u: Array
    nuisance: Array
    kind: str  # design | repeat | infill


def bench(targets: Sequence[Target]) -> list[tuple[str, str]]:
    """Return the experiments that targets need, as (experiment, surface) without repeats."""
    return list(dict.fromkeys((t.experiment, t.surface) for t in targets))


def case_spec(
    study: Study, place: tuple[str, str], parameters: Mapping[str, float], seed: int
) -> CaseSpec:
    """Return the case of one experiment at given contact parameters.

    Parameters
    ----------
    study : Study
        Particle, scale, engine, apparatus and effects.
    place : (str, str)
        Experiment and surface.
    parameters : mapping
        All six contact parameters.
    seed : int
        Seed of the insertion.
    """
    experiment, surface = place
    return CaseSpec(
        experiment=experiment,
        particle=study.bulk.particle,
        surface=surface,
        scale=study.scale,
        # Ten digits are more than any parameter means and keep case ids stable across platforms.
        parameters={name: float(f"{value:.10g}") for name, value in sorted(parameters.items())},
        apparatus=dict(study.apparatus.get(experiment, {})),
        effects=dict(study.effects),
        seed=seed,
        engine=study.engine,
    )


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
    y = forward(target.transform, np.asarray(raw, float))
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
