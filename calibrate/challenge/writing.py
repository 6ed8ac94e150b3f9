"""The folder of one study of a suite: study file and curves, as a laboratory would hand them on."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.challenge.laboratory import Errors, errors_of, measured_values
from calibrate.challenge.learnt import Learnt
from calibrate.challenge.rules import Rules
from calibrate.errors import CalibrationError
from calibrate.questions.core.forms import Form, FormKey
from calibrate.questions.core.from_study import form_key, levels_of, place_of
from calibrate.questions.core.runs import Runs
from calibrate.scales import forward, slope
from calibrate.study.data import StudyData, load_data
from calibrate.study.measured.scalars import impossible
from calibrate.study.model import Study
from calibrate.study.places import Place
from calibrate.study.schema.settings import Shared
from calibrate.study.schema.targets import Target
from calibrate.study.write import study_text
from liggghts_io.files import write_text

__all__ = ["write_study"]

MOST_MISSING: Final = 0.5
"""Part of the targets that a study must have."""
FEWEST_LEVELS: Final = 3
"""Levels that a curve must have to be one."""


def write_study(
    data: StudyData,
    learnt: Learnt,
    rules: Rules,
    forms: Mapping[FormKey, Form],
    runs: Mapping[Place, Runs],
    folder: Path,
    name: str,
) -> None:
    """Write a study with what its runs measured; what no run gave could not be measured.

    Parameters
    ----------
    data : StudyData
        The suite's study.
    learnt : Learnt
        It knows how much single runs scatter, as a laboratory knows its experiments.
    rules : Rules
    forms : mapping
        Of the suite's study.
    runs : mapping
        By place.
    folder : Path
        Made if it is missing.
    name : str

    Raises
    ------
    CalibrationError
        If less than half of the targets could be measured, or nobody could read what is written.
    """
    study, targets, shared = data.study, [], list(data.study.shared)
    folder.mkdir(parents=True, exist_ok=True)
    for target in study.targets:
        place = place_of(target)
        form = forms[form_key(study, place)]
        output = form.output(target.observable, target.model_scale, levels_of(data, target))
        found = measured_values(runs[place], output.table_columns)
        if not len(found) or (target.is_curve and found.shape[1] < FEWEST_LEVELS):
            continue
        values, scale = found.mean(axis=0), target.model_scale
        errors = errors_of(learnt, study, target, rules, np.asarray(forward(scale, found)))
        told = _told(target, folder, levels_of(data, target)[: len(values)], values, errors)
        if told is not None:
            targets.append(told)
            shared += _luck(target, errors)
    if len(targets) < MOST_MISSING * len(study.targets):
        msg = f"{name}: its runs gave {len(targets)} of {len(study.targets)} targets"
        raise CalibrationError(msg)
    seen = {target.experiment for target in targets}
    own = {
        "name": name, "title": f"Study {name}", "targets": targets, "shared": shared,
        "rigs": [one for one in study.rigs if one.name in seen],
    }  # fmt: skip
    _write_readable(study.model_copy(update=own), folder / "study.toml")


def _told(
    target: Target, folder: Path, levels: tuple[float, ...], values: Array, errors: Errors
) -> Target | None:
    """Return a target with what was measured; None where it cannot be what was."""
    steps = np.array([slope(target.model_scale, float(value)) for value in values])
    if target.is_curve:
        return _with_curve(target, folder, levels, values, errors.own / steps)
    value, se = float(values[0]), float(errors.own[0] / steps[0])
    if impossible(target, value, se):
        return None
    repeats = {"repeats": errors.repeats} if errors.repeats else {}
    return target.model_copy(update={"value": value, "se": se, **repeats})


def _luck(target: Target, errors: Errors) -> list[Shared]:
    """Return the error that all levels of a curve share, if that is told."""
    if not errors.common.shape[1]:
        return []
    # On a logarithmic scale an error in common is relative.
    size = float(errors.common[0, 0])
    return [Shared(name=f"luck_{target.name}", targets=[target.name], relative_se=size)]


def _write_readable(study: Study, path: Path) -> None:
    """Write a study; none is left where its own reader refuses it."""
    write_text(path, study_text(study))
    try:
        load_data(path)
    except CalibrationError:
        path.unlink()
        raise


def _with_curve(
    target: Target, folder: Path, levels: tuple[float, ...], values: Array, se: Array
) -> Target:
    """Write a curve to a file of its own, and return the target that names it.

    The suite's own study may point many targets at one file, as a place for their levels.
    """
    file = f"{target.name}.csv"
    rows = [f"{target.x_column},{target.column},{target.se_column}"]
    rows += [
        f"{x:g},{float(y):.6g},{float(e):.4g}" for x, y, e in zip(levels, values, se, strict=True)
    ]
    write_text(folder / file, "\n".join(rows) + "\n")
    return target.model_copy(update={"file": file})
