"""Posteriors on disk: one npz file, arrays and a JSON text, no pickles."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final
from zipfile import BadZipFile

import numpy as np

from calibrate.errors import CalibrationError
from calibrate.inference.posterior import Posterior, Region
from calibrate.inference.priors import Prior
from calibrate.inference.space import Space, Tie, Unknown

__all__ = ["load_posterior", "posterior_record", "save_posterior"]

_FORMAT: Final = "bulkcal posterior 1"


def posterior_record(posterior: Posterior) -> dict[str, Any]:
    """Return everything but the samples as plain data, ready for JSON."""
    return {
        "format": _FORMAT,
        "space": asdict(posterior.space),
        "log_evidence": posterior.log_evidence,
        "log_evidence_error": posterior.log_evidence_error,
        "best": posterior.best.tolist(),
        "regions": [
            {"weight": one.weight}
            | {key: getattr(one, key).tolist() for key in ("low", "high", "mean")}
            for one in posterior.regions
        ],
        "diagnostics": dict(posterior.diagnostics),
        "provenance": dict(posterior.provenance),
    }


def save_posterior(posterior: Posterior, path: Path) -> None:
    """Write a posterior to an npz file.

    Parameters
    ----------
    posterior : Posterior
        Its provenance must be plain data.
    path : Path
    """
    record = json.dumps(posterior_record(posterior))
    with path.open("wb") as file:
        np.savez_compressed(file, samples=posterior.samples, record=np.array(record))


def load_posterior(path: Path) -> Posterior:
    """Read what `save_posterior` wrote.

    Raises
    ------
    CalibrationError
        If the file is not one of these.
    """
    try:
        with path.open("rb") as opened, np.load(opened, allow_pickle=False) as file:
            samples, record = file["samples"], json.loads(str(file["record"]))
        space = _space(record["space"])
        regions = tuple(
            Region(one["weight"], *(np.array(one[key]) for key in ("low", "high", "mean")))
            for one in record["regions"]
        )
        good = record["format"] == _FORMAT and samples.shape[1] == space.size
    except (OSError, ValueError, KeyError, TypeError, EOFError, BadZipFile) as err:
        msg = f"{path}: no stored posterior; run the calibration again"
        raise CalibrationError(msg) from err
    if not good:
        msg = f"{path}: written by another version; run the calibration again"
        raise CalibrationError(msg)
    return Posterior(
        space, samples, record["log_evidence"], record["log_evidence_error"],
        np.array(record["best"]), regions, record["diagnostics"], record["provenance"],
    )  # fmt: skip


def _space(record: dict[str, Any]) -> Space:
    unknowns = tuple(
        Unknown(**{**one, "prior": Prior(**one["prior"])}) for one in record["unknowns"]
    )
    ties = tuple(Tie(**{**one, "members": tuple(one["members"])}) for one in record["ties"])
    return Space(unknowns, ties)
