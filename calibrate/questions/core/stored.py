"""Runs that are stored already and are points of a study's space, whoever asked for them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np

from calibrate.questions.core.design import Stand, case_at, stands_of
from calibrate.questions.core.forms import Form, FormKey
from calibrate.questions.core.runs import Runs, with_curves
from calibrate.runs.campaign import run_table
from calibrate.study.data import StudyData
from calibrate.study.model import Study
from liggghts_io import CaseError, CaseResult, CaseSpec, case_id, load_spec, stored_result
from liggghts_io.materials import kind_of

__all__ = ["stored_runs"]

ALIKE: Final = 1e-6
"""Difference below which two contact parameters are the same."""


def stored_runs(data: StudyData, forms: Mapping[FormKey, Form], root: Path) -> Runs | None:
    """Return the finished runs under a directory that a study can learn from.

    These are runs of the same experiments, grains, scale, engine, code and fixed values, at any
    values of what is free: those of stages, of an earlier budget or of a diagnosis.

    Parameters
    ----------
    data : StudyData
    forms : mapping
        Form by key.
    root : Path
        Directory of case directories; need not exist.

    Returns
    -------
    Runs or None
        None where there are none.
    """
    stands = stands_of(data.study, forms)
    specs: list[CaseSpec] = []
    results: list[CaseResult] = []
    for directory in sorted(root.iterdir()) if root.is_dir() else ():
        try:
            spec = load_spec(directory)
            # A case of other code or of another version has another name today.
            named = any(_fits(data.study, s, spec) for s in stands) and case_id(spec)
        except (CaseError, OSError):
            continue  # no case, or one of another version
        result = stored_result(root, directory.name) if named == directory.name else None
        if result is not None:
            specs.append(spec)
            results.append(result)
    return with_curves(specs, run_table(specs, results), forms) if specs else None


def _fits(study: Study, stand: Stand, spec: CaseSpec) -> bool:
    """Whether a case is one that the study could ask for, at some values of what is free."""
    if (spec.experiment, kind_of(spec.surface)) != stand.form.key:
        return False
    u, strengths = stand.form.place_in(spec)
    if not (np.isfinite(u).all() and np.all(np.abs(u - 0.5) <= 0.5 + ALIKE)):
        return False
    own = case_at(study, stand, u, strengths, spec.seed)
    same = all(
        getattr(own, name) == getattr(spec, name)
        for name in ("scale", "engine", "particle", "effects", "own")
    )
    return (
        same
        and _near(own.apparatus, spec.apparatus)
        and all(
            abs(value - spec.parameters.get(name, np.nan)) < ALIKE
            for name, value in own.parameters.items()
        )
    )


def _near(one: Mapping[str, float], other: Mapping[str, float]) -> bool:
    """Whether two apparatus are the same up to rounding."""
    return one.keys() == other.keys() and all(
        np.isclose(value, other[name], rtol=ALIKE) for name, value in one.items()
    )
