"""Proposals that are fitted to weighted points."""

from __future__ import annotations

import numpy as np
import pytest

from calibrate.inference.sampler.mixture import Mixture


def test_a_proposal_is_not_fitted_to_the_one_point_that_has_the_weight(rng):
    z = rng.standard_normal((1000, 2))
    z[0] = (6.0, 0.0)
    weights = np.full(1000, 0.1 / 999)
    weights[0] = 0.9
    found = Mixture(np.ones(1), np.zeros((1, 2)), np.eye(2)[None], 8.0).refitted(z, weights)
    # Held to 0.005 beside the 0.1 of all others, the point moves the mean by 6 * 0.005 / 0.105.
    assert found.means[0] == pytest.approx([6.0 / 21.0, 0.0], abs=0.1)


def test_points_of_one_weight_all_count(rng):
    z = 3.0 + rng.standard_normal((50, 1))
    found = Mixture(np.ones(1), np.zeros((1, 1)), np.eye(1)[None], 8.0)
    found = found.refitted(z, np.full(50, 0.02), 5)
    # The mixture keeps a 51st of where it was.
    assert found.means[0, 0] == pytest.approx(z.mean(), abs=0.1)
