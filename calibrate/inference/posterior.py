"""What is known of the unknowns after the data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.inference.intervals import LEVELS, Interval, regions, shortest
from calibrate.inference.priors import Prior, from_unit
from calibrate.inference.space import Space

__all__ = ["Posterior", "Region"]


@dataclass(frozen=True, eq=False)
class Region:
    """One of the separate regions in which the probability lies.

    Attributes
    ----------
    weight : float
        Its share of the probability.
    low, high : (K,) float64
        Central 90 % of each value inside it.
    mean : (K,) float64
        On the unit ranges, carried back to values.
    """

    weight: float
    low: Array
    high: Array
    mean: Array


@dataclass(frozen=True, eq=False)
class Posterior:
    """Draws of equal weight and what a sampler knows beside them.

    Attributes
    ----------
    space : Space
        Unknowns and ties; names and ranges of the columns.
    samples : (n, K) float64
        Values, in the unknowns' units; the last columns are mean and spread of each tie.
    log_evidence, log_evidence_error : float
        Logarithm of the probability of the data over the prior, and its standard error.
    best : (K,) float64
        Most probable values of which everyone asked for lies in its 68 % interval.
    regions : tuple of Region
        Separate regions, the most probable first; one where the probability hangs together.
    diagnostics : mapping of str to str or float
        How the draws came about: method, likelihood calls, effective size, seconds, and the
        doubt, in words, where the error of the evidence is not to be trusted.
    provenance : mapping
        What the caller wants to keep with it.
    """

    space: Space
    samples: Array
    log_evidence: float
    log_evidence_error: float
    best: Array
    regions: tuple[Region, ...]
    diagnostics: Mapping[str, Any] = field(default_factory=dict)
    provenance: Mapping[str, Any] = field(default_factory=dict)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the columns of `samples`."""
        return self.space.names

    @property
    def doubt(self) -> str:
        """Why the error of the evidence is not to be trusted; empty where it is."""
        return str(self.diagnostics.get("doubt", ""))

    def column(self, name: str) -> Array:
        """Return the samples of one unknown, (n,)."""
        return np.asarray(self.samples[:, self.space.index(name)])

    def interval(self, name: str, level: float) -> Interval:
        """Return the shortest span of one unknown that holds `level`, in its unit."""
        return interval_of(self.space, self.samples, self.space.index(name), level)

    def correlation(self) -> pd.DataFrame:
        """Return the correlations of the values on their unit ranges, nuisances left out."""
        asked = list(self.space.asked)
        names = [self.names[i] for i in asked]
        units = self.space.units(self.samples)[:, asked]
        with np.errstate(invalid="ignore", divide="ignore"):
            matrix = np.atleast_2d(np.corrcoef(units, rowvar=False))
        return pd.DataFrame(np.nan_to_num(matrix), index=names, columns=names)

    def table(self) -> pd.DataFrame:
        """Return a row for every unknown that is asked for.

        Returns
        -------
        DataFrame
            Index ``name``; best, mean, sd, then low and high of the 68, 90 and 95 % intervals and
            whether each end is open.
        """
        rows = []
        for i in self.space.asked:
            values = self.samples[:, i]
            row: dict[str, Any] = {"name": self.names[i], "best": float(self.best[i])}
            row |= {"mean": float(values.mean()), "sd": float(values.std(ddof=1))}
            for level in LEVELS:
                span = interval_of(self.space, self.samples, i, level)
                for key in ("low", "high", "open_low", "open_high"):
                    row[f"{key}_{round(100 * level)}"] = getattr(span, key)
            rows.append(row)
        return pd.DataFrame(rows).set_index("name")

    def draws(self, count: int, rng: np.random.Generator) -> Array:
        """Return some of the samples without repetition, (count, K), all if there are fewer."""
        size = min(count, len(self.samples))
        return np.asarray(self.samples[rng.choice(len(self.samples), size=size, replace=False)])


def interval_of(space: Space, samples: Array, column: int, level: float) -> Interval:
    """Return the shortest interval of a column, found on its unit range, in its unit."""
    prior = space.priors[column]
    if not prior.bounded:
        return shortest(samples[:, column], level, prior.low, prior.high)
    unit = np.clip(space.unit(samples[:, column], column), 0.0, 1.0)
    return _in_its_unit(shortest(unit, level, 0.0, 1.0), prior)


def regions_of(space: Space, samples: Array, column: int, level: float) -> list[Interval]:
    """Return the separate intervals of a column, found on its unit range, in its unit."""
    prior = space.priors[column]
    if not prior.bounded:
        return regions(samples[:, column], level, prior.low, prior.high)
    unit = np.clip(space.unit(samples[:, column], column), 0.0, 1.0)
    return [_in_its_unit(span, prior) for span in regions(unit, level, 0.0, 1.0)]


def _in_its_unit(span: Interval, prior: Prior) -> Interval:
    ends = from_unit(np.array([span.low, span.high]), prior.low, prior.high, prior.spacing)
    return Interval(float(ends[0]), float(ends[1]), span.open_low, span.open_high)
