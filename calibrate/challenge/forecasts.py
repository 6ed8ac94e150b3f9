"""Forecasts of a suite: what a method says of each study, as plain data."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, TypeAlias

import numpy as np

from calibrate.arrays import Array
from calibrate.causes.diagnosis import Diagnosis, Options, diagnose
from calibrate.causes.left_out import told_by_others
from calibrate.challenge.judges.baselines import BASELINES, ORACLE, baseline
from calibrate.challenge.judges.imagined import imagined
from calibrate.challenge.judges.variants import OURS, VARIANTS
from calibrate.challenge.learnt import Learnt
from calibrate.errors import CalibrationError
from calibrate.study.data import load_data
from liggghts_io.files import write_text

__all__ = ["FORECASTS", "LIMIT", "NEED_TRUTH", "forecast", "forecast_path", "forecast_study"]

FORECASTS: Final = "forecasts"
LIMIT: Final = "limit"
"""The diagnosis, of data that its own emulators give at the truth: what nobody with these runs can
do better."""
NEED_TRUTH: Final = (ORACLE, LIMIT)
QUANTILES: Final = (0.05, 0.5, 0.95)
SHOWN: Final = 0.02
"""Probability of a cause from which its strength is forecast."""
SEED: Final = 7
Record: TypeAlias = dict[str, Any]


def forecast_path(out: Path, method: str, study: Path) -> Path:
    """Return where the forecast of a study lies."""
    return out / method / f"{study.name}.json"


def forecast(
    learnt: Learnt,
    study: Path,
    out: Path,
    method: str,
    truth: Mapping[str, Any] | None = None,
    options: Options | None = None,
) -> bool:
    """Forecast one study of a suite; return whether there was anything to do.

    Parameters
    ----------
    learnt : Learnt
    study : Path
        Folder of the study.
    out : Path
        Of the forecasts; one that is there stays.
    method : str
        Of `calibrate.challenge.judges.variants` or `calibrate.challenge.judges.baselines`, or
        `LIMIT`.
    truth : mapping, optional
        What is true of the study, for methods of `NEED_TRUTH`.
    options : Options, optional
        How much work a diagnosis does; by default gains are claimed by `OURS` alone.
    """
    path = forecast_path(out, method, study)
    if path.exists():
        return False
    try:
        record = forecast_study(learnt, study, method, truth, options)
    except (CalibrationError, ArithmeticError, ValueError, np.linalg.LinAlgError) as err:
        # It counts as the floor; the others go on. A study may be one that cannot be read: a box
        # that stayed empty weighs nothing, and only positive masses are studied.
        record = {"failed": f"{type(err).__name__}: {err}"}
    path.parent.mkdir(parents=True, exist_ok=True)
    write_text(path, json.dumps(record, indent=1) + "\n")
    return True


def forecast_study(
    learnt: Learnt,
    study: Path,
    method: str,
    truth: Mapping[str, Any] | None = None,
    options: Options | None = None,
) -> Record:
    """Return what a method says of one study; the truth is for methods of `NEED_TRUTH` alone.

    Raises
    ------
    CalibrationError
        If the study cannot be read, or a truth is needed and not given.
    """
    data = load_data(study / "study.toml")
    board = learnt.board(data)
    if method in NEED_TRUTH and truth is None:
        msg = f"method '{method}' reads the truth of a study, and was given none"
        raise CalibrationError(msg)
    if method in BASELINES:
        return baseline(method, board, truth["values"] if truth else None)
    if truth is not None and method == LIMIT:
        board = imagined(board, truth, np.random.default_rng([SEED, truth["number"]]))
    else:
        board = VARIANTS[method].change(board, data.study)
    options = options or Options(held_out=method == OURS)
    found = diagnose(board, np.random.default_rng(SEED), options=options)
    answers, verdict = found.verdict.answers, found.verdict
    return {
        "verdict": verdict.kind,
        "names": list(verdict.names),
        "none": answers.none,
        "unknown": answers.unknown,
        "where": dict(list(answers.where.items())[:3]),
        "inclusion": {n: p for n, p in answers.inclusion.items() if p > 1e-6},
        "pairs": [[*pair, p] for pair, p in answers.pairs.items() if p > 1e-6],
        "strengths": _strengths(found),
        "p_best": verdict.chances.p_best,
        "p_misfit": verdict.chances.p_misfit,
        "p_explained": max(verdict.chances.p_explained.values(), default=1.0),
        "gain": _gain(found),
        "draws": len(found.found.cloud),
        "size": found.base.size,
    }


def _strengths(found: Diagnosis) -> dict[str, list[float]]:
    """Return quantiles of the strengths of probable causes, pairs counted."""
    told = {}
    answers = found.verdict.answers
    for name, p in answers.inclusion.items():
        if p < SHOWN:
            continue
        parts, shares = [], []
        hypotheses: dict[tuple[str, ...], float] = {(name,): answers.single[name]}
        for names, share in (hypotheses | dict(answers.pairs)).items():
            if name in names and names in found.found.weighed:
                parts.append(found.strengths(name, names))
                shares.append(share)
        weights = np.repeat(np.array(shares) / [len(x) for x in parts], [len(x) for x in parts])
        told[name] = [float(q) for q in _quantiles(np.concatenate(parts), weights)]
    return told


def _quantiles(values: Array, weights: Array) -> Array:
    order = np.argsort(values)
    reached = np.cumsum(weights[order]) / weights.sum()
    return np.asarray(values[order][np.searchsorted(reached, QUANTILES).clip(0, len(values) - 1)])


def _gain(found: Diagnosis) -> Record | None:
    """Return the claimed gain of the leading hypothesis, and what each place is expected to be."""
    if not found.gains:
        return None
    one = found.gains[0]
    return {
        "causes": list(one.candidates),
        "log_density": one.log_density,
        "low": one.low,
        "high": one.high,
        "chance": one.chance,
        "base": _left_out(found, ()),
        "with": _left_out(found, one.candidates),
    }


def _left_out(found: Diagnosis, names: tuple[str, ...]) -> dict[str, Record]:
    """Return mean and covariance of every place's numbers, told by all other places."""
    return {
        "+".join(place.names): {
            "mean": place.mean.tolist(),
            "covariance": place.covariance.tolist(),
        }
        for place in told_by_others(found.found, names)
    }
