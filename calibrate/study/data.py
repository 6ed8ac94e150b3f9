"""A study with all that belongs to it on disk, read once and handed on."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from calibrate.study.curves import MeasuredCurve, read_curves
from calibrate.study.load import parse_study, read_study_file
from calibrate.study.measured import Measured, read_measured
from calibrate.study.model import Study

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
        When anything in the study or its data is wrong, before the first run.
    """
    raw = read_study_file(path)
    study = parse_study(path, raw)
    return StudyData(
        path=path,
        sha256=hashlib.sha256(raw).hexdigest(),
        study=study,
        measured=read_measured(study, path),
        curves=read_curves(study, path),
    )
