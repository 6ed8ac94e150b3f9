"""A diagnosis as plain data: what a page, a figure or another program is made from."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from calibrate.causes.candidates import Candidate
from calibrate.causes.diagnosis import Diagnosis
from calibrate.causes.judging.probabilities import inclusion_of
from calibrate.causes.told.next_step import next_record
from calibrate.causes.told.words import headline, sentences

__all__ = ["diagnosis_record"]


def diagnosis_record(found: Diagnosis) -> dict[str, Any]:
    """Return everything but the draws; numbers may be infinite or nan.

    Parameters
    ----------
    found : Diagnosis
    """
    verdict, answers = found.verdict, found.verdict.answers
    values, _ = found.best(())
    names = found.board.problem.space.names
    return {
        "verdict": verdict.kind,
        "names": list(verdict.names),
        "headline": headline(found),
        "sentences": sentences(found),
        "leading": list(found.leading),
        "probabilities": dict(answers.single),
        "inclusion": dict(answers.inclusion),
        "pairs": [{"causes": list(pair), "probability": p} for pair, p in answers.pairs.items()],
        "where": dict(answers.where),
        "doubts": dict(answers.doubts),
        "chances": {
            **asdict(verdict.chances),
            "p_explained": {" and ".join(n): p for n, p in verdict.chances.p_explained.items()},
            "lasting": inclusion_of(verdict.chances.lasting),
        },
        "levels": asdict(found.levels),
        "candidates": [_candidate(found, one) for one in found.board.candidates],
        "measure_next": next_record(found),
        "parameters": dict(zip(names, values.tolist(), strict=True)),
        "residuals": [asdict(row) for row in found.residuals],
        "groups": [asdict(one) for one in found.groups],
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
        "probability": found.verdict.answers.single[one.name],
        "inclusion": found.verdict.answers.inclusion[one.name],
        "log_ratio": found.log_ratio(one.name),
        "log_ratio_error": float(np.hypot(found.found.weighed[one.name,].error, found.base.error)),
        "strength": found.strength(one.name),
        "low_95": span.low,
        "high_95": span.high,
        "absorbed": seen.absorbed,
        "detectable": seen.detectable,
        "achieved": seen.achieved,
        "limit": seen.limit,
        "visible": seen.visible,
        "power": seen.power,
        "alike": list(seen.alike),
        "instead": asdict(seen.instead) if seen.instead else None,
        "bias": dict(seen.bias),
    }
