"""The experiments: one file each, one line each in the registry."""

from __future__ import annotations

from typing import Final

from liggghts_io.errors import CaseError, nearest
from liggghts_io.experiments.base import (
    SCALES,
    Build,
    Experiment,
    Notes,
    Observed,
    Setup,
    View,
)
from liggghts_io.experiments.conveyor import CONVEYOR
from liggghts_io.experiments.heap import HEAP
from liggghts_io.experiments.numbers import Observable, Parameter
from liggghts_io.experiments.plate_impact import PLATE_IMPACT

EXPERIMENTS: Final = {one.name: one for one in (HEAP, CONVEYOR, PLATE_IMPACT)}

__all__ = [
    "EXPERIMENTS",
    "SCALES",
    "Build",
    "Experiment",
    "Notes",
    "Observable",
    "Observed",
    "Parameter",
    "Setup",
    "View",
    "experiment_named",
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
