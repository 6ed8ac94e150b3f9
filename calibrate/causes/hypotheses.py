"""How probable the data are under each hypothesis: nothing missing, or some candidates switched on.

All hypotheses share the emulators, the data and the stream of random numbers, so that the evidence
of one depends neither on which others are considered nor on their order.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.candidates import Candidate, Measured, with_candidates
from calibrate.inference.evidence import Evidence, evidence, evidence_from
from calibrate.inference.intervals import Interval, shortest
from calibrate.inference.problem import Problem
from calibrate.inference.sampler.importance import take

__all__ = ["Board", "Hypothesis", "Weighed", "weigh_hypothesis"]

ERROR: Final = 0.03
"""Standard error of a log evidence at which drawing ends, in nats."""
SAMPLES: Final = 2000
"""Draws of equal weight that are kept."""
_LOG_2PI: Final = math.log(2.0 * math.pi)


@dataclass(frozen=True, eq=False)
class Board:
    """What all hypotheses have in common.

    Attributes
    ----------
    problem : Problem
        The base model.
    candidates : tuple of Candidate
        Effects that may be missing.
    shifts : tuple of Candidate
        Shifts of unknown origin, one per reading.
    known : mapping
        Independent measurements of effects, by effect.
    """

    problem: Problem
    candidates: tuple[Candidate, ...]
    shifts: tuple[Candidate, ...]
    known: Mapping[str, Measured]

    def members(self, names: Sequence[str]) -> tuple[Candidate, ...]:
        """Return candidates or shifts by name."""
        by_name = {one.name: one for one in (*self.candidates, *self.shifts)}
        return tuple(by_name[name] for name in names)

    def hypothesis(self, *names: str) -> Hypothesis:
        """Return the hypothesis that these candidates act, all others not."""
        return Hypothesis(self, self.members(names))


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """A set of candidates that act; the empty one is the base model.

    Attributes
    ----------
    board : Board
    members : tuple of Candidate
    """

    board: Board
    members: tuple[Candidate, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the members."""
        return tuple(one.name for one in self.members)

    @property
    def problem(self) -> Problem:
        """Its unknowns and data."""
        return with_candidates(self.board.problem, self.members, self.board.known)

    @property
    def absent(self) -> tuple[Measured, ...]:
        """Independent measurements of effects that are off here, and so say zero."""
        mine = {one.effect for one in self.members}
        return tuple(bench for effect, bench in self.board.known.items() if effect not in mine)

    def strengths(self, values: Array) -> dict[str, Array]:
        """Return the strengths of measured effects for values (..., K); 0 where one is off."""
        first = len(self.board.problem.space.unknowns)
        at = {one.effect: first + k for k, one in enumerate(self.members)}
        off = np.zeros(values.shape[:-1])
        return {e: values[..., at[e]] if e in at else off for e in self.board.known}

    @property
    def constant(self) -> float:
        """Log density of the measurements of effects that are off."""
        return sum(
            -0.5 * (bench.value / bench.se) ** 2 - math.log(bench.se) - 0.5 * _LOG_2PI
            for bench in self.absent
        )


@dataclass(frozen=True, eq=False)
class Weighed:
    """A hypothesis after the data.

    Attributes
    ----------
    hypothesis : Hypothesis
    problem : Problem
        Its unknowns and data.
    log_evidence, error : float
        Logarithm of the probability of the data, and its standard error.
    size : float
        Effective number of draws behind it.
    samples : (n, K) float64
        Values of all unknowns, of equal weight.
    best : (K,) float64
        The most probable of them.
    found : Evidence
        What other hypotheses may start from.
    """

    hypothesis: Hypothesis
    problem: Problem
    log_evidence: float
    error: float
    size: float
    samples: Array
    best: Array
    found: Evidence

    def strength(self, name: str) -> Array:
        """Return the samples of a member's strength, (n,)."""
        return np.asarray(self.samples[:, self.problem.space.index(name)])

    def interval(self, name: str, level: float) -> Interval:
        """Return the shortest interval of a member's strength."""
        member = next(one for one in self.hypothesis.members if one.name == name)
        return shortest(self.strength(name), level, member.low, member.high)


def weigh_hypothesis(hypothesis: Hypothesis, seed: int, known: Weighed | None = None) -> Weighed:
    """Compute the evidence by importance sampling from a mixture of t distributions.

    Parameters
    ----------
    hypothesis : Hypothesis
    seed : int
        The same for all hypotheses that are compared.
    known : Weighed, optional
        The base model, or the same hypothesis with other data: where the search starts.
    """
    rng = np.random.default_rng(seed)
    problem = hypothesis.problem
    if known is None:
        found = evidence(problem, rng, ERROR)
    else:
        found = evidence_from(known.found, problem, rng, ERROR)
    return _kept(hypothesis, found, rng)


def _kept(hypothesis: Hypothesis, found: Evidence, rng: np.random.Generator) -> Weighed:
    space, drawn = found.problem.space, found.drawn
    with np.errstate(divide="ignore"):
        height = np.log(drawn.weights) + found.proposal.log_density(drawn.z)
    best = drawn.z[int(np.argmax(height))]
    return Weighed(
        hypothesis,
        found.problem,
        drawn.log_evidence + hypothesis.constant,
        drawn.error,
        drawn.size,
        space.from_normal(drawn.z[take(drawn.weights, SAMPLES, rng)]),
        space.from_normal(best[None])[0],
        found,
    )
