"""The comparison: truths, methods and budgets, one line on disk for every answer."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final, NamedTuple

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


class Task(NamedTuple):
    """What a method has to answer.

    Attributes
    ----------
    method : Method
    budgets : tuple of int
        Checkpoints in parameter vectors over all places, in rising order.
    """

    method: Method
    budgets: tuple[int, ...] = BUDGETS


def run_campaign(
    folder: Path,
    simulator: Simulator,
    tasks: Sequence[Task],
    truths: Sequence[int],
    tell: Callable[[str], None] = print,
) -> None:
    """Let each method answer for each truth, and write what is new.

    Truth by truth, all methods in turn, so that a campaign that is cut compares all of them over
    the truths that it has done.

    Parameters
    ----------
    folder : Path
        Where answers are kept; runs are the simulator's to keep.
    simulator : Simulator
    tasks : sequence of Task
    truths : sequence of int
    tell : callable
        Receives a line per method and truth.
    """
    file = folder / ANSWERS
    done = {(line["truth"], line["method"], line["budget"]) for line in read_lines(file)}
    for number in truths:
        wanted = [task for task in tasks if _left(number, task, done)]
        if not wanted:
            continue
        truth = plant(simulator, number, parameters_of(number, TRUTHS))
        for task in wanted:
            count = 0
            for found in _solved(simulator, truth, task, _left(number, task, done)):
                key = (number, task.method.name, found.budget)
                if key not in done:
                    append_line(file, _line(simulator, truth, task.method.name, found))
                    done.add(key)
                    count += 1
            tell(f"truth {number}, {task.method.name}: {count} answers")


def _left(number: int, task: Task, done: set[tuple[int, str, int]]) -> list[int]:
    """Return the budgets that a method has not answered for a truth."""
    return [b for b in task.budgets if (number, task.method.name, b) not in done]


def _solved(
    simulator: Simulator, truth: Truth, task: Task, budgets: Sequence[int]
) -> Iterator[Answer]:
    """Solve a truth, from the beginning at each budget where a method is no sequence.

    Runs and random numbers of a budget then do not depend on which others are asked for.
    """
    method = task.method
    if method.sequential:
        problem, rng = _problem(simulator, truth, method), _rng(truth, ())
        yield from method.solve(problem, task.budgets, rng)
        return
    for budget in budgets:
        problem = _problem(simulator, truth, method, budget)
        yield from method.solve(problem, (budget,), _rng(truth, (budget,)))


def _rng(truth: Truth, budgets: tuple[int, ...]) -> np.random.Generator:
    """Return the generator of a method for a truth."""
    return np.random.default_rng([SEED, truth.number, 1, *budgets])


def _problem(simulator: Simulator, truth: Truth, method: Method, *budgets: int) -> Problem:
    """Return the problem with seeds that no other method, truth or separate budget has."""
    key = [SEED, truth.number, zlib.crc32(method.name.encode()), *budgets]
    return Problem(truth.measured, truth.error, simulator, np.random.default_rng(key))


def _line(simulator: Simulator, truth: Truth, method: str, found: Answer) -> dict[str, Any]:
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
    }


def _plain(values: Mapping[str, Array]) -> dict[str, list[float | None]]:
    """Return lists in which a failed run is null."""
    return {
        name: [float(y) if np.isfinite(y) else None for y in row] for name, row in values.items()
    }
