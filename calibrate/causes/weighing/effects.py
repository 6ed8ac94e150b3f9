"""What every cause adds to every reading at draws, in units of the errors there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.candidates import Candidate
from calibrate.causes.strengths.terms import Cross, Terms
from calibrate.causes.weighing.bench import Bench

__all__ = ["Added", "added_by"]


@dataclass(frozen=True, eq=False)
class Added:
    """What a cause adds at n draws: slope and bend of each reading it touches, whitened.

    Attributes
    ----------
    slopes, bends : dict of int to (n, L) float64
        By number of the reading.
    doubts : dict of int to (n,) float64
        By how much the variance of a reading grows with the squared strength, relative to what it
        is without the cause.
    """

    slopes: dict[int, Array]
    bends: dict[int, Array]
    doubts: dict[int, Array]

    def rows(self, which: Array) -> Added:
        """Return some of the draws."""
        return Added(*({k: x[which] for k, x in part.items()} for part in self._parts))

    @property
    def silent(self) -> Added:
        """The doubt about what is added, and nothing added."""
        nothing = {k: np.zeros_like(x) for k, x in self.slopes.items()}
        return Added(nothing, nothing, self.doubts)

    def joined(self, other: Added) -> Added:
        """Return what is added at these draws, and at others below."""
        both = zip(self._parts, other._parts, strict=True)
        return Added(*({k: np.concatenate([x, b[k]]) for k, x in a.items()} for a, b in both))

    @property
    def _parts(self) -> tuple[dict[int, Array], ...]:
        return self.slopes, self.bends, self.doubts

    def terms(self, bench: Bench) -> list[Terms]:
        """Return the coefficients of what is left, reading by reading."""
        return [
            Terms(
                _products(bench.left[k], a, self.bends[k]),
                self.doubts[k],
                bench.freedom[k],
                a.shape[1],
            )
            for k, a in self.slopes.items()
        ]

    def cross(self, other: Added, bench: Bench) -> list[Cross]:
        """Return the coefficients of what is left with another cause on as well."""
        found = []
        nothing = np.zeros(len(bench))
        for k in sorted(self.slopes.keys() | other.slopes.keys()):
            r = bench.left[k]
            none = np.zeros_like(r)
            a, c = self.slopes.get(k, none), self.bends.get(k, none)
            b, d = other.slopes.get(k, none), other.bends.get(k, none)
            first = Terms(
                _products(r, a, c),
                self.doubts.get(k, nothing),
                bench.freedom[k],
                r.shape[1],
            )
            second = Terms(
                _products(r, b, d),
                other.doubts.get(k, nothing),
                bench.freedom[k],
                r.shape[1],
            )
            mixed = np.array([_dot(a, b), _dot(a, d), _dot(c, b), _dot(c, d)])
            found.append(Cross(first, second, mixed))
        return found


def _products(r: Array, a: Array, c: Array) -> Array:
    return np.array([_dot(r, r), _dot(r, a), _dot(r, c), _dot(a, a), _dot(a, c), _dot(c, c)])


def _dot(a: Array, b: Array) -> Array:
    return np.asarray(np.einsum("nl,nl->n", a, b))


def added_by(bench: Bench, candidate: Candidate) -> Added:
    """Return what a cause adds to the readings of the places where it acts."""
    slopes: dict[int, Array] = {}
    bends: dict[int, Array] = {}
    doubts: dict[int, Array] = {}
    acts = dict(candidate.acts)
    number = 0
    for k, one in enumerate(bench.seen):
        parts = one.changes(acts[k], candidate.about) if k in acts else None
        for reading in one.place.readings:
            turned = bench.whitening[number]
            if parts is not None:
                slope, bend, doubt = (part[:, reading.columns] for part in parts)
                slopes[number] = np.einsum("nkl,nl->nk", turned, slope)
                bends[number] = np.einsum("nkl,nl->nk", turned, bend)
                doubts[number] = np.mean(np.sum((turned @ doubt) ** 2, axis=2), axis=1)
            number += 1
    return Added(slopes, bends, doubts)
