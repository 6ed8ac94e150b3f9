"""Curves that experiments give, as a study knows them: y at fixed levels of x.

The one place that says which experiment has which curve.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from liggghts_io.experiments import Experiment

__all__ = ["MASS_TIME", "CurveKind", "curve_named", "curves_of"]


@dataclass(frozen=True)
class CurveKind:
    """A curve of an experiment.

    Attributes
    ----------
    name, unit, meaning : str
        What is compared, y, and its unit.
    x_name, x_unit : str
        At levels of what, and its unit.
    levels : tuple of float
        Where it is compared unless a study says otherwise [x_unit].
    """

    name: str
    unit: str
    meaning: str
    x_name: str
    x_unit: str
    levels: tuple[float, ...]


MASS_TIME: Final = CurveKind(
    name="mass_time",
    unit="s",
    meaning="time until a mass lies on the scale",
    x_name="mass",
    x_unit="g",
    levels=(25.0, 50.0, 75.0, 100.0),
)


def curves_of(experiment: Experiment) -> tuple[CurveKind, ...]:
    """Return the curves of an experiment."""
    return (MASS_TIME,) if experiment.curve else ()


def curve_named(experiment: Experiment, name: str) -> CurveKind | None:
    """Return a curve of an experiment, None where it has none of that name."""
    return next((one for one in curves_of(experiment) if one.name == name), None)
