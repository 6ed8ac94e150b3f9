"""The joint calibration of bulkcal: `calibrate.questions.joint` with a runner that counts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from benchmarks.peers.apparatus import MATERIAL, PLACES, TARGETS
from benchmarks.peers.problem import Answer, Array, Cost, Problem, answer
from benchmarks.peers.study import Planted, counting_runner, planted_study
from calibrate.questions.joint.calibration import calibrate_jointly
from calibrate.questions.joint.result import JointResult
from calibrate.study.schema.settings import LARGEST_STUDY_SEED

CHECK_SEEDS: Final = 2
"""Runs of each place at the optimum, the fewest that a study allows; no draws are checked."""

LEAST_START: Final = 10
"""Points of each place in the first design, the fewest from which six inputs are learnt."""
SHARE: Final = 10
"""Runs for each point of it: five places and some repeats make it half of all runs."""


class Joint:
    """All targets at once: a first design, then runs where the answer is uncertain.

    A budget is a study of its own with at most that many runs, those of its final check among
    them. Studies of one truth have the same seed, and so begin with the same runs; each is
    counted as if it were the only one.
    """

    name = "ours-joint"
    sequential = True

    def solve(
        self, problem: Problem, budgets: Sequence[int], rng: np.random.Generator
    ) -> Iterator[Answer]:
        """Yield the optimum and the 90 % intervals of a study of each size."""
        seed = int(rng.integers(1, LARGEST_STUDY_SEED))
        for budget in budgets:
            result, mine = _calibrate(problem, budget * len(PLACES), seed)
            table = result.table().loc[list(problem.names)]
            interval: Array = table[["low_90", "high_90"]].to_numpy(float)
            yield answer(mine, budget, table["best"].to_numpy(float), interval)


def _calibrate(problem: Problem, most: int, seed: int) -> tuple[JointResult, Problem]:
    """Return the result of a study with that many runs at most, and what it has cost.

    A check that moves the answer is repeated on top of a study's budget; a study that has taken
    too many runs that way is done again with a smaller one.
    """
    runs = most - CHECK_SEEDS * len(PLACES)
    while True:
        mine = replace(problem, cost=Cost())
        start = max(LEAST_START, most // SHARE)
        design = {"runs": runs, "start": start, "check_seeds": CHECK_SEEDS, "check_draws": 0}
        data = planted_study(planted_targets(problem), seed, design)
        result = calibrate_jointly(data, counting_runner(mine))
        if mine.cost.runs <= most:
            return result, mine
        if runs <= most / 4:
            msg = f"{most} runs are too few for the first design and its check"
            raise ValueError(msg)
        runs -= mine.cost.runs - most


def planted_targets(problem: Problem) -> list[Planted]:
    """Return what was measured."""
    found = []
    for name, target in TARGETS.items():
        place = PLACES[target.place]
        found.append(
            Planted(
                name, MATERIAL, place.surface, place.experiment, target.observable,
                problem.measured[name], problem.error[name],
            )
        )  # fmt: skip
    return found
