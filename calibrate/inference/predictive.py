"""What a posterior expects of readings, those it was fitted to and those it never saw."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import pandas as pd
from scipy import special

from calibrate.arrays import Array
from calibrate.inference.likelihood import log_density, misfit, nodes
from calibrate.inference.problem import Place, Reading

__all__ = ["predictive", "scores"]

_QUANTILES: Final = (0.05, 0.5, 0.95)
_KEPT: Final = 1000  # samples that stand for the posterior


def scores(places: Sequence[Place], samples: Array) -> pd.DataFrame:
    """Return the log predictive density of every reading.

    Parameters
    ----------
    places : sequence of Place
        Their readings may have been held out of the fit.
    samples : (n, K) float64
        Values of equal weight.

    Returns
    -------
    DataFrame
        Columns place, reading, log_score: log of the mean over the samples of the density of all
        levels of the reading at once. Higher is better; the unit is nats.
    """
    rows = []
    for place in places:
        prediction = place.predict(samples)
        for reading in place.readings:
            log_p = log_density(reading, prediction, samples)
            score = float(special.logsumexp(log_p)) - float(np.log(len(samples)))
            rows.append({"place": place.name, "reading": reading.name, "log_score": score})
    return pd.DataFrame(rows, columns=["place", "reading", "log_score"])


def predictive(
    places: Sequence[Place], samples: Array, rng: np.random.Generator, kept: int = _KEPT
) -> pd.DataFrame:
    """Return what is expected of every level of every reading, and how far the measured one is.

    Parameters
    ----------
    places : sequence of Place
    samples : (n, K) float64
        Values of equal weight.
    rng : Generator
    kept : int
        Samples that are used.

    Returns
    -------
    DataFrame
        On the model scale: place, reading, level, measured, se; mean, sd and quantiles q05, q50,
        q95 of the expected output, its emulator's uncertainty and shared errors included, the
        error of the measurement not; z, the normal deviate as unlikely as the measured value, all
        errors counted.
    """
    some = samples[rng.choice(len(samples), min(kept, len(samples)), replace=False)]
    rows = []
    for place in places:
        prediction = place.predict(some)
        for reading in place.readings:
            own = prediction.columns(reading.columns)
            extra = 0.0 if reading.extra is None else np.sum(reading.extra**2, axis=1)
            away = misfit(reading, prediction, some)
            good = np.isfinite(away).all(axis=1)
            expected, variance = (reading.y - away)[good], (own.total + extra)[good]
            drawn = expected + np.sqrt(variance) * rng.standard_normal(expected.shape)
            z = _deviates(reading, away[good], variance)
            for level in range(len(reading.y)):
                row = {"place": place.name, "reading": reading.name, "level": level}
                row |= {"measured": reading.y[level], "se": reading.se[level]}
                spread = variance[:, level].mean() + expected[:, level].var()
                row |= {"mean": expected[:, level].mean(), "sd": np.sqrt(spread)}
                quantiles = np.quantile(drawn[:, level], _QUANTILES)
                row |= dict(zip(("q05", "q50", "q95"), quantiles, strict=True))
                rows.append(row | {"z": z[level]})
    return pd.DataFrame(rows)


def _deviates(reading: Reading, away: Array, variance: Array) -> Array:
    """Return for each level, (L,), the normal deviate as unlikely as the measured value."""
    w, log_weight = nodes(reading.repeats, 1)
    total = np.sqrt(variance[:, :, None] + w * reading.se[:, None] ** 2)  # (n, L, q)
    x = away[:, :, None] / total
    tails = [special.logsumexp(special.log_ndtr(s * x) + log_weight, axis=(0, 2)) for s in (1, -1)]
    below, above = (tail - np.log(len(away)) for tail in tails)
    # The smaller tail keeps its digits.
    left = below < above
    z = special.ndtri_exp(np.minimum(np.where(left, below, above), 0.0))
    return np.asarray(np.where(left, z, -z))
