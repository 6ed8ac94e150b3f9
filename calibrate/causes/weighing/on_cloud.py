"""Hypotheses weighed on one cloud of draws, which grows where one of them has too few."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.candidates import Board, doubt_about
from calibrate.causes.strengths.about import Span, about_of, span_of
from calibrate.causes.weighing.bases import base_modes
from calibrate.causes.weighing.cloud import FEW, cloud_of, effective, fitted, mixture_of
from calibrate.causes.weighing.effects import Added, added_by
from calibrate.causes.weighing.evidences import Effort, Evidences, without
from calibrate.causes.weighing.hypotheses import Weighed, rough_evidence, summed, weigh
from calibrate.causes.weighing.modes import Mode, mode_near
from calibrate.causes.weighing.pairs import promising
from calibrate.causes.weighing.tangent import tangent_at
from calibrate.causes.weighing.unknown import slab_gains, slab_weight, slabs_of
from calibrate.inference.sampler.mixture import Mixture

__all__ = ["MATTERS", "OnCloud"]

PRIOR_DRAWS: Final = 3000
AROUND: Final = 600
"""Draws around the modes of the base model."""
EACH: Final = 120
"""Draws that are added for a hypothesis that too few draws serve."""
ROUNDS: Final = 6
LEADING: Final = 6
"""Hypotheses that are weighed exactly while more is drawn."""
CLOSE: Final = 5.0
"""Nats below the most probable within which one of them gets more draws."""
SETTLED: Final = 0.5
"""Of the effective draws that a hypothesis needs by its grid, those that it needs exactly."""
MATTERS: Final = 8.0
"""Nats below the most probable within which a hypothesis matters."""
CLOSER: Final = 3
"""Times that leading causes are looked for about the strengths that were found, at most."""
SCREENED: Final = 2
"""Single causes from whose heaviest draws all pairs are looked at, besides the base model."""
PAIR_PRICE: Final = 4.0
"""Nats by which a pair is less probable before the data than a single cause, about."""


class OnCloud:
    """A weighing under way: exact up to the number of draws, for few unknowns."""

    def __init__(self, board: Board, rng: np.random.Generator, effort: Effort) -> None:
        self.effort = effort
        self.board, self.problem, self.rng = board, board.problem, rng
        self.wide = board.with_doubts()
        self.priors = {one.name: board.strength_prior(one) for one in self.wide.candidates}
        self.bases: list[Mode] = []
        self.added: dict[str, Added] = {}
        self.kept: list[tuple[str, ...]] = []
        self.heights: dict[tuple[str, ...], float] = {}
        self.sought: dict[tuple[str, ...], Mode] = {}
        self.tell: Callable[[float], None] = lambda _part: None

    def find_base(self) -> None:
        """Draw from the prior and around the modes of the base model."""
        size = self.problem.space.size
        self.cloud = cloud_of(self.problem, Mixture.prior(size), PRIOR_DRAWS, self.rng)
        self.bases = base_modes(self.problem, self.rng)
        around = mixture_of(
            [one.z for one in self.bases],
            [1.2 * one.covariance for one in self.bases],
            [1.0] * len(self.bases),
        )
        self.kept = [(), *((one.name,) for one in self.board.candidates)]
        self.added = {one.name: added_by(self.cloud.bench, one) for one in self.board.candidates}
        self._grow(around, AROUND)

    def _grow(self, mixture: Mixture, count: int) -> None:
        """Draw more, and learn what every cause adds there."""
        before = len(self.cloud)
        self.cloud = self.cloud.grown(mixture, count, self.rng)
        new = self.cloud.bench.rows(np.arange(before, before + count))
        for one in self.board.candidates:
            self.added[one.name] = self.added[one.name].joined(added_by(new, one))
        self.before = self.cloud.log_weight
        self.log_weight = self.before + self.cloud.bench.rough

    def _rough(self, names: tuple[str, ...]) -> Array:
        found = rough_evidence(
            self.cloud,
            self.log_weight,
            [self.added[name] for name in names],
            [self.priors[name] for name in names],
        )
        return np.asarray(found + self.wide.constant(names))

    def refine(self) -> None:
        """Draw more for every hypothesis that matters and that too few draws serve."""
        self._refine(self.kept)

    def _refine(self, hypotheses: Sequence[tuple[str, ...]]) -> None:
        open_ = list(hypotheses)
        rough: dict[tuple[str, ...], Array] = {}
        for number in range(ROUNDS):
            rough |= {names: self._rough(names) for names in open_}
            thin = self._thin(rough, MATTERS + 4.0 * max(2 - number, 0))
            if not thin:
                return
            # One that was left alone may matter now; it is looked at on all draws again.
            late = [names for names in thin if names not in open_]
            rough |= {names: self._rough(names) for names in late}
            self._draw_for({names: rough[names] for names in thin})
            # What has enough draws is not looked at again: it keeps the height it had.
            open_ = thin

    def look_closer(self) -> None:
        """Look for the leading causes about the strengths that were found.

        What a cause adds is a parabola of its strength only nearly: as good as another for a weak
        one, while a strong one is found where the parabola is right.
        """
        for _ in range(CLOSER):
            singles = [(one.name,) for one in self.board.candidates if not one.switch]
            leading = sorted(singles, key=lambda names: -self.heights[names])[:LEADING]
            known = {one.name: one.about for one in self.board.candidates}
            new = {name: about_of(self._span((name,)), known[name]) for (name,) in leading}
            moved = {name: at for name, at in new.items() if at is not None}
            if not moved:
                return
            self._look_about(moved)

    def _span(self, names: tuple[str, ...]) -> Span:
        """Return between which strengths a cause lies."""
        one = self._weighed(names)
        return span_of(one.strengths[:, 0], one.weights)

    def _look_about(self, strengths: Mapping[str, tuple[float, float]]) -> None:
        """Draw again where hypotheses lie that are looked for about these strengths."""
        self._told_about(strengths)
        for one in self.board.members(tuple(strengths)):
            self.added[one.name] = added_by(self.cloud.bench, one)
        self._refine([(name,) for name in strengths])

    def _told_about(self, strengths: Mapping[str, tuple[float, float]]) -> None:
        self.board = self.board.about(strengths)
        self.wide = self.board.with_doubts()
        self.sought = {n: one for n, one in self.sought.items() if not set(n) & strengths.keys()}

    def _thin(
        self, rough: Mapping[tuple[str, ...], Array], matters: float
    ) -> list[tuple[str, ...]]:
        """Return the hypotheses that matter and that too few draws serve."""
        height = {
            names: _log_sum(one) - PAIR_PRICE * max(len(names) - 1, 0)
            for names, one in rough.items()
        }
        self.heights |= height
        best = max(self.heights.values())
        wanted = [names for names, one in height.items() if one > best - matters or not names]
        return [names for names in wanted if effective(rough[names]) < self.effort.enough]

    def _draw_for(self, log_weights: Mapping[tuple[str, ...], Array]) -> None:
        """Draw more for hypotheses with these weights (n,) of the draws."""
        around = [fitted(self.cloud, one) for one in log_weights.values()]
        around += [
            self._mode(names, one)
            for names, one in log_weights.items()
            if names in self.kept and effective(one) < FEW * self.cloud.z.shape[1]
        ]
        means, covariances = zip(*around, strict=True)
        self._grow(mixture_of(means, covariances, [1.0] * len(around)), EACH * len(log_weights))

    def _mode(self, names: tuple[str, ...], log_weight: Array) -> tuple[Array, Array]:
        """Return middle and width of a hypothesis where it is highest, for few draws tell none."""
        if names not in self.sought:
            start = self.cloud.z[int(np.argmax(log_weight + self.cloud.log_drawn))]
            priors = [self.priors[name] for name in names]
            self.sought[names] = mode_near(self.problem, start, self.wide.members(names), priors)
        mode = self.sought[names]
        return mode.z, 1.2 * mode.covariance

    def find_pairs(self) -> None:
        """Look at all pairs roughly, and at those that count on the cloud."""
        rough = {n: self._rough(n) for n in self.kept}
        self._keep_pairs(
            {n: _log_sum(one) for n, one in rough.items()},
            lambda n: self.cloud.z[int(np.argmax(rough[n]))],
        )

    def _keep_pairs(
        self, heights: Mapping[tuple[str, ...], float], at: Callable[[tuple[str, ...]], Array]
    ) -> None:
        """Keep the pairs that may count, and weigh them.

        Parameters
        ----------
        heights : mapping
            Log evidence of the hypotheses that were kept so far, about.
        at : callable
            Tells a likely point z of one of them.
        """
        names = [one.name for one in self.board.candidates]
        pairs = [(a, b) for a, b in itertools.combinations(names, 2) if self.board.together(a, b)]
        if not pairs:
            return
        singles = sorted((n for n in heights if n), key=lambda n: -heights[n])
        ranked = [
            promising(
                tangent_at(self.problem, at(place)),
                self.board,
                self.priors,
                pairs,
                MATTERS - PAIR_PRICE,
            )
            for place in ((), *singles[:SCREENED])
        ]
        # The best from everywhere first: what one place overrates leaves room for the others.
        turns = itertools.zip_longest(*ranked)
        chosen = dict.fromkeys(pair for turn in turns for pair in turn if pair)
        self.kept += list(chosen)[: self.effort.pairs]
        self.refine()

    def settle(self) -> None:
        """Draw more where what leads has too few draws when it is weighed exactly.

        Where a cause is strong, weights as the grids see them are not those of the likelihood.
        """
        leading = sorted(self.kept, key=lambda names: -self.heights[names])[:LEADING]
        for _ in range(ROUNDS):
            exact = [*(self._weighed(names) for names in leading), *self._slabs()]
            best = max(one.log_evidence for one in exact)
            thin = [
                one for one in exact
                if one.size < SETTLED * self.effort.enough and one.log_evidence > best - CLOSE
            ]  # fmt: skip
            if not thin:
                return
            self._draw_for({one.names: one.log_weight for one in thin})

    def _weighed(self, names: tuple[str, ...]) -> Weighed:
        return weigh(
            self.cloud,
            self.before,
            self.log_weight,
            self.wide.members(names),
            [self.added[name] for name in names],
            [self.priors[name] for name in names],
            self.wide.constant(names),
            self.rng,
        )

    def _slabs(self) -> list[Weighed]:
        """Weigh what is in no library, wherever it may be."""
        gains = slab_gains(self.cloud.bench, list(self.board.spreads))
        none = np.zeros((len(self.cloud), 0))
        base = self.before + self.cloud.bench.log_likelihood + self.board.constant(())
        return [
            summed((slab.name,), base + slab_weight(slab, gains), none, self.cloud.bench.terms)
            for slab in slabs_of(self.problem)
        ]

    def finished(self) -> Evidences:
        """Weigh everything exactly."""
        weighed = self._all()
        doubts = self._doubts({names: weighed[names].log_evidence for names in self.kept})
        return Evidences(self.board, self.cloud, weighed, tuple(self.bases), doubts)

    def _all(self) -> dict[tuple[str, ...], Weighed]:
        weighed = {names: self._weighed(names) for names in self.kept}
        return weighed | {one.names: one for one in self._slabs()}

    def _doubts(
        self, found: Mapping[tuple[str, ...], float]
    ) -> dict[tuple[str, ...], tuple[float, ...]]:
        """Return log evidences with a doubt alone in place of each member, where they matter."""
        fair = {names: one - PAIR_PRICE * max(len(names) - 1, 0) for names, one in found.items()}
        limit = max(fair.values()) - MATTERS
        return {
            names: tuple(self._doubted(names, k) for k in range(len(names)))
            for names, one in found.items()
            if fair[names] > limit and names and all(one > found[rest] for rest in without(names))
        }

    def _doubted(self, names: tuple[str, ...], k: int) -> float:
        """Return the log evidence of a hypothesis with the doubt about member k in its place."""
        doubt = doubt_about(names[k])
        if doubt not in self.priors:
            return -np.inf
        self.added[doubt] = self.added[names[k]].silent
        return self._doubt_weighed((*names[:k], doubt, *names[k + 1 :]))

    def _doubt_weighed(self, names: tuple[str, ...]) -> float:
        return self._weighed(names).log_evidence


def _log_sum(log_weight: Array) -> float:
    top = float(log_weight.max())
    return top + float(np.log(np.mean(np.exp(log_weight - top))))
