"""Evidence ratios of nested hypotheses: exact where known, and the same from seed to seed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from calibrate.errors import CalibrationError
from calibrate.inference import Evidence, Place, Problem, evidence, evidence_from
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Source
from calibrate.inference.space import Space, Unknown
from tests.calibrate.inference.linear import direct, exact, linear, normal_space, scalars

SIZE, SE = 4, 0.3
REPEATS = 0.05
"""Nats within which a log evidence ratio repeats between seeds."""


def nested(effect: Prior) -> tuple[Problem, Problem, np.ndarray, np.ndarray]:
    """Return a problem, the same with an effect, the slopes of both, and data with the effect."""
    rng = np.random.default_rng(4)
    slopes, strength = rng.normal(size=(7, SIZE)), rng.normal(size=7)
    y = slopes @ rng.normal(size=SIZE) + 1.2 * strength + SE * rng.normal(size=7)
    emulator = replace(linear(slopes), effects=strength[:, None])
    off = Place("here", emulator, direct(SIZE), (Source(),), scalars(y, [SE] * 7))
    space = normal_space(SIZE)
    base = Problem(space, (off,))
    more = Space((Unknown("tilt", "", effect), *space.unknowns))
    moved = tuple(Source(i + 1) for i in range(SIZE))
    wide = Problem(more, (replace(off, u=moved, strengths=(Source(0),)),))
    return base, wide, np.column_stack([slopes, strength]), y


def ratio(base: Problem, wide: Problem, seed: int) -> tuple[Evidence, Evidence]:
    known = evidence(base, np.random.default_rng(seed))
    return known, evidence_from(known, wide, np.random.default_rng(seed))


def test_ratios_are_exact_and_repeat():
    base, wide, slopes, y = nested(Prior.normal(0.0, 1.0))
    noise = SE**2 * np.eye(7)
    truth = exact(slopes, y, noise)[2] - exact(slopes[:, :SIZE], y, noise)[2]
    assert truth > 1.0
    for seed in (1, 2, 3):
        known, found = ratio(base, wide, seed)
        told = found.drawn.log_evidence - known.drawn.log_evidence
        assert told == pytest.approx(truth, abs=REPEATS)
        assert not found.drawn.doubt
        assert found.drawn.error < 0.011


def test_a_strength_with_a_non_local_prior_has_its_evidence():
    """Under x^2 N(0, 1) zero has no probability, so that two signs are two modes."""
    base, wide, slopes, y = nested(Prior.non_local(1.0))
    _, found = ratio(base, wide, 1)
    x = np.linspace(-8.0, 8.0, 4001)
    density = x**2 * stats.norm.pdf(x)
    noise = SE**2 * np.eye(7) + slopes[:, :SIZE] @ slopes[:, :SIZE].T
    away = y - x[:, None] * slopes[:, SIZE]
    like = stats.multivariate_normal(np.zeros(7), noise).pdf(away)
    truth = np.log(np.sum(density * like) * (x[1] - x[0]))
    assert found.drawn.log_evidence == pytest.approx(truth, abs=REPEATS)


def test_a_hypothesis_with_other_unknowns_is_refused():
    base, wide, *_ = nested(Prior.normal(0.0, 1.0))
    known = evidence(wide, np.random.default_rng(1))
    with pytest.raises(CalibrationError, match="tilt"):
        evidence_from(known, base, np.random.default_rng(1))
