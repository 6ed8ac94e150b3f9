"""What is hidden in each study of a suite, and how strong it is."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any, Final

import numpy as np
from scipy.optimize import brentq

from calibrate.arrays import Array
from calibrate.causes.candidates import Board, Candidate
from calibrate.causes.judging.straight import Straight, straight_at
from calibrate.causes.weighing.tangent import tangent_at
from calibrate.challenge.foreign import FOREIGN
from calibrate.challenge.imitation import distances, strength_at
from calibrate.challenge.rules import Rules, rng_of
from calibrate.inference.priors import to_unit

__all__ = ["Hidden", "Truth", "draw_truth"]

TRIES: Final = 200
"""Parameter sets that are tried for one at which a cause can be as strong as asked."""
USUAL: Final = 2.5
"""Ordinary strength at which the other cause of a pair is looked at."""
INSIDE: Final = 0.02
"""Part of every range that truths keep away from its ends."""
NUMERICS: Final = ("time_step", "width", "side_wall")


@dataclass(frozen=True)
class Hidden:
    """A cause that acts in a study.

    Attributes
    ----------
    name : str
        Candidate, or kind of `FOREIGN`.
    strength : float
        In the cause's unit.
    noncentrality : float
        What it does, in standard errors, that neither the parameters nor the other cause of a pair
        can imitate; nan for foreign ones.
    """

    name: str
    strength: float
    noncentrality: float = float("nan")


@dataclass(frozen=True)
class Truth:
    """What is true of a study.

    Attributes
    ----------
    number : int
    kind : str
    values : dict of str to float
        Parameters by key.
    hidden : tuple of Hidden
    numerics : str
        What differs in how the runs are made; empty for nothing.
    engine : str
    from_prior : bool
        Whether strengths were drawn from the stated prior.
    fresh : bool
        Whether the experiments are made once more, to see what a cause really gains.
    """

    number: int
    kind: str
    values: dict[str, float]
    hidden: tuple[Hidden, ...] = ()
    numerics: str = ""
    engine: str = "minidem"
    from_prior: bool = False
    fresh: bool = False

    def plain(self) -> dict[str, Any]:
        """Return it as plain data."""
        return asdict(self)

    @classmethod
    def of_plain(cls, record: Mapping[str, Any]) -> Truth:
        """Return a truth from plain data, with or without a salt."""
        told = {one.name: record[one.name] for one in fields(cls)}
        return cls(**{**told, "hidden": tuple(Hidden(**one) for one in told["hidden"])})


def draw_truth(rules: Rules, kind: str, number: int, seed: str, board: Board) -> Truth:
    """Return what is hidden in one study.

    Parameters
    ----------
    rules : Rules
    kind : str
    number : int
    seed : str
        Text that seeds the suite.
    board : Board
        Of the suite's study; its measured values do not matter, their errors do.
    """
    rng = rng_of(seed, number)
    numerics = str(rng.choice(NUMERICS)) if rng.random() < rules.other_numerics else ""
    liggghts = bool(rng.random() < rules.liggghts)
    from_prior = bool(rng.random() < rules.from_prior)
    fresh = bool(rng.random() < rules.fresh)
    wanted = rules.noncentrality[int(rng.integers(len(rules.noncentrality)))]
    for _ in range(TRIES):
        z, values = _inside(board, rng)
        if kind == "nothing":
            return Truth(number, kind, values, (), numerics, _engine(liggghts))
        if kind == "foreign":
            one = FOREIGN[str(rng.choice(sorted(FOREIGN)))]
            strength = float(rng.uniform(one.low, one.high))
            hidden: tuple[Hidden, ...] = (Hidden(one.name, strength),)
            return Truth(number, kind, values, hidden, numerics, _engine(liggghts))
        straight = straight_at(board, tangent_at(board.problem, z))
        chosen = _causes(board, straight, 2 if kind == "pair" else 1, wanted, rng, prior=from_prior)
        if rules.imitation == "anywhere":
            row = board.problem.space.from_normal(z[None])[0]
            chosen = _unlike_any(board, row, chosen, wanted, rng, prior=from_prior)
        if chosen:
            hidden = tuple(Hidden(c.name, _rounded(x * c.scale), strong) for c, x, strong in chosen)
            native = all(_native(c) for c, *_ in chosen)
            engine = _engine(liggghts and native)
            return Truth(number, kind, values, hidden, numerics, engine, from_prior, fresh)
    msg = f"study {number}: no cause can be {wanted:g} errors strong in {TRIES} draws"
    raise RuntimeError(msg)


def _rounded(strength: float) -> float:
    """Return a strength as it would be written down.

    Emulators are fitted to the tenth digit or so, on another machine to other ones: a suite drawn
    again there would find none of its runs.
    """
    return float(f"{strength:.5g}")


def _engine(liggghts: bool) -> str:
    return "liggghts" if liggghts else "minidem"


def _native(candidate: Candidate) -> bool:
    from liggghts_io.effects import EFFECTS  # late: the table of plug-ins is read on import

    return not EFFECTS[candidate.effect].extension


def _inside(board: Board, rng: np.random.Generator) -> tuple[Array, dict[str, float]]:
    """Return coordinates and values of parameters that lie inside their ranges."""
    space = board.problem.space
    while True:
        z = rng.standard_normal(space.size)
        row = space.from_normal(z[None])
        spans = [
            (to_unit(row[0, k], p.low, p.high, p.spacing))
            for k, p in enumerate(space.priors)
            if p.bounded
        ]
        if all(INSIDE < u < 1.0 - INSIDE for u in spans):
            return z, dict(zip(space.names, map(float, row[0]), strict=True))


def _causes(
    board: Board,
    straight: Straight,
    count: int,
    wanted: float,
    rng: np.random.Generator,
    *,
    prior: bool,
) -> list[tuple[Candidate, float, float]]:
    """Return causes with ordinary strengths and their non-centralities; [] for none."""
    open_ = []
    for k, p in enumerate(straight.priors):
        most = max(_strong(straight, k, end) for end in (p.low, p.high))
        if most >= wanted and (not p.fixed or prior):
            open_.append(k)
    if len(open_) < count:
        return []
    chosen = [int(k) for k in rng.choice(open_, size=count, replace=False)]
    if count == 2 and not board.together(*(board.candidates[k].name for k in chosen)):
        return []
    found = []
    for k in chosen:
        p = straight.priors[k]
        beside = [j for j in chosen if j != k]
        if prior or p.fixed:
            x = float(p.draw(1, rng)[0])
        else:
            sized = [_strength(straight, k, end, wanted, beside) for end in (p.low, p.high)]
            possible = [one for one in sized if one is not None]
            if not possible:
                return []
            x = possible[int(rng.integers(len(possible)))]
        found.append((board.candidates[k], x, _strong(straight, k, x, beside)))
    return found


def _unlike_any(
    board: Board,
    values: Array,
    chosen: Sequence[tuple[Candidate, float, float]],
    wanted: float,
    rng: np.random.Generator,
    *,
    prior: bool,
) -> list[tuple[Candidate, float, float]]:
    """Return causes so strong that no parameters imitate them; [] where one cannot be.

    Those of a pair are looked at alone: what the other one imitates straight on counts as before.
    """
    found, alone = [], len(chosen) == 1
    for one, x, near in chosen:
        given = prior or one.switch
        if given or not alone:
            (far,) = distances(board, values, one, [x], rng)
            if given or far >= wanted:
                found.append((one, x, min(near, far)))
                continue
        end = (one.high if x > 0.0 else one.low) / one.scale
        told = strength_at(board, values, one, (0.0 if alone else x, end), wanted, rng)
        if told is None:
            return []
        found.append((one, *told))
    return found


def _strength(
    straight: Straight, k: int, end: float, wanted: float, beside: Sequence[int]
) -> float | None:
    """Return the strength towards one end that is as strong as wanted; None where none is."""
    if not _strong(straight, k, end, beside) >= wanted:
        return None
    return float(brentq(lambda x: _strong(straight, k, x, beside) - wanted, 0.0, end))


def _strong(straight: Straight, k: int, x: float, beside: Sequence[int] = ()) -> float:
    """Return the non-centrality of a cause: what it does in errors, as far as that is its own.

    What the parameters can do is not, and neither is what causes beside it do, those of a pair:
    of two that only look like one another nobody knows which acts. Without what is luck of the runs
    behind an answer: who takes that for the answer draws strengths that nothing shows.
    """
    own = straight.added(k, np.array([x]))[0]
    turned = straight.inverse @ own
    square = own @ turned - straight.luck[k] * x**2
    if beside:
        others = straight.answers[:, beside] + USUAL * straight.bends[:, beside]
        across = others.T @ turned
        square -= across @ np.linalg.lstsq(others.T @ straight.inverse @ others, across)[0]
    return math.sqrt(max(float(square), 0.0))
