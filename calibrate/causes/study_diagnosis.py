"""The diagnosis of a study that was calibrated jointly: effect twins, emulators, board, verdict."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from calibrate.causes.diagnosis import Diagnosis, Options, diagnose
from calibrate.causes.from_study import board_of, scales_of, twin_cases, with_effects
from calibrate.questions.core.emulate import emulators_of
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import CurveReader, make_runs, read_stored_curve
from calibrate.questions.joint.result import JointResult
from calibrate.runs.runner import Runner

__all__ = ["diagnose_joint"]


def _silent(_what: str, _share: float) -> None:
    """Tell nobody."""


def diagnose_joint(
    joint: JointResult,
    runner: Runner,
    rng: np.random.Generator,
    *,
    options: Options | None = None,
    read: CurveReader = read_stored_curve,
    progress: Callable[[str, float], None] = _silent,
) -> Diagnosis:
    """Diagnose a study with the runs of its joint calibration and a twin of some for each effect.

    Parameters
    ----------
    joint : JointResult
    runner : Runner
        Runs the twins; finished ones are read.
    rng : numpy Generator
    options : Options, optional
    read : callable
        Reads a curve of a run.
    progress : callable
        See `calibrate.causes.diagnosis.diagnose`.
    """
    forms = forms_of(with_effects(joint.data))
    twins = make_runs(twin_cases(forms, joint.runs), "Effects switched on", runner, forms, read)
    emulators = emulators_of(forms, joint.runs.joined(twins))
    board = board_of(joint.data, emulators, rng)
    return diagnose(board, rng, options=options, scales=scales_of(joint.study), progress=progress)
