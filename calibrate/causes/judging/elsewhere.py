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
from calibrate.emulator.types import Inputs, Prediction
from calibrate.inference.problem import Place, Problem

__all__ = ["Acting", "Imitation", "nearest_imitations"]

Acting: TypeAlias = Mapping[int, Mapping[int, float]]
"""Strengths of what acts, in ordinary ones, by place and column of the strengths."""

TRIED: Final = 256
"""Random parameter sets, of which the nearest are starts."""
ROUNDS: Final = 20
"""Steps of each start."""
STEP: Final = 1e-3
"""Of finite differences, on the unit range."""
DAMPED, EASED, HARDER = 1e-3, 0.2, 10.0
"""Damping at first, and its factors after a step that helps and one that does not."""


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
    """What the readings of one place are expected to be with each cause, (c, L), and roots.

    ``roots[k]`` turns differences (L,) into independent numbers of unit variance: ``d @ root``.
    """

    place: Place
    columns: Array
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

    Of what the emulators expect: there is no luck in it, and no measured value. Parameters with a
    range go anywhere in it; others, such as errors of instruments, count for what their prior makes
    of it, in standard deviations from where they are.

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
    space = problem.space
    free = range(len(space.unknowns))
    bounded = np.array([one.prior.bounded for one in space.unknowns])
    ends = np.where(bounded, 0.0, -np.inf), np.where(bounded, 1.0, np.inf)

    def at(units: Array) -> Array:
        rest = np.repeat(space.units(values[None])[:, len(free) :], len(units), axis=0)
        return space.values_of(np.hstack([units, rest]))

    aims = [_aim(place, values, [one.get(k, {}) for one in acting])
            for k, place in enumerate(problem.places)]  # fmt: skip
    own = np.clip(space.units(values[None])[0, free], *ends)
    other = rng.uniform(size=(TRIED, len(free)))
    tried = np.vstack([own, np.where(bounded, other, own)])
    whose = np.repeat(np.arange(len(acting)), starts)
    far = _sizes(aims, at(tried), len(acting))
    nearest = 1 + np.argsort(far[:, 1:], axis=1, kind="stable")[:, : starts - 1]
    begun = np.hstack([np.zeros((len(acting), 1), int), nearest])

    def left(units: Array) -> tuple[Array, Array]:
        rest, slopes = _left(aims, at, units, whose)
        held = np.where(bounded, 0.0, units - own)
        pull = np.repeat(np.diag(np.where(bounded, 0.0, 1.0))[None], len(units), axis=0)
        return np.hstack([rest, held]), np.concatenate([slopes, pull], axis=1)

    sizes, units = _descended(left, tried[begun.ravel()], *ends)
    best = sizes.reshape(len(acting), starts).argmin(axis=1) + starts * np.arange(len(acting))
    found = zip(np.sqrt(sizes[best]), at(units[best]), strict=True)
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


def _left(
    aims: Sequence[_Aim], at: Callable[[Array], Array], units: Array, whose: Array
) -> tuple[Array, Array]:
    """Return what is left of each cause (b, L), and its slopes (b, L, d)."""
    count, d = units.shape
    steps = np.where(units < 0.5, STEP, -STEP)
    moved = units[:, None, :] + steps[:, None, :] * np.eye(d)
    values = at(np.vstack([units, moved.reshape(count * d, d)]))
    rest, slopes = [], []
    for aim in aims:
        told = _told(aim.place, values, {}).mean[:, aim.columns]
        here, there = told[:count], told[count:].reshape(count, d, -1)
        roots = aim.roots[whose]
        rest.append(np.einsum("bl,blm->bm", here - aim.means[whose], roots))
        change = (there - here[:, None, :]) / steps[:, :, None]
        slopes.append(np.einsum("bdl,blm->bmd", change, roots))
    return np.concatenate(rest, axis=1), np.concatenate(slopes, axis=1)


def _sizes(aims: Sequence[_Aim], values: Array, count: int) -> Array:
    """Return the sums of squares that are left of each cause at each parameter set, (c, n)."""
    total = np.zeros((count, len(values)))
    for aim in aims:
        told = _told(aim.place, values, {}).mean[:, aim.columns]
        for k in range(count):
            total[k] += np.sum(((told - aim.means[k]) @ aim.roots[k]) ** 2, axis=1)
    return total


def _aim(place: Place, values: Array, acting: Sequence[Mapping[int, float]]) -> _Aim:
    columns = np.concatenate([np.arange(r.columns.start, r.columns.stop) for r in place.readings])
    means, roots = [], []
    for on in acting:
        told = _told(place, values[None], on)
        factors = told.factors[0][columns]
        covariance = np.diag(told.variance[0][columns]) + factors @ factors.T
        row = 0
        for reading in place.readings:
            mine = slice(row, row + len(reading.y))
            covariance[mine, mine] += reading.covariance
            if reading.extra is not None:
                covariance[mine, mine] += reading.extra @ reading.extra.T
            for _, loading in reading.shared:
                covariance[mine, mine] += np.outer(loading, loading)
            row = mine.stop
        means.append(told.mean[0][columns])
        roots.append(np.linalg.inv(np.linalg.cholesky(covariance)).T)
    return _Aim(place, columns, np.array(means), np.array(roots))


def _told(place: Place, values: Array, on: Mapping[int, float]) -> Prediction:
    """Return what the emulator of a place expects where some causes act."""
    known = place.inputs(values)
    strengths = known.strengths.copy()
    for column, x in on.items():
        strengths[:, column] = x
    return place.emulator.predict(Inputs(known.u, strengths, known.seeds))
