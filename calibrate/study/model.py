"""The study file: what was measured, what is free, in which stages.

A study is one TOML file beside its measured data (CSV). Everything in it is checked before the
first run: unknown keys, unknown names and limits here, files in `load`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator

from calibrate.errors import unknown_name
from calibrate.scales import Scale, scale_of
from liggghts_io.bulk import Bulk
from liggghts_io.case.runner import ENGINES
from liggghts_io.effects import EFFECTS
from liggghts_io.experiments import EXPERIMENTS, SCALES
from liggghts_io.materials import CONTACT_PARAMETERS, SURFACES

__all__ = ["Curve", "Known", "Stage", "Study", "Target"]


def _one_of(known: Callable[[], Iterable[str]]) -> AfterValidator:
    """Accept a name of a registry, read when it is needed; else say the nearest one."""

    def check(word: str) -> str:
        names = list(known())
        if word not in names:
            raise ValueError(unknown_name(word, names))
        return word

    return AfterValidator(check)


def _with_curve() -> list[str]:
    return [name for name, one in EXPERIMENTS.items() if one.curve]


ExperimentName = Annotated[str, _one_of(lambda: EXPERIMENTS)]
CurveExperiment = Annotated[str, _one_of(_with_curve)]
SurfaceName = Annotated[str, _one_of(lambda: SURFACES)]
ScaleName = Annotated[str, _one_of(lambda: SCALES)]
EngineName = Annotated[str, _one_of(lambda: ENGINES)]
Name = Annotated[str, Field(min_length=1, max_length=80, pattern=r"^[A-Za-z0-9_]+$")]
Bounds = tuple[float, float]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Target(_Strict):
    """One measured number and the simulated observable that answers to it.

    The row of the CSV file is the one whose ``particle`` and ``surface`` are those of the target.

    Attributes
    ----------
    name, label : str
        Short name, and words for a reader.
    experiment, surface : str
        Where it was measured.
    observable : str
        Name of the simulated value.
    unit : str
        Unit of the measured value and its error; they are converted to that of the simulated
        one, which must be of the same dimension.
    file, column, sem_column : str
        CSV file with the measured value and its standard error.
    transform : {"none", "log", "sqrt"}, optional
        Scale on which it is modelled and compared, see `calibrate.scales`; where the study does
        not say, the unit does.
    """

    name: Name
    label: str
    experiment: ExperimentName
    surface: SurfaceName
    observable: Name
    unit: str
    file: str
    column: str
    sem_column: str
    transform: Scale | None = None

    @property
    def scale(self) -> Scale:
        """Scale of the observable, for stages and diagnosis alike."""
        return self.transform or scale_of(self.simulated_unit)

    @property
    def simulated_unit(self) -> str:
        """Unit of the simulated value, in which both are compared and shown."""
        return EXPERIMENTS[self.experiment].observable(self.observable).unit


class Curve(_Strict):
    """A measured mass-time curve, used by the diagnosis only.

    Attributes
    ----------
    name, label : str
        Short name, and words for a reader.
    experiment, surface : str
        Where it was measured; the experiment is one that simulates a curve.
    file, time_column, mass_column, sem_column : str
        CSV file with times [s], masses [g] and their standard errors [g].
    """

    name: Name
    label: str
    experiment: CurveExperiment
    surface: SurfaceName
    file: str
    time_column: str = "time_s"
    mass_column: str = "mass_g"
    sem_column: str = "sem_g"


class Known(_Strict):
    """An independent measurement of an effect's strength, with its standard error.

    A level on the plate or a period timed over many strokes: the diagnosis then considers only
    strengths that this measurement allows.

    Attributes
    ----------
    value, sem : float
        In the effect's unit.
    """

    value: float = 0.0
    sem: Annotated[float, Field(gt=0.0)]


class Stage(_Strict):
    """Two parameters that are freed together and the targets that decide them.

    Attributes
    ----------
    name, title : str
        Short name, and words for a reader.
    free : dict of str to (float, float)
        Range of each of the two parameters.
    targets : list of str
        Names of the targets.
    points : int
        Size of the Latin hypercube.
    repeats : int
        How many of its points are run with a second seed; they measure the noise.
    infill : int
        How many points are added near the optimum.
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

    Attributes
    ----------
    name, title : str
        Short name, and words for a reader.
    bulk : Bulk
        The grains; a file may name a row of a table instead (``particle``).
    scale, engine : str
        Size of the simulated experiments, and the program that runs them.
    seed : int
        First seed of the runs, and seed of every draw.
    check_seeds : int
        Runs per experiment of the final check.
    fixed : dict of str to float
        Contact parameters until a stage frees them.
    apparatus : dict of str to dict of str to float
        Overrides of apparatus parameters by experiment.
    effects : dict of str to float
        Model extensions that are switched on, with their strength.
    known : dict of str to Known
        Independent measurements of effects, for the diagnosis.
    published : dict of str to float
        Values to show beside the found ones, never used otherwise.
    target : list of Target
    curve : list of Curve
    stage : list of Stage
        In the order in which they run.
    """

    name: Name
    title: str
    bulk: Bulk
    scale: ScaleName
    engine: EngineName = "minidem"
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
                _known(word, CONTACT_PARAMETERS, f"stage '{stage.name}': free")
        for table, registry in (
            ("fixed", CONTACT_PARAMETERS),
            ("published", CONTACT_PARAMETERS),
            ("apparatus", EXPERIMENTS),
            ("effects", EFFECTS),
            ("known", EFFECTS),
        ):
            for word in getattr(self, table):
                _known(word, registry, table)
        _distinct("freed parameter", [p for s in self.stage for p in s.free])
        self._check_complete()
        return self

    def _check_complete(self) -> None:
        for parameter in CONTACT_PARAMETERS:
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


def _known(word: str, known: Collection[str], place: str) -> None:
    if word not in known:
        msg = f"{place}: {unknown_name(word, known)}"
        raise ValueError(msg)
