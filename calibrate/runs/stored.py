"""Names in a study's result directory, and cases that are stored there already."""

from __future__ import annotations

from pathlib import Path

from liggghts_io import CaseResult, CaseSpec, case_id, stored_result

__all__ = [
    "DIAGNOSIS",
    "DIAGNOSIS_START",
    "EXTENDED",
    "FIGURE",
    "RECORD",
    "REPORT",
    "RUNS",
    "SAMPLES",
    "SECTION",
    "SENSITIVITY",
    "SENSITIVITY_PAGE",
    "START",
    "TABLE",
    "WHAT_IF",
    "stored_case",
]

RUNS, TABLE = "runs", "runs.csv"
RECORD, REPORT = "calibration.json", "report.html"
DIAGNOSIS, FIGURE, SECTION = "diagnosis.json", "diagnosis.png", "diagnosis.html"
EXTENDED, DIAGNOSIS_START, WHAT_IF = "extended", "diagnosis_start.json", "what_if"
SENSITIVITY, SENSITIVITY_PAGE = "sensitivity.json", "sensitivity.html"
SAMPLES, START = "posterior.npz", "joint_start.json"


def stored_case(spec: CaseSpec, root: Path, *, limit_s: float | None = None) -> CaseResult | None:
    """Return the stored result of a case under `root`, or None when it has to run.

    Parameters
    ----------
    spec : CaseSpec
    root : Path
    limit_s : float, optional
        Wall-clock limit of a run [s]; one that was stopped after that time counts as stored.
    """
    return stored_result(root, case_id(spec), limit_s)
