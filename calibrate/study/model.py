"""The study file: what was measured, what is free, in which stages.

A study is one TOML file beside its measured data (CSV). Everything in it is checked before the
first run: unknown keys, unknown names and limits here, files in `load`.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from calibrate.errors import suggest
from calibrate.scales import Scale, scale_of

__all__ = ["PARAMETERS", "Curve", "Known", "Stage", "Study", "Target"]

PARAMETERS = ("mu_pp", "mu_roll_pp", "mu_pw", "mu_roll_pw", "e_pp", "e_pw")
"""The contact parameters that a case knows: friction, rolling friction, restitution."""

Name = Annotated[str, Field(min_length=1, max_length=80, pattern=r"^[A-Za-z0-9_]+$")]
Bounds = tuple[float, float]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Target(_Strict):
    """One measured number and the simulated observable that answers to it.

    The row of the CSV file is the one whose ``particle`` and ``surface`` are those of the target.
    ``transform`` is the scale on which the observable is modelled and compared (see `scales`);
    where the study does not say, the unit does.
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
    transform: Scale | None = None

    @property
    def scale(self) -> Scale:
        """Scale of the observable, for stages and diagnosis alike."""
        return self.transform or scale_of(self.unit)


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

    ``fixed`` holds parameters until a stage frees them; ``apparatus`` overrides apparatus
    parameters per experiment; ``effects`` switches on model extensions (name = strength);
    ``known`` holds independent measurements of effects for the diagnosis; ``published`` holds
    values to show beside the found ones, never used otherwise.
    """

    name: Name
    title: str
    particle: str
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
