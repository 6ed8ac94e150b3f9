"""Scores of answers: parameter error, prediction error, coverage, cost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from benchmarks.peers.apparatus import RANGES
from benchmarks.peers.problem import Array


def score_table(lines: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """Return a row per answer.

    Parameters
    ----------
    lines : sequence of mapping
        As `campaign.run_campaign` wrote them.

    Returns
    -------
    DataFrame
        truth, method, budget, runs, failed, particle_steps; error_NAME: found minus true as a part
        of the range; error: root mean square of the six; covered: share of the six 90 % intervals
        that hold the truth, and width: their mean width as a part of the range, nan without
        intervals; prediction: mean over the unseen measurements of the squared difference in
        standard errors, less what the scatter of the check runs adds to it.
    """
    return pd.DataFrame([_row(line) for line in lines])


def _row(line: Mapping[str, Any]) -> dict[str, Any]:
    low, high = np.array(list(RANGES.values())).T
    true = np.array(line["true_theta"])
    errors = (np.array(line["theta"]) - true) / (high - low)
    row = {
        name: line[name]
        for name in ("truth", "method", "budget", "runs", "failed", "particle_steps")
    }
    row |= {f"error_{name}": e for name, e in zip(RANGES, errors, strict=True)}
    row["error"] = float(np.sqrt(np.mean(errors**2)))
    row["covered"] = row["width"] = np.nan
    if line["interval"] is not None:
        ends = np.clip(np.array(line["interval"]).T, low, high)
        row["covered"] = float(np.mean((ends[0] <= true) & (true <= ends[1])))
        row["width"] = float(np.mean((ends[1] - ends[0]) / (high - low)))
    row["prediction"] = float(np.mean([_squared(line, name) for name in line["unseen"]]))
    return row


def _squared(line: Mapping[str, Any], name: str) -> float:
    """Return the squared difference of a prediction in standard errors, without check noise.

    The mean of n runs scatters by their variance over n around what the answer really predicts;
    taking that off leaves the square unbiased, so that it may be negative for one answer.
    """
    values: Array = np.array([np.nan if y is None else y for y in line["predicted"][name]])
    values = values[np.isfinite(values)]
    noise = np.var(values, ddof=1) / values.size
    error = line["unseen_error"][name]
    return float(((values.mean() - line["unseen"][name]) ** 2 - noise) / error**2)


def common_truths(scores: pd.DataFrame, methods: Sequence[str] = ()) -> pd.DataFrame:
    """Return the answers that can be compared at each budget.

    Parameters
    ----------
    scores : DataFrame
        From `score_table`.
    methods : sequence of str
        All by default.

    Returns
    -------
    DataFrame
        Of every budget the truths for which all methods that have answered with it have done so;
        a method that has done less than half of what the furthest one has is left out there.
    """
    wanted = scores[scores["method"].isin(methods)] if methods else scores
    parts = []
    for _, rows in wanted.groupby("budget"):
        done = rows.groupby("method")["truth"].transform("nunique")
        far = rows[done >= 0.5 * done.max()]
        parts.append(far[far["truth"].isin(_shared(far, "method"))])
    return pd.concat(parts) if parts else wanted


def _shared(rows: pd.DataFrame, column: str) -> set[int]:
    """Return the truths that every value of a column has."""
    return set.intersection(*(set(group["truth"]) for _, group in rows.groupby(column)))


def paired(scores: pd.DataFrame, cells: Sequence[tuple[str, int]]) -> pd.DataFrame:
    """Return `summary` of some methods at some budgets over the truths that all of them have.

    Parameters
    ----------
    scores : DataFrame
        From `score_table`.
    cells : sequence of (str, int)
        Method and budget.
    """
    keys = pd.MultiIndex.from_frame(scores[["method", "budget"]])
    wanted = scores[keys.isin(cells)]
    keys = pd.MultiIndex.from_frame(wanted[["method", "budget"]])
    if keys.nunique() < len(cells):
        return summary(wanted.iloc[:0])
    shared = _shared(wanted.assign(cell=keys.to_flat_index()), "cell")
    return summary(wanted[wanted["truth"].isin(shared)])


def summary(scores: pd.DataFrame) -> pd.DataFrame:
    """Return a row per method and budget.

    Returns
    -------
    DataFrame
        truths; particle_steps: median; error: root mean square over truths and parameters, and
        error_se its standard error over truths; prediction: root of the mean square, and
        prediction_median over truths; covered; width; failed: share of runs.
    """
    rows = [
        {"method": method, "budget": budget, **_average(group)}
        for (method, budget), group in scores.groupby(["method", "budget"], sort=True)
    ]
    return pd.DataFrame(rows)


def _average(group: pd.DataFrame) -> dict[str, float]:
    error, error_se = _root_mean(group["error"].to_numpy() ** 2)
    prediction, prediction_se = _root_mean(group["prediction"].to_numpy())
    square = float(group["prediction"].median())
    return {
        "truths": group["truth"].nunique(),
        "particle_steps": float(group["particle_steps"].median()),
        "error": error,
        "error_se": error_se,
        "prediction": prediction,
        "prediction_se": prediction_se,
        "prediction_median": float(np.sqrt(max(0.0, square))),
        "covered": float(group["covered"].mean()),
        "width": float(group["width"].mean()),
        "failed": float(group["failed"].sum() / max(1, group["runs"].sum())),
    }


def _root_mean(squares: Array) -> tuple[float, float]:
    """Return the root of a mean square and its standard error, by the spread of the squares."""
    root = float(np.sqrt(max(0.0, squares.mean())))
    if squares.size < 2 or root == 0.0:
        return root, float("nan")
    return root, float(np.std(squares, ddof=1) / np.sqrt(squares.size) / (2.0 * root))
