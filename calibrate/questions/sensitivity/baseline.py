"""Around which values parameters are varied, one at a time, and between which."""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from calibrate.errors import CalibrationError, unknown_name
from calibrate.inference.priors import Spacing, from_unit
from calibrate.study.data import StudyData
from calibrate.study.model import Study
from calibrate.study.own_rigs import home_of
from calibrate.study.places import Place

__all__ = ["BASELINE", "ELASTIC", "Varied", "baseline_of", "read_baseline", "varied_at"]

BASELINE: Final = "baseline.csv"
"""Table beside a study that is taken where the command names none."""
_WRITTEN: Final = {
    "youngs_modulus": "youngs_modulus_pa",
    "poisson_ratio": "poisson_ratio",
    "density": "density_kg_m3",
}
"""Number of the grains as a table may call it, and as a study does."""
_UNITS: Final = {"youngs_modulus_pa": "Pa", "density_kg_m3": "kg/m3", "poisson_ratio": "-"}
LIMITS: Final = {"youngs_modulus_pa": (5e6, 1e9), "poisson_ratio": (0.0, 0.49)}
"""What both engines take."""
ELASTIC: Final = ("youngs_modulus_pa", "poisson_ratio")
"""Always varied: calibrations rest on it that they do not matter."""
STIFFER: Final = 10.0
"""Simulated grains are softer than real ones; the modulus is varied up to so many times."""
POISSON: Final = (0.1, 0.45)
"""From cork-like to nearly incompressible solids, as far as bulk solids are."""


@dataclass(frozen=True)
class Varied:
    """A parameter at a place, and how it is varied.

    Attributes
    ----------
    name, instance : str
    baseline : float
    low, high : float
    spacing : {"linear", "log"}
    """

    name: str
    instance: str
    baseline: float
    low: float
    high: float
    spacing: Spacing = "linear"

    def values(self, levels: int) -> tuple[float, ...]:
        """Return so many values over the range, and the baseline, rising, each once."""
        spread = from_unit(np.linspace(0.0, 1.0, levels), self.low, self.high, self.spacing)
        return tuple(sorted({float(f"{one:.6g}") for one in (*spread, self.baseline)}))


def read_baseline(path: Path, study: Study) -> dict[str, float]:
    """Read a table of baseline values.

    Parameters
    ----------
    path : Path
        CSV with the columns quantity, value and unit; lines that begin with ``#`` are comments.
        Quantities are parameters of the study, ``youngs_modulus`` [Pa], ``poisson_ratio`` and
        ``density`` [kg/m3].
    study : Study

    Raises
    ------
    CalibrationError
        With file, line, value and remedy.
    """
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as err:
        why = getattr(err, "strerror", None) or "not UTF-8"
        msg = f"{path}: cannot be read ({why}); give a CSV table with the head quantity,value,unit"
        raise CalibrationError(msg) from err
    rows = [(k, line) for k, line in enumerate(lines, 1) if line.strip() and line[0] != "#"]
    if not rows or [c.strip() for c in rows[0][1].split(",")] != ["quantity", "value", "unit"]:
        msg = f"{path}: needs the head quantity,value,unit"
        raise CalibrationError(msg)
    found: dict[str, float] = {}
    for number, line in rows[1:]:
        name, value = _row(f"{path}:{number}", line, study)
        if name in found:
            msg = f"{path}:{number}: '{name}' has a value above; remove one"
            raise CalibrationError(msg)
        found[name] = value
    return found


def _row(place: str, line: str, study: Study) -> tuple[str, float]:
    """Return name and value of a line of a table."""
    cells = [cell.strip() for cell in next(csv.reader([line]))]
    if len(cells) != len(("quantity", "value", "unit")):
        msg = f"{place}: {len(cells)} cells; write quantity,value,unit"
        raise CalibrationError(msg)
    quantity, text, unit = cells
    name = _WRITTEN.get(quantity, quantity)
    if not study.layout.knows(name):
        known = dict.fromkeys((*study.parameters, *_acting(study), *_WRITTEN))
        msg = f"{place}: {unknown_name(quantity, known)}"
        raise CalibrationError(msg)
    if unit != _UNITS.get(name, unit):
        msg = f"{place}: {quantity} in '{unit}'; give it in {_UNITS[name]}"
        raise CalibrationError(msg)
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        msg = f"{place}: {quantity} = '{text}' is not a number"
        raise CalibrationError(msg)
    low, high = LIMITS.get(name, (-math.inf, math.inf))
    if not low <= value <= high:
        msg = f"{place}: {quantity} = {value:g}; the engines take {low:g} to {high:g}"
        raise CalibrationError(msg)
    return name, value


def _acting(study: Study) -> list[str]:
    return [name for place in study.places for name in study.layout.acting(place)]


def baseline_of(data: StudyData, table: Path | None = None) -> dict[tuple[str, str], float]:
    """Return the baseline by name and instance.

    A value of the table comes first, then what the study gives as `value`, then the middle of the
    range. Numbers of the grains that are not varied stay what the study says.

    Parameters
    ----------
    data : StudyData
    table : Path, optional
        Without it, `BASELINE` beside the study, if it is there.

    Raises
    ------
    CalibrationError
        As `read_baseline`.
    """
    study = data.study
    beside = home_of(data.path) / BASELINE
    chosen = table or (beside if beside.is_file() else None)
    given = {} if chosen is None else read_baseline(chosen, study)
    found: dict[tuple[str, str], float] = {}
    for name in dict.fromkeys((*_acting(study), *study.parameters, *ELASTIC)):
        for place in study.places:
            instance = study.layout.instance(name, place)
            if instance is None or (name, instance) in found:
                continue
            value = given.get(name, study.value_of(name, *place))
            span = study.range_of(name, instance)
            if value is None and span is not None:
                value = float(from_unit(np.array(0.5), *span, _spacing(study, name, span)))
            if value is not None:
                found[name, instance] = value
    return found


def _spacing(study: Study, name: str, span: tuple[float, float]) -> Spacing:
    log = name in study.parameters and study.parameters[name].spacing == "log"
    return "log" if log and span[0] > 0.0 else "linear"


def varied_at(
    study: Study, place: Place, baseline: Mapping[tuple[str, str], float]
) -> list[Varied]:
    """Return what is varied at a place: all that is free there, and the elastic constants.

    Parameters
    ----------
    study : Study
    place : Place
    baseline : mapping
        From `baseline_of`.
    """
    found = []
    acting = study.layout.acting(place)
    names = [*acting, *(name for name in study.parameters if name not in acting)]
    for name in names:
        instance = study.layout.instance(name, place)
        span = None if instance is None else study.range_of(name, instance)
        if instance is not None and span is not None:
            middle = baseline[name, instance]
            found.append(Varied(name, instance, middle, *span, _spacing(study, name, span)))
    fixed = (name for name in ELASTIC if name not in {one.name for one in found})
    for name in fixed:
        instance = study.layout.instance(name, place) or ""
        value = baseline[name, instance]
        if name == "poisson_ratio":
            low, high = min(POISSON[0], value), max(POISSON[1], value)
            found.append(Varied(name, instance, value, low, high))
        else:
            top = min(STIFFER * value, LIMITS[name][1])
            found.append(Varied(name, instance, value, value, top, "log"))
    return [one for one in found if one.low < one.high]
