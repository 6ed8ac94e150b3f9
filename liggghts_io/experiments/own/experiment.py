"""From the folder of an own experiment to an experiment like the built-in ones."""

from __future__ import annotations

from liggghts_io.errors import CaseError
from liggghts_io.experiments.base import Experiment
from liggghts_io.experiments.own.record import OwnExperiment


def own_experiment(own: OwnExperiment) -> Experiment:
    """Return the experiment that a folder describes."""
    msg = f"{own.name}: own experiments cannot be run yet"
    raise CaseError(msg)
