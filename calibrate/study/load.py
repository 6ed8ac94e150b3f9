"""Read a study file and find the data files beside it.

Data files lie in the study's own directory, so that a file from a stranger cannot make the program
read anything else. All mistakes are told at once, with their lines.
"""

from __future__ import annotations

import reprlib
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from pydantic import BaseModel, ValidationError

from calibrate.errors import CalibrationError, suggest
from calibrate.study.bulk import NAME_OR_DESCRIBE, NAMED_BULK, with_bulk
from calibrate.study.checks import check_cases, check_parts
from calibrate.study.draft import Draft, draft_of
from calibrate.study.mistakes import Key, Lines, Mistakes
from calibrate.study.model import Curve, Known, Stage, Study, Target
from calibrate.study.tables import bytes_of
from liggghts_io.bulk import Bulk

__all__ = ["Read", "data_file", "load_study", "read_study", "read_study_file"]

LARGEST_STUDY: Final = 1_000_000
"""Bytes of a study file; the bundled one has five thousand."""

_LONGEST_NAME: Final = 255  # of a file, on every file system in use


@dataclass(frozen=True)
class Read:
    """A study file as far as it could be understood.

    Attributes
    ----------
    path : Path
    draft : Draft
        Its valid parts.
    study : Study or None
        The whole, None where a key or value is wrong.
    mistakes : Mistakes
        What was found so far.
    """

    path: Path
    draft: Draft
    study: Study | None
    mistakes: Mistakes

    def whole(self) -> Study:
        """Return the study, after a look at the cases that it asks for.

        Raises
        ------
        StudyError
            With all mistakes.
        """
        if self.study is not None and not self.mistakes:
            check_cases(self.study, self.draft, self.mistakes)
        self.mistakes.tell()
        if self.study is None:
            msg = f"{self.path}: is no study; see cases/README.md"
            raise CalibrationError(msg)
        return self.study


def load_study(path: Path) -> Study:
    """Read and check a study file, but not the measured data.

    Parameters
    ----------
    path : Path
        TOML file.

    Returns
    -------
    Study

    Raises
    ------
    CalibrationError
        With file, line, key, value and the nearest valid word of everything that is wrong.
    """
    return read_study(path, read_study_file(path)).whole()


def read_study_file(path: Path) -> bytes:
    """Return the bytes of a study file.

    Raises
    ------
    CalibrationError
        When there is no such file, or it is too large for a study.
    """
    return bytes_of(path, LARGEST_STUDY, "a study file (TOML)")


def read_study(path: Path, raw: bytes) -> Read:
    """Read the bytes of a study file, and note what is wrong.

    Parameters
    ----------
    path : Path
        Where the bytes come from.
    raw : bytes
        From `read_study_file`.

    Raises
    ------
    CalibrationError
        When it is no TOML.
    """
    text = _text(path, raw)
    data = _toml(path, text)
    mistakes = Mistakes(path, Lines(text))
    without = {key: value for key, value in data.items() if key not in NAMED_BULK}
    described = None
    with mistakes.noting(("particle",)):
        described = with_bulk(data, lambda name: data_file(path, name))
    study = None
    try:
        study = Study.model_validate(without if described is None else described)
    except ValidationError as err:
        _note(err, mistakes, grains_told=described is None)
    draft = draft_of(without if described is None else described)
    check_parts(draft, mistakes)
    for kind, parts in (("target", draft.targets), ("curve", draft.curves)):
        for number, one in parts.items():
            with mistakes.noting((kind, number, "file")):
                data_file(path, one.file)
    return Read(path, draft, study, mistakes)


def data_file(study_path: Path, name: str) -> Path:
    """Return the data file `name` of a study, which must lie in the study's directory.

    Raises
    ------
    CalibrationError
        When the file lies elsewhere (also through a link) or does not exist.
    """
    shown = reprlib.repr(name)
    if "\0" in name or any(len(part) > _LONGEST_NAME for part in Path(name).parts):
        msg = f"file = {shown} is no name of a file; give that of a CSV file beside the study"
        raise CalibrationError(msg)
    try:
        home = study_path.resolve().parent
        path = (home / name).resolve()
        if not path.is_relative_to(home):
            msg = f"file = {shown} lies outside the study's directory; copy it to {home}"
            raise CalibrationError(msg)
        if path.is_file():
            return path
    except (OSError, RuntimeError, ValueError) as err:  # RuntimeError: a loop of links
        msg = f"file = {shown} cannot be found ({err}); put a CSV file beside the study"
        raise CalibrationError(msg) from err
    near = suggest(name, sorted(p.name for p in home.glob("*.csv")))
    missing = "is a directory, not a file, in" if path.is_dir() else "does not exist in"
    msg = f"file = {shown} {missing} {home}{near}"
    raise CalibrationError(msg)


def _text(path: Path, raw: bytes) -> str:
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError as err:
        line = raw.count(b"\n", 0, err.start) + 1
        msg = f"{path}:{line}: byte {raw[err.start]:#04x} is not UTF-8; save the study as UTF-8"
        raise CalibrationError(msg) from err


def _toml(path: Path, text: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except RecursionError as err:
        msg = f"{path}: not valid TOML: brackets are nested too deeply; a study needs two levels"
        raise CalibrationError(msg) from err
    except ValueError as err:  # TOMLDecodeError, or a number of thousands of digits
        msg = f"{path}: not valid TOML: {err}"
        raise CalibrationError(msg) from err


def _note(err: ValidationError, mistakes: Mistakes, *, grains_told: bool) -> None:
    """Turn what pydantic found into key, value and remedy."""
    findings = err.errors(include_url=False)
    meant = set()  # keys that are missing because they are misspelt
    for found in findings:
        loc = tuple(found["loc"])
        if found["type"] == "extra_forbidden":
            near = suggest(str(loc[-1]), _keys_at(loc[:-1]))
            meant |= {(*loc[:-1], key) for key in _keys_at(loc[:-1]) if f"'{key}'" in near}
    for found in findings:
        loc = tuple(found["loc"])
        if found["type"] == "missing" and (
            loc in meant
            or (loc == ("bulk",) and (grains_told or any((key,) in meant for key in NAMED_BULK)))
        ):
            continue
        mistakes.add(loc, _describe(found))


def _describe(found: Mapping[str, Any]) -> str:
    """Return one finding in words."""
    loc: Key = tuple(found["loc"])
    place = ".".join(str(part) for part in loc)
    if found["type"] == "extra_forbidden":
        known = _keys_at(loc[:-1])
        near = suggest(str(loc[-1]), known) or f"; known keys: {', '.join(known)}"
        return f"unknown key '{place}'{near}"
    if found["type"] == "missing" and place == "bulk":
        return f"key 'particle' is missing; {NAME_OR_DESCRIBE}"
    if found["type"] == "missing":
        return f"key '{place}' is missing; add it"
    message = str(found["msg"]).removeprefix("Value error, ")
    value = "" if found["type"] == "value_error" else f" = {reprlib.repr(found['input'])}"
    return f"{place}{value}: {message}" if place else message


def _keys_at(loc: Key) -> Sequence[str]:
    """Return the keys that are known at `loc`."""
    inner: dict[str, type[BaseModel]] = {
        "target": Target,
        "curve": Curve,
        "stage": Stage,
        "known": Known,
        "bulk": Bulk,
    }
    model = inner.get(str(loc[0]), Study) if loc else Study
    return sorted([*model.model_fields, *(() if loc else NAMED_BULK)])
