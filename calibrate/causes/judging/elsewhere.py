"""Whether other parameters do what a cause does: not straight on from where they are, but anywhere.

A strong cause leaves room to go far. Restitution that falls with speed is, for the boxes of one
experiment, a smaller restitution coefficient; along the slopes at the true one it looks like
nothing that parameters can do.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.weighing.bench import whitened
from calibrate.emulator.types import Prediction
from calibrate.inference.likelihood import misfit
from calibrate.inference.problem import Problem, Reading

__all__ = ["Acting", "Imitation", "nearest_imitations"]

Acting: TypeAlias = Mapping[int, Mapping[int, float]]
"""Ordinary strengths of what acts, by place and column of the strengths (`candidates.acting`)."""

TRIED: Final = 256
"""Random parameter sets, of which the nearest are starts."""
ROUNDS: Final = 20
"""Steps of each start."""
STEP: Final = 1e-3
"""Of finite differences, on the unit range."""
DAMPED: Final = 1e-3
"""Damping at first."""
EASED: Final = 0.2
"""Its factor after a step that helps."""
HARDER: Final = 10.0
"""Its factor after one that does not."""


@dataclass(frozen=True)
class Imitation:
    """The parameters of the base model that come nearest to what a cause does.

    Attributes
    ----------
    distance : float
        What is left, in standard errors of measurement and emulator.
    parameters : (K,) float64
        Where they are.
    """

    distance: float
    parameters: Array


@dataclass(frozen=True, eq=False)
class _Aim:
    """What a reading is expected to be with each cause, (c, L), and what makes errors of it one.

    ``roots`` (c, L, L) turn differences into independent numbers of unit variance.
    """

    means: Array
    roots: Array


def nearest_imitations(
    problem: Problem,
    values: Array,
    acting: Sequence[Acting],
    rng: np.random.Generator,
    starts: int,
) -> list[Imitation]:
    """Return how near the base model comes to what each cause does, wherever parameters are.

    Of what the emulators expect: there is no luck in it, and no measured value. Parameters go
    anywhere in their ranges; one that was measured, or of which more than a range is believed,
    counts by how far it goes from where it is, in its standard errors.

    Parameters
    ----------
    problem : Problem
        The base model.
    values : (K,) float64
        Parameters at which the causes act.
    acting : sequence of mapping
        One for each cause, or for causes that act together.
    rng : numpy Generator
    starts : int
        Parameter sets from which each is looked for: `values`, and the nearest of random ones.
    """
    if not acting:
        return []
    space, count = problem.space, len(problem.space.unknowns)
    bounded = np.array([one.prior.bounded for one in space.unknowns])
    low, high = np.where(bounded, 0.0, -np.inf), np.where(bounded, 1.0, np.inf)
    whole = space.units(values[None])

    def at(units: Array) -> Array:
        rest = np.repeat(whole[:, count:], len(units), axis=0)
        return space.values_of(np.hstack([units, rest]))

    aims = _aims(problem, values, acting)
    whose = np.repeat(np.arange(len(acting)), starts)
    own = np.clip(whole[0, :count], low, high)
    tried = np.vstack([own, np.where(bounded, rng.uniform(size=(TRIED, count)), own)])
    told = _told(problem, values, at(tried))
    sizes = np.array([np.sum(_left(aims, told, k) ** 2, axis=1) for k in range(len(acting))])
    nearest = 1 + np.argsort(sizes[:, 1:], axis=1, kind="stable")[:, : starts - 1]
    begun = np.hstack([np.zeros((len(acting), 1), int), nearest])

    def left(units: Array) -> tuple[Array, Array]:
        """Return what is left (b, R), and its slopes (b, R, d)."""
        steps = np.where(units < 0.5, STEP, -STEP)
        moved = units[:, None, :] + steps[:, None, :] * np.eye(count)
        rows = at(np.concatenate([units[:, None, :], moved], axis=1).reshape(-1, count))
        rest = _left(aims, _told(problem, values, rows), np.repeat(whose, 1 + count))
        rest = rest.reshape(len(units), 1 + count, -1)
        slopes = (rest[:, 1:] - rest[:, :1]) / steps[:, :, None]
        return rest[:, 0], np.swapaxes(slopes, 1, 2)

    squares, units = _descended(left, tried[begun.ravel()], low, high)
    best = squares.reshape(len(acting), starts).argmin(axis=1) + starts * np.arange(len(acting))
    found = zip(np.sqrt(squares[best]), at(units[best]), strict=True)
    return [Imitation(float(distance), parameters) for distance, parameters in found]


def _descended(
    left: Callable[[Array], tuple[Array, Array]], units: Array, low: Array, high: Array
) -> tuple[Array, Array]:
    """Return least sums of squares (b,) and where they are (b, d): Levenberg and Marquardt.

    Many small problems at once, since a call of an emulator takes its time whatever it is asked.
    """
    damping = np.full(len(units), DAMPED)
    rest, slopes = left(units)
    size = np.sum(rest**2, axis=1)
    for _ in range(ROUNDS):
        downhill = np.einsum("bld,bl->bd", slopes, rest)
        # What stands at an end of its range and would go beyond it stays.
        stuck = ((units <= low) & (downhill > 0.0)) | ((units >= high) & (downhill < 0.0))
        held = np.where(stuck[:, None, :], 0.0, slopes)
        normal = np.einsum("bld,ble->bde", held, held)
        scale = np.einsum("bdd->bd", normal)
        extra = damping[:, None] * (scale + scale.max(axis=1, keepdims=True) * 1e-6 + 1e-12)
        normal += extra[:, :, None] * np.eye(units.shape[1])
        step = np.linalg.solve(normal, -np.where(stuck, 0.0, downhill)[:, :, None])[:, :, 0]
        new = np.clip(units + step, low, high)
        tried, steep = left(new)
        helps = np.sum(tried**2, axis=1) < size
        units = np.where(helps[:, None], new, units)
        rest = np.where(helps[:, None], tried, rest)
        slopes = np.where(helps[:, None, None], steep, slopes)
        size = np.sum(rest**2, axis=1)
        damping = damping * np.where(helps, EASED, HARDER)
    return size, units


def _told(problem: Problem, now: Array, values: Array) -> list[Array]:
    """Return what parameters (n, K) make of each reading, (n, L), and how far they go themselves.

    That is the last one, in standard errors of what is measured or believed of them.
    """
    known = [(one.index, one.se) for one in problem.known]
    believed = [
        (k, one.prior.sd)
        for k, one in enumerate(problem.space.unknowns)
        if one.prior.kind != "uniform"
    ]
    gone = [(values[:, k] - now[k]) / error for k, error in (*known, *believed)]
    found = []
    for place in problem.places:
        prediction = place.emulator.predict(place.inputs(values))
        found += [_expected(reading, prediction, values) for reading in place.readings]
    return [*found, np.array(gone).reshape(len(gone), len(values)).T]


def _left(aims: Sequence[_Aim], told: Sequence[Array], whose: Array | int) -> Array:
    """Return what is left of the cause that each row is held beside, (n, R)."""
    *readings, gone = told
    rest = [
        np.einsum("...kl,...l->...k", aim.roots[whose], one - aim.means[whose])
        for aim, one in zip(aims, readings, strict=True)
    ]
    return np.concatenate([*rest, gone], axis=1)


def _aims(problem: Problem, now: Array, acting: Sequence[Acting]) -> list[_Aim]:
    found = []
    for k, place in enumerate(problem.places):
        told = [place.emulator.predict(place.inputs(now[None], one.get(k, {}))) for one in acting]
        for reading in place.readings:
            own = [one.columns(reading.columns) for one in told]
            means = [_expected(reading, one, now[None]) for one in told]
            roots = [whitened(reading, one) for one in own]
            found.append(_Aim(np.concatenate(means), np.concatenate(roots)))
    return found


def _expected(reading: Reading, told: Prediction, values: Array) -> Array:
    """Return what a reading is expected to be, (n, L), with the errors that it shares."""
    return reading.y - misfit(reading, told, values)
