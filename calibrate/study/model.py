"""The study file: what was measured, what is free, in which stages.

A study is one TOML file beside its measured data (CSV). Everything in it is checked before the
first run: unknown keys, unknown names, limits, and that the data files lie in the study's own
directory, so that a file from a stranger cannot make the program read anything else.
"""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from calibrate.errors import CalibrationError
from calibrate.study.bulk import NAME_OR_DESCRIBE, NAMED_BULK, with_bulk
from calibrate.words import suggest
from liggghts_io.bulk import Bulk
from liggghts_io.case.spec import check_particle
from liggghts_io.errors import CaseError

__all__ = ["PARAMETERS", "Curve", "Stage", "Study", "Target", "load_study", "study_text"]

PARAMETERS = ("mu_pp", "mu_roll_pp", "mu_pw", "mu_roll_pw", "e_pp", "e_pw")
"""The contact parameters that a case knows: friction, rolling friction, restitution."""

Name = Annotated[str, Field(min_length=1, max_length=80, pattern=r"^[A-Za-z0-9_]+$")]
Bounds = tuple[float, float]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Target(_Strict):
    """One measured number and the simulated observable that answers to it.

    The row of the CSV file is the one whose ``particle`` and ``surface`` are those of the target.
    ``transform`` is the scale on which the surrogate works; ``sqrt`` suits collected masses, whose
    scatter grows with their size.
    """

    name: Name
    label: str
    experiment: Literal["heap", "conveyor", "plate_impact"]
    surface: Literal["steel", "alumina", "glued"]
    observable: Name
    unit: str
    file: str
    column: str
    sem_column: str
    transform: Literal["none", "log", "sqrt"] = "none"


class Curve(_Strict):
    """A measured mass-time curve, used by the diagnosis only."""

    name: Name
    label: str
    experiment: Literal["conveyor"]
    surface: Literal["steel", "alumina", "glued"]
    file: str
    time_column: str = "time_s"
    mass_column: str = "mass_g"
    sem_column: str = "sem_g"


class Known(_Strict):
    """An independent measurement of an effect's strength, with its standard error.

    A level on the plate or a period timed over many strokes: the diagnosis then considers only
    strengths that this measurement allows.
    """

    value: float = 0.0
    sem: Annotated[float, Field(gt=0.0)]


class Stage(_Strict):
    """Two parameters that are freed together and the targets that decide them.

    ``points`` is the size of the Latin hypercube, ``repeats`` how many of its points are run with
    a second seed (they measure the noise), ``infill`` how many points are added near the optimum.
    """

    name: Name
    title: str
    free: dict[str, Bounds]
    targets: Annotated[list[str], Field(min_length=2)]
    points: Annotated[int, Field(ge=8, le=2000)]
    repeats: Annotated[int, Field(ge=0)] = 4
    infill: Annotated[int, Field(ge=0, le=200)] = 0

    @model_validator(mode="after")
    def _check(self) -> Stage:
        if len(self.free) != 2:
            msg = f"stage '{self.name}' frees {len(self.free)} parameters; a stage frees exactly 2"
            raise ValueError(msg)
        for key, (low, high) in self.free.items():
            if not 0.0 <= low < high:
                msg = f"free.{key} = [{low}, {high}] is no range; give [low, high] with 0 <= low"
                raise ValueError(msg)
        if self.repeats > self.points:
            msg = f"repeats = {self.repeats} exceeds points = {self.points}"
            raise ValueError(msg)
        return self


