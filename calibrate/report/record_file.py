"""The file of a calibration's record: plain data with a digest, read without what made it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from calibrate.errors import CalibrationError
from liggghts_io.files import canonical_json, sha256_text

__all__ = ["hashed_record", "kept_part", "read_record"]


def read_record(path: Path) -> dict[str, Any]:
    """Read the record of a calibration, without its digest.

    Raises
    ------
    CalibrationError
        When the file does not hold one, or was changed.
    """
    try:
        data: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        digest = data.pop("sha256")
        whole = digest == sha256_text(canonical_json(data))
    except (OSError, ValueError, KeyError, AttributeError, TypeError) as err:
        msg = f"{path}: holds no calibration ({err}); run 'bulkcal calibrate' again"
        raise CalibrationError(msg) from err
    if not whole:
        msg = f"{path}: was changed or cut; run 'bulkcal calibrate' again"
        raise CalibrationError(msg)
    return data


def kept_part(path: Path, study_sha256: str, *keys: str) -> dict[str, Any]:
    """Return entries of a record that is there and belongs to the same study file and data.

    Parameters
    ----------
    path : Path
    study_sha256 : str
    *keys : str
        Entries to return as far as the record has them; all where none is named.
    """
    try:
        found = read_record(path)
    except CalibrationError:
        return {}  # none, or one that was changed: it is written anew
    if found.get("study_sha256") != study_sha256:
        return {}
    return {key: value for key, value in found.items() if not keys or key in keys}


def hashed_record(record: Mapping[str, Any]) -> dict[str, Any]:
    """Return a record of plain data with its digest; `read_record` wants it."""
    return {**record, "sha256": sha256_text(canonical_json(record))}
