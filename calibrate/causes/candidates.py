"""What may be wrong: effects of known form with an unknown strength; and what all share, a board.

Strengths have the non-local prior x^2 N(0, s^2), so that a cause of no size gains nothing.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from calibrate.causes.strengths.prior import StrengthPrior
from calibrate.emulator.with_effects import WithEffects
from calibrate.inference.problem import Problem

__all__ = ["Board", "Candidate", "Measured", "acting", "board_of_problem", "doubt_about"]

WIDTH: Final = 2.0
"""s of a strength's prior, in ordinary strengths; 2.8 of them are the most probable."""
LIMIT: Final = 6.0
"""Largest strength that is considered, in ordinary strengths."""
PRIOR_DRAWS: Final = 512


@dataclass(frozen=True)
class Measured:
    """An independent measurement of an effect's strength.

    Attributes
    ----------
    value, se : float
        In the effect's unit.
    places : frozenset of int, optional
        Where it holds; everywhere where they are left out.
    """

    value: float
    se: float
    places: frozenset[int] | None = None

    def concerns(self, one: Candidate) -> bool:
        """Whether it measures the strength of a candidate of its effect."""
        return self.places is None or any(k in self.places for k, _ in one.acts)

    def log_density(self, x: float, scale: float) -> float:
        """Return its log density at a strength, both in ordinary ones."""
        z = (x - self.value / scale) / (self.se / scale)
        return -0.5 * z**2 - math.log(self.se / scale) - 0.5 * math.log(2.0 * math.pi)


@dataclass(frozen=True, eq=False)
class Candidate:
    """One thing that may be wrong.

    Attributes
    ----------
    name : str
        Name in tables; an effect that may act in one place alone appears once for each.
    effect : str
        Name in a case's `effects`.
    scale : float
        Ordinary strength, in its unit: what emulators call 1.
    low, high : float
        Limits of the strength; one of them is zero for an effect of one sign; both are equal for
        one that is on or off.
    acts : tuple of (int, int)
        Places where it acts, each with its column of the strengths.
    title, unit, settled_by : str
        For a reader; the last is the measurement that would confirm or exclude it.
    settled_se, settled_hours : float
        Standard error of that measurement, in the unit; hours that it takes.
    about : (float, float), optional
        Ordinary strengths about which it is looked for: there a parabola is what is expected of it.
    """

    name: str
    effect: str
    scale: float
    low: float
    high: float
    acts: tuple[tuple[int, int], ...] = ()
    title: str = ""
    unit: str = ""
    settled_by: str = ""
    settled_se: float = 0.0
    settled_hours: float = 1.0
    about: tuple[float, float] | None = None

    @property
    def limit(self) -> float:
        """Largest possible size of the strength."""
        return max(abs(self.low), abs(self.high))

    @property
    def switch(self) -> bool:
        """Whether it is on or off."""
        return self.low == self.high

    @classmethod
    def of_effect(
        cls,
        effect: str,
        scale: float,
        limits: tuple[float, float],
        acts: Sequence[tuple[int, int]],
        where: str = "",
    ) -> Candidate:
        """Return an effect as a candidate, its limits narrowed to `LIMIT` ordinary strengths.

        Parameters
        ----------
        effect : str
        scale : float
        limits : (float, float)
        acts : sequence of (int, int)
        where : str
            The only funnel, material or wall where it acts, if so.
        """
        low, high = max(limits[0], -LIMIT * scale), min(limits[1], LIMIT * scale)
        name = f"{effect}:{where}" if where else effect
        return cls(name, effect, scale, low, high, tuple(acts))


def acting(causes: Iterable[tuple[Candidate, float]]) -> dict[int, dict[int, float]]:
    """Return what acts where: ordinary strengths by place and column of the strengths.

    Parameters
    ----------
    causes : iterable of (Candidate, float)
        Each with its ordinary strength.
    """
    found: dict[int, dict[int, float]] = {}
    for one, x in causes:
        for k, column in one.acts:
            found.setdefault(k, {})[column] = x
    return found