class Study(_Strict):
    """A calibration study as read from its file.

    ``bulk`` describes the grains; a file may name a row of a table instead (``particle``).
    ``fixed`` holds parameters until a stage frees them; ``apparatus`` overrides apparatus
    parameters per experiment; ``effects`` switches on model extensions (name = strength);
    ``known`` holds independent measurements of effects for the diagnosis; ``published`` holds
    values to show beside the found ones, never used otherwise.
    """

    name: Name
    title: str
    bulk: Bulk
    scale: Literal["paper", "lab", "quick"]
    engine: Literal["minidem", "liggghts"] = "minidem"
    seed: Annotated[int, Field(ge=1)] = 1
    check_seeds: Annotated[int, Field(ge=2, le=50)] = 3
    fixed: dict[str, float] = Field(default_factory=dict)
    apparatus: dict[str, dict[str, float]] = Field(default_factory=dict)
    effects: dict[str, float] = Field(default_factory=dict)
    known: dict[str, Known] = Field(default_factory=dict)
    published: dict[str, float] = Field(default_factory=dict)
    target: Annotated[list[Target], Field(min_length=2)]
    curve: list[Curve] = Field(default_factory=list)
    stage: Annotated[list[Stage], Field(min_length=1)]

    @model_validator(mode="after")
    def _check(self) -> Study:
        names = [t.name for t in self.target]
        _distinct("target", names)
        _distinct("stage", [s.name for s in self.stage])
        for stage in self.stage:
            for word in stage.targets:
                _known(word, names, f"stage '{stage.name}': targets")
            for word in stage.free:
                _known(word, PARAMETERS, f"stage '{stage.name}': free")
        for table, words in (("fixed", self.fixed), ("published", self.published)):
            for word in words:
                _known(word, PARAMETERS, table)
        for word in self.apparatus:
            _known(word, ("heap", "conveyor", "plate_impact"), "apparatus")
        _distinct("freed parameter", [p for s in self.stage for p in s.free])
        self._check_complete()
        return self

    def _check_complete(self) -> None:
        for parameter in PARAMETERS:
            if parameter not in self.fixed and parameter not in self.stage[0].free:
                msg = (
                    f"'{parameter}' has no value before a stage frees it; "
                    f"add it under [fixed], for example {parameter} = 0.3"
                )
                raise ValueError(msg)

    @property
    def particle(self) -> str:
        """Name of the grains, which the measured tables give in the column ``particle``."""
        return self.bulk.name

    def target_named(self, name: str) -> Target:
        """Return the target called `name`; `name` is one that the study was checked for."""
        return next(t for t in self.target if t.name == name)


def _distinct(what: str, words: list[str]) -> None:
    for word in words:
        if words.count(word) > 1:
            msg = f"{what} '{word}' appears twice; give each its own name"
            raise ValueError(msg)


def _known(word: str, known: tuple[str, ...] | list[str], place: str) -> None:
    if word not in known:
        msg = f"{place}: unknown name '{word}'{suggest(word, known)}"
        raise ValueError(msg)


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
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as err:
        msg = (
            f"{path}: cannot be read as a study file ({_reason(err)}); give the path of a TOML file"
        )
        raise CalibrationError(msg) from err
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


def _reason(err: Exception) -> str:
    return str(getattr(err, "strerror", None) or err)


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


def study_text(study: Study, header: str = "") -> str:
    """Return `study` as TOML text that `load_study` reads back to an equal study.

    Parameters
    ----------
    study : Study
        Study to write.
    header : str
        Comment on top, without the comment signs.
    """
    data = study.model_dump(exclude_defaults=True)
    lines = [f"# {line}" for line in header.splitlines()]
    tables = ("bulk", "fixed", "effects", "published")
    lists = ("target", "curve", "stage")
    lines += [
        f"{k} = {_toml(v)}"
        for k, v in data.items()
        if k not in (*tables, *lists, "apparatus", "known")
    ]
    for key in tables:
        lines += _table(key, data.get(key, {}))
    for group in ("apparatus", "known"):
        for key, values in data.get(group, {}).items():
            lines += _table(f"{group}.{key}", values)
    for key in lists:
        for item in data.get(key, []):
            free = item.pop("free", {})
            lines += ["", f"[[{key}]]", *(f"{k} = {_toml(v)}" for k, v in item.items())]
            lines += _table(f"{key}.free", free)
    return "\n".join(lines) + "\n"


def _table(key: str, values: dict[str, object]) -> list[str]:
    return ["", f"[{key}]", *(f"{k} = {_toml(v)}" for k, v in values.items())] if values else []


def _toml(value: object) -> str:
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        return f'"{escaped}"'
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_toml(v) for v in value) + "]"
    return repr(value)
