"""From a study and parameters to case specifications."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TypeAlias

import pandas as pd

from calibrate.study.model import Study, Target
from liggghts_io import CaseSpec
from liggghts_io.effects import EFFECTS

__all__ = ["Runner", "bench", "case_spec"]

Runner: TypeAlias = Callable[[Sequence[CaseSpec], str], pd.DataFrame]
"""Runs cases under a label and returns one row per case in their order (see `campaign`)."""


def bench(targets: Sequence[Target]) -> list[tuple[str, str]]:
    """Return the experiments that targets need, as (experiment, surface) without repeats."""
    return list(dict.fromkeys((t.experiment, t.surface) for t in targets))


def _acting(study: Study, experiment: str) -> dict[str, float]:
    """Return the effects of a study that act in an experiment."""
    return {
        name: strength
        for name, strength in study.effects.items()
        if EFFECTS[name].acts_in(experiment)
    }


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
        effects=_acting(study, experiment),
        seed=seed,
        engine=study.engine,
    )
