"""The file of a calibration's record: plain data with a digest, read without what made it."""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from calibrate.errors import CalibrationError
from liggghts_io.errors import CaseError
from liggghts_io.files import canonical_json, sha256_file, sha256_text, shell_word

if TYPE_CHECKING:
    from calibrate.study.data import StudyData

__all__ = [
    "FILES",
    "FROM_HERE",
    "hashed_record",
    "kept_part",
    "named_study",
    "of_this_version",
    "outdated",
    "read_record",
]

FROM_HERE: Final = "study_from_here"
"""Entry of a record: its study file, seen from the directory of the record."""
FILES: Final = "study_files"
"""Entry of a record: the files of its study with their digests."""


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
    except (OSError, ValueError, KeyError, AttributeError, TypeError, RecursionError) as err:
        why = err if isinstance(err, OSError | ValueError) else "its digest is not there"
        msg = f"{path}: holds no calibration ({why}); run 'bulkcal calibrate' again"
        raise CalibrationError(msg) from err
    if not whole:
        msg = f"{path}: was changed or cut; run 'bulkcal calibrate' again"
        raise CalibrationError(msg)
    return data


@contextlib.contextmanager
def of_this_version(path: Path) -> Iterator[None]:
    """Take a ``with`` block that reads entries of a whole record for one of another version.

    Parameters
    ----------
    path : Path
        The record, for the message.

    Raises
    ------
    CalibrationError
        Where an entry is not there, or is something else than it is today.
    """
    try:
        yield
    except (KeyError, TypeError, ValueError, AttributeError, IndexError) as err:
        what = f"no {err}" if isinstance(err, KeyError) else str(err)
        msg = (
            f"{path}: was written by another version of bulkcal ({what}); the command that made it "
            "makes it anew from the runs that are there"
        )
        raise CalibrationError(msg) from err


def kept_part(path: Path, study_sha256: str, *keys: str) -> dict[str, Any]:
    """Return entries of a record that is there and belongs to the same study file and data.

    Parameters
    ----------
    path : Path
    study_sha256 : str
        `StudyData.sha256`, which covers the data as well; records of earlier versions, whose
        digest covers less, belong to no study that reads tables.
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


def named_study(data: StudyData, path: Path) -> dict[str, Any]:
    """Return what a record says of the study that it is of, and of all files of that.

    Parameters
    ----------
    data : StudyData
    path : Path
        The record.
    """
    return {
        "study": data.study.name,
        "study_file": str(data.path),
        FROM_HERE: os.path.relpath(data.path.absolute(), path.absolute().parent),
        "study_sha256": data.sha256,
        FILES: dict(data.files),
    }


def outdated(path: Path, record: Mapping[str, Any]) -> str:
    """Return what to be told of a record whose study has changed since, or may have; else ''.

    Parameters
    ----------
    path : Path
        The record.
    record : mapping
        From `read_record`.

    Returns
    -------
    str
        Nothing as well where the study is not there, as in a directory that was sent to somebody.
    """
    if not {FROM_HERE, FILES} <= record.keys():
        return (
            f"{path}: was written by an earlier version, which did not note its data; whether they "
            "changed since is not known, 'bulkcal calibrate' makes it anew from the runs there"
        )
    study = path.absolute().parent / record[FROM_HERE]
    if not study.is_file():
        return ""
    home = study.resolve().parent
    changed = [
        name
        for name, digest in record[FILES].items()
        if _digest_of(study if name == study.name else home / name) != digest
    ]
    if not changed:
        return ""
    typed = Path(record["study_file"])
    called = typed if typed.exists() and typed.samefile(study) else os.path.normpath(study)
    words = (shell_word(called), "--out", shell_word(path.parent))
    return (
        f"{path}: is of other data than the study has now ({' and '.join(changed)} changed since); "
        f"make it anew with: bulkcal calibrate {' '.join(words)}"
    )


def _digest_of(path: Path) -> str:
    """Return the digest of a file or of the folder of an experiment; '' where it is gone."""
    try:
        if not path.is_dir():
            return sha256_file(path)
        from liggghts_io import read_experiment  # Jinja and more, which most studies do not need

        return read_experiment(path).digest
    except (OSError, CaseError):
        return ""


def hashed_record(record: Mapping[str, Any]) -> dict[str, Any]:
    """Return a record of plain data with its digest; `read_record` wants it."""
    return {**record, "sha256": sha256_text(canonical_json(record))}
