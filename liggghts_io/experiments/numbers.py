"""Numbers of an experiment: those that describe its apparatus, and those and curves it gives."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from liggghts_io.errors import CaseError


@dataclass(frozen=True)
class Parameter:
    """One documented number of an apparatus with its value at each scale.

    Attributes
    ----------
    name, unit, meaning : str
        A name that ends in `_d` counts in Sauter diameters of the grain.
    quick, lab, paper : float
    limits : (float, float)
        Between which a case can be written and run; both are allowed.
    whole : bool
        Whether it counts something.
    source : str
        Where the value comes from: a paper, a bench, a choice and its reason; empty if nobody said.
    """

    name: str
    unit: str
    meaning: str
    quick: float
    lab: float
    paper: float
    limits: tuple[float, float] = (0.0, math.inf)
    whole: bool = False
    source: str = ""

    def check(self, value: float) -> None:
        """Refuse a value outside the limits.

        Raises
        ------
        CaseError
            With name, value, limits and meaning.
        """
        low, high = self.limits
        if not low <= value <= high or (self.whole and value != int(value)):
            kind = "a whole number" if self.whole else "a number"
            unit = "" if self.unit == "-" else f" {self.unit}"
            msg = (
                f"{self.name} = {value:g}{unit}: give {kind} from {low:g} to "
                f"{high:g}{unit} ({self.meaning})"
            )
            raise CaseError(msg)


def same(
    name: str,
    unit: str,
    meaning: str,
    value: float,
    limits: tuple[float, float] = (0.0, math.inf),
    *,
    whole: bool = False,
    source: str = "",
) -> Parameter:
    """Return a parameter with one value for all scales."""
    return Parameter(name, unit, meaning, value, value, value, limits, whole, source)


@dataclass(frozen=True)
class Observable:
    """A number that an experiment gives, simulated and measured alike.

    Attributes
    ----------
    name, unit, meaning : str
        The unit is that of the simulated value; measured ones are converted to it.
    low, high : float
        Between them lies every value that such a measurement can have.
    part_of : str
        Curve of the same experiment that holds this number too, empty if none does: whoever
        compares both would count it twice.
    """

    name: str
    unit: str
    meaning: str
    low: float = 0.0
    high: float = math.inf
    part_of: str = ""


@dataclass(frozen=True)
class Curve:
    """A curve that an experiment gives: one quantity at fixed levels of another.

    Attributes
    ----------
    name, meaning : str
    unit : str
        Of the quantity that is compared.
    x_name, x_unit : str
        Word and unit of what the levels are levels of.
    levels : tuple of float
        Rising; where the curve is compared when nobody asks for other levels.
    file : str
        Table of `Observed` that holds the curve.
    x_column, y_column : str
        Its columns.
    scale : str
        On which errors are alike along the curve: "linear", "log" or "sqrt".
    low, high : float
        Between them lies every value that such a measurement can have.
    """

    name: str
    unit: str
    meaning: str
    x_name: str
    x_unit: str
    levels: tuple[float, ...]
    file: str
    x_column: str
    y_column: str
    scale: Literal["linear", "log", "sqrt"] = "linear"
    low: float = 0.0
    high: float = math.inf


@dataclass(frozen=True)
class Adjustment:
    """An effect of a user's own experiment: one variable of its script is added to or scaled.

    Attributes
    ----------
    name, title, unit, meaning, settled_by : str
        As of any effect.
    variable : str
        Variable of the script.
    how : str
        "add": the strength is added; "scale": the variable is multiplied by 1 + strength.
    step : float
        Ordinary strength.
    low, high : float
        Allowed strengths.
    candidate : bool
        Whether the diagnosis tries it without being asked.
    settled_se, settled_hours : float
        As of any effect.
    """

    name: str
    title: str
    unit: str
    meaning: str
    settled_by: str
    variable: str
    how: str
    step: float
    low: float
    high: float
    candidate: bool = True
    settled_se: float = 0.0
    settled_hours: float = 1.0
