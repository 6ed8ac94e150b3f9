"""The result of a stage from its surrogates: values, intervals, and what is said of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.inference import Interval, determined
from calibrate.inference.intervals import LEVELS
from calibrate.scales import backward, slope
from calibrate.significance import worst_of
from calibrate.staged.bench import Fitted
from calibrate.staged.crossing import judge, least_squares_sentence
from calibrate.staged.posterior.cloud import CloudPosterior
from calibrate.staged.problem import StagePosterior, common_covariance
from calibrate.staged.result import StageResult, TargetFit
from calibrate.staged.samples import Freed, Planned

__all__ = ["intervals_of", "result_of", "values_of"]

SHARE: Final = 0.90
"""Of the interval outside which the paper's point is remarked upon."""


def result_of(
    fitted: Fitted,
    planned: Sequence[Planned],
    runs: pd.DataFrame,
    rng: np.random.Generator,
) -> StageResult:
    """Return the result of a stage.

    Parameters
    ----------
    fitted : Fitted
    planned : sequence of Planned
        What was run.
    runs : DataFrame
        Results in the same order.
    rng : Generator
        For draws of the posterior.
    """
    bench = fitted.bench
    posterior = fitted.posterior(rng)
    best = posterior.best()
    least, objective = fitted.least_squares()
    fits = _target_fits(fitted, best)
    intervals = intervals_of(posterior, bench.freed)
    verdict = judge(
        bench.targets,
        np.array([fit.measured.value for fit in fits]),
        fitted.averages,
        [fit.z for fit in fits],
        posterior,
    )
    paper = values_of(bench.freed, least)
    common = {name: levels[SHARE] for name, levels in intervals.items()}
    more = least_squares_sentence(paper, common, SHARE)
    undetermined: tuple[str, ...] = ()
    if isinstance(posterior, CloudPosterior):
        told = determined(posterior.drawn, rng)
        more += told.sentences
        undetermined = tuple(told.table.index[~told.table["determined"].to_numpy(bool)])
    return StageResult(
        stage=bench.stage,
        freed=bench.freed,
        fits=tuple(fits),
        best=best,
        found=_inside(values_of(bench.freed, best), intervals),
        intervals=intervals,
        least_squares=paper,
        objective=objective,
        posterior=posterior,
        verdict=replace(verdict, sentences=(*verdict.sentences, *more)),
        planned=tuple(planned),
        runs=runs,
        undetermined=undetermined,
    )


def values_of(freed: Freed, point: Array) -> dict[str, float]:
    """Return a point of the unit cube, (d,), in the parameters' own units."""
    return dict(zip(freed.names, map(float, freed.values(point[None])[0]), strict=True))


def intervals_of(posterior: StagePosterior, freed: Freed) -> dict[str, dict[float, Interval]]:
    """Return the intervals in the parameters' own units, by parameter and level."""
    result: dict[str, dict[float, Interval]] = {name: {} for name in freed.names}
    for level in LEVELS:
        unit = [posterior.interval(i, level) for i in range(posterior.size)]
        low, high = freed.values(np.array([[one.low for one in unit], [one.high for one in unit]]))
        for i, name in enumerate(freed.names):
            ends = float(low[i]), float(high[i])
            result[name][level] = Interval(*ends, unit[i].open_low, unit[i].open_high)
    return result


def _inside(
    found: dict[str, float], intervals: dict[str, dict[float, Interval]]
) -> dict[str, float]:
    """Return values inside their intervals; the way through units may cost the last digit."""
    narrow = {name: levels[LEVELS[0]] for name, levels in intervals.items()}
    return {
        name: min(max(value, narrow[name].low), narrow[name].high) for name, value in found.items()
    }


def _target_fits(fitted: Fitted, best: Array) -> list[TargetFit]:
    fits = []
    targets, places, scores = fitted.bench.targets, fitted.problem.places, fitted.z(best)
    for target, place, surrogate, z in zip(targets, places, fitted.surrogates, scores, strict=True):
        mean, variance = surrogate.average(best[None])
        shared = float(common_covariance(place.readings[0]).mean())
        error = float(np.sqrt(variance[0] + shared))
        value = float(backward(target.model_scale, mean)[0])
        fits.append(
            TargetFit(
                target=target,
                measured=fitted.bench.measured(target),
                surrogate=surrogate,
                predicted=value,
                predicted_sd=error / slope(target.model_scale, value),
                z=worst_of([float(one) for one in z]),
            )
        )
    return fits
