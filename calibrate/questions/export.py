"""A joint result in the forms that others read: plain data, JSON, CSV, LIGGGHTS lines."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from calibrate.questions.core.problem import unknown_at
from calibrate.questions.joint.result import JointResult
from calibrate.questions.script_lines import Script, ScriptNumber, script_lines, script_of
from calibrate.study.places import Place
from liggghts_io.effects import EFFECTS

__all__ = ["csv_text", "joint_record", "json_text", "liggghts_lines", "script_of_joint"]

LEVEL: Final = 0.9
DIGITS: Final = "%.8g"
"""Of numbers in CSV: more than any of them means."""


def script_of_joint(result: JointResult, material: str) -> Script:
    """Return what a LIGGGHTS script needs to know of a material.

    Parameters
    ----------
    result : JointResult
    material : str
        Name of the material in the study.
    """
    study = result.study

    def number_at(name: str, place: Place) -> ScriptNumber | None:
        key = unknown_at(study, name, place) if name in study.parameters else None
        if key is None:
            value = study.value_of(name, *place)
            if value is None or (value == 0.0 and name in EFFECTS):
                return None
            return ScriptNumber(name, value)
        if key in result.undetermined:
            return ScriptNumber(key, result.best[key], known="not determined")
        span = result.posterior.interval(key, LEVEL)
        return ScriptNumber(key, result.best[key], span.low, span.high, "found")

    return script_of(study, material, number_at)


def liggghts_lines(result: JointResult, material: str) -> str:
    """Return lines for a LIGGGHTS script; parameters as `script_of_joint`."""
    return script_lines(script_of_joint(result, material))


def joint_record(result: JointResult) -> dict[str, Any]:
    """Return everything but the draws as plain data: no types of NumPy, None for nan.

    What is not determined has no value there; what the engine was run with stands apart, in
    ``checked_with``.
    """
    posterior = result.posterior
    table = result.table().reset_index()
    table["best"] = table["best"].where(table["determined"])
    found: dict[str, Any] = _plain(
        {
            "provenance": dict(result.provenance),
            "unknowns": table.to_dict(orient="records"),
            "checked_with": dict(result.best),
            "log_evidence": posterior.log_evidence,
            "log_evidence_error": posterior.log_evidence_error,
            "modes": [
                {
                    "weight": one.weight,
                    **{
                        what: dict(zip(posterior.names, getattr(one, what).tolist(), strict=True))
                        for what in ("low", "high", "mean")
                    },
                }
                for one in posterior.regions
            ],
            "correlation": posterior.correlation().to_dict(),
            "check": result.check_table().to_dict(orient="records"),
            "unseen_z": result.unseen_z,
            "emulators": result.emulators.quality.to_dict(orient="records"),
            "sentences": list(result.sentences),
            "scripts": {
                one.name: script_of_joint(result, one.name).record()
                for one in result.study.materials
            },
        }
    )
    return found


def json_text(result: JointResult) -> str:
    """Return everything that a program may want, draws included."""
    posterior = result.posterior
    samples = {
        name: [float(f"{x:.6g}") for x in posterior.samples[:, k]]
        for k, name in enumerate(posterior.names)
    }
    whole = {"kind": "bulkcal joint calibration", **joint_record(result), "samples": samples}
    return json.dumps(whole, indent=1, allow_nan=False) + "\n"


def _plain(value: Any) -> Any:
    """Return a value as JSON holds it: no nan, no types of NumPy."""
    if isinstance(value, Mapping):
        return {str(key): _plain(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value


def csv_text(result: JointResult) -> str:
    """Return the table of unknowns as CSV; what is not determined has no value."""
    table = result.table()
    table["best"] = table["best"].where(table["determined"])
    return table.to_csv(lineterminator="\n", float_format=DIGITS)
