"""The highest of many hills is found, also where hardly any start leads to it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import special

from calibrate.inference.likelihood import IMPOSSIBLE
from calibrate.inference.sampler.importance import adapt, weigh
from calibrate.inference.sampler.modes import find_modes
from calibrate.inference.sampler.target import central_derivatives, log_prior

SIZE, DECOYS = 8, 30
HIGHER = 6.0  # nats that the evidence of one hill lies above that of each of the others
WIDTHS = np.concatenate([[0.2], np.full(DECOYS, 0.5)])


class Hills:
    """A posterior of normal hills on a sphere that the prior favours, the first the highest."""

    def __init__(self, seed: int) -> None:
        middles = np.random.default_rng(seed).standard_normal((DECOYS + 1, SIZE))
        self.middles = middles * 2.0 / np.linalg.norm(middles, axis=1)[:, None]
        # Normal densities: what each adds to the evidence is its weight.
        self.log_weights = np.concatenate([[HIGHER], np.zeros(DECOYS)])
        self.size = SIZE

    def progress(self, fraction: float, /) -> None:
        """Tell nobody."""

    def log_posterior(self, z):
        """Return the log density, (n,)."""
        square = np.sum((z[:, None] - self.middles) ** 2, axis=2) / WIDTHS**2
        volume = SIZE * np.log(WIDTHS * np.sqrt(2.0 * np.pi))
        hills = special.logsumexp(self.log_weights - 0.5 * square - volume, axis=1)
        return np.where(log_prior(z) > IMPOSSIBLE, hills, IMPOSSIBLE)

    def derivatives(self, z):
        """Return gradient and Hessian."""
        return central_derivatives(self.log_posterior, z)


@pytest.mark.parametrize("seed", range(12))
def test_the_highest_of_many_hills_is_found(seed):
    hills = Hills(seed)
    rng = np.random.default_rng(100 + seed)
    found = find_modes(hills, rng)
    away = np.linalg.norm(found.means - hills.middles[0], axis=1)
    assert away[np.argmax(found.weights)] < 0.25 * WIDTHS[0]  # at its top, not on its slope
    # Thirty others add e^-6 of the first each: missing all of them costs 0.072 nats.
    drawn = weigh(hills, adapt(hills, found, rng), 4000, rng)
    truth = special.logsumexp(hills.log_weights)
    assert drawn.log_evidence == pytest.approx(truth, abs=0.072 + 4.0 * drawn.error)


class Rounded(Hills):
    """The same posterior as another processor rounds it."""

    def log_posterior(self, z):
        """Return the log density with other last digits, (n,)."""
        digits = np.random.default_rng(len(z)).standard_normal(len(z))
        return super().log_posterior(z) * (1.0 + 1e-14 * digits)


def test_no_last_digit_becomes_another_proposal():
    # Second differences lose half of the digits, and one proposal that is taken by one processor
    # and not by another makes all draws behind it, and the runs chosen from these, others.
    here, there = (find_modes(kind(3), np.random.default_rng(103)) for kind in (Hills, Rounded))
    for name in ("weights", "means", "covariances"):
        np.testing.assert_array_equal(getattr(there, name), getattr(here, name))
