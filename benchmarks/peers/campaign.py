"""The comparison: truths, methods and budgets, one line on disk for every answer."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

import numpy as np

from benchmarks.peers.lines import append_line, read_lines
from benchmarks.peers.problem import Answer, Array, Method, Problem, draw_seed
from benchmarks.peers.simulator import Simulator
from benchmarks.peers.truths import SEED, Truth, parameters_of, plant, predict

TRUTHS: Final = 20
BUDGETS: Final = (20, 40, 60, 100)
CHECK_SEEDS: Final = 8
"""Runs behind the prediction of an answer; their scatter is taken off in `scores`."""
ANSWERS: Final = "answers.jsonl"


class Middle:
    """The middle of the ranges, without any run: what every method must beat."""

    name = "middle"

    def solve(
        self, problem: Problem, budgets: Sequence[int], rng: np.random.Generator
    ) -> Iterator[Answer]:
        """Yield the middle and the central 90 % of the ranges."""
        del rng
        low, high = problem.bounds.T
        inside = np.column_stack([low + 0.05 * (high - low), high - 0.05 * (high - low)])
        yield Answer(budgets[0], 0.5 * (low + high), inside, 0, 0, 0.0)


def run_campaign(
    folder: Path,
    simulator: Simulator,
    methods: Sequence[Method],
    truths: Sequence[int],
    budgets: Sequence[int] = BUDGETS,
    tell: Callable[[str], None] = print,
) -> None:
    """Let each method answer for each truth, truth by truth, and write what is new.

    Parameters
    ----------
    folder : Path
        Where answers are kept; runs are the simulator's to keep.
    simulator : Simulator
    methods : sequence of Method
    truths : sequence of int
    budgets : sequence of int
        Checkpoints in parameter vectors over all places.
    tell : callable
        Receives a line per method and truth.
    """
    file = folder / ANSWERS
    done = {(line["truth"], line["method"]) for line in read_lines(file) if line["last"]}
    for number in truths:
        wanted = [method for method in methods if (number, method.name) not in done]
        if not wanted:
            continue
        truth = plant(simulator, number, parameters_of(number, TRUTHS))
        for method in wanted:
            told = {(x["truth"], x["method"], x["budget"]) for x in read_lines(file)}
            answers = list(method.solve(_problem(simulator, truth, method), budgets, _rng(number)))
            for found in answers:
                if (number, method.name, found.budget) not in told:
                    last = found is answers[-1]
                    append_line(file, _line(simulator, truth, method.name, found, last=last))
            tell(f"truth {number}, {method.name}: {len(answers)} answers")


def _rng(number: int) -> np.random.Generator:
    """Return the generator of a method for a truth."""
    return np.random.default_rng([SEED, number, 1])


def _problem(simulator: Simulator, truth: Truth, method: Method) -> Problem:
    """Return the problem with seeds that no other method or truth has."""
    seeds = np.random.default_rng([SEED, truth.number, zlib.crc32(method.name.encode())])
    return Problem(truth.measured, truth.error, simulator, seeds)


def _line(
    simulator: Simulator, truth: Truth, method: str, found: Answer, *, last: bool
) -> dict[str, Any]:
    """Return one answer with what it predicts, as plain numbers."""
    rng = np.random.default_rng([SEED, truth.number, zlib.crc32(method.encode()), found.budget])
    seeds = [draw_seed(rng) for _ in range(CHECK_SEEDS)]
    predicted = predict(simulator, found.theta, seeds)
    interval = None if found.interval is None else found.interval.tolist()
    return {
        "truth": truth.number,
        "method": method,
        **asdict(found),
        "theta": found.theta.tolist(),
        "interval": interval,
        "true_theta": truth.theta.tolist(),
        "predicted": _plain(predicted),
        "unseen": truth.unseen,
        "unseen_error": truth.unseen_error,
        "unseen_spread": truth.unseen_spread,
        "measured": truth.measured,
        "error": truth.error,
        "last": last,
    }


def _plain(values: Mapping[str, Array]) -> dict[str, list[float | None]]:
    """Return lists in which a failed run is null."""
    return {
        name: [float(y) if np.isfinite(y) else None for y in row] for name, row in values.items()
    }
