"""What these data can determine at all, and what no parameters can explain; before anything dear.

A few runs of every place show what responds to what. From the slopes of their emulators follows
how narrow each unknown can become (the Fisher information of all measurements and of the prior),
and from the emulators' whole span whether a measured value lies outside what any parameters give.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.inference.likelihood import log_likelihood
from calibrate.inference.problem import Problem
from calibrate.planning.points import spread
from calibrate.questions.words import undetermined_words
from calibrate.scales import backward
from calibrate.study.data import StudyData

__all__ = ["Identification", "Unreachable", "identify", "unreachable"]

PRIOR_DRAWS: Final = 2048
LIKELY: Final = 64
"""Of these draws the ones at which slopes are taken, by how well they agree with the data."""
TEMPERATURE: Final = 4.0
"""The likelihood's power is one over this: a pilot does not know where the answer lies."""
STEP: Final = 0.02
"""Of a unit range, for slopes."""
UNIT_SD: Final = 1.0 / np.sqrt(12.0)
"""Standard deviation of a flat prior on the unit range."""
VAGUE: Final = 0.75
"""Part of the prior's width above which the data say nothing of an unknown."""
TOO_FAR: Final = 3.0
"""Combined errors by which a value has to lie outside everything that the emulator knows."""


@dataclass(frozen=True)
class Unreachable:
    """A measured value that no parameters within their ranges explain.

    Attributes
    ----------
    name, label, unit : str
        Of the target.
    level : float
        Of a curve; nan for a number.
    measured, nearest : float
        The value, and the nearest one that the emulator gives anywhere.
    errors : float
        Their distance in combined errors of measurement and emulator.
    """

    name: str
    label: str
    unit: str
    level: float
    measured: float
    nearest: float
    errors: float

    @property
    def words(self) -> str:
        """Say how far it lies outside."""
        where = f" at {self.level:g}" if np.isfinite(self.level) else ""
        return (
            f"{self.label}{where}: measured {self.measured:.4g} {self.unit}, and the nearest that "
            f"any parameters within their ranges give is {self.nearest:.4g} {self.unit}, "
            f"{self.errors:.1f} combined errors away; widen the ranges, check the measurement or "
            "the apparatus, or add an effect"
        )


@dataclass(frozen=True)
class Identification:
    """What a study's data can determine.

    Attributes
    ----------
    widths : DataFrame
        A row per unknown: ``width``, the standard deviation that the data leave over that of the
        prior; ``target``, the measurement that says most of it.
    outside : tuple of Unreachable
    runs : int
        Runs behind the statement.
    sentences : tuple of str
        What is not determined, and what cannot be reached.
    """

    widths: pd.DataFrame
    outside: tuple[Unreachable, ...]
    runs: int
    sentences: tuple[str, ...]

    def table(self) -> pd.DataFrame:
        """Return `widths`."""
        return self.widths


def identify(
    data: StudyData, problem: Problem, runs: int, rng: np.random.Generator
) -> Identification:
    """Say what the data can determine.

    Parameters
    ----------
    data : StudyData
    problem : Problem
        With emulators of a pilot design, or better ones.
    runs : int
        Runs behind these emulators.
    rng : numpy Generator
    """
    values = problem.space.transform(spread(PRIOR_DRAWS, problem.space.size, rng))
    log_l = log_likelihood(problem, values) / TEMPERATURE
    weights = np.exp(log_l - log_l.max())
    likely = rng.choice(len(values), size=LIKELY, p=weights / weights.sum())
    widths = _widths(problem, values[likely])
    outside = unreachable(data, problem, values)
    vague = widths.index[widths["width"] > VAGUE]
    sentences = [undetermined_words(data.study, problem.space, str(name)) for name in vague]
    return Identification(widths, outside, runs, (*sentences, *(one.words for one in outside)))


def _widths(problem: Problem, values: Array) -> pd.DataFrame:
    """Return what the measurements leave of each unknown's prior width, averaged over draws."""
    space = problem.space
    units = space.units(values)
    informations: dict[str, Array] = {
        reading.name: np.zeros((len(values), space.size, space.size))
        for reading in problem.readings
    }
    for place in problem.places:
        slopes = np.zeros((len(values), place.predict(values[:1]).mean.shape[1], space.size))
        for k in place.indices:
            up, down = units.copy(), units.copy()
            up[:, k], down[:, k] = units[:, k] + STEP, units[:, k] - STEP
            if space.priors[k].bounded:
                up[:, k], down[:, k] = np.minimum(up[:, k], 1.0), np.maximum(down[:, k], 0.0)
            rise = place.predict(space.values_of(up)).mean
            rise = rise - place.predict(space.values_of(down)).mean
            slopes[:, :, k] = rise / (up[:, k] - down[:, k])[:, None]
        for reading in place.readings:
            j = slopes[:, reading.columns] / reading.se[:, None]
            for index, loading in reading.shared:
                j[:, :, index] = loading / reading.se
            informations[reading.name] += np.swapaxes(j, 1, 2) @ j
    own = np.diag([1.0 / _unit_sd(problem, k) ** 2 for k in range(space.size)])
    for known in problem.known:
        prior = space.priors[known.index]
        own[known.index, known.index] += ((prior.high - prior.low) / known.se) ** 2
    left = np.linalg.inv(own + sum(informations.values()))
    rows = []
    for k in space.asked:
        if k >= len(space.unknowns):
            continue
        width = float(np.median(np.sqrt(left[:, k, k]))) / _unit_sd(problem, k)
        says = {name: float(np.mean(one[:, k, k])) for name, one in informations.items()}
        best = max(says, key=says.__getitem__, default="")
        rows.append({"name": space.names[k], "width": width, "target": best})
    return pd.DataFrame(rows).set_index("name")


def _unit_sd(problem: Problem, column: int) -> float:
    """Return the standard deviation of a prior on the unit range."""
    return UNIT_SD if problem.space.priors[column].bounded else 1.0


def unreachable(data: StudyData, problem: Problem, values: Array) -> tuple[Unreachable, ...]:
    """Return the measured values that lie outside what the emulators give anywhere.

    Parameters
    ----------
    data : StudyData
    problem : Problem
    values : (n, K) float64
        Draws that fill the prior.
    """
    found = []
    for place in problem.places:
        expected = place.predict(values)
        for reading in place.readings:
            mean, total = expected.mean[:, reading.columns], expected.total[:, reading.columns]
            errors = np.abs(mean - reading.y) / np.sqrt(total + reading.se**2)
            same_side = np.abs(np.sign(mean - reading.y).sum(axis=0)) == len(values)
            least = np.where(same_side, errors.min(axis=0), 0.0)
            k = int(np.argmax(least))
            if least[k] <= TOO_FAR:
                continue
            target = data.study.target_named(reading.name)
            near = float(mean[np.argmin(errors[:, k]), k])
            levels = data.curves[target.name].levels if target.is_curve else (np.nan,)
            found.append(
                Unreachable(
                    target.name,
                    target.label,
                    target.simulated_unit,
                    float(levels[k]),
                    float(backward(target.model_scale, reading.y[k])),
                    float(backward(target.model_scale, np.array(near))),
                    float(least[k]),
                )
            )
    return tuple(found)
