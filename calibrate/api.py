"""The library in five lines of a notebook.

    from calibrate import load

    study = load("study.toml")
    print(study.identify("out").sentences)
    result = study.calibrate("out")
    result.table()
    result.figure()

Runs are stored under the directory that is named, and found again by whoever names it. In a script,
as with everything that starts processes, these lines stand under ``if __name__ == "__main__":``.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rich.console import Console

from calibrate.cli.show.progress import RunsBar
from calibrate.questions.core.design import pilot_cases
from calibrate.questions.core.emulate import emulators_of
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.problem import problem_of
from calibrate.questions.core.runs import make_runs
from calibrate.questions.core.stored import stored_runs
from calibrate.questions.identify import Identification, identify
from calibrate.questions.joint.calibration import calibrate_jointly
from calibrate.questions.joint.result import JointResult
from calibrate.runs.campaign import Campaign
from calibrate.runs.others import held_case
from calibrate.runs.stored import RUNS, stored_case
from calibrate.study.data import StudyData, load_data
from liggghts_io import execute

__all__ = ["LoadedStudy", "load"]


@dataclass(frozen=True)
class LoadedStudy:
    """A study with its data, ready for questions.

    Attributes
    ----------
    data : StudyData
    """

    data: StudyData

    def identify(self, out: str | Path, *, workers: int = 0) -> Identification:
        """Say what the data can determine, from a few runs of every place.

        Parameters
        ----------
        out : path
            Directory for the runs; those that are there already are used.
        workers : int
            Processes, 0 for one per core.
        """
        study, forms = self.data.study, forms_of(self.data)
        rng = np.random.default_rng(study.run.seed)
        with _bar("pilot runs") as bar, _campaign(Path(out), workers, bar) as campaign:
            earlier = stored_runs(self.data, forms, Path(out) / RUNS)
            runs = make_runs(pilot_cases(study, forms, rng), "Pilot design", campaign, forms)
            runs = runs if earlier is None else runs.joined(earlier)
            emulators = emulators_of(forms, runs)
        trained = {key: one.emulator for key, one in emulators.trained.items()}
        return identify(self.data, problem_of(self.data, forms, trained), len(runs), rng)

    def calibrate(self, out: str | Path, *, workers: int = 0) -> JointResult:
        """Calibrate all materials against all targets at once.

        Parameters
        ----------
        out : path
            Directory for the runs; started again, the work goes on where it was.
        workers : int
            Processes, 0 for one per core.

        Raises
        ------
        CalibrationError, liggghts_io.CaseError
            For what cannot be run, and when too few runs succeed.
        """
        with _bar("emulators and posterior") as bar, _campaign(Path(out), workers, bar) as campaign:
            earlier = stored_runs(self.data, forms_of(self.data), Path(out) / RUNS)
            return calibrate_jointly(self.data, campaign, earlier=earlier, tell=bar.say)


def load(path: str | Path) -> LoadedStudy:
    """Read a study and its data.

    Raises
    ------
    CalibrationError
        With all that is wrong in the study and its data.
    """
    return LoadedStudy(load_data(Path(path)))


def _bar(label: str) -> RunsBar:
    return RunsBar(label, Console())


def _campaign(out: Path, workers: int, bar: RunsBar) -> Campaign:
    return Campaign(
        out / RUNS, execute, stored=stored_case, held=held_case, workers=workers,
        progress=bar, tell=bar.say,
    )  # fmt: skip
