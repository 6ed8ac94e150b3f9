"""The experiments: one file each, one line each in the registry."""

from __future__ import annotations

from typing import Final

from liggghts_io.errors import CaseError, nearest
from liggghts_io.experiments.base import SCALES, Experiment
from liggghts_io.experiments.conveyor import CONVEYOR
from liggghts_io.experiments.heap import HEAP
from liggghts_io.experiments.numbers import Adjustment, Curve, Observable, Parameter
from liggghts_io.experiments.own.experiment import own_experiment
from liggghts_io.experiments.own.folder import read_experiment
from liggghts_io.experiments.own.record import OwnExperiment, own_of, plain_own
from liggghts_io.experiments.plate_impact import PLATE_IMPACT
from liggghts_io.experiments.setup import Build, Observed, Setup
from liggghts_io.experiments.view import Notes, View

EXPERIMENTS: Final = {one.name: one for one in (HEAP, CONVEYOR, PLATE_IMPACT)}

__all__ = [
    "EXPERIMENTS",
    "SCALES",
    "Adjustment",
    "Build",
    "Curve",
    "Experiment",
    "Notes",
    "Observable",
    "Observed",
    "OwnExperiment",
    "Parameter",
    "Setup",
    "View",
    "experiment_named",
    "own_experiment",
    "own_of",
    "plain_own",
    "read_experiment",
]


def experiment_named(name: str) -> Experiment:
    """Return the experiment of that name.

    Raises
    ------
    CaseError
        For an unknown name, with the nearest known one.
    """
    try:
        return EXPERIMENTS[name]
    except KeyError:
        msg = f"unknown experiment {name!r}{nearest(name, list(EXPERIMENTS))}"
        raise CaseError(msg) from None
