"""What may be wrong: effects of known form with an unknown strength, and shifts of unknown origin.

A candidate adds one unknown to the problem. The strength of an effect enters the emulators; a
shift enters the readings themselves and stands for everything that is in no library. Their
strengths have the non-local prior phi^2 N(0, s^2), so that a cause of no size gains nothing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.errors import CalibrationError
from calibrate.inference.discrepancy import reaches
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Known, Place, Problem, Source
from calibrate.inference.space import Space, Unknown

__all__ = ["Candidate", "Measured", "Shifted", "shifts_of", "with_candidates"]

WIDTH: Final = 2.0
"""s of a strength's prior, in ordinary strengths; 2.8 of them are the most probable."""
LIMIT: Final = 6.0
"""Largest strength that is considered, in ordinary strengths."""


@dataclass(frozen=True)
class Measured:
    """An independent measurement of an effect's strength.

    Attributes
    ----------
    value, se : float
        In the effect's unit.
    """

    value: float
    se: float


@dataclass(frozen=True, eq=False)
class Shifted:
    """What one unit of a shift adds to a reading.

    Attributes
    ----------
    place, reading : int
        Position of the place, and of the reading in it.
    loading : (L,) float64
        On the model scale.
    """

    place: int
    reading: int
    loading: Array


@dataclass(frozen=True, eq=False)
class Candidate:
    """One thing that may be wrong.

    Attributes
    ----------
    name : str
        Name in tables; an effect that may act in one apparatus alone appears once for each.
    effect : str
        Name in a case's `effects`; empty for a shift.
    scale : float
        Ordinary strength, in its unit: what emulators call 1.
    low, high : float
        Limits of the strength; one of them is zero for an effect of one sign.
    acts : tuple of (int, int)
        Places where it acts, each with its column of the strengths.
    shifts : tuple of Shifted
        Readings that it shifts, for a candidate that is no effect.
    title, unit, settled_by : str
        For a reader; the last is the measurement that would confirm or exclude it.
    """

    name: str
    effect: str
    scale: float
    low: float
    high: float
    acts: tuple[tuple[int, int], ...] = ()
    shifts: tuple[Shifted, ...] = ()
    title: str = ""
    unit: str = ""
    settled_by: str = ""

    @property
    def prior(self) -> Prior:
        """Prior of the strength."""
        return Prior.non_local(WIDTH * self.scale, self.low, self.high)

    @property
    def limit(self) -> float:
        """Largest possible size of the strength."""
        return max(abs(self.low), abs(self.high))

    @classmethod
    def of_effect(
        cls,
        effect: str,
        scale: float,
        limits: tuple[float, float],
        acts: Sequence[tuple[int, int]],
        apparatus: str = "",
    ) -> Candidate:
        """Return an effect as a candidate, its limits narrowed to `LIMIT` ordinary strengths.

        Parameters
        ----------
        effect : str
        scale : float
        limits : (float, float)
        acts : sequence of (int, int)
        apparatus : str
            The only apparatus where it acts, if so.
        """
        low, high = max(limits[0], -LIMIT * scale), min(limits[1], LIMIT * scale)
        name = f"{effect}:{apparatus}" if apparatus else effect
        return cls(name, effect, scale, low, high, tuple(acts))


def with_candidates(
    problem: Problem, members: Sequence[Candidate], known: Mapping[str, Measured]
) -> Problem:
    """Return the problem with the strengths of some candidates among its unknowns.

    Parameters
    ----------
    problem : Problem
        The base model: strengths of the candidates' effects are the number 0 there.
    members : sequence of Candidate
        May be none.
    known : mapping
        Independent measurements, by effect.

    Raises
    ------
    CalibrationError
        If two members are one effect at one place, which no data could tell apart.
    """
    _check(problem, members)
    first = len(problem.space.unknowns)
    unknowns = tuple(Unknown(one.name, "", one.prior, one.title) for one in members)
    space = Space((*problem.space.unknowns, *unknowns), problem.space.ties)
    places = list(problem.places)
    measured = list(problem.known)
    for index, one in enumerate(members, first):
        for k, column in one.acts:
            places[k] = _switched(places[k], column, Source(index, 0.0, 0.0, one.scale))
        for shift in one.shifts:
            places[shift.place] = _shifted(places[shift.place], shift, index)
        if one.effect in known:
            bench = known[one.effect]
            measured.append(Known(index, bench.value, bench.se))
    return Problem(space, tuple(places), tuple(measured))


def _check(problem: Problem, members: Sequence[Candidate]) -> None:
    taken: dict[tuple[int, int], str] = {}
    for one in members:
        for at in one.acts:
            if at in taken:
                msg = (
                    f"candidates {taken[at]} and {one.name} are the same effect at "
                    f"'{problem.places[at[0]].name}'; consider one of them at a time"
                )
                raise CalibrationError(msg)
            taken[at] = one.name


def _switched(place: Place, column: int, source: Source) -> Place:
    strengths = list(place.strengths)
    strengths[column] = source
    return replace(place, strengths=tuple(strengths))


def _shifted(place: Place, shift: Shifted, index: int) -> Place:
    readings = list(place.readings)
    one = readings[shift.reading]
    readings[shift.reading] = replace(one, shared=(*one.shared, (index, shift.loading)))
    return replace(place, readings=tuple(readings))


def shifts_of(problem: Problem, rng: np.random.Generator) -> tuple[Candidate, ...]:
    """Return a shift of every reading: what is wrong there may be in no library.

    The s of its strength is what `calibrate.inference.discrepancy.reaches` says.

    Parameters
    ----------
    problem : Problem
    rng : Generator
    """
    found = []
    sizes = reaches(problem, rng)
    for k, place in enumerate(problem.places):
        for i, reading in enumerate(place.readings):
            size = max(sizes[k][i] / WIDTH, float(reading.se.min()))
            loading = np.full(len(reading.y), size)
            name = f"unknown at {reading.name}"
            found.append(Candidate(name, "", 1.0, -LIMIT, LIMIT, (), (Shifted(k, i, loading),)))
    return tuple(found)
