"""What stays in a directory when the same study is calibrated into it again, in another mode."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import pandas as pd

from calibrate.errors import CalibrationError
from calibrate.report.record_file import FILES, kept_part, read_record
from calibrate.report.sections import Section, add_section, further_sections
from calibrate.runs.stored import RECORD, REPORT, TABLE
from calibrate.study.data import StudyData

__all__ = ["Kept", "kept_in", "outdated_in", "replaced_in"]

JOINT: Final = "joint"
STAGES_ID: Final = '<section id="stages">'


class Kept:
    """What a directory held of the same study file and data before it is written to.

    Parameters
    ----------
    out : Path
        Directory of the result.
    record : mapping
        Its record, empty where it belongs to another study.
    """

    def __init__(self, out: Path, record: dict[str, Any]) -> None:
        self._out = out
        self._record = record
        self._sections: list[Section] = further_sections(out / REPORT) if record else []

    @property
    def staged_page(self) -> bool:
        """Whether a report by stages is there, to which a joint section can be added."""
        if "stages" not in self._record:
            return False
        try:
            return STAGES_ID in (self._out / REPORT).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError):
            return False

    @property
    def staged_values(self) -> dict[str, float]:
        """What stages found, by the study's label of a parameter."""
        freed = {name for stage in self._record.get("stages", ()) for name in stage["values"]}
        values = self._record.get("parameters", {})
        return {name: value for name, value in values.items() if name.partition(" ")[0] in freed}

    def put_sections_back(self) -> None:
        """Add the further sections of the earlier report to the one that replaced it."""
        for section in self._sections:
            add_section(self._out / REPORT, section)

    def with_runs_of_joint(self, table: pd.DataFrame) -> pd.DataFrame:
        """Return a table of runs by stages with those of the joint part that stays."""
        names = self._record.get(JOINT, {}).get("runs", [])
        before = self._table()
        return _joined(table, before[before["case_id"].isin(names)])

    def with_runs_of_stages(self, table: pd.DataFrame) -> pd.DataFrame:
        """Return a table of joint runs with those of the stages that stay, in front."""
        before = self._table() if "stages" in self._record else _none()
        return _joined(before[before["stage"] != JOINT], table)

    def _table(self) -> pd.DataFrame:
        """Return the table of runs that is there."""
        try:
            found = pd.read_csv(self._out / TABLE, dtype={"case_id": str})
        except (OSError, ValueError):
            return _none()
        return found if {"case_id", "stage"} <= set(found.columns) else _none()


def kept_in(out: Path, study_sha256: str) -> Kept:
    """Look at what a directory holds.

    Parameters
    ----------
    out : Path
        Directory of the result, which need not be there.
    study_sha256 : str
        Digest of study and data; what belongs to another is not kept.
    """
    return Kept(out, kept_part(out / RECORD, study_sha256))


def replaced_in(out: Path, name: str) -> str:
    """Return the name of another study whose results a directory has; '' if there are none.

    Parameters
    ----------
    out : Path
        Directory of the result.
    name : str
        Of the study that is calibrated into it.
    """
    try:
        found = str(read_record(out / RECORD).get("study", name))
    except CalibrationError:
        return ""
    return "" if found == name else found


def outdated_in(out: Path, data: StudyData) -> str:
    """Return why results in a directory are of other data of the same study; '' where not so.

    Parameters
    ----------
    out : Path
        Directory of the result.
    data : StudyData
        As it is calibrated into it.
    """
    try:
        record = read_record(out / RECORD)
    except CalibrationError:
        return ""
    if record.get("study") != data.study.name or record.get("study_sha256") == data.sha256:
        return ""
    before = record.get(FILES)
    if before is None:
        return "made by an earlier version, which did not note its data"
    now = dict(data.files)
    changed = [name for name in {**before, **now} if before.get(name) != now.get(name)]
    return f"{' and '.join(changed) or 'the study'} changed since"


def _none() -> pd.DataFrame:
    return pd.DataFrame({"case_id": [], "stage": []})


def _joined(first: pd.DataFrame, second: pd.DataFrame) -> pd.DataFrame:
    """Return both, each case once."""
    fresh = second[~second["case_id"].isin(first["case_id"])]
    parts = [part for part in (first, fresh) if len(part)]
    return pd.concat(parts, ignore_index=True) if parts else first
