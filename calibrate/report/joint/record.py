"""A joint calibration on disk: the joint part of the record, and its draws beside it."""

from __future__ import annotations

import json
from io import BytesIO
from pathlib import Path

import numpy as np

from calibrate.inference.posterior import Posterior
from calibrate.inference.store import posterior_record
from calibrate.questions.export import joint_record
from calibrate.questions.joint.result import JointResult
from calibrate.report.record import provenance
from calibrate.report.record_file import hashed_record, kept_part, named_study
from calibrate.study.model import Study
from liggghts_io.files import sha256_bytes, write_bytes, write_text
from liggghts_io.materials import CONTACT_PARAMETERS

__all__ = ["write_joint"]

JOINT = "joint"


def write_joint(result: JointResult, path: Path, samples: Path, command: str) -> Path:
    """Write draws, and the record with its joint part.

    A part by stages that is there and belongs to the same study file and data stays.

    Parameters
    ----------
    result : JointResult
    path : Path
        The record; replaced as a whole.
    samples : Path
        File of the draws beside it, npz; `calibrate.inference.store` reads it.
    command : str
        Command that made it.
    """
    content = _posterior_bytes(result.posterior)
    write_bytes(samples, content)
    part = {
        **joint_record(result),
        "samples": {"file": samples.name, "sha256": sha256_bytes(content)},
        "runs": list(result.runs.table["case_id"]),
        "failed_runs": int((result.runs.table["status"] != "ok").sum()),
    }
    part["provenance"] |= provenance(result.study, command)
    before = kept_part(path, result.data.sha256)
    whole = {
        **named_study(result.data, path),
        "parameters": _all_values(result),
    }
    if "stages" in before:
        whole = before
    write_text(path, json.dumps(hashed_record({**whole, JOINT: part}), indent=1) + "\n")
    return path


def _posterior_bytes(posterior: Posterior) -> bytes:
    """Return what `calibrate.inference.store.load_posterior` reads."""
    held = BytesIO()
    text = json.dumps(posterior_record(posterior))
    np.savez_compressed(held, samples=posterior.samples, record=np.array(text))
    return held.getvalue()


def _all_values(result: JointResult) -> dict[str, float]:
    """Return what was found and what the study fixes, named as a calibration by stages does."""
    study: Study = result.study
    found = dict(zip(study.free, (result.best[k] for k in result.posterior.names), strict=False))
    values = {}
    for name in dict.fromkeys([*CONTACT_PARAMETERS, *study.parameters]):
        for place in study.places:
            instance = study.layout.instance(name, place)
            if instance is None:
                continue
            value = found.get((name, instance), study.value_of(name, *place))
            if value is not None:
                values[study.label(name, instance)] = float(value)
    return values
