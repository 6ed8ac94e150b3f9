"""The same diagnosis with less, or more, than it has: what each part is worth."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.candidates import Board, Measured
from calibrate.causes.weighing.bases import best_mode
from calibrate.emulator.emulator import Scores
from calibrate.emulator.types import Inputs, Prediction
from calibrate.emulator.with_effects import WithEffects
from calibrate.inference.problem import Known, Reading
from calibrate.study.model import Study

__all__ = ["OURS", "VARIANTS", "Variant"]

OURS: Final = "ours"
SURE: Final = 0.02
"""Of a prior deviation: how well frozen parameters are known.

Far below what data leave of one; at a thousandth the sampler needs many minutes for a study.
"""
TIMED: Final = Measured(0.0, 0.002)
WEIGHED: Final = Measured(0.0, 0.01)
SEED: Final = 5
SPREAD: Final = "spread of "
"""How names begin of the spread between what a tie holds together."""


@dataclass(frozen=True)
class Variant:
    """One way to judge a board.

    Attributes
    ----------
    name, meaning : str
    change : callable
        Board and its study to the board that is judged.
    settled : tuple of str
        Effects that it takes as measured; studies in which one of them is hidden do not count.
    """

    name: str
    meaning: str
    change: Callable[[Board, Study], Board]
    settled: tuple[str, ...] = ()


@dataclass(frozen=True)
class _Certain(WithEffects):
    """An emulator that takes what it says for exact."""

    def predict(self, inputs: Inputs) -> Prediction:
        return _sure(super().predict(inputs))

    def scores(self, inputs: Inputs) -> Scores:
        return tuple((mean, np.zeros_like(variance)) for mean, variance in super().scores(inputs))

    def switched(
        self,
        scores: Scores,
        u: Array,
        strengths: list[tuple[int, Array]],  # type: ignore[override]
    ) -> Prediction:
        return _sure(super().switched(scores, u, strengths))

    def parts(
        self, column: int, u: Array, at: tuple[float, float] | None = None
    ) -> tuple[Array, Array, Array]:
        slope, bend, doubt = super().parts(column, u, at)
        return slope, bend, np.zeros_like(doubt)


def _sure(one: Prediction) -> Prediction:
    return Prediction(one.mean, np.zeros_like(one.variance), np.zeros((*one.mean.shape, 0)))


def _certain(board: Board, _study: Study) -> Board:
    places = []
    for place in board.problem.places:
        known = place.emulator
        if not isinstance(known, WithEffects):
            msg = "only an emulator that learnt causes by themselves can be taken for exact"
            raise TypeError(msg)
        exact = _Certain(known.base, known.changes, known.effects)
        places.append(replace(place, emulator=exact))
    return replace(board, problem=replace(board.problem, places=tuple(places)))


def _frozen(board: Board, _study: Study) -> Board:
    """Hold the parameters where a calibration without causes puts them."""
    problem = board.problem
    mode = best_mode(problem, np.random.default_rng(SEED))
    there = problem.space.from_normal(mode.z[None])[0]
    near = problem.space.from_normal(mode.z[None] + SURE)[0]
    held = [
        Known(k, float(value), max(abs(float(beside - value)), 1e-9))
        for k, (value, beside) in enumerate(zip(there, near, strict=True))
    ]
    return replace(board, problem=replace(problem, known=(*problem.known, *held)))


def _without_curves(board: Board, _study: Study) -> Board:
    places = [
        replace(place, readings=tuple(_last(reading) for reading in place.readings))
        for place in board.problem.places
    ]
    return replace(board, problem=replace(board.problem, places=tuple(places)))


def _last(reading: Reading) -> Reading:
    """Return the last level of a curve, with all of its error."""
    if len(reading.y) == 1:
        return reading
    last = reading.columns.stop - 1
    extra = None if reading.extra is None else reading.extra[-1:]
    shared = tuple((index, loading[-1:]) for index, loading in reading.shared)
    return replace(
        reading, columns=slice(last, last + 1), y=reading.y[-1:], se=reading.se[-1:],
        extra=extra, shared=shared, together=None,
    )  # fmt: skip


def _one_material(board: Board, study: Study) -> Board:
    """Leave out what was measured of all materials but the first."""
    first = study.materials[0].name
    places = [
        place if where.material == first else replace(place, readings=())
        for place, where in zip(board.problem.places, study.places, strict=True)
    ]
    return replace(board, problem=replace(board.problem, places=tuple(places)))


def _ties_fixed(board: Board, _study: Study) -> Board:
    """Let tied parameters be alike, as if nothing scattered between materials."""
    problem = board.problem
    held = [
        Known(k, 0.0, SURE) for k, name in enumerate(problem.space.names) if name.startswith(SPREAD)
    ]
    return replace(board, problem=replace(problem, known=(*problem.known, *held)))


def _with_known(board: Board, _study: Study) -> Board:
    known = {"plate_period": (TIMED,), "mass_flow_factor": (WEIGHED,)}
    return replace(board, known={**board.known, **known})


VARIANTS: Final = {
    one.name: one
    for one in (
        Variant(OURS, "the diagnosis as it is", lambda board, _study: board),
        Variant("known", "period timed to 0.2 %, flows weighed to 1 %", _with_known,
                ("plate_period", "mass_flow_factor")),
        Variant("no_curves", "the time of a curve's last level instead of the curve",
                _without_curves),
        Variant("frozen", "parameters held where the calibration puts them", _frozen),
        Variant("one_material", "of the first material only", _one_material),
        Variant("ties_fixed", "tied parameters taken to be the same", _ties_fixed),
        Variant("certain", "measurement errors only, emulators taken for exact", _certain),
    )
}  # fmt: skip
"""By name."""
