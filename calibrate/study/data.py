"""A study with all that belongs to it on disk, read once and handed on."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from calibrate.errors import CalibrationError
from calibrate.study.checks.measured import curves_of_many_places
from calibrate.study.checks.plausible import Values, check_amounts, implausible
from calibrate.study.load import Read, data_file, read_study, read_study_file
from calibrate.study.measured.assigned import Around
from calibrate.study.measured.curves import MeasuredCurve, measured_curve
from calibrate.study.measured.files import bytes_of, text_in
from calibrate.study.measured.scalars import Measured, given_value, measured_value
from calibrate.study.measured.tables import LARGEST_TABLE, Table, table_of
from calibrate.study.mistakes import Key
from calibrate.study.model import Study
from liggghts_io.files import sha256_bytes, sha256_file

__all__ = ["StudyData", "load_data"]


@dataclass(frozen=True)
class StudyData:
    """A study and its measured data.

    Attributes
    ----------
    path : Path
        Study file; its data lie beside it.
    sha256 : str
        Digest of the study file and of all that it reads, `files`: a result that notes another
        is of other data.
    files : mapping of str to str
        Digest of each file and folder that the study names, by its name there: tables of
        measured data and of grains, folders of own experiments.
    study : Study
    scalars : mapping
        Measured number by target name, in the unit of the simulated one.
    curves : mapping
        Measured curve by target name, at its levels and in the unit of the simulated one.
    """

    path: Path
    sha256: str
    files: Mapping[str, str]
    study: Study
    scalars: Mapping[str, Measured]
    curves: Mapping[str, MeasuredCurve]

    @property
    def doubts(self) -> list[str]:
        """What is odd in the data, though not impossible, a sentence for each."""
        values = Values(self.scalars, self.curves)
        return [*curves_of_many_places(self.study), *implausible(self.study, values)]

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
    tables: dict[str, str] = {}
    scalars, curves = _measured(read, tables)
    if read.study is not None and not read.mistakes:
        check_amounts(read.study, Values(scalars, curves), read.mistakes)
    study = read.whole()
    tables |= {name: sha256_file(one) for name, one in read.grains.items()}
    folders = {one.folder: study.own[one.name].digest for one in study.rigs if one.folder}
    return StudyData(
        path=path,
        sha256=_digest(raw, study, tables),
        files={path.name: sha256_bytes(raw), **tables, **folders},
        study=study,
        scalars=scalars,
        curves=curves,
    )


def _digest(raw: bytes, study: Study, tables: Mapping[str, str]) -> str:
    """Return the digest of a study and of what it reads: that of its file, where it reads none."""
    own = [f"{name} {one.digest}" for name, one in sorted(study.own.items())]
    data = [f"{name} {digest}" for name, digest in sorted(tables.items())]
    return hashlib.sha256(b"\n".join([raw, *map(str.encode, [*own, *data])])).hexdigest()


def _measured(
    read: Read, digests: dict[str, str]
) -> tuple[dict[str, Measured], dict[str, MeasuredCurve]]:
    """Read all measured data, each file once; note its digest, and what is wrong."""
    tables: dict[str, Table | None] = {}
    scalars: dict[str, Measured] = {}
    curves: dict[str, MeasuredCurve] = {}
    declared = read.draft.declared
    around = Around(tuple(declared.values()), tuple(read.draft.materials.values()))
    for number, target in read.draft.targets.items():
        key: Key = ("target", number)
        if target.file is None:
            with read.mistakes.noting((*key, "value")):
                scalars[target.name] = given_value(target, read.path.name)
            continue
        if number not in declared:  # nobody knows which rows of a table are its own
            continue
        material = read.draft.material_named(target.material)
        with read.mistakes.noting(key):
            if target.file not in tables:
                tables[target.file] = _table(read, key, target.file, digests)
            table = tables[target.file]
            if table is None:
                continue
            if target.is_curve:
                curves[target.name] = measured_curve(target, material, table, around)
            else:
                scalars[target.name] = measured_value(target, material, table, around)
    return scalars, curves


def _table(read: Read, key: Key, file: str, digests: dict[str, str]) -> Table | None:
    """Read a table and note its digest; None where it cannot be, which is noted."""
    with suppress(CalibrationError):
        path = data_file(read.path, file)  # that it is missing has been noted
        with read.mistakes.noting((*key, "file")):
            raw = bytes_of(path, LARGEST_TABLE, "a CSV file")
            digests[file] = sha256_bytes(raw)
            return table_of(path, text_in(path, raw))
    return None
