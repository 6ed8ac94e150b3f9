"""What a diagnosis is asked: measured numbers, free parameters, candidate causes.

Symbols: theta are the base parameters in their own units, `u` the same on [0, 1] over the
parameter's range (logarithmic for friction), `phi` the strength of a candidate effect.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np

from calibrate.arrays import Array
from calibrate.errors import CalibrationError
from calibrate.scales import Scale, forward
from liggghts_io import CaseResult, CaseSpec

Runner: TypeAlias = Callable[[Sequence[CaseSpec]], Sequence[CaseResult]]


@dataclass(frozen=True)
class Parameter:
    """A base parameter that the fit may move.

    Attributes
    ----------
    name : str
        Name as in a case's `parameters`, for example ``mu_pp``.
    lower, upper : float
        Range; a hard limit, and the width of the weak prior.
    start : float
        Where the search starts, usually the result of the staged calibration.
    logarithmic : bool
        Whether `u` is linear in the logarithm (friction) or in the value (restitution).
    """

    name: str
    lower: float
    upper: float
    start: float
    logarithmic: bool = False

    def __post_init__(self) -> None:
        """Refuse a start outside the range, where no surrogate could be centred."""
        if not self.lower <= self.start <= self.upper:
            msg = (
                f"parameter {self.name}: start {self.start} lies outside its range "
                f"{self.lower} to {self.upper}; widen the range or move the start"
            )
            raise CalibrationError(msg)

    def to_unit(self, value: float) -> float:
        """Map a value to [0, 1] over the range."""
        if self.logarithmic:
            return float(np.log(value / self.lower) / np.log(self.upper / self.lower))
        return (value - self.lower) / (self.upper - self.lower)

    def from_unit(self, u: float) -> float:
        """Map [0, 1] back to the parameter's own unit."""
        if self.logarithmic:
            return float(self.lower * (self.upper / self.lower) ** u)
        return self.lower + u * (self.upper - self.lower)


@dataclass(frozen=True)
class Observable:
    """A measured number and where the simulation shows the same quantity.

    Attributes
    ----------
    experiment : str
        Key of the experiment in `Problem.experiments`, for example ``heap_steel``.
    quantity : str
        Key in a case result's observables, for example ``angle_deg``.
    value, sem : float
        Measured mean and standard error of the mean, in the unit the quantity's name says.
    scale : {"none", "log", "sqrt"}
        Scale on which it is modelled and compared, see `calibrate.scales`.
    repeats : int
        Number of measurements behind `sem`; 0 where the error is known, not estimated.
    on_curve : bool
        Whether it is a point of a curve, whose points come from the same repeats and share their
        luck.
    """

    experiment: str
    quantity: str
    value: float
    sem: float
    scale: Scale
    repeats: int = 0
    on_curve: bool = False

    def __post_init__(self) -> None:
        """Refuse an error bar that cannot weigh anything, and a value off the scale."""
        if not (np.isfinite(self.value) and self.sem > 0.0 and np.isfinite(self.sem)):
            msg = (
                f"observable {self.name}: value {self.value} with standard error {self.sem}; "
                "give a finite value and a standard error above zero"
            )
            raise CalibrationError(msg)
        if not np.isfinite(forward(self.scale, np.array(self.value))):
            msg = (
                f"observable {self.name}: value {self.value:g} has no place on the scale "
                f"'{self.scale}'; choose another transform"
            )
            raise CalibrationError(msg)

    @property
    def name(self) -> str:
        """Name over all experiments, ``experiment.quantity``."""
        return f"{self.experiment}.{self.quantity}"


@dataclass(frozen=True)
class Candidate:
    """A cause that the library can switch on.

    Attributes
    ----------
    name : str
        Name in tables; an effect that may act in one experiment alone appears once for each.
    effect : str
        Name in a case's `effects`.
    step : float
        Strength of the probing runs, a typical physical size.
    lower, upper : float
        Physical limits of the strength; a one-sided effect has zero as one of them.
    experiments : tuple of str
        Experiments whose runs it changes.
    title : str
        One line for a reader.
    settled_by : str
        The independent measurement that would confirm or exclude it, empty if none is known.
    """

    name: str
    effect: str
    step: float
    lower: float
    upper: float
    experiments: tuple[str, ...]
    title: str = ""
    settled_by: str = ""

    @property
    def two_sided(self) -> bool:
        """Whether both signs are physically possible."""
        return self.lower < 0.0 < self.upper


@dataclass(frozen=True)
class Nuisance:
    """A declared error that several observables share, one standard deviation of it.

    Attributes
    ----------
    name : str
        What it is, for example a camera that is not level.
    shifts : mapping
        Observable name -> shift in the observable's unit for one standard deviation.
    """

    name: str
    shifts: Mapping[str, float]


@dataclass(frozen=True)
class Problem:
    """Everything a diagnosis needs besides a way to run cases.

    Attributes
    ----------
    parameters, observables, candidates : tuple
        See their classes.
    experiments : mapping
        Experiment key -> case description whose parameters, effects and seed are replaced.
    active : mapping
        Experiment key -> names of the parameters that matter there.
    nuisances : tuple of Nuisance
        Declared common errors.
    """

    parameters: tuple[Parameter, ...]
    observables: tuple[Observable, ...]
    experiments: Mapping[str, CaseSpec]
    active: Mapping[str, tuple[str, ...]]
    candidates: tuple[Candidate, ...]
    nuisances: tuple[Nuisance, ...] = field(default=())

    @property
    def start(self) -> Array:
        """Start of the search on [0, 1], shape (n_parameters,)."""
        return np.array([p.to_unit(p.start) for p in self.parameters])

    def unit(self, theta: Mapping[str, float]) -> Array:
        """Map parameter values to [0, 1], shape (n_parameters,)."""
        return np.array([p.to_unit(theta[p.name]) for p in self.parameters])

    def theta(self, u: Array) -> dict[str, float]:
        """Parameter values in their own units at `u`, shape (n_parameters,)."""
        return {p.name: p.from_unit(float(x)) for p, x in zip(self.parameters, u, strict=True)}

    def observed_in(self, experiment: str) -> tuple[Observable, ...]:
        """Observables of one experiment, in the order of `observables`."""
        return tuple(o for o in self.observables if o.experiment == experiment)

    def candidates_in(self, experiment: str) -> tuple[Candidate, ...]:
        """Candidates that change one experiment."""
        return tuple(c for c in self.candidates if experiment in c.experiments)

    def probes_in(self, experiment: str) -> tuple[Candidate, ...]:
        """One candidate for each effect that changes an experiment: what has to be run there.

        An effect that acts in both funnels and one that acts in this funnel alone are two
        candidates, but in this funnel they are one and the same run.
        """
        acting = self.candidates_in(experiment)
        return tuple({c.effect: c for c in acting}.values())

    def effects_in(self, experiment: str, strengths: Mapping[str, float]) -> dict[str, float]:
        """Effect strengths in one experiment for given candidate strengths."""
        on: dict[str, float] = {}
        for one in self.candidates_in(experiment):
            if strengths.get(one.name, 0.0) != 0.0:
                on[one.effect] = on.get(one.effect, 0.0) + strengths[one.name]
        return on

    def order(self) -> tuple[str, ...]:
        """Experiments that have data, in a fixed order."""
        seen = dict.fromkeys(o.experiment for o in self.observables)
        return tuple(seen)
