"""What was measured: a number or a curve, where, and which simulated observable answers to it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field, PrivateAttr, ValidationInfo, field_validator, model_validator

from calibrate.errors import CalibrationError, unknown_name
from calibrate.scales import Scale, scale_of
from calibrate.study.schema.words import File, Label, Name, Table, Unit, Words, also_named
from calibrate.study.units import factor
from liggghts_io import OwnExperiment
from liggghts_io.experiments import EXPERIMENTS, Curve, Experiment, Observable

__all__ = ["Target", "experiments_in", "own_in"]

_FROM_FILE = ("column", "se_column", "x_column", "columns", "levels")


def experiments_in(info: ValidationInfo) -> Mapping[str, Experiment]:
    """Return the experiments that a study may name: those handed on, or the built-in ones."""
    context: Mapping[str, Mapping[str, Experiment]] = info.context or {}
    return context.get("experiments", EXPERIMENTS)


def own_in(info: ValidationInfo) -> Mapping[str, OwnExperiment]:
    """Return the study's own experiments: those handed on, or none."""
    context: Mapping[str, Mapping[str, OwnExperiment]] = info.context or {}
    return context.get("own", {})


class Target(Table):
    """One measured number or curve.

    Attributes
    ----------
    name, label : str
        Short name, without it that of the observable, and words for a reader; without them the
        name.
    material, surface, experiment : str
        Where it was measured. A file may leave out material or surface where there is one only.
    observable : str
        Name of the simulated value or curve.
    unit : str, optional
        Unit of the measured value and its error; they are converted to that of the simulated
        one, which must be of the same dimension. A number needs one; columns of a curve may say
        theirs in their names.
    scale : {"linear", "log", "sqrt"}, optional
        Scale on which it is modelled and compared, see `calibrate.scales`; where the study does
        not say, the unit does.
    value, se : float, optional
        Measured value and its standard error, given in the study itself.
    repeats : int, optional
        Measurements behind the standard error; 0 where nobody says.
    file, column, se_column : str, optional
        CSV file with the value and its standard error; without `se_column` its rows are repeats.
    x_column, columns : str, list of str, optional
        Of a curve: against what, and instead of `column` one column per repeat.
    levels : list of float, optional
        Of a curve: where it is compared, in the unit of its x.
    """

    name: Name
    label: Words
    material: Label
    surface: Label
    experiment: Name
    observable: Name
    unit: Unit | None = None
    scale: Literal["linear", "log", "sqrt"] | None = None
    value: float | None = None
    se: float | None = None
    repeats: Annotated[int, Field(ge=0, le=10**9)] | None = None
    file: File | None = None
    column: Words | None = None
    se_column: Words | None = None
    x_column: Words | None = None
    columns: list[Words] = Field(default_factory=list)
    levels: Annotated[list[float], Field(max_length=100)] = Field(default_factory=list)
    _kind: Observable | Curve = PrivateAttr()

    @model_validator(mode="before")
    @classmethod
    def _labelled(cls, data: Any) -> Any:
        return also_named(also_named(data, "name", "observable"), "label", "name")

    @field_validator("experiment")
    @classmethod
    def _known(cls, word: str, info: ValidationInfo) -> str:
        known = experiments_in(info)
        if word not in known:
            raise ValueError(unknown_name(word, known))
        return word

    @field_validator("observable")
    @classmethod
    def _given(cls, word: str, info: ValidationInfo) -> str:
        """Refuse an observable that the experiment does not give."""
        if "experiment" in info.data:
            _observable(experiments_in(info)[info.data["experiment"]], word)
        return word

    @field_validator("unit")
    @classmethod
    def _convertible(cls, word: str | None, info: ValidationInfo) -> str | None:
        """Refuse a unit that cannot be turned into that of the observable."""
        if word is not None and {"experiment", "observable"} <= info.data.keys():
            experiment = experiments_in(info)[info.data["experiment"]]
            try:
                factor(word, _observable(experiment, info.data["observable"]).unit)
            except CalibrationError as err:
                raise ValueError(str(err)) from err
        return word

    @model_validator(mode="after")
    def _check(self, info: ValidationInfo) -> Target:
        self._kind = _observable(experiments_in(info)[self.experiment], self.observable)
        wrong = _curve_form(self) if self.is_curve else _number_form(self)
        if wrong:
            msg = f"target '{self.name}': {wrong}"
            raise ValueError(msg)
        return self

    @property
    def curve(self) -> Curve | None:
        """The curve that was measured, None for a number."""
        return self._kind if isinstance(self._kind, Curve) else None

    @property
    def is_curve(self) -> bool:
        """Whether it is a curve, not a number."""
        return self.curve is not None

    @property
    def observed(self) -> Observable:
        """The simulated number that answers to it; not for a curve."""
        if isinstance(self._kind, Curve):
            msg = f"target '{self.name}' is a curve; only a number is asked for here"
            raise CalibrationError(msg)
        return self._kind

    @property
    def simulated_unit(self) -> str:
        """Unit of the simulated value, in which both are compared and shown."""
        return self._kind.unit

    @property
    def model_scale(self) -> Scale:
        """Scale of the observable, for all methods alike."""
        if self.scale is not None:
            return self.scale
        return scale_of(self.simulated_unit) if self.curve is None else self.curve.scale


def _observable(experiment: Experiment, word: str) -> Observable | Curve:
    """Return the observable or curve of that name.

    Raises
    ------
    ValueError
        With the nearest name.
    """
    known: dict[str, Observable | Curve] = {one.name: one for one in experiment.observables}
    known |= {one.name: one for one in experiment.curves}
    if word not in known:
        msg = unknown_name(word, known).replace("unknown name", "unknown observable")
        msg = f"{experiment.name}: {msg}"
        raise ValueError(msg)
    return known[word]


def _number_form(target: Target) -> str:
    """Return what is wrong with how a measured number is given; empty if nothing is."""
    if target.unit is None:
        return f'unit is missing; add unit = "{target.simulated_unit}" or another unit of it'
    if (target.value is None) == (target.file is None):
        return "give value and se right here, or file and column; one of the two"
    if target.value is not None:
        extra = next((key for key in _FROM_FILE if getattr(target, key)), "")
        if extra:
            return f"{extra} belongs to a file, and value = {target.value:g} is given right here"
        return "" if target.se is not None else "se is missing; add the standard error of the value"
    if target.se is not None:
        return "se stands beside value only; name the column of the file with se_column"
    if target.column is None:
        return "column is missing; name the column of the file that holds the value"
    curve = next((key for key in ("x_column", "columns", "levels") if getattr(target, key)), "")
    return f"{curve} is for curves, and {target.observable} is a number" if curve else ""


def _curve_form(target: Target) -> str:
    """Return what is wrong with how a measured curve is given; empty if nothing is."""
    if target.file is None or target.x_column is None:
        return f"{target.observable} is a curve; give file, x_column and column (or columns)"
    if target.value is not None or target.se is not None:
        return f"{target.observable} is a curve; its values and errors stand in its file"
    if (target.column is None) == (not target.columns):
        return "give column, or columns with one repeat each; one of the two"
    if target.column is not None and target.se_column is None:
        return "se_column is missing; name it, or give columns with one repeat each"
    if target.columns and target.se_column is not None:
        return "columns are repeats and tell the error; leave se_column out"
    if target.columns and len(set(target.columns)) < 2:
        return "columns: two repeats are the fewest that tell an error"
    if any(b <= a for a, b in zip(target.levels, target.levels[1:], strict=False)):
        return f"levels = {target.levels} must rise"
    return ""
