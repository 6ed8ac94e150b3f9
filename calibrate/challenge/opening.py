"""Open the truths of a suite and lay them beside the forecasts."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final, TypeAlias

import numpy as np
from scipy import stats

from calibrate.arrays import Array
from calibrate.causes.candidates import Board
from calibrate.causes.judging.straight import straight_at
from calibrate.causes.weighing.tangent import tangent_at
from calibrate.challenge.cases import Case
from calibrate.challenge.folders import FRESH, Suite
from calibrate.challenge.imitation import unlike_any
from calibrate.challenge.judges.baselines import coordinates
from calibrate.challenge.judges.variants import VARIANTS
from calibrate.challenge.learnt import Learnt
from calibrate.challenge.scores import WEAK
from calibrate.challenge.sealing import opened
from calibrate.errors import CalibrationError
from calibrate.questions.core.from_study import levels_of
from calibrate.scales import forward
from calibrate.study.data import load_data
from calibrate.study.model import Study
from calibrate.study.schema.targets import Target

__all__ = ["cases_of", "checked_truths", "power"]

Record: TypeAlias = dict[str, Any]

TEST_LEVEL: Final = 0.05
"""How often a test of what causes leave may object where only luck is."""


def checked_truths(suite: Suite) -> dict[str, Record]:
    """Return the truths of a suite by study.

    Raises
    ------
    CalibrationError
        If one is not that of which the digest was published.
    """
    truths, digests = suite.truths(), suite.seals()["digests"]
    for name, digest in digests.items():
        if name not in truths or not opened(truths[name], digest):
            msg = f"{suite.path}: the truth of {name} is not the one that was sealed"
            raise CalibrationError(msg)
    return {name: truths[name] for name in digests}


def cases_of(
    suite: Suite,
    forecasts: Path | zipfile.Path,
    methods: list[str],
    learnt: Learnt,
    first: int = 0,
    tell: Callable[[str], None] | None = None,
) -> dict[str, list[Case]]:
    """Return the cases that count for each method; a forecast that is missing gets the floor.

    So does a study that could not be made, or that cannot be read; one that nobody has tried to
    make does not count yet.

    Parameters
    ----------
    suite : Suite
    forecasts : Path or zipfile.Path
        Holds a folder for each method.
    methods : list of str
    learnt : Learnt
    first : int
        How many of the studies count, the first ones; 0 for all.
    tell : callable, optional
        Told which study is looked at; one takes a second.
    """
    tried, truths = suite.tried(), checked_truths(suite)
    truths = {name: truths[name] for name in sorted(truths)[: first or None]}
    folders = [path for path in suite.studies() if path.name in truths]
    away = {}
    for number, path in enumerate(folders, start=1):
        if tell:
            tell(f"comparing: study {number} of {len(folders)}")
        away[path.name] = _away(path, truths[path.name], learnt)
    nowhere = (np.nan, np.nan, np.nan, np.nan)
    found: dict[str, list[Case]] = {}
    for method in methods:
        settled = VARIANTS[method].settled if method in VARIANTS else ()
        cases = found.setdefault(method, [])
        for name, truth in truths.items():
            if name not in tried or _hides(truth, settled):
                continue
            said = _read(forecasts / method / f"{name}.json")
            gained = _gained(suite, name, said) if said else None
            far, beyond, unlike, tested = away.get(name, nowhere)
            cases.append(Case(truth, said, far, beyond, gained, unlike, tested))
    return found


def _hides(truth: Mapping[str, Any], effects: tuple[str, ...]) -> bool:
    return any(one["name"].partition(":")[0] in effects for one in truth["hidden"])


def _read(path: Path | zipfile.Path) -> Record | None:
    if not path.exists():
        return None
    record: Record = json.loads(path.read_text(encoding="utf-8"))
    return None if "failed" in record else record


def _away(
    study: Path, truth: Mapping[str, Any], learnt: Learnt
) -> tuple[float, float, float, float]:
    """Return how far data and causes are from the base model, see `Case`.

    The first two are of what is left at the true parameters, y, over its expected size: of
    y^T K^-1 y, and of the least that any one straight cause leaves of it. The third is that of
    causes that are hidden alone and are as strong as something is required for, the last how often
    a test of the size of what causes leave would object (a noncentral chi square with as many
    degrees of freedom as errors have). nan for a study that cannot be read.
    """
    try:
        data = load_data(study / "study.toml")
    except CalibrationError:
        return np.nan, np.nan, np.nan, np.nan
    board: Board = learnt.board(data)
    space = board.problem.space
    known = np.array([truth["values"].get(name, 0.0) for name in space.names])
    straight = straight_at(board, tangent := tangent_at(board.problem, coordinates(space, known)))
    turned = straight.inverse @ tangent.left
    square, luck = float(tangent.left @ turned), float(np.trace(straight.inverse))
    seen = straight.information > 0.0
    imitated = (turned @ straight.answers[:, seen]) ** 2 / straight.information[seen]
    rest = square - float(np.max(imitated, initial=0.0))
    unlike = np.nan
    if truth["kind"] == "single" and truth["hidden"][0]["noncentrality"] >= WEAK:
        unlike = unlike_any(board, truth, np.random.default_rng(truth["number"]))
    far, beyond = max(square - luck, 0.0), max(rest - luck, 0.0)
    tested = power(beyond, luck)
    return float(np.sqrt(far)), float(np.sqrt(beyond)), unlike, tested


def power(noncentrality: float, freedom: float) -> float:
    """Return how often a chi-square test of level `TEST_LEVEL` objects.

    Parameters
    ----------
    noncentrality : float
        What is there beside luck, in squared standard errors.
    freedom : float
        Degrees of freedom of luck, not necessarily whole.
    """
    return float(stats.ncx2.sf(stats.chi2.isf(TEST_LEVEL, freedom), freedom, noncentrality))


def _gained(suite: Suite, name: str, said: Record) -> float | None:
    """Return what the claimed causes gain on new data of the same experiments."""
    path = suite.path / FRESH / f"{name}.json"
    claim = said["gain"]
    if claim is None or not path.exists():
        return None
    data = load_data(suite.path / "studies" / name / "study.toml")
    fresh, targets = json.loads(path.read_text(encoding="utf-8")), _targets(data.study)
    total = 0.0
    for place, told in claim["with"].items():
        parts = []
        for one in (targets[target] for target in place.split("+")):
            # Of a curve the study may have the first levels alone.
            values = np.array(fresh[one.name][: len(levels_of(data, one)) or 1])
            parts.append(forward(one.model_scale, values))
        y = np.concatenate(parts)
        if not np.isfinite(y).all():
            return None
        total += _log_density(told, y) - _log_density(claim["base"][place], y)
    return total


def _targets(study: Study) -> dict[str, Target]:
    return {target.name: target for target in study.targets}


def _log_density(told: Mapping[str, Any], y: Array) -> float:
    normal = stats.multivariate_normal(told["mean"], told["covariance"], allow_singular=True)
    return float(normal.logpdf(y))
