"""A diagnosis as plain data: what a page, a figure or another program is made from."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from calibrate.causes.candidates import Candidate
from calibrate.causes.diagnosis import Diagnosis
from calibrate.causes.words import headline, sentences

__all__ = ["diagnosis_record"]


def diagnosis_record(found: Diagnosis) -> dict[str, Any]:
    """Return everything but the draws; numbers may be infinite or nan.

    Parameters
    ----------
    found : Diagnosis
    """
    verdict, base = found.verdict, found.base
    return {
        "verdict": verdict.kind,
        "names": list(verdict.names),
        "headline": headline(found),
        "sentences": sentences(found),
        "probabilities": dict(verdict.probabilities),
        "credible": list(verdict.credible),
        "where": dict(verdict.where),
        "chances": asdict(verdict.chances),
        "levels": asdict(found.levels),
        "candidates": [_candidate(found, one) for one in found.board.candidates],
        "parameters": dict(zip(base.problem.space.names, base.best.tolist(), strict=True)),
        "residuals": [asdict(row) for row in found.residuals],
        "residuals_after": [asdict(row) for row in found.after],
        "gains": [{**asdict(one), "claimed": one.claimed} for one in found.gains],
    }


def _candidate(found: Diagnosis, one: Candidate) -> dict[str, Any]:
    seen, span = found.visibility.of(one.name), found.interval(one.name)
    return {
        "name": one.name,
        "effect": one.effect,
        "title": one.title,
        "unit": one.unit,
        "settled_by": one.settled_by,
        "probability": found.verdict.probabilities[one.name],
        "log_ratio": found.log_ratio(one.name),
        "log_ratio_error": float(np.hypot(found.weighed[one.name,].error, found.base.error)),
        "sway": found.sways[one.name],
        "strength": found.strength(one.name),
        "low_95": span.low,
        "high_95": span.high,
        "absorbed": seen.absorbed,
        "detectable": seen.detectable,
        "limit": seen.limit,
        "visible": seen.visible,
        "power": seen.power,
        "alike": list(seen.alike),
        "bias": dict(seen.bias),
    }
