"""Read a study file and find the data files beside it.

Data files lie in the study's own directory, so that a file from a stranger cannot make the program
read anything else.
"""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

from pydantic import BaseModel, ValidationError

from calibrate.errors import CalibrationError, suggest
from calibrate.study.bulk import NAME_OR_DESCRIBE, NAMED_BULK, with_bulk
from calibrate.study.model import Curve, Known, Stage, Study, Target
from liggghts_io.bulk import Bulk
from liggghts_io.case.spec import check_particle
from liggghts_io.errors import CaseError

__all__ = ["data_file", "load_study", "parse_study", "read_study_file"]


def load_study(path: Path) -> Study:
    """Read and check a study file.

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
        With file, key, value and the nearest valid word when anything is wrong.
    """
    return parse_study(path, read_study_file(path))


def read_study_file(path: Path) -> bytes:
    """Return the bytes of a study file.

    Raises
    ------
    CalibrationError
        When there is no such file.
    """
    try:
        return path.read_bytes()
    except OSError as err:
        raise _unreadable(path, err) from err


def parse_study(path: Path, raw: bytes) -> Study:
    """Check the bytes of a study file, and that the data files it names are there.

    Parameters
    ----------
    path : Path
        Where the bytes come from.
    raw : bytes
        From `read_study_file`.

    Raises
    ------
    CalibrationError
        As `load_study`.
    """
    try:
        text = raw.decode("utf-8")
    except UnicodeDecodeError as err:
        raise _unreadable(path, err) from err
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as err:
        msg = f"{path}: not valid TOML: {err}"
        raise CalibrationError(msg) from err
    data = with_bulk(data, path, lambda name: data_file(path, name))
    try:
        study = Study.model_validate(data)
    except ValidationError as err:
        raise CalibrationError(_describe(path, text, err)) from err
    for file in [*(t.file for t in study.target), *(c.file for c in study.curve)]:
        data_file(path, file)
    _check_needs(path, study)
    return study


def _check_needs(path: Path, study: Study) -> None:
    """Refuse grains of which an experiment of the study needs more than is known."""
    places = [(t.name, t.experiment, t.surface) for t in study.target]
    places += [(c.name, c.experiment, c.surface) for c in study.curve]
    for name, experiment, surface in places:
        try:
            check_particle(study.bulk.particle, experiment, surface, study.effects)
        except CaseError as err:
            msg = f"{path}: '{name}': {err}"
            raise CalibrationError(msg) from err


def data_file(study_path: Path, name: str) -> Path:
    """Return the data file `name` of a study, which must lie in the study's directory.

    Raises
    ------
    CalibrationError
        When the file lies elsewhere (also through a link) or does not exist.
    """
    home = study_path.resolve().parent
    path = (home / name).resolve()
    if not path.is_relative_to(home):
        msg = f"{study_path}: file = '{name}' lies outside the study's directory; copy it to {home}"
        raise CalibrationError(msg)
    if not path.is_file():
        near = suggest(name, sorted(p.name for p in home.glob("*.csv")))
        msg = f"{study_path}: file = '{name}' does not exist in {home}{near}"
        raise CalibrationError(msg)
    return path


def _unreadable(path: Path, err: Exception) -> CalibrationError:
    reason = getattr(err, "strerror", None) or err
    return CalibrationError(
        f"{path}: cannot be read as a study file ({reason}); give the path of a TOML file"
    )


def _describe(path: Path, text: str, err: ValidationError) -> str:
    """Turn one of pydantic's findings into place, value and remedy; a misspelt key comes first."""
    findings = err.errors(include_url=False)
    found = min(findings, key=lambda f: f["type"] != "extra_forbidden")
    loc = tuple(found["loc"])
    place = ".".join(str(part) for part in loc)
    if found["type"] == "extra_forbidden":
        key = str(loc[-1])
        known = sorted([*_model_at(loc[:-1]).model_fields, *(NAMED_BULK if not loc[1:] else ())])
        near = suggest(key, known) or f"; known keys: {', '.join(known)}"
        return f"{path}{_line(text, key)}: unknown key '{place}'{near}"
    if found["type"] == "missing" and place == "bulk":
        return f"{path}: key 'particle' is missing; {NAME_OR_DESCRIBE}"
    if found["type"] == "missing":
        return f"{path}: key '{place}' is missing; add it"
    message = str(found["msg"]).removeprefix("Value error, ")
    value = "" if found["type"] == "value_error" else f" = {found['input']!r}"
    where = f" {place}{value}:" if place else ""
    return f"{path}:{where} {message}"


def _model_at(loc: tuple[int | str, ...]) -> type[BaseModel]:
    """Return the model that owns the keys at `loc`."""
    inner: dict[str, type[BaseModel]] = {
        "target": Target,
        "curve": Curve,
        "stage": Stage,
        "known": Known,
        "bulk": Bulk,
    }
    return inner.get(str(loc[0]), Study) if loc else Study


def _line(text: str, key: str) -> str:
    """Return ``:<line>`` where `key` is set, or nothing when that is not unique."""
    pattern = re.compile(rf"\s*(\[+)?\s*{re.escape(key)}\s*(=|\.|\])")
    lines = [i for i, line in enumerate(text.splitlines(), 1) if pattern.match(line)]
    return f":{lines[0]}" if len(lines) == 1 else ""
