"""A study's own experiments: the folders that its ``[[experiment]]`` tables name."""

from __future__ import annotations

import reprlib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from calibrate.errors import CalibrationError, suggest
from calibrate.study.draft import tables_in
from calibrate.study.mistakes import Key, Mistakes
from liggghts_io import CaseError, OwnExperiment, read_experiment
from liggghts_io.effects import effects_in
from liggghts_io.experiments import DEFINITION, EXPERIMENTS, Experiment, own_experiment

__all__ = ["home_of", "own_experiments"]


def home_of(study_path: Path) -> Path:
    """Return the folder in which a study's files lie: that of the file itself, behind any link.

    Raises
    ------
    OSError, RuntimeError
        Where links lead nowhere.
    """
    return study_path.resolve().parent if study_path.is_symlink() else study_path.parent


def own_experiments(
    data: Mapping[str, Any], study_path: Path, mistakes: Mistakes
) -> dict[str, OwnExperiment]:
    """Return the own experiments of a study by name, and note what is wrong in their folders.

    Parameters
    ----------
    data : mapping
        The study's tables.
    study_path : Path
        Study file; folders lie in its directory.
    mistakes : Mistakes
        Takes every mistake of every folder, with its file and line, at the key `folder`.
    """
    found: dict[str, OwnExperiment] = {}
    measured = [target.get("experiment") for target in tables_in(data.get("target"))]
    used = [one for name, one in EXPERIMENTS.items() if name in measured]
    for number, table in enumerate(tables_in(data.get("experiment"))):
        folder, key = table.get("folder"), ("experiment", number, "folder")
        if not isinstance(folder, str):
            continue
        with mistakes.noting(key):
            own = _read(_folder(study_path, folder), key, mistakes)
            if own is None:
                continue
            _check_name(own, table.get("name"), folder)
            _check_effects(own, [*used, *map(own_experiment, found.values())])
            found[own.name] = own
    return found


def _folder(study_path: Path, name: str) -> Path:
    """Return a folder inside the study's directory.

    Raises
    ------
    CalibrationError
        When it lies elsewhere, also through a link, or there is none.
    """
    shown = reprlib.repr(name)
    try:
        home = home_of(study_path)
        path = home / name
        real, inside = path.resolve(), home.resolve()
        within, there = real != inside and real.is_relative_to(inside), path.is_dir()
    except (OSError, RuntimeError, ValueError) as err:  # RuntimeError: a loop of links
        msg = f"folder = {shown} cannot be found ({err}); put the folder beside the study"
        raise CalibrationError(msg) from err
    if not within:
        msg = f"folder = {shown} lies outside the study's directory; copy it to {home.resolve()}"
        raise CalibrationError(msg)
    if not there:
        near = suggest(name, sorted(one.parent.name for one in home.glob(f"*/{DEFINITION}")))
        msg = f"folder = {shown} does not exist in {home.resolve()}{near}"
        raise CalibrationError(msg)
    return path


def _read(folder: Path, key: Key, mistakes: Mistakes) -> OwnExperiment | None:
    """Read a folder; None where that fails, with each of its mistakes noted on its own."""
    try:
        return read_experiment(folder)
    except CaseError as err:
        for line in str(err).splitlines():
            mistakes.add(key, line)
    return None


def _check_name(own: OwnExperiment, said: object, folder: str) -> None:
    """Refuse a folder that describes another experiment than its table says."""
    if own.name != said:
        msg = (
            f"{folder}/{DEFINITION} has name = '{own.name}', and this table says '{said}'; write "
            "the same name in both"
        )
        raise CalibrationError(msg)


def _check_effects(own: OwnExperiment, others: Iterable[Experiment]) -> None:
    """Refuse an effect with a name that is taken, in the program or in another experiment.

    Raises
    ------
    CalibrationError, CaseError
    """
    effects_in(own_experiment(own))
    mine = {one.name for one in own_experiment(own).effects}
    for other in others:
        taken = mine & {one.name for one in other.effects}
        for name in sorted(taken):
            msg = (
                f"effect '{name}' stands in {other.name} and in {own.name}; rename one, so that a "
                "strength belongs to one of them"
            )
            raise CalibrationError(msg)
