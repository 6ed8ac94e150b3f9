"""A calibration and a diagnosis as plain data for a program, and what is needed to repeat them."""

from __future__ import annotations

import json
import os
import platform
from collections.abc import Mapping
from dataclasses import asdict
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np

from calibrate.causes.studies.result import StudyDiagnosis
from calibrate.questions.script_lines import Script, ScriptNumber, script_of
from calibrate.report.record_file import hashed_record, kept_part, named_study
from calibrate.staged.calibration import Calibration
from calibrate.staged.result import StageResult
from calibrate.study.model import Study
from calibrate.study.places import Place
from liggghts_io.effects import EFFECTS
from liggghts_io.files import write_text

__all__ = [
    "plain",
    "provenance",
    "script_of_stages",
    "write_calibration",
    "write_diagnosis",
]

LEVEL = 0.9
PACKAGES = ("bulkcal", "numpy", "scipy", "smt", "numba", "pandas")


def provenance(study: Study, command: str) -> dict[str, str]:
    """Return what is needed to repeat a result: versions, seed, command, machine."""
    facts = {"command": command, "seed": str(study.run.seed), "engine": study.run.engine}
    for name in PACKAGES:
        try:
            facts[name] = version(name)
        except PackageNotFoundError:
            facts[name] = "not installed as a package"
    facts["python"] = platform.python_version()
    facts["system"] = f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores"
    return facts


def write_calibration(result: Calibration, path: Path, command: str) -> Path:
    """Write a calibration as JSON: what a program needs to go on from here.

    Parameters
    ----------
    result : Calibration
    path : Path
        File to write; replaced as a whole. A joint part of the same study stays.
    command : str
        Command that made it.
    """
    record = {
        **named_study(result.data, path),
        "parameters": dict(result.parameters),
        "stages": [_stage_record(result, stage) for stage in result.stages],
        "covariance": {
            "names": list(result.samples.columns),
            "matrix": np.atleast_2d(np.cov(result.samples.to_numpy(), rowvar=False)).tolist(),
        },
        "check": [
            {**asdict(row), "deviation_percent": row.deviation_percent, "z": row.z}
            for row in result.check
        ],
        "scripts": {
            one.name: script_of_stages(result, one.name).record() for one in result.study.materials
        },
        "runs": len(result.runs),
        "failed_runs": int((result.runs["status"] != "ok").sum()),
        "provenance": provenance(result.study, command),
    }
    joint = kept_part(path, result.data.sha256, "joint")
    return _write(path, hashed_record(plain(record | joint)))


def script_of_stages(result: Calibration, material: str) -> Script:
    """Return what a LIGGGHTS script needs to know of a material, as the stages found it.

    Parameters
    ----------
    result : Calibration
    material : str
        Name of the material in the study.
    """
    study = result.study
    spans = {
        (name, instance): stage.intervals[name][LEVEL]
        for stage in result.stages
        for name, instance in stage.freed.keys
    }

    def number_at(name: str, place: Place) -> ScriptNumber | None:
        instance = study.layout.instance(name, place)
        value = None if instance is None else result.parameters.get(study.label(name, instance))
        if instance is None or value is None or not np.isfinite(value):
            value = study.value_of(name, *place)
            off = name in EFFECTS and value == 0.0
            return None if value is None or off else ScriptNumber(name, value)
        span = spans.get((name, instance))
        label = study.label(name, instance)
        if span is None:
            return ScriptNumber(label, value)
        return ScriptNumber(label, value, span.low, span.high, "found")

    return script_of(study, material, number_at)


def _stage_record(result: Calibration, stage: StageResult) -> dict[str, Any]:
    return {
        "name": stage.stage.name,
        "status": stage.verdict.status,
        "notes": result.sentences(stage),
        "values": dict(stage.found),
        "intervals": {
            name: {f"{level:g}": asdict(interval) for level, interval in levels.items()}
            for name, levels in stage.intervals.items()
        },
        "eq_18": {"values": dict(stage.least_squares), "objective": stage.objective},
        "targets": [
            {
                "name": fit.target.name,
                "measured": fit.measured.value,
                "measured_se": fit.measured.se,
                "predicted": fit.predicted,
                "predicted_sd": fit.predicted_sd,
                "z": fit.z,
                "q2": fit.surrogate.quality.q2,
                "z_rms": fit.surrogate.quality.z_rms,
            }
            for fit in stage.fits
        ],
    }


def write_diagnosis(result: StudyDiagnosis, path: Path, facts: Mapping[str, Any]) -> dict[str, Any]:
    """Write a diagnosis as JSON and return what was written: all that page and screen show.

    Parameters
    ----------
    result : StudyDiagnosis
    path : Path
        File to write; replaced as a whole.
    facts : mapping
        Further ones, for example the files that were written.
    """
    record = plain({**result.record(), **facts})
    _write(path, hashed_record(record))
    return dict(record)


def plain(value: Any) -> Any:
    """Return plain Python values; numbers that JSON does not know (nan, inf) become None."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and not np.isfinite(value) else value


def _write(path: Path, record: Mapping[str, Any]) -> Path:
    """Write a record as a whole or not at all."""
    write_text(path, json.dumps(record, indent=1) + "\n")
    return path
