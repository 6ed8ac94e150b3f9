"""The experiments: ours, those of other installed packages, and a user's own."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from liggghts_io.errors import CaseError, nearest
from liggghts_io.experiments.base import SCALES, Experiment
from liggghts_io.experiments.bundled import bundled_experiments, bundled_folder
from liggghts_io.experiments.numbers import Adjustment, Curve, Observable, Parameter
from liggghts_io.experiments.own.experiment import own_experiment
from liggghts_io.experiments.own.folder import experiment_files
from liggghts_io.experiments.own.folder import read_experiment as read_folder
from liggghts_io.experiments.own.record import DEFINITION, OwnExperiment, own_of, plain_own
from liggghts_io.experiments.setup import Build, Observed, Setup
from liggghts_io.experiments.view import Notes, View
from liggghts_io.plug_ins import load_plug_ins

_LOADED: Final = load_plug_ins("bulkcal.experiments", Experiment, bundled_experiments())
EXPERIMENTS: Final[dict[str, Experiment]] = _LOADED.found

__all__ = [
    "DEFINITION",
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
    "bundled_folder",
    "experiment_files",
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
        broken = "".join(f"; {one}" for one in _LOADED.broken)
        msg = f"unknown experiment {name!r}{nearest(name, list(EXPERIMENTS))}{broken}"
        raise CaseError(msg) from None


def read_experiment(folder: Path) -> OwnExperiment:
    """Read the folder of a user's own experiment, and check all of it.

    Parameters
    ----------
    folder : Path
        With `experiment.toml`, either `script.in.j2` or one ordinary LIGGGHTS script (`NAME.in` or
        `in.NAME`), and the meshes that the definition names.

    Raises
    ------
    CaseError
        With every mistake that was found, each with file, line, value and remedy.
    """
    own = read_folder(folder)
    if own.name in EXPERIMENTS:
        msg = f"{folder}: name = {own.name!r} is that of a known experiment; choose another"
        raise CaseError(msg)
    return own
