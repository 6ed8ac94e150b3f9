"""When to stop: the next batch is not expected to change an answer, or the budget is spent.

What a batch may show is imagined from the emulators' own variances; each imagined outcome gives
every posterior draw another likelihood, and so moves the ends and the middle of every interval.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.arrays import Array

__all__ = ["LARGEST_MOVE", "QUANTILES", "Outlook", "expected_moves", "weighted_quantiles"]

QUANTILES: Final = (0.05, 0.5, 0.95)
"""The answers: both ends of the 90 % interval, and the median."""
LARGEST_MOVE: Final = 0.1
"""Of an interval's length; a batch that is expected to move less is not worth running."""


def weighted_quantiles(values: Array, weights: Array, levels: Sequence[float]) -> Array:
    """Return quantiles of weighted draws, (levels, K).

    Parameters
    ----------
    values : (n, K) float64
    weights : (n,) float64
        Not negative, not all zero.
    levels : sequence of float
    """
    found = np.empty((len(levels), values.shape[1]))
    for k in range(values.shape[1]):
        order = np.argsort(values[:, k])
        share = np.cumsum(weights[order])
        middle = (share - 0.5 * weights[order]) / share[-1]
        found[:, k] = np.interp(levels, middle, values[order, k])
    return found


def expected_moves(samples: Array, log_ratios: Array) -> Array:
    """Return how far answers are expected to move, in lengths of their intervals, (K,).

    Parameters
    ----------
    samples : (n, K) float64
        Posterior draws as the emulators are now.
    log_ratios : (f, n) float64
        Log likelihood of each draw after each of f imagined batches, minus that of now.

    Returns
    -------
    (K,) float64
        Per unknown, the largest of the mean moves of `QUANTILES`.
    """
    now = weighted_quantiles(samples, np.ones(len(samples)), QUANTILES)
    length = np.maximum(now[-1] - now[0], np.finfo(float).tiny)
    moves = []
    for ratios in log_ratios:
        weights = np.exp(ratios - ratios.max())
        moves.append(np.abs(weighted_quantiles(samples, weights, QUANTILES) - now) / length)
    return np.asarray(np.mean(moves, axis=0).max(axis=0))


@dataclass(frozen=True)
class Outlook:
    """What is known before the next batch.

    Attributes
    ----------
    spent, budget : int
        Runs made, and runs allowed.
    batch : int
        Runs of the next batch.
    names : tuple of str
        Unknowns.
    moves : tuple of float
        What `expected_moves` says of each; empty where nobody asked.
    error_ratio : float
        Largest variance of an emulator over the measurement's, averaged over the posterior.
    tolerance : float
        Ratio that is small enough.
    """

    spent: int
    budget: int
    batch: int
    names: tuple[str, ...] = ()
    moves: tuple[float, ...] = ()
    error_ratio: float = np.inf
    tolerance: float = 0.0

    @property
    def settled(self) -> bool:
        """Whether the next batch is not expected to change an answer."""
        return self.error_ratio <= self.tolerance or self._largest[1] < LARGEST_MOVE

    @property
    def exhausted(self) -> bool:
        """Whether the budget is spent."""
        return self.spent >= self.budget

    @property
    def stop(self) -> bool:
        """Whether to stop, for either reason."""
        return self.settled or self.exhausted

    @property
    def _largest(self) -> tuple[str, float]:
        """Name and size of the largest expected move."""
        pairs = list(zip(self.names, self.moves, strict=bool(self.moves)))
        return max(pairs, key=lambda pair: pair[1], default=("", np.inf))

    @property
    def words(self) -> str:
        """Say why it stops, or what the next batch is for."""
        name, move = self._largest
        if self.error_ratio <= self.tolerance:
            return (
                f"Stopped after {self.spent} runs: the emulators' variance is "
                f"{self.error_ratio:.2g} of the measurements' ({self.tolerance:g} is enough)."
            )
        if self.settled:
            return (
                f"Stopped after {self.spent} runs: {self.batch} more are expected to move no "
                f"interval by more than {100 * move:.0f} % of its length."
            )
        what = f"; {self.batch} more could still move {name} by {100 * move:.0f} % of its interval"
        end = what if np.isfinite(move) else ""
        if self.exhausted:
            return f"The budget of {self.budget} runs is spent{end}."
        return f"{self.spent} of {self.budget} runs{end}."
