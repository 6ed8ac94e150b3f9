"""What a study's numbers could tell at best: data drawn from the model that judges them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.candidates import Board, acting
from calibrate.emulator.types import Prediction
from calibrate.inference.problem import Place, Reading

__all__ = ["imagined"]


def imagined(board: Board, truth: Mapping[str, Any], rng: np.random.Generator) -> Board:
    """Return a board whose readings are drawn from its own emulators and errors at the truth.

    Who judges it has the right model, to the last error. What is not found there, these numbers
    do not hold for anybody who has the same emulators.

    Parameters
    ----------
    board : Board
    truth : mapping
        As `calibrate.challenge.truths.Truth.plain` gives it. What is foreign is in no emulator:
        such a board is returned as it is.
    rng : Generator
    """
    problem, space = board.problem, board.problem.space
    known = {one.name: one for one in board.candidates}
    # A cause of a place where nothing could be measured is no candidate, and shows nothing.
    hidden = [(known[h["name"]], h["strength"]) for h in truth["hidden"] if h["name"] in known]
    if truth["kind"] == "foreign":
        return board
    # Errors that readings have in common are nobody's parameters: they are drawn, too.
    drawn = space.draw(1, rng)
    told = np.array([[truth["values"].get(name, np.nan) for name in space.names]])
    values = np.where(np.isfinite(told), told, drawn)
    on = acting((one, strength / one.scale) for one, strength in hidden)
    places = tuple(
        _drawn(place, values, on.get(k, {}), rng) for k, place in enumerate(problem.places)
    )
    return replace(board, problem=replace(problem, places=places))


def _drawn(place: Place, values: Array, on: Mapping[int, float], rng: np.random.Generator) -> Place:
    expected = place.emulator.predict(place.inputs(values, on))
    outcome = _outcome(expected, rng)
    readings = tuple(_measured(one, outcome, values, rng) for one in place.readings)
    return replace(place, readings=readings)


def _outcome(expected: Prediction, rng: np.random.Generator) -> Array:
    """Return what the engine may give if the emulator is as uncertain as it says, (M,)."""
    factors = expected.factors[0]
    own = np.sqrt(expected.variance[0]) * rng.standard_normal(len(factors))
    together = factors @ rng.standard_normal(factors.shape[1])
    return np.asarray(expected.mean[0] + own + together)


def _measured(reading: Reading, outcome: Array, values: Array, rng: np.random.Generator) -> Reading:
    y = outcome[reading.columns] + reading.root @ rng.standard_normal(len(reading.se))
    if reading.extra is not None:
        y = y + reading.extra @ rng.standard_normal(reading.extra.shape[1])
    for index, loading in reading.shared:
        y = y + float(values[0, index]) * loading
    return replace(reading, y=np.asarray(y))
