"""What is in no library: readings that are off, one, those of a place, of an experiment, or all.

Each is a slab: the readings it touches have a normal error more, independent of each other, whose
size is one of `SIZES` standard deviations of what the prior allows there. A curve is off by a
constant and by a slope.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array
from calibrate.causes.weighing.bench import Bench
from calibrate.inference.likelihood import log_density
from calibrate.inference.problem import Problem, Reading

__all__ = ["EVERYWHERE", "SIZES", "Slab", "slab_gains", "slab_weight", "slabs_of", "widened"]

EVERYWHERE: Final = "unknown everywhere"
SIZES: Final = (0.1, 0.3, 1.0)


@dataclass(frozen=True)
class Slab:
    """Readings that may be off together.

    Attributes
    ----------
    name : str
    readings : tuple of int
        Numbers of them, place by place.
    """

    name: str
    readings: tuple[int, ...]


def slabs_of(problem: Problem) -> tuple[Slab, ...]:
    """Return a slab for each reading, place and experiment of several readings, and everything."""
    found, number = [], 0
    experiments: dict[str, list[int]] = {}
    for place in problem.places:
        mine = tuple(range(number, number + len(place.readings)))
        number += len(mine)
        experiments.setdefault(place.experiment, []).extend(mine)
        found += [
            Slab(f"unknown at {reading.name}", (k,))
            for k, reading in zip(mine, place.readings, strict=True)
        ]
        if len(mine) > 1:
            found.append(Slab(f"unknown in {place.name}", mine))
    found += [Slab(f"unknown in {name}", tuple(own)) for name, own in experiments.items() if name]
    found.append(Slab(EVERYWHERE, tuple(range(number))))
    # One experiment may be one place, or all there is.
    return tuple({one.readings: one for one in reversed(found)}.values())[::-1]


def widened(problem: Problem, slab: Slab, size: float, spreads: Sequence[float]) -> Problem:
    """Return the problem with a slab of one of the `SIZES`."""
    places, number = [], 0
    for place in problem.places:
        readings = []
        for reading in place.readings:
            off = number in slab.readings
            readings.append(_off(reading, size * spreads[number]) if off else reading)
            number += 1
        places.append(replace(place, readings=tuple(readings)))
    return replace(problem, places=tuple(places))


def slab_gains(bench: Bench, spreads: list[float]) -> Array:
    """Return how much more probable each reading is at draws if it is off, (sizes, n, R).

    Parameters
    ----------
    bench : Bench
    spreads : list of float
        What the prior allows each reading to be, as a standard deviation.
    """
    found = np.zeros((len(SIZES), *bench.terms.shape))
    number = 0
    for seen in bench.seen:
        for reading in seen.place.readings:
            for s, size in enumerate(SIZES):
                off = _off(reading, size * spreads[number])
                new = log_density(off, seen.prediction, bench.points)
                found[s, :, number] = new - bench.terms[:, number]
            number += 1
    return found


def _off(reading: Reading, size: float) -> Reading:
    count = len(reading.se)
    columns = [np.full(count, size)]
    if count > 1:
        columns.append(size * np.linspace(-1.0, 1.0, count))
    own = [] if reading.extra is None else [reading.extra]
    return replace(reading, extra=np.column_stack([*own, *columns]))


def slab_weight(slab: Slab, gains: Array) -> Array:
    """Return the log gain of a slab at draws, its size integrated, (n,)."""
    each = gains[:, :, list(slab.readings)].sum(axis=2)
    return np.asarray(special.logsumexp(each, axis=0) - np.log(len(SIZES)))
