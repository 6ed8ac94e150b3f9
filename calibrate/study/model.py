"""The study file: what was measured, what is free, in which stages.

A study is one TOML file beside its measured data (CSV). Everything in it is checked before the
first run: keys, types, names and limits of single values here, what belongs together in `checks`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Annotated, Final

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    Strict,
    ValidationInfo,
    field_validator,
    model_validator,
)

from calibrate.errors import CalibrationError, unknown_name
from calibrate.scales import Scale, scale_of
from calibrate.study.units import factor
from liggghts_io.bulk import Bulk
from liggghts_io.case.runner import ENGINES
from liggghts_io.errors import CaseError
from liggghts_io.experiments import EXPERIMENTS, SCALES
from liggghts_io.materials import SURFACES

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
Words = Annotated[str, Field(min_length=1, max_length=200)]
Unit = Annotated[str, Field(min_length=1, max_length=20)]
File = Annotated[str, Field(min_length=1, max_length=1000)]
Bounds = Annotated[tuple[float, float], Strict(strict=False)]  # TOML has lists only


LARGEST_STUDY_SEED: Final = 2**30
"""Runs count their seeds from it, and stay below the largest that an engine takes."""


class _Strict(BaseModel):
    """A table of the study: no unknown keys, no text for numbers, no infinite numbers."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


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
    label: Words
    experiment: ExperimentName
    surface: SurfaceName
    observable: Name
    unit: Unit
    file: File
    column: Words
    sem_column: Words
    transform: Scale | None = None

    @field_validator("observable")
    @classmethod
    def _given(cls, word: str, info: ValidationInfo) -> str:
        """Refuse an observable that the experiment does not give."""
        experiment = info.data.get("experiment")
        if experiment is not None:
            try:
                EXPERIMENTS[experiment].observable(word)
            except CaseError as err:
                raise ValueError(str(err)) from err
        return word

    @field_validator("unit")
    @classmethod
    def _convertible(cls, word: str, info: ValidationInfo) -> str:
        """Refuse a unit that cannot be turned into that of the observable."""
        experiment, observable = info.data.get("experiment"), info.data.get("observable")
        if experiment is not None and observable is not None:
            try:
                factor(word, EXPERIMENTS[experiment].observable(observable).unit)
            except CalibrationError as err:
                raise ValueError(str(err)) from err
        return word

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
        CSV file with times [s], masses [g] and their standard errors [g]; a name that ends in
        another unit, such as ``time_ms``, has its values converted.
    """

    name: Name
    label: Words
    experiment: CurveExperiment
    surface: SurfaceName
    file: File
    time_column: Words = "time_s"
    mass_column: Words = "mass_g"
    sem_column: Words = "sem_g"


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
    title: Words
    free: dict[str, Bounds]
    targets: Annotated[list[str], Field(min_length=2)]
    points: Annotated[int, Field(ge=8, le=2000)]
    repeats: Annotated[int, Field(ge=0, le=2000)] = 4
    infill: Annotated[int, Field(ge=0, le=200)] = 0

    @model_validator(mode="after")
    def _check(self) -> Stage:
        if len(self.free) != 2:
            msg = f"stage '{self.name}' frees {len(self.free)} parameters; a stage frees exactly 2"
            raise ValueError(msg)
        for key, (low, high) in self.free.items():
            if not low < high:
                msg = f"free.{key} = [{low}, {high}] is no range; give [low, high] with low < high"
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
    title: Words
    bulk: Bulk
    scale: ScaleName
    engine: EngineName = "minidem"
    seed: Annotated[int, Field(ge=1, le=LARGEST_STUDY_SEED)] = 1
    check_seeds: Annotated[int, Field(ge=2, le=50)] = 3
    fixed: dict[str, float] = Field(default_factory=dict)
    apparatus: dict[str, dict[str, float]] = Field(default_factory=dict)
    effects: dict[str, float] = Field(default_factory=dict)
    known: dict[str, Known] = Field(default_factory=dict)
    published: dict[str, float] = Field(default_factory=dict)
    target: Annotated[list[Target], Field(min_length=2)]
    curve: list[Curve] = Field(default_factory=list)
    stage: Annotated[list[Stage], Field(min_length=1)]

    @property
    def particle(self) -> str:
        """Name of the grains, which the measured tables give in the column ``particle``."""
        return self.bulk.name

    def target_named(self, name: str) -> Target:
        """Return the target called `name`; `name` is one that the study was checked for."""
        return next(t for t in self.target if t.name == name)
