"""Names in a study's result directory, and cases that are stored there already."""

from __future__ import annotations

from pathlib import Path

from liggghts_io import CaseError, CaseResult, CaseSpec, case_id, load_result

__all__ = ["RECORD", "REPORT", "RUNS", "stored_case"]

RUNS = "runs"
REPORT = "report.html"
RECORD = "calibration.json"


def stored_case(spec: CaseSpec, root: Path) -> CaseResult | None:
    """Return the stored result of a case under `root`, or None when it has to run."""
    try:
        return load_result(root / case_id(spec))
    except CaseError:
        return None
