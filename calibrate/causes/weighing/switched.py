"""What is expected with causes on, and how probable that makes what was measured."""

from __future__ import annotations

from collections.abc import Sequence

from calibrate.arrays import Array
from calibrate.causes.candidates import Candidate
from calibrate.causes.weighing.bench import Bench, Seen
from calibrate.emulator.types import Prediction
from calibrate.inference.likelihood import log_density

__all__ = ["predicted_at", "terms_with"]


def terms_with(bench: Bench, members: Sequence[Candidate], strengths: Array, which: Array) -> Array:
    """Return the log density of every reading at some draws with causes on, (n, R).

    Parameters
    ----------
    bench : Bench
    members : sequence of Candidate
    strengths : (n, m) float64
        Ordinary ones, at these draws.
    which : (n,) int
        The draws.
    """
    values = bench.points[which]
    found, number = bench.terms[which].copy(), 0
    for k, seen in enumerate(bench.seen):
        touched = any(at == k for one in members for at, _ in one.acts)
        prediction = predicted_at(seen.rows(which), k, members, strengths) if touched else None
        for reading in seen.place.readings:
            if prediction is not None:
                found[:, number] = log_density(reading, prediction, values)
            number += 1
    return found


def predicted_at(seen: Seen, k: int, members: Sequence[Candidate], strengths: Array) -> Prediction:
    """Return what is expected at place k with causes on.

    Parameters
    ----------
    seen : Seen
        The place at n draws.
    k : int
    members : sequence of Candidate
    strengths : (n, m) float64
        Ordinary ones.
    """
    on = [
        (column, strengths[:, m])
        for m, one in enumerate(members)
        for at, column in one.acts
        if at == k
    ]
    return seen.predict(on)
