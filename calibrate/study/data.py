"""A study with all that belongs to it on disk, read once and handed on."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from calibrate.errors import CalibrationError
from calibrate.study.load import Read, data_file, read_study, read_study_file
from calibrate.study.measured.curves import MeasuredCurve, measured_curve
from calibrate.study.measured.scalars import Measured, given_value, measured_value
from calibrate.study.measured.tables import Table, read_table
from calibrate.study.mistakes import Key
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
        Digest of the study file as it was read, and of the folders of its own experiments.
    study : Study
    scalars : mapping
        Measured number by target name, in the unit of the simulated one.
    curves : mapping
        Measured curve by target name, at its levels and in the unit of the simulated one.
    """

    path: Path
    sha256: str
    study: Study
    scalars: Mapping[str, Measured]
    curves: Mapping[str, MeasuredCurve]

    @property
    def sources(self) -> tuple[str, ...]:
        """Where the measured data come from, each source once."""
        numbers = [one.source for one in self.scalars.values()]
        return tuple(dict.fromkeys([*numbers, *(one.source for one in self.curves.values())]))


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
    scalars, curves = _measured(read)
    study = read.whole()
    return StudyData(
        path=path,
        sha256=_digest(raw, study),
        study=study,
        scalars=scalars,
        curves=curves,
    )


def _digest(raw: bytes, study: Study) -> str:
    """Return the digest of a study: that of its file, where it has no experiment of its own."""
    own = [f"{name} {one.digest}" for name, one in sorted(study.own.items())]
    return hashlib.sha256(b"\n".join([raw, *map(str.encode, own)])).hexdigest()


def _measured(read: Read) -> tuple[dict[str, Measured], dict[str, MeasuredCurve]]:
    """Read all measured data, each file once, and note what is wrong."""
    tables: dict[str, Table | None] = {}
    scalars: dict[str, Measured] = {}
    curves: dict[str, MeasuredCurve] = {}
    for number, target in read.draft.declared.items():
        key: Key = ("target", number)
        material = read.draft.material_named(target.material)
        with read.mistakes.noting(key):
            if target.file is None:
                scalars[target.name] = given_value(target, read.path.name)
                continue
            if target.file not in tables:
                tables[target.file] = _table(read, key, target.file)
            table = tables[target.file]
            if table is None:
                continue
            if target.is_curve:
                curves[target.name] = measured_curve(target, material, table)
            else:
                scalars[target.name] = measured_value(target, material, table)
    return scalars, curves


def _table(read: Read, key: Key, file: str) -> Table | None:
    """Read a table; None where it cannot be, which is noted."""
    with suppress(CalibrationError):
        path = data_file(read.path, file)  # that it is missing has been noted
        with read.mistakes.noting((*key, "file")):
            return read_table(path)
    return None
