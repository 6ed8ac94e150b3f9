"""Hypotheses of many unknowns, each weighed where it is highest.

With ten unknowns or so a cloud of draws reaches every hypothesis. With thirty (two materials on
three walls) it does not: around a mode one draw in a thousand counts, evidences are off by several
nats, and what leads is a matter of luck. So evidences are those of a normal distribution around the
highest point (Laplace's method); draws around the modes tell strengths and residuals, none of them
heavier than a part of all. Where a cause leads to a higher point of the base model, everything is
looked at again from there.

References
----------
Ionides, Journal of Computational and Graphical Statistics 17 (2008), 295: truncated weights.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from scipy import special

from calibrate.arrays import Array
from calibrate.causes.candidates import WIDTH, Board
from calibrate.causes.strengths.about import Span
from calibrate.causes.weighing.bases import base_modes
from calibrate.causes.weighing.cloud import cloud_of, mixture_of
from calibrate.causes.weighing.effects import added_by
from calibrate.causes.weighing.evidences import Effort
from calibrate.causes.weighing.hypotheses import Weighed
from calibrate.causes.weighing.modes import Mode, mode_near
from calibrate.causes.weighing.on_cloud import MATTERS, OnCloud
from calibrate.causes.weighing.unknown import SIZES, Slab, slabs_of, widened
from calibrate.inference.sampler.mixture import effective_size

__all__ = ["ByModes", "evened"]

ERROR: Final = 1.0
"""Nats by which an evidence of a base model with 30 unknowns differed over five seeds; where little
is straight the method itself may be off by more."""
EACH: Final = 60
"""Draws around a mode,"""
LEADING: Final = 400
"""and around one of those that matter."""
LONG: Final = 60
"""Steps to a mode of the base model, on which all else stands."""
STARTS: Final = 3
"""Best modes of the base model, and those of leading causes, from which it is looked for again;"""
AGAIN: Final = 3
"""and how often all is looked at again, at most, where it lies"""
HIGHER: Final = 0.5
"""nats higher than was known."""
FAR: Final = 12.0
"""Nats below the best from which a hypothesis is not looked at again."""
PARTS: Final = 20
"""The heaviest draw of a hypothesis holds at most this part of all weight."""
NINE_TENTHS: Final = 1.28
"""Standard deviations below which a normal distribution has nine tenths."""
WIDER: Final = 1.2
"""Factor on the covariance of a mode where draws are made."""


class ByModes(OnCloud):
    """A weighing under way, by the modes of the hypotheses."""

    def __init__(self, board: Board, rng: np.random.Generator, effort: Effort) -> None:
        super().__init__(board, rng, effort)
        self.modes: dict[tuple[str, ...], Mode] = {}
        self.slabs: dict[tuple[str, ...], float] = {}
        self.looked: dict[tuple[str, ...], list[Mode]] = {}

    def find_base(self) -> None:
        """Look for the modes of the base model."""
        found = base_modes(self.problem, self.rng)
        self._start_from([mode_near(self.problem, one.z, rounds=LONG) for one in found[:STARTS]])
        self.kept = [(), *((one.name,) for one in self.board.candidates)]

    def _start_from(self, modes: Sequence[Mode]) -> None:
        self.bases = sorted(modes, key=lambda one: -one.log_evidence)
        self.modes[()] = self.bases[0]

    def refine(self) -> None:
        """Look for the modes of the hypotheses that were not looked at."""
        for k, names in enumerate(self.kept):  # most of the work of a study of many unknowns
            self._look_at([names])
            self.tell((k + 1) / len(self.kept))
        for _ in range(AGAIN):
            if not self._higher():
                break
            best = max(self._log_evidence(names) for names in self.kept)
            # What was far below stays far below.
            self._look_at([n for n in self.kept if self._log_evidence(n) > best - FAR])
        self.heights = {names: self._log_evidence(names) for names in self.kept}

    def _span(self, names: tuple[str, ...]) -> Span:
        mode = self.modes[names]
        (x,), ((slope, bend),) = mode.strengths, mode.parts
        here = slope + 2.0 * x * bend
        told = here @ np.linalg.solve(mode.tangent.covariance, here)
        wide = NINE_TENTHS / np.sqrt(told + 1.0 / WIDTH**2)
        return float(x - wide), float(x), float(x + wide)

    def _look_about(self, strengths: Mapping[str, tuple[float, float]]) -> None:
        self._told_about(strengths)
        for name in strengths:
            self.looked.pop((name,), None)
        self._look_at([(name,) for name in strengths])
        self.heights |= {(name,): self._log_evidence((name,)) for name in strengths}

    def _look_at(self, hypotheses: Sequence[tuple[str, ...]]) -> None:
        for names in hypotheses:
            self.modes[names] = self._highest(names)

    def _higher(self) -> bool:
        """Whether the base model lies higher where a cause led to; then all are looked at again."""
        leading = sorted(filter(None, self.kept), key=lambda names: -self._log_evidence(names))
        found = [mode_near(self.problem, self.modes[n].z, rounds=LONG) for n in leading[:STARTS]]
        best = max(found, key=lambda one: one.log_evidence, default=self.bases[0])
        if best.log_evidence < self.bases[0].log_evidence + HIGHER:
            return False
        self._start_from([best, self.bases[0]])
        return True

    def _highest(self, names: tuple[str, ...]) -> Mode:
        """Return the best mode found so far, and from those of the base model or of the members."""
        if not names:
            return self.modes[()]
        # Doubts alone need not have been looked for.
        parts = [self.modes[(name,)] for name in names if (name,) in self.modes]
        starts = parts if len(names) > 1 else self.bases[:2]
        old = self.looked.setdefault(names, [])
        new = [one for one in starts if not any(one is known for known in old)]
        old += new
        priors = [self.priors[name] for name in names]
        members = self.wide.members(names)
        found = [mode_near(self.problem, one.z, members, priors) for one in new]
        found += [self.modes[names]] if names in self.modes else []
        return max(found, key=lambda one: one.log_evidence)

    def _log_evidence(self, names: tuple[str, ...]) -> float:
        return self.modes[names].log_evidence + self.wide.constant(names)

    def find_pairs(self) -> None:
        """Look at all pairs roughly, and for the modes of those that may count."""
        self._keep_pairs(self.heights, lambda names: self.modes[names].z)

    def settle(self) -> None:
        """Draw around the modes, those of what is in no library among them."""
        for slab in slabs_of(self.problem):
            self._find_slab(slab)
        heights = self.heights | self.slabs
        best = max(heights.values())
        counts = [LEADING if heights[n] > best - MATTERS else EACH for n in self.modes]
        around = mixture_of(
            [one.z for one in self.modes.values()],
            [WIDER * one.covariance for one in self.modes.values()],
            [float(count) for count in counts],
        )
        points = [one.z for one in self.modes.values()]
        self.cloud = cloud_of(self.problem, around, sum(counts), self.rng, points)
        self.added = {one.name: added_by(self.cloud.bench, one) for one in self.board.candidates}
        self.before = self.cloud.log_weight
        self.log_weight = self.before + self.cloud.bench.rough

    def _find_slab(self, slab: Slab) -> None:
        """Look for the highest point of what is in no library, of every size."""
        start, modes = self.modes[()], []
        for size in SIZES:
            wide = widened(self.problem, slab, size, self.board.spreads)
            start = mode_near(wide, start.z)
            modes.append(start)
        each = [one.log_evidence for one in modes]
        self.modes[(slab.name,)] = modes[int(np.argmax(each))]
        mean = float(special.logsumexp(each)) - np.log(len(SIZES))
        self.slabs[(slab.name,)] = mean + self.board.constant(())

    def _all(self) -> dict[tuple[str, ...], Weighed]:
        heights = self.heights | self.slabs
        return {names: _at_mode(one, heights[names]) for names, one in super()._all().items()}

    def _doubt_weighed(self, names: tuple[str, ...]) -> float:
        self._look_at([names])
        return self._log_evidence(names)


def _at_mode(one: Weighed, log_evidence: float) -> Weighed:
    """Return a hypothesis with the evidence by its mode, and draws none of which is too heavy."""
    held = evened(one.log_weight)
    held += log_evidence + np.log(len(held)) - float(special.logsumexp(held))
    size = effective_size(np.exp(held - held.max()))
    return replace(one, log_evidence=log_evidence, error=ERROR, size=size, log_weight=held)


def evened(log_weight: Array) -> Array:
    """Return log weights cut to one height, so that no draw holds more than one in `PARTS`, (n,).

    Draws of one weight, where fewer than that many have any.
    """
    some = np.isfinite(log_weight)
    order = np.sort(log_weight[some])[::-1]
    lighter = np.logaddexp.accumulate(order[::-1])[::-1]
    for cut in range(min(PARTS, len(order))):
        # Were the `cut` heaviest as heavy as `top`, they and the others would be PARTS times top.
        top = float(lighter[cut]) - np.log(PARTS - cut)
        if top >= order[cut]:
            return np.asarray(np.minimum(log_weight, top))
    return np.where(some, 0.0, -np.inf)
