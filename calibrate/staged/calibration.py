"""A whole calibration: the stages in order, then the final check."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from calibrate.runs.cases import Runner
from calibrate.staged.check import CheckRow, run_check
from calibrate.staged.stages import Earlier, StageResult, run_stage
from calibrate.study.load import load_study
from calibrate.study.measured import Measured, read_measured
from calibrate.study.model import PARAMETERS, Study

__all__ = ["Calibration", "calibrate"]

POSTERIOR_SAMPLES = 500


@dataclass(frozen=True)
class Calibration:
    """Result of a study: the stages, the parameters they found and the final check.

    ``samples`` holds draws from the posteriors of all stages, one column per freed parameter.
    """

    study: Study
    study_path: Path
    measured: Mapping[str, Measured]
    stages: tuple[StageResult, ...]
    parameters: Mapping[str, float]
    samples: pd.DataFrame
    check: tuple[CheckRow, ...]
    check_runs: pd.DataFrame

    @property
    def runs(self) -> pd.DataFrame:
        """All runs, with a column that says which stage asked for them."""
        parts = [s.runs.assign(stage=s.stage.name) for s in self.stages]
        return pd.concat([*parts, self.check_runs.assign(stage="check")], ignore_index=True)


def calibrate(
    study_path: Path, runner: Runner, stage_done: Callable[[StageResult], None] | None = None
) -> Calibration:
    """Calibrate a study.

    Parameters
    ----------
    study_path : Path
        Study file; its data lie beside it.
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
        When the study or its data are wrong, or too few runs succeeded.
    """
    study = load_study(study_path)
    measured = read_measured(study, study_path)
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
    parameters = {name: found.get(name, study.fixed.get(name, np.nan)) for name in PARAMETERS}
    check, runs = run_check(study, measured, parameters, runner)
    samples_table = pd.DataFrame(earlier.samples, columns=list(earlier.names))
    return Calibration(
        study=study,
        study_path=study_path,
        measured=measured,
        stages=tuple(stages),
        parameters=parameters,
        samples=samples_table,
        check=tuple(check),
        check_runs=runs,
    )
