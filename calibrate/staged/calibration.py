"""A whole calibration: the stages in order, then the final check."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from calibrate.errors import CalibrationError
from calibrate.questions.core.from_study import levels_of
from calibrate.questions.core.runs import CurveReader, read_stored_curve
from calibrate.runs.runner import Runner
from calibrate.significance import weighed
from calibrate.staged.check import CheckRow, run_check
from calibrate.staged.earlier import Earlier
from calibrate.staged.placed import placed
from calibrate.staged.result import StageResult
from calibrate.staged.stages import run_stage
from calibrate.staged.surrogates.surface import fewest_points
from calibrate.study.cases import Values
from calibrate.study.data import StudyData
from calibrate.study.model import Study
from liggghts_io.materials import CONTACT_PARAMETERS

__all__ = ["Calibration", "calibrate"]

POSTERIOR_SAMPLES = 500


@dataclass(frozen=True)
class Calibration:
    """Result of a study: the stages, the parameters they found and the final check.

    Attributes
    ----------
    data : StudyData
        The study and what was measured.
    stages : tuple of StageResult
        In the study's order.
    parameters : mapping
        Contact parameters and what else the study names to their values, with the instance behind
        the name where there are several, such as "mu_pw HSP13/steel".
    samples : DataFrame
        Draws from the posteriors of all stages, one column per freed parameter.
    check : tuple of CheckRow
        Measured and simulated at the found parameters, one row per target.
    check_runs : DataFrame
        Runs of the final check.
    """

    data: StudyData
    stages: tuple[StageResult, ...]
    parameters: Mapping[str, float]
    samples: pd.DataFrame
    check: tuple[CheckRow, ...]
    check_runs: pd.DataFrame

    @property
    def study(self) -> Study:
        """The study itself."""
        return self.data.study

    def sentences(self, stage: StageResult) -> list[str]:
        """Return what a stage says of its result, and where the final check contradicts it."""
        rows = [row for row in self.check if row.name in stage.stage.targets and row.significant]
        return [
            *stage.verdict.sentences,
            *(
                f"The final check decides: the simulator itself misses {row.label} by "
                f"{weighed(row.z, errors='measurement and simulation')}."
                for row in rows
            ),
        ]

    @property
    def runs(self) -> pd.DataFrame:
        """All runs, with a column that says which stage asked for them."""
        parts = [
            placed(s.runs, [p.place for p in s.planned]).assign(stage=s.stage.name)
            for s in self.stages
        ]
        return pd.concat([*parts, self.check_runs.assign(stage="check")], ignore_index=True)


def calibrate(
    data: StudyData,
    runner: Runner,
    stage_done: Callable[[StageResult], None] | None = None,
    read: CurveReader = read_stored_curve,
) -> Calibration:
    """Calibrate a study.

    Parameters
    ----------
    data : StudyData
        The study and what was measured, from `load_data`.
    runner : Runner
        Runs cases, normally a `Campaign`.
    stage_done : callable, optional
        Called with each finished stage.
    read : CurveReader
        Reads curves of finished cases.

    Returns
    -------
    Calibration

    Raises
    ------
    CalibrationError
        When too few runs succeeded.
    """
    study = data.study
    _refuse(data)
    earlier = Earlier()
    stages: list[StageResult] = []
    for number in range(len(study.stages)):
        result = run_stage(data, number, earlier, runner, read)
        stages.append(result)
        if stage_done:
            stage_done(result)
        rng = np.random.default_rng([study.run.seed, number, 1])
        values = np.array(list(result.found.values()))
        samples = result.samples(POSTERIOR_SAMPLES, rng)
        earlier = earlier.joined(result.freed.keys, values, samples)
    found = {
        key: value
        for stage in stages
        for key, value in zip(stage.freed.keys, stage.found.values(), strict=True)
    }
    check, runs = run_check(data, found, runner, read)
    labels = [study.label(*key) for key in earlier.keys]
    samples_table = pd.DataFrame(earlier.samples, columns=labels)
    return Calibration(
        data=data,
        stages=tuple(stages),
        parameters=_all_values(study, found),
        samples=samples_table,
        check=tuple(check),
        check_runs=runs,
    )


def _refuse(data: StudyData) -> None:
    """Refuse a study that has no stages, or stages that this calibration cannot follow.

    Raises
    ------
    CalibrationError
        With the stage and what is the matter.
    """
    study = data.study
    if not study.stages:
        msg = f"{data.path}: has no [[stage]]; a calibration by stages needs at least one"
        raise CalibrationError(msg)
    for stage in study.stages:
        where = f"{data.path}: stage '{stage.name}'"
        size = len(stage.free)
        numbers = sum(
            max(len(levels_of(data, study.target_named(name))), 1) for name in stage.targets
        )
        if numbers < size:
            msg = (
                f"{where} has {numbers} measured {'number' if numbers == 1 else 'numbers'} for "
                f"{size} free parameters; give it {size} or more, or free fewer"
            )
            raise CalibrationError(msg)
        if stage.points < fewest_points(size):
            msg = (
                f"{where}: points = {stage.points} are too few for {size} free parameters; give "
                f"at least {fewest_points(size)}"
            )
            raise CalibrationError(msg)


def _all_values(study: Study, found: Values) -> dict[str, float]:
    """Return what was found and what the study fixes, in the order of the contact parameters."""
    layout = study.layout
    values: dict[str, float] = {}
    for name in dict.fromkeys([*CONTACT_PARAMETERS, *study.parameters]):
        for place in study.places:
            instance = layout.instance(name, place)
            if instance is None:
                continue
            fixed = study.value_of(name, *place)
            value = found.get((name, instance), np.nan if fixed is None else fixed)
            values[study.label(name, instance)] = float(value)
    return values
