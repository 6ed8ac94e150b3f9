"""The first cases of a joint calibration, and whether they are enough to learn from."""

from __future__ import annotations

from pathlib import Path

from calibrate.questions.core.design import first_cases, joint_rng, refuse_few_points
from calibrate.questions.core.from_study import forms_of
from calibrate.runs.stored import RUNS
from calibrate.study.data import StudyData
from liggghts_io import CaseSpec

__all__ = ["check_design"]


def check_design(data: StudyData, out: Path) -> list[CaseSpec]:
    """Return the first cases of a joint calibration; refuse them where they tell too little.

    Runs that are there, and those of stages, count as well and may make up for a small start.

    Parameters
    ----------
    data : StudyData
    out : Path
        Directory of the result, which need not be there.

    Raises
    ------
    CalibrationError
    """
    forms = forms_of(data)
    specs = first_cases(data.study, forms, joint_rng(data.study))
    if not (data.study.stages or (out / RUNS).is_dir()):
        refuse_few_points(forms, specs)
    return specs
