"""The middle of the ranges, without any run: what every method must beat."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from benchmarks.peers.problem import Answer, Problem


class Middle:
    """The middle, with the central 90 % of the ranges."""

    name = "middle"
    sequential = True

    def solve(
        self, problem: Problem, budgets: Sequence[int], rng: np.random.Generator
    ) -> Iterator[Answer]:
        """Yield it once."""
        del rng
        low, high = problem.bounds.T
        inside = np.column_stack([low + 0.05 * (high - low), high - 0.05 * (high - low)])
        yield Answer(budgets[0], 0.5 * (low + high), inside, 0, 0, 0.0)
