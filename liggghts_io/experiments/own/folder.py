"""Read the folder of an own experiment."""

from __future__ import annotations

from pathlib import Path

from liggghts_io.errors import CaseError
from liggghts_io.experiments.own.record import OwnExperiment


def read_experiment(folder: Path) -> OwnExperiment:
    """Read the folder of an own experiment."""
    msg = f"{folder}: own experiments cannot be read yet"
    raise CaseError(msg)
