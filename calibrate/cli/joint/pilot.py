"""A few runs of every place, and what the data can determine at all."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from rich.console import Console
from threadpoolctl import threadpool_limits

from calibrate.cli.ending import result_directory, said_how_to_continue
from calibrate.cli.running import running
from calibrate.cli.show.progress import RunsBar
from calibrate.cli.show.streams import Terminal
from calibrate.questions.core.design import pilot_cases
from calibrate.questions.core.emulate import emulators_of
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.problem import problem_of
from calibrate.questions.core.runs import make_runs
from calibrate.questions.core.stored import stored_runs
from calibrate.questions.identify import Identification, identify
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.stored import RUNS
from calibrate.study.data import StudyData
from liggghts_io import CaseSpec

__all__ = ["cases_of_pilot", "run_pilot"]

_HERE = RunOptions()


def cases_of_pilot(data: StudyData) -> list[CaseSpec]:
    """Return the cases of a pilot, always the same ones."""
    rng = np.random.default_rng(data.study.run.seed)
    unique = {repr(one): one for one in pilot_cases(data.study, forms_of(data), rng)}
    return list(unique.values())


def run_pilot(
    data: StudyData,
    out: Path,
    command: str,
    how: RunOptions = _HERE,
    *,
    console: Console | None = None,
) -> Identification:
    """Say what the data can determine, from a few runs of every place and all that are there.

    Parameters
    ----------
    data : StudyData
    out : Path
        Directory for the runs; a calibration into it uses them again.
    command : str
        Command that continues this work.
    how : RunOptions
        What runs the cases, how many at once and for how long.
    console : Console, optional
        Where progress and remarks go, stderr by default.

    Raises
    ------
    CalibrationError, liggghts_io.CaseError
        For too few good runs, and for a full or read-only disk.
    BugError
        For a fault of this program.
    """
    result_directory(out)
    forms = forms_of(data)
    bar = RunsBar("pilot runs", console or Terminal(stderr=True))
    with said_how_to_continue(out, command, bar.say):
        with running(out, how, bar) as campaign:
            earlier = stored_runs(data, forms, out / RUNS)
            runs = make_runs(cases_of_pilot(data), "Pilot design", campaign, forms)
        runs = runs if earlier is None else runs.joined(earlier)
        # Matrices are small and many: threads of the linear algebra only get in each other's way.
        with threadpool_limits(limits=1):
            emulators = emulators_of(forms, runs)
            trained = {key: one.emulator for key, one in emulators.trained.items()}
            problem = problem_of(data, forms, trained)
            rng = np.random.default_rng(data.study.run.seed)
            return identify(data, problem, len(runs), rng)
