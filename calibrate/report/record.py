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

from calibrate.diagnose.pipeline import Diagnosis
from calibrate.errors import CalibrationError
from calibrate.report.diagnosis_words import sentences
from calibrate.staged.calibration import Calibration
from calibrate.staged.result import StageResult
from calibrate.study.model import Study
from liggghts_io.files import canonical_json, sha256_text, write_text

__all__ = ["as_data", "provenance", "start_of", "write_calibration", "write_diagnosis"]

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
        File to write; replaced as a whole.
    command : str
        Command that made it.
    """
    record = {
        "study": result.study.name,
        "study_file": str(result.data.path),
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
        "runs": len(result.runs),
        "failed_runs": int((result.runs["status"] != "ok").sum()),
        "provenance": provenance(result.study, command),
    }
    whole = plain(record)
    return _write(path, {**whole, "sha256": sha256_text(canonical_json(whole))})


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


def as_data(found: Diagnosis) -> dict[str, Any]:
    """Everything in plain types; numbers that do not exist are None."""
    verdict, local = found.verdict, found.local
    data: dict[str, Any] = {
        "verdict": verdict.kind,
        "names": list(verdict.names),
        "sentences": sentences(found),
        "p_misfit": verdict.p_misfit,
        "p_search": verdict.p_search,
        "threshold": verdict.threshold,
        "best_gain": verdict.best_gain,
        "levels": asdict(found.levels),
        "parameters": found.theta,
        "parameters_held": [
            p.name for p, h in zip(found.problem.parameters, local.base.held, strict=True) if h
        ],
        "settled": local.settled,
        "runs": local.runs,
        "failed_runs": list(local.failed),
        "residuals": [asdict(r) for r in found.residuals],
        "residuals_after": [asdict(r) for r in found.after],
        "engine_before": [asdict(r) for r in found.engine_before],
        "engine_after": [asdict(r) for r in found.engine_after],
        "absorption": [asdict(v) for v in found.absorption.candidates],
        "cosines": found.absorption.cosines.tolist(),
        "suspects": [_suspect(found, k) for k in range(len(verdict.suspects))],
        "gains": [asdict(g) for g in found.gains],
    }
    return {key: plain(value) for key, value in data.items()}


def _suspect(found: Diagnosis, index: int) -> dict[str, Any]:
    one = found.verdict.suspects[index]
    profile = found.verdict.intervals.get(one.candidate)
    return {
        "candidate": one.candidate,
        "strength": one.strength,
        "interval68": list(profile.interval68) if profile else None,
        "interval95": list(profile.interval95) if profile else None,
        "gain": one.gain,
        "p_residual": one.p_residual,
        "p_rival": one.p_rival,
        "parameters": found.problem.theta(one.fitted.u),
    }


def write_diagnosis(found: Diagnosis, path: Path, extra: Mapping[str, Any]) -> Path:
    """Write a diagnosis as JSON.

    Parameters
    ----------
    found : Diagnosis
    path : Path
        File to write; replaced as a whole.
    extra : mapping
        Further facts, for example name and digest of the study.
    """
    return _write(path, {**extra, **as_data(found)})


def start_of(record: Path) -> dict[str, float]:
    """Read the parameters of a calibration from its record.

    Raises
    ------
    CalibrationError
        When the file does not hold one, or was changed.
    """
    try:
        data = json.loads(record.read_text(encoding="utf-8"))
        digest = data.pop("sha256")
        if digest != sha256_text(canonical_json(data)):
            msg = f"{record}: was changed or cut; run 'bulkcal calibrate' again"
            raise CalibrationError(msg)
        return {str(k): float(v) for k, v in data["parameters"].items()}
    except (OSError, ValueError, KeyError, AttributeError, TypeError) as err:
        msg = f"{record}: holds no calibration ({err}); run 'bulkcal calibrate' again"
        raise CalibrationError(msg) from err


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
