"""What a measurement or an experiment is worth, and what its results would mean."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple, TypeAlias

from calibrate.arrays import Array
from calibrate.causes.candidates import Candidate
from calibrate.causes.judging.probabilities import NONE

__all__ = [
    "APART",
    "Feasible",
    "Names",
    "Offer",
    "Outcome",
    "Prospect",
    "Read",
    "Trial",
    "outcomes_of",
    "ranked",
]

Names: TypeAlias = tuple[str, ...]
"""Members of an answer: none of them, one, a pair; what is in no library by its name."""

LEAST: Final = 0.05
"""Nats below which a measurement tells nothing worth an hour."""
SHOWN: Final = 3
"""Results of a measurement, and answers after each, that are told."""
NOTICED: Final = 0.01
"""Probability from which the result that an answer expects is told."""
APART: Final = 1.0
"""Standard deviations, of the vaguer one, by which results differ that are told side by side."""
SAID: Final = 0.02
"""Probability after a result from which an answer is told, besides the first."""


class Read(NamedTuple):
    """A number that is read off.

    Attributes
    ----------
    name, unit : str
    se : float
        Standard error of the result, in the unit.
    """

    name: str
    unit: str
    se: float


@dataclass(frozen=True)
class Trial:
    """A further experiment, of which runs of the engine said what it would give.

    Attributes
    ----------
    name, words : str
        What it is called, and what is done.
    hours : float
        Hours that it takes.
    reads : tuple of Read
    command : str
        What to type next, empty where there is nothing.
    """

    name: str
    words: str
    hours: float
    reads: tuple[Read, ...]
    command: str = ""


@dataclass(frozen=True)
class Feasible:
    """A measurement that a laboratory could make of one number.

    Attributes
    ----------
    name : str
        As a candidate or a parameter is called; with ":" and where, if it differs between places.
    words : str
        What is done.
    unit : str
    se : float
        Standard error of the result, in the unit.
    hours : float
        Hours that it takes.
    effect : str
        Effect whose strength is measured, empty for an unknown of the base model.
    places : frozenset of int
        Places where a cause of that effect must act for the result to be its strength.
    unknown : str
        Name of the unknown that is measured.
    """

    name: str
    words: str
    unit: str
    se: float
    hours: float
    effect: str = ""
    places: frozenset[int] = frozenset()
    unknown: str = ""

    @property
    def reads(self) -> tuple[Read, ...]:
        """The one number."""
        return (Read(self.name, self.unit, self.se),)

    def measures(self, one: Candidate) -> bool:
        """Whether the result is the strength of a candidate."""
        return one.effect == self.effect and any(k in self.places for k, _ in one.acts)


@dataclass(frozen=True)
class Outcome:
    """What a result would mean.

    Attributes
    ----------
    values : tuple of float
        Of each number that is read, in its unit.
    probability : dict of str to float
        Of the answers that lead after it.
    """

    values: tuple[float, ...]
    probability: dict[str, float]


@dataclass(frozen=True)
class Offer:
    """A measurement and what it is worth.

    Attributes
    ----------
    measurement : Feasible or Trial
    information : float
        Expected information on which answer holds, nats.
    outcomes : tuple of Outcome
        Of the results that leading answers expect.
    """

    measurement: Feasible | Trial
    information: float
    outcomes: tuple[Outcome, ...]

    @property
    def per_hour(self) -> float:
        """Information over effort, nats per hour."""
        return self.information / self.measurement.hours


@dataclass(frozen=True)
class Prospect:
    """What measurements could still tell.

    Attributes
    ----------
    entropy : float
        How open it is which answer holds, nats: more nothing can tell.
    offers : tuple of Offer
        What tells most per hour first; those that tell next to nothing are left out.
    """

    entropy: float
    offers: tuple[Offer, ...]


def ranked(offers: Sequence[Offer]) -> tuple[Offer, ...]:
    """Return what tells enough to be worth an hour, the most per hour first."""
    worth = [one for one in offers if one.information >= LEAST]
    return tuple(sorted(worth, key=lambda one: -one.per_hour))


def outcomes_of(
    shares: Mapping[Names, float],
    results: Sequence[tuple[float, ...]],
    apart: Callable[[int, int], bool],
    after: Callable[[int], Array],
) -> tuple[Outcome, ...]:
    """Return the results that leading answers expect, and how probable each answer is after them.

    Parameters
    ----------
    shares : mapping
        Probability of each answer, the largest first.
    results : sequence of tuple of float
        What each of them expects.
    apart : callable
        Numbers of two answers to whether their results differ.
    after : callable
        Number of an answer to the probabilities of all after its result.
    """
    told: list[int] = []
    for number, share in enumerate(shares.values()):
        differs = all(apart(number, other) for other in told)
        if share > NOTICED and differs and len(told) < SHOWN:
            told.append(number)
    words = [" and ".join(names) or NONE for names in shares]
    found = []
    for number in told:
        best = sorted(zip(words, map(float, after(number)), strict=True), key=lambda one: -one[1])
        lead, *others = best[:SHOWN]
        kept = dict([lead, *(one for one in others if one[1] >= SAID)])
        found.append(Outcome(results[number], kept))
    return tuple(found)
