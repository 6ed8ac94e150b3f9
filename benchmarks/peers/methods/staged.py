"""The calibration by stages of bulkcal: `calibrate.staged` with the stages of the paper."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from benchmarks.peers.methods.decalioc import HELD, STAGES
from benchmarks.peers.methods.joint import CHECK_SEEDS, planted_targets
from benchmarks.peers.problem import Answer, Array, Cost, Problem, answer
from benchmarks.peers.study import counting_runner, planted_study
from calibrate.staged.calibration import Calibration, calibrate
from calibrate.study.schema.settings import LARGEST_STUDY_SEED

LEVEL: Final = 0.9
FEWEST: Final = 8
"""Points that a stage needs at least."""


class Staged:
    """Two parameters at a time: a first design, repeats, then runs near the solution.

    A budget is a study of its own; every stage spends it at its places, as `decalioc` does, in
    the proportions of the shipped study, and the final check is a part of it.
    """

    name = "ours-staged"
    sequential = False

    def solve(
        self, problem: Problem, budgets: Sequence[int], rng: np.random.Generator
    ) -> Iterator[Answer]:
        """Yield the found values and their 90 % intervals of a study of each size."""
        seed = int(rng.integers(1, LARGEST_STUDY_SEED))
        for budget in budgets:
            mine = replace(problem, cost=Cost())
            design = {"check_seeds": CHECK_SEEDS}
            data = planted_study(
                planted_targets(mine), seed, design, held=HELD, stages=_stages(budget - CHECK_SEEDS)
            )
            yield _answer(mine, budget, calibrate(data, counting_runner(mine)))


def _answer(problem: Problem, budget: int, found: Calibration) -> Answer:
    """Return what the stages found, in the order of the parameters."""
    ends = {name: span[LEVEL] for stage in found.stages for name, span in stage.intervals.items()}
    interval: Array = np.array([(ends[name].low, ends[name].high) for name in problem.names])
    theta = np.array([found.parameters[name] for name in problem.names])
    return answer(problem, budget, theta, interval)


def _stages(runs: int) -> str:
    """Return the stages, each with so many runs at every place that it uses."""
    points, repeats = max(round(0.4 * runs), FEWEST), round(0.1 * runs)
    lines: list[str] = []
    for number, stage in enumerate(STAGES):
        name = f"stage_{number + 1}"
        lines += ["[[stage]]", f'name = "{name}"', f'title = "{name}"']
        lines += [f"free = {list(stage.free)}", f"targets = {list(stage.targets)}"]
        lines += [f"points = {points}", f"repeats = {repeats}"]
        lines.append(f"infill = {runs - points - repeats}")
    return "\n".join(lines)
