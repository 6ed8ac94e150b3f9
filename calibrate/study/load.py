"""Read a study file and find the data files beside it.

Data files lie in the study's own directory, so that a file from a stranger cannot make the program
read anything else. All mistakes are told at once, with their lines.
"""

from __future__ import annotations

import reprlib
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from pydantic import ValidationError

from calibrate.errors import CalibrationError, suggest
from calibrate.study.checks import check_parts, check_runs
from calibrate.study.draft import Draft, draft_of
from calibrate.study.filled import filled
from calibrate.study.measured.files import bytes_of
from calibrate.study.mistakes import Lines, Mistakes
from calibrate.study.model import Study
from calibrate.study.old_form import refuse_old
from calibrate.study.own_rigs import home_of, own_experiments
from calibrate.study.wording import note
from liggghts_io.experiments import EXPERIMENTS, own_experiment

__all__ = ["Read", "data_file", "load_study", "read_study", "read_study_file", "toml_in"]

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
    grains : mapping of str to Path
        Tables of grains that were read, by their names in the study.
    """

    path: Path
    draft: Draft
    study: Study | None
    mistakes: Mistakes
    grains: Mapping[str, Path]

    def whole(self) -> Study:
        """Return the study, after a look at the cases that it asks for.

        Raises
        ------
        StudyError
            With all mistakes.
        """
        if self.study is not None and not self.mistakes:
            check_runs(self.study, self.draft, self.mistakes)
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
        When it is no TOML, or a study of the first form.
    """
    text, data = toml_in(path, raw)
    refuse_old(path, text, data)
    mistakes = Mistakes(path, Lines(text))
    grains: dict[str, Path] = {}

    def located(name: str) -> Path:
        grains[name] = data_file(path, name)
        return grains[name]

    whole = filled(data, located, mistakes)
    told = bool(mistakes)
    own = own_experiments(whole, path, mistakes)
    experiments = EXPERIMENTS | {name: own_experiment(one) for name, one in own.items()}
    draft = draft_of(whole, experiments)
    study = None
    try:
        study = Study.model_validate(whole, context={"experiments": experiments, "own": own})
    except ValidationError as err:
        note(err, whole, mistakes, materials_told=told, unread=draft.unread)
    check_parts(draft, mistakes)
    for number, target in draft.targets.items():
        if target.file is not None:
            with mistakes.noting(("target", number, "file")):
                data_file(path, target.file)
    return Read(path, draft, study, mistakes, grains)


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
        home = home_of(study_path).resolve()
        path = (home / name).resolve()
        inside, there = path.is_relative_to(home), path.is_file()
    except (OSError, RuntimeError, ValueError) as err:  # RuntimeError: a loop of links
        msg = f"file = {shown} cannot be found ({err}); put a CSV file beside the study"
        raise CalibrationError(msg) from err
    if not inside:
        msg = f"file = {shown} lies outside the study's directory; copy it to {home}"
        raise CalibrationError(msg)
    if there:
        return path
    near = suggest(name, sorted(p.name for p in home.glob("*.csv")))
    missing = "is a directory, not a file, in" if path.is_dir() else "does not exist in"
    msg = f"file = {shown} {missing} {home}{near}"
    raise CalibrationError(msg)


def toml_in(path: Path, raw: bytes) -> tuple[str, dict[str, Any]]:
    """Return the text of a study file and the tables in it.

    Raises
    ------
    CalibrationError
        When it is no TOML in UTF-8.
    """
    try:
        text = raw.decode("utf-8-sig")  # an editor may begin it with a mark
    except UnicodeDecodeError as err:
        line = raw.count(b"\n", 0, err.start) + 1
        msg = f"{path}:{line}: byte {raw[err.start]:#04x} is not UTF-8; save the study as UTF-8"
        raise CalibrationError(msg) from err
    try:
        return text, tomllib.loads(text)
    except RecursionError as err:
        msg = f"{path}: not valid TOML: brackets are nested too deeply; a study needs two levels"
        raise CalibrationError(msg) from err
    except ValueError as err:  # TOMLDecodeError, or a number of thousands of digits
        msg = f"{path}: not valid TOML: {err}; a study file is TOML, 'bulkcal init' writes one"
        raise CalibrationError(msg) from err
