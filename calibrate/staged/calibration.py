"""A whole calibration: the stages in order, the final check, and the record of both."""

from __future__ import annotations

import json
import os
import platform
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from calibrate.runs.cases import Runner
from calibrate.staged.check import CheckRow, run_check
from calibrate.staged.stages import Earlier, StageResult, run_stage
from calibrate.study.measured import Measured, read_measured
from calibrate.study.model import PARAMETERS, Study, load_study

__all__ = ["Calibration", "calibrate", "write_record"]

POSTERIOR_SAMPLES = 500
PACKAGES = ("bulkcal", "numpy", "scipy", "smt", "numba", "pandas")


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


def provenance(study: Study, command: str) -> dict[str, str]:
    """Return what is needed to repeat a result: versions, seed, command, machine."""
    facts = {"command": command, "seed": str(study.seed), "engine": study.engine}
    for name in PACKAGES:
        try:
            facts[name] = version(name)
        except PackageNotFoundError:
            facts[name] = "not installed as a package"
    facts["python"] = platform.python_version()
    facts["system"] = f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores"
    return facts


def write_record(result: Calibration, path: Path, command: str) -> Path:
    """Write a calibration as JSON: what a program needs to go on from here.

    Parameters
    ----------
    result : Calibration
    path : Path
        File to write; replaced as a whole.
    command : str
        Command that made it.
    """
    record = {
        "study": result.study.name,
        "study_file": str(result.study_path),
        "parameters": dict(result.parameters),
        "stages": [_stage_record(stage) for stage in result.stages],
        "covariance": {
            "names": list(result.samples.columns),
            "matrix": np.atleast_2d(np.cov(result.samples.to_numpy(), rowvar=False)).tolist(),
        },
        "check": [
            {**asdict(row), "deviation_percent": row.deviation_percent, "z": row.z}
            for row in result.check
        ],
        "runs": len(result.runs),
        "failed_runs": int((result.runs["status"] != "ok").sum()),
        "provenance": provenance(result.study, command),
    }
    temporary = path.with_name(path.name + ".tmp")
    temporary.write_text(json.dumps(_no_nan(record), indent=1) + "\n", encoding="utf-8")
    temporary.replace(path)
    return path


def _stage_record(stage: StageResult) -> dict[str, Any]:
    return {
        "name": stage.stage.name,
        "status": stage.verdict.status,
        "notes": list(stage.verdict.sentences),
        "objective": stage.objective,
        "values": dict(stage.found),
        "intervals": {
            name: {f"{level:g}": asdict(interval) for level, interval in levels.items()}
            for name, levels in stage.intervals.items()
        },
        "targets": [
            {
                "name": fit.target.name,
                "measured": fit.measured.value,
                "measured_se": fit.measured.sem,
                "predicted": fit.predicted,
                "predicted_sd": fit.predicted_sd,
                "z": fit.z,
                "q2": fit.surrogate.quality.q2,
                "z_rms": fit.surrogate.quality.z_rms,
            }
            for fit in stage.fits
        ],
    }


def _no_nan(value: Any) -> Any:
    """Replace nan, which JSON does not know, by null, and numpy's scalars by Python's."""
    if isinstance(value, dict):
        return {key: _no_nan(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_no_nan(item) for item in value]
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and not np.isfinite(value) else value
