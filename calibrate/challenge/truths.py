"""What is hidden in each study of a suite, and how strong it is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any, Final

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.candidates import Board, Candidate
from calibrate.causes.judging.straight import Straight, straight_at
from calibrate.causes.weighing.tangent import tangent_at
from calibrate.challenge.foreign import FOREIGN
from calibrate.challenge.rules import Rules, rng_of
from calibrate.inference.priors import to_unit

__all__ = ["Hidden", "Truth", "draw_truth"]

TRIES: Final = 200
"""Parameter sets that are tried for one at which a cause can be as strong as asked."""
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
        Strength in standard errors of what the parameters cannot imitate; nan for foreign ones.
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
        if chosen:
            hidden = tuple(
                Hidden(c.name, _rounded(x * c.scale), float(abs(x) * r)) for c, x, r in chosen
            )
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
    """Return causes with ordinary strengths and the root of their information; [] for none."""
    root = _roots(straight)
    open_ = []
    for k in range(len(board.candidates)):
        reach = max(abs(straight.priors[k].low), abs(straight.priors[k].high))
        if root[k] * reach >= wanted and (not straight.priors[k].fixed or prior):
            open_.append(k)
    if len(open_) < count:
        return []
    chosen = [int(k) for k in rng.choice(open_, size=count, replace=False)]
    if count == 2 and not board.together(*(board.candidates[k].name for k in chosen)):
        return []
    found = []
    for k in chosen:
        p = straight.priors[k]
        if prior or p.fixed:
            x = float(p.draw(1, rng)[0])
        else:
            size = wanted / root[k]
            signs = [s for s in (1.0, -1.0) if p.low <= s * size <= p.high]
            if not signs:
                return []
            x = size * signs[int(rng.integers(len(signs)))]
        found.append((board.candidates[k], x, float(root[k])))
    return found


def _roots(straight: Straight) -> Array:
    """Return the root of the information on an ordinary strength of each cause, bends counted.

    Without what is luck of the runs behind its answer: who takes that for the answer draws
    strengths that nothing shows.
    """
    answers = straight.answers + 2.5 * straight.bends
    squares = np.einsum("ic,ij,jc->c", answers, straight.inverse, answers) - straight.luck
    return np.asarray(np.sqrt(np.maximum(squares, 0.0)))
