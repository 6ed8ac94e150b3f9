"""From a problem to its posterior: which sampler, how long, and what it tells."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any, Final, Literal, TypeAlias

import numpy as np

from calibrate.errors import CalibrationError
from calibrate.inference.blocks.joint import weigh_blocks
from calibrate.inference.blocks.structure import split
from calibrate.inference.optimum import best_values
from calibrate.inference.posterior import Posterior
from calibrate.inference.problem import Problem
from calibrate.inference.regions import describe, find_regions
from calibrate.inference.sampler.anneal import anneal
from calibrate.inference.sampler.importance import RELIABLE, Weighted, adapt, take, weigh
from calibrate.inference.sampler.mixture import Mixture
from calibrate.inference.sampler.modes import find_modes
from calibrate.inference.sampler.nested import nested
from calibrate.inference.sampler.target import Target

__all__ = ["METHODS", "sample"]

Method: TypeAlias = Literal["auto", "importance", "blocks", "nested", "annealed"]
METHODS: Final = ("auto", "importance", "blocks", "nested", "annealed")

_FINAL: Final = (8000, 32000)  # draws of the last round; more where few of them count
_CLOUD: Final = 1000
_FEW: Final = 10  # unknowns that need no blocks
_SHARE_MODES: Final = 0.3
_SHARE_ADAPTED: Final = 0.8
_SHARE_SAMPLED: Final = 0.9  # of the work; the rest finds regions and best values


def sample(
    problem: Problem,
    rng: np.random.Generator,
    *,
    method: Method = "auto",
    draws: int = 4000,
    progress: Callable[[float, float], None] | None = None,
    stop: Callable[[], bool] | None = None,
    provenance: Mapping[str, Any] | None = None,
) -> Posterior:
    """Return the posterior of a problem.

    Parameters
    ----------
    problem : Problem
    rng : Generator
        The same generator state gives the same result.
    method : {"auto", "importance", "blocks", "nested", "annealed"}
        ``auto`` is importance sampling, by ``blocks`` where more than ten unknowns fall into such
        that are independent given the others; unless fewer than 500 draws count, then annealing.
        ``nested`` (dynesty) asks for one likelihood at a time: for checks.
    draws : int
        Most samples that are returned; never more than the draws count for.
    progress : callable, optional
        Told the fraction done and the seconds left.
    stop : callable, optional
        Asked between batches of likelihoods; True raises `Stopped`.
    provenance : mapping, optional
        Kept with the result.

    Raises
    ------
    CalibrationError
        If no point of the prior can have given the data, or a method does not suit.
    Stopped
        If the caller wants it.
    """
    start = time.monotonic()
    tell = _Clock(progress, start)
    target = Target(problem, stop or (lambda: False), tell)
    drawn, used = _drawn(target, method, rng)
    count = int(min(draws, max(drawn.size, 1.0)))
    z = drawn.z[rng.permutation(take(drawn.weights, count, rng))]
    tell(_SHARE_SAMPLED)
    samples = problem.space.from_normal(z)
    best = best_values(target, samples)
    regions = describe(problem.space, samples, find_regions(target, z))
    tell(1.0)
    return Posterior(
        problem.space, samples, drawn.log_evidence, drawn.error, best, regions,
        diagnostics={
            "method": used, "calls": target.calls, "effective_size": drawn.size,
            "doubt": drawn.doubt,
            "seconds": time.monotonic() - start,
        },
        provenance=dict(provenance or {}),
    )  # fmt: skip


def _drawn(target: Target, method: Method, rng: np.random.Generator) -> tuple[Weighted, str]:
    """Return draws by the wanted method, and which one it was."""
    if method == "nested":
        return nested(target, rng), "nested"
    if method == "blocks" or (method == "auto" and target.size > _FEW):
        parts = split(target.problem)
        if parts is not None:
            found = weigh_blocks(target, parts, rng)
            if method == "blocks" or found.size >= RELIABLE:
                return found, "blocks"
        elif method == "blocks":
            msg = "method 'blocks': no blocks of unknowns are independent here; use 'auto'"
            raise CalibrationError(msg)
    if method != "annealed":
        proposal = find_modes(target, rng)
        target.progress(_SHARE_MODES)
        proposal = adapt(target, proposal, rng)
        target.progress(_SHARE_ADAPTED)
        found = importance(target, proposal, rng)
        if method == "importance" or found.size >= RELIABLE:
            return found, "importance"
    return anneal(target, _CLOUD, rng), "annealed"


def importance(target: Target, proposal: Mixture, rng: np.random.Generator) -> Weighted:
    """Return weighted draws, more of them where few count and more would be enough.

    Parameters
    ----------
    target : Target
    proposal : Mixture
    rng : Generator
    """
    few, many = _FINAL
    found = weigh(target, proposal, few, rng)
    if found.size >= RELIABLE or found.size * many / few < RELIABLE:
        return found
    return weigh(target, proposal, many, rng)


class _Clock:
    """Tells the caller how far the work is and how long the rest may take."""

    def __init__(self, tell: Callable[[float, float], None] | None, start: float) -> None:
        self._tell, self._start, self._most = tell, start, 0.0

    def __call__(self, fraction: float) -> None:
        self._most = max(self._most, fraction)  # a method that follows another starts again
        if self._tell is not None and self._most > 0.0:
            spent = time.monotonic() - self._start
            self._tell(self._most, spent * (1.0 - self._most) / self._most)
