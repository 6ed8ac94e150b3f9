"""The diagnosis as plain data for a program."""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from pathlib import Path
from typing import Any

from calibrate.diagnose.pipeline import Diagnosis
from calibrate.report.diagnosis_words import sentences


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
    return {key: _finite(value) for key, value in data.items()}


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


def _finite(value: Any) -> Any:
    """Replace numbers that JSON does not know."""
    if isinstance(value, dict):
        return {k: _finite(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(v) for v in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def write_record(found: Diagnosis, path: Path, extra: dict[str, Any]) -> Path:
    """Write the diagnosis as JSON, as a whole or not at all.

    Parameters
    ----------
    extra : dict
        Further facts, for example command and digest of the study.
    """
    temporary = path.with_name(path.name + ".tmp")
    text = json.dumps({**extra, **as_data(found)}, indent=1, sort_keys=False) + "\n"
    temporary.write_text(text, encoding="utf-8")
    temporary.replace(path)
    return path
