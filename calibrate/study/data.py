"""A study with all that belongs to it on disk, read once and handed on."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from calibrate.errors import CalibrationError
from calibrate.study.curves import MeasuredCurve, measured_curve
from calibrate.study.load import Read, data_file, read_study, read_study_file
from calibrate.study.measured import Measured, measured_value
from calibrate.study.mistakes import Key
from calibrate.study.model import Curve, Study, Target
from calibrate.study.tables import Table, read_table

__all__ = ["StudyData", "load_data"]


@dataclass(frozen=True)
class StudyData:
    """A study and its measured data.

    Attributes
    ----------
    path : Path
        Study file; its data lie beside it.
    sha256 : str
        Digest of the study file as it was read.
    study : Study
    measured : mapping
        Measured value by target name.
    curves : mapping
        Measured mass-time curve by curve name.
    """

    path: Path
    sha256: str
    study: Study
    measured: Mapping[str, Measured]
    curves: Mapping[str, MeasuredCurve]


def load_data(path: Path) -> StudyData:
    """Read a study file and every data file that it names, each once.

    Parameters
    ----------
    path : Path
        Study file.

    Raises
    ------
    CalibrationError
        With all that is wrong in the study and its data, before the first run.
    """
    raw = read_study_file(path)
    read = read_study(path, raw)
    measured, curves = _measured(read)
    return StudyData(
        path=path,
        sha256=hashlib.sha256(raw).hexdigest(),
        study=read.whole(),
        measured=measured,
        curves=curves,
    )


def _measured(read: Read) -> tuple[dict[str, Measured], dict[str, MeasuredCurve]]:
    """Read all measured data, each file once, and note what is wrong."""
    tables: dict[str, Table | None] = {}
    measured: dict[str, Measured] = {}
    curves: dict[str, MeasuredCurve] = {}
    parts: dict[Key, Target | Curve] = {("target", n): t for n, t in read.draft.targets.items()}
    parts |= {("curve", n): c for n, c in read.draft.curves.items()}
    for key, one in parts.items():
        if one.file not in tables:
            tables[one.file] = _table(read, key, one.file)
        table = tables[one.file]
        if table is None:
            continue
        with read.mistakes.noting(key):
            if isinstance(one, Curve):
                curves[one.name] = measured_curve(one, table)
            elif read.draft.particle:
                measured[one.name] = measured_value(one, read.draft.particle.name, table)
    return measured, curves


def _table(read: Read, key: Key, file: str) -> Table | None:
    """Read a table; None where it cannot be, which is noted."""
    with suppress(CalibrationError):
        path = data_file(read.path, file)  # that it is missing has been noted
        with read.mistakes.noting((*key, "file")):
            return read_table(path)
    return None
