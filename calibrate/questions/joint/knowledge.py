"""What a joint calibration knows after some runs, and the result that it makes of it."""

from __future__ import annotations

import importlib.metadata
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from threadpoolctl import threadpool_limits

from calibrate.arrays import Array
from calibrate.inference.determined import determined
from calibrate.inference.discrepancy import with_discrepancy
from calibrate.inference.intervals import LEVELS
from calibrate.inference.posterior import Posterior
from calibrate.inference.problem import Problem
from calibrate.inference.sampling import sample
from calibrate.questions.core.design import joint_rng
from calibrate.questions.core.emulate import Emulators, emulators_of
from calibrate.questions.core.forms import Form, FormKey
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.problem import problem_of
from calibrate.questions.core.runs import Runs
from calibrate.questions.joint.check import check_rows
from calibrate.questions.joint.result import JointResult
from calibrate.questions.joint.summary import names_outside, sentences_of
from calibrate.questions.words import remedies
from calibrate.study.data import StudyData

__all__ = ["Knowledge", "fit_jointly", "learnt", "result_of"]

DISCREPANCY: Final = 5
"""Keeps the draws that size a discrepancy apart from those of other questions, and always alike."""


@dataclass(frozen=True)
class Knowledge:
    """What is known after some runs.

    Attributes
    ----------
    runs : Runs
    emulators : Emulators
    problem : Problem
    posterior : Posterior
    """

    runs: Runs
    emulators: Emulators
    problem: Problem
    posterior: Posterior


def learnt(
    data: StudyData, forms: Mapping[FormKey, Form], runs: Runs, rng: np.random.Generator
) -> Knowledge:
    """Return what runs say: emulators, problem and posterior.

    Parameters
    ----------
    data : StudyData
    forms : mapping
        Form by key.
    runs : Runs
    rng : numpy Generator
        For the posterior's draws.
    """
    emulators = emulators_of(forms, runs)
    trained = {key: one.emulator for key, one in emulators.trained.items()}
    problem = with_discrepancy(
        problem_of(data, forms, trained),
        data.study.likelihood.discrepancy,
        np.random.default_rng([data.study.run.seed, DISCREPANCY]),
    )
    return Knowledge(runs, emulators, problem, sample(problem, rng))


def fit_jointly(data: StudyData, runs: Runs) -> JointResult:
    """Fit all targets of a study to runs that are there; nothing is run.

    Parameters
    ----------
    data : StudyData
        The study and what was measured.
    runs : Runs
        From a table, for example.

    Returns
    -------
    JointResult
        Its check has what the emulators predict, and what the engine shows only where runs at the
        very optimum are among those given.

    Raises
    ------
    CalibrationError
        When there are too few runs.
    """
    rng = joint_rng(data.study)
    with threadpool_limits(limits=1):  # matrices are small and many
        known = learnt(data, forms_of(data), runs, rng)
        words = f"Fitted to {len(runs)} runs that were there; no engine has checked the result."
        return result_of(data, known, known.posterior.best, np.empty(0), words, 0, rng)


def result_of(
    data: StudyData,
    known: Knowledge,
    best: Array,
    unseen: Array,
    ending: str,
    asked: int,
    rng: np.random.Generator,
) -> JointResult:
    """Return what is known in the end, with the values that are given.

    Parameters
    ----------
    data : StudyData
    known : Knowledge
    best : (K,) float64
        Values that were checked.
    unseen : (m,) float64
        How far the check's runs were from what had been expected, in expected errors.
    ending : str
        Why no more runs were made.
    asked : int
        Runs that counted against the budget.
    rng : numpy Generator
    """
    study, posterior = data.study, known.posterior
    rows = check_rows(study, known.problem, known.emulators, known.runs, best, posterior.samples)
    said = determined(posterior, rng, remedies(study))
    loose = tuple(said.table.index[~said.table["determined"].astype(bool)])
    moved = [name for name in names_outside(best, posterior, LEVELS[0]) if name not in loose]
    return JointResult(
        data=data,
        problem=known.problem,
        emulators=known.emulators,
        posterior=posterior,
        best=dict(zip(posterior.names, map(float, best), strict=True)),
        undetermined=loose,
        check=rows,
        unseen_z=float(np.sqrt(np.mean(unseen**2))) if len(unseen) else float("nan"),
        sentences=sentences_of(
            data, known.problem, posterior.samples, said.sentences, moved, rows, ending
        ),
        runs=known.runs,
        provenance={
            "study": study.name,
            "study_sha256": data.sha256,
            "bulkcal": importlib.metadata.version("bulkcal"),
            "runs": len(known.runs),
            "runs_of_budget": asked,
            **posterior.diagnostics,
        },
    )
