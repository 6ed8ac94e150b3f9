"""A whole calibration: the stages in order, then the final check."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from calibrate.runs.runner import Runner
from calibrate.staged.check import CheckRow, run_check
from calibrate.staged.earlier import Earlier
from calibrate.staged.result import StageResult
from calibrate.staged.significance import weighed
from calibrate.staged.stages import run_stage
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
        Contact parameter to its value; nan where neither a stage nor the study sets it.
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
        parts = [s.runs.assign(stage=s.stage.name) for s in self.stages]
        return pd.concat([*parts, self.check_runs.assign(stage="check")], ignore_index=True)


def calibrate(
    data: StudyData, runner: Runner, stage_done: Callable[[StageResult], None] | None = None
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

    Returns
    -------
    Calibration

    Raises
    ------
    CalibrationError
        When too few runs succeeded.
    """
    study, measured = data.study, data.measured
    earlier = Earlier()
    stages: list[StageResult] = []
    for number in range(len(study.stage)):
        result = run_stage(study, number, measured, earlier, runner)
        stages.append(result)
        if stage_done:
            stage_done(result)
        rng = np.random.default_rng([study.seed, number, 1])
        values = np.array(list(result.found.values()))
        samples = result.samples(POSTERIOR_SAMPLES, rng)
        earlier = earlier.joined(list(result.found), values, samples)
    found = {name: value for stage in stages for name, value in stage.found.items()}
    parameters = {
        name: found.get(name, study.fixed.get(name, np.nan)) for name in CONTACT_PARAMETERS
    }
    check, runs = run_check(study, measured, parameters, runner)
    samples_table = pd.DataFrame(earlier.samples, columns=list(earlier.names))
    return Calibration(
        data=data,
        stages=tuple(stages),
        parameters=parameters,
        samples=samples_table,
        check=tuple(check),
        check_runs=runs,
    )
