"""Simple methods beside which the diagnosis is scored.

All judge the bench straightened around one point, where everything measured is y = J z + what
causes add + errors of unit variance; see `calibrate.causes.judging.straight`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, Final, TypeAlias

import numpy as np
from scipy import special
from scipy.optimize import least_squares

from calibrate.arrays import Array
from calibrate.causes.candidates import Board
from calibrate.causes.judging.levels import Levels
from calibrate.causes.judging.probabilities import (
    PRIOR_NONE,
    PRIOR_PAIR,
    PRIOR_SINGLE,
    PRIOR_UNKNOWN,
)
from calibrate.causes.judging.straight import Straight, straight_at
from calibrate.causes.judging.verdict import smallest_set
from calibrate.causes.weighing.bases import best_mode
from calibrate.causes.weighing.tangent import tangent_at
from calibrate.inference.space import Space

__all__ = ["BASELINES", "ORACLE", "baseline", "coordinates"]

Record: TypeAlias = dict[str, Any]
SEED: Final = 11
STUDIES: Final = 1000
RIVAL: Final = 0.05
"""Chance of a lead over a rival from which it stays in the group."""
ORACLE: Final = "oracle"
"""Sees the true parameters."""


def baseline(name: str, board: Board, values: Mapping[str, float] | None = None) -> Record:
    """Return what a simple method says of a board.

    Parameters
    ----------
    name : str
    board : Board
    values : mapping, optional
        True parameters by key; only the oracle sees them.
    """
    return BASELINES[name](board, values or {})


def _record(kind: str, names: list[str], inclusion: Mapping[str, float], **more: Any) -> Record:
    return {
        "verdict": kind, "names": names, "none": 0.0, "unknown": 0.0, "where": {},
        "inclusion": {n: p for n, p in inclusion.items() if p > 1e-6}, "pairs": [],
        "strengths": {}, "gain": None, **more,
    }  # fmt: skip


def _prior(board: Board, _values: Mapping[str, float]) -> Record:
    """Say what is believed before any data."""
    count = len(board.candidates)
    each = (PRIOR_SINGLE + 2.0 * PRIOR_PAIR) / count
    inclusion = {one.name: each for one in board.candidates}
    return _record("none", [], inclusion, none=PRIOR_NONE, unknown=PRIOR_UNKNOWN)


def _bench(board: Board) -> tuple[Straight, Array]:
    """Return the bench around the best values of the base model, and y there."""
    mode = best_mode(board.problem, np.random.default_rng(SEED))
    tangent = tangent_at(board.problem, mode.z)
    return straight_at(board, tangent), tangent.left + tangent.slopes @ tangent.z


def _signature(board: Board, _values: Mapping[str, float]) -> Record:
    """Name the cause whose answer alone fits best, if chance seldom fits as well."""
    levels, rng = Levels(), np.random.default_rng(SEED)
    straight, y = _bench(board)
    here = _gains(straight, y[None])[0]
    chance = _gains(straight, straight.imagine(STUDIES, rng)).max(axis=1)
    best = int(np.argmax(here))
    found = np.mean(chance >= here[best]) < levels.chance
    # Half of the squared distance, less half a nat for the strength, as a log evidence ratio.
    p = special.softmax(np.concatenate([[0.0], here - 0.5]))
    inclusion = dict(zip(straight.names, map(float, p[1:]), strict=True))
    names = [straight.names[best]] if found else []
    return _record("named" if found else "none", names, inclusion, none=float(p[0]))


def _gains(straight: Straight, y: Array) -> Array:
    """Return half the squared distance that the best strength of each cause saves, (B, c)."""
    a = straight.answers
    size = np.maximum(straight.information, 1e-12)
    along = y @ straight.inverse @ a
    x = along / size
    for k, prior in enumerate(straight.priors):
        x[:, k] = np.clip(x[:, k], prior.low, prior.high)
    return np.asarray(x * along - 0.5 * x**2 * size)


def _rule_of_2026(board: Board, _values: Mapping[str, float]) -> Record:
    """Judge by the rule of commit 31a2ed1, on today's emulators.

    The best candidate must gain more than in 97 % of imagined studies without a cause; rivals stay
    in the group if, were they true, the best would lead by as much in more than 5 % of cases; a
    residual with p <= 0.05 is unknown, as is a misfit with p <= 0.01 that nothing explains.
    """
    levels, rng = Levels(), np.random.default_rng(SEED)
    straight, y = _bench(board)
    here = _gains(straight, y[None])[0]
    nulls = straight.imagine(STUDIES, rng)
    best = int(np.argmax(here))
    whole = _length(straight, nulls)
    if np.mean(_gains(straight, nulls).max(axis=1) >= here[best]) >= levels.chance:
        misfit = float(np.mean(whole >= _length(straight, y[None])[0]))
        return _record("unknown" if misfit <= levels.misfit else "none", [], {}, none=1.0)
    left = y - _fitted(straight, best, y)
    if np.mean(whole >= _length(straight, left[None])[0]) <= levels.explained:
        return _record("unknown", [], {}, unknown=1.0)
    group = [best]
    for k in np.argsort(-here)[1:]:
        x = np.full(STUDIES, _strength(straight, int(k), y))
        studies = straight.with_cause(int(k), x, rng)
        gains = _gains(straight, studies)
        if np.mean(gains[:, best] - gains[:, k] >= here[best] - here[k]) > RIVAL:
            group.append(int(k))
    names = [straight.names[k] for k in group]
    each = {name: 1.0 / len(names) for name in names}
    return _record("named" if len(names) == 1 else "set", names, each)


def _length(straight: Straight, y: Array) -> Array:
    return np.asarray(np.sum((y @ straight.inverse) ** 2, axis=1))


def _strength(straight: Straight, k: int, y: Array) -> float:
    size = max(float(straight.information[k]), 1e-12)
    x = float(y @ straight.inverse @ straight.answers[:, k]) / size
    return float(np.clip(x, straight.priors[k].low, straight.priors[k].high))


def _fitted(straight: Straight, k: int, y: Array) -> Array:
    return np.asarray(_strength(straight, k, y) * straight.answers[:, k])


def _oracle(board: Board, values: Mapping[str, float]) -> Record:
    """Know the parameters: only the cause and its strength are asked for."""
    space: Space = board.problem.space
    # Errors in common, such as the luck of a curve, stay unknown to the oracle as well.
    known = np.array([values.get(name, 0.0) for name in space.names])
    tangent = tangent_at(board.problem, coordinates(space, known))
    free = [k for k, name in enumerate(space.names) if name not in values]
    slopes = np.zeros_like(tangent.slopes)
    slopes[:, free] = tangent.slopes[:, free]
    straight = straight_at(board, replace(tangent, slopes=slopes))
    ratios = straight.log_ratios(tangent.left[None])[0]
    share = np.log(PRIOR_SINGLE / len(ratios))
    p = special.softmax(np.concatenate([[np.log(PRIOR_NONE)], ratios + share]))
    inclusion = dict(zip(straight.names, map(float, p[1:]), strict=True))
    ordered = dict(sorted(inclusion.items(), key=lambda one: -one[1]))
    best = next(iter(ordered))
    levels = Levels()
    if inclusion[best] > levels.name:
        return _record("named", [best], inclusion, none=float(p[0]))
    if p[0] < levels.other:
        alone: dict[tuple[str, ...], float] = {(name,): share for name, share in ordered.items()}
        names = list(smallest_set(alone, levels.credible))
        return _record("set", names, inclusion, none=float(p[0]))
    return _record("none", [], inclusion, none=float(p[0]))


def coordinates(space: Space, values: Array) -> Array:
    """Return the coordinates of values, (K,)."""
    wanted = space.units(values[None])[0]

    def away(z: Array) -> Array:
        return np.asarray(space.units(space.from_normal(z[None]))[0] - wanted)

    return np.asarray(least_squares(away, np.zeros(space.size)).x)


BASELINES: Final[dict[str, Callable[[Board, Mapping[str, float]], Record]]] = {
    "prior": _prior,
    "signature": _signature,
    "rule_31a2ed1": _rule_of_2026,
    ORACLE: _oracle,
}
"""By name."""