@dataclass(frozen=True, eq=False)
class Board:
    """What all hypotheses have in common.

    Attributes
    ----------
    problem : Problem
        The base model: strengths of the candidates' effects are the number 0 there.
    candidates : tuple of Candidate
        Effects that may be missing.
    known : mapping
        Independent measurements, by effect.
    spreads : tuple of float
        What the prior allows each reading to be, as a standard deviation on the model scale.
    """

    problem: Problem
    candidates: tuple[Candidate, ...]
    known: Mapping[str, Sequence[Measured]] = field(default_factory=dict)
    spreads: tuple[float, ...] = ()

    def candidate(self, name: str) -> Candidate:
        """Return a candidate by name."""
        return next(one for one in self.candidates if one.name == name)

    def members(self, names: Sequence[str]) -> tuple[Candidate, ...]:
        """Return candidates by name."""
        return tuple(self.candidate(name) for name in names)

    def together(self, a: str, b: str) -> bool:
        """Whether two candidates can act at once: not where they are one effect at one place."""
        return not set(self.candidate(a).acts) & set(self.candidate(b).acts)

    def about(self, strengths: Mapping[str, tuple[float, float]]) -> Board:
        """Return a board on which candidates are looked for about some strengths."""
        found = [replace(one, about=strengths.get(one.name, one.about)) for one in self.candidates]
        return replace(self, candidates=tuple(found))

    def measured(self, one: Candidate) -> tuple[Measured, ...]:
        """Return the measurements of a candidate's strength."""
        return tuple(known for known in self.known.get(one.effect, ()) if known.concerns(one))

    def with_doubts(self) -> Board:
        """Return a board on which the doubt about every answer is a candidate, too.

        Runs tell the answer to a cause up to an error that grows with its strength. An effect of
        which little is known thus explains nearly anything, if it is only strong enough. Its doubt
        alone takes the answer to be nothing, as uncertain as it is: what that explains is no credit
        of the cause. Emulators that do not learn causes by themselves have no doubts apart.
        """
        found = []
        for one in self.candidates:
            emulators = [(k, column, self.problem.places[k].emulator) for k, column in one.acts]
            acts = tuple(
                (k, column + emulator.effects)
                for k, column, emulator in emulators
                if isinstance(emulator, WithEffects)
            )
            if len(acts) == len(one.acts):
                found.append(replace(one, name=doubt_about(one.name), acts=acts))
        return replace(self, candidates=(*self.candidates, *found))

    def strength_prior(self, one: Candidate) -> StrengthPrior:
        """Return what is believed of a strength, in ordinary ones."""
        bench = _together(self.measured(one))
        measured = None if bench is None else (bench.value / one.scale, bench.se / one.scale)
        return StrengthPrior(one.low / one.scale, one.high / one.scale, WIDTH, measured)

    def constant(self, names: Sequence[str]) -> float:
        """Return what measurements say of a hypothesis whatever its strengths, as log density.

        That is the density of those of effects that are off, in ordinary strengths; and where one
        strength was measured more than once, how well these measurements agree.
        """
        on = self.members(names)
        total = 0.0
        for effect, listed in self.known.items():
            acting = [one for one in on if one.effect == effect]
            for scale in [one.scale for one in self.candidates if one.effect == effect][:1]:
                off = (b for b in listed if not any(b.concerns(one) for one in acting))
                total += sum(bench.log_density(0.0, scale) for bench in off)
        for one in on:
            several = self.measured(one)
            whole = _together(several)
            if whole is not None and len(several) > 1:
                x = whole.value / one.scale
                total += sum(bench.log_density(x, one.scale) for bench in several)
                total -= whole.log_density(x, one.scale)
        return total


def doubt_about(name: str) -> str:
    """Return the name of the doubt about a cause's answer."""
    return f"doubt about {name}"


def _together(several: Sequence[Measured]) -> Measured | None:
    """Return measurements of one strength as one, weighted by their errors."""
    if len(several) < 2:
        return next(iter(several), None)
    weights = [bench.se**-2 for bench in several]
    value = sum(w * bench.value for w, bench in zip(weights, several, strict=True)) / sum(weights)
    return Measured(value, sum(weights) ** -0.5)


def board_of_problem(
    problem: Problem,
    candidates: Sequence[Candidate],
    known: Mapping[str, Sequence[Measured]],
    rng: np.random.Generator,
) -> Board:
    """Return a board; what the prior allows each reading to be is drawn.

    Parameters
    ----------
    problem : Problem
    candidates : sequence of Candidate
    known : mapping
    rng : Generator
    """
    values = problem.space.draw(PRIOR_DRAWS, rng)
    spreads = []
    for place in problem.places:
        mean = place.predict(values).mean
        for reading in place.readings:
            size = mean[:, reading.columns].std(axis=0)
            spreads.append(max(float(np.sqrt(np.mean(size**2))), float(reading.se.min())))
    return Board(problem, tuple(candidates), dict(known), tuple(spreads))
