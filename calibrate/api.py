"""The library in a few lines of a notebook.

    from calibrate import load

    study = load("study.toml")
    print(study.identify("out").sentences)
    result = study.calibrate("out")
    result.table()
    result.figure()
    print(study.diagnose("out").sentences)
    study.sensitivity("out").figure()

Runs are stored under the directory that is named, and found again by whoever names it. In a script,
as with everything that starts processes, these lines stand under ``if __name__ == "__main__":``.
"""

from __future__ import annotations

import ast
import sys
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console

from calibrate.causes.studies.result import StudyDiagnosis
from calibrate.cli.diagnose_study import diagnose_study
from calibrate.cli.joint.pilot import run_pilot
from calibrate.cli.joint.study import calibrate_jointly_into
from calibrate.cli.sensitivity.study import study_sensitivity
from calibrate.errors import CalibrationError
from calibrate.executor_names import LOCAL
from calibrate.questions.identify import Identification
from calibrate.questions.joint.result import JointResult
from calibrate.questions.sensitivity.result import SensitivityResult
from calibrate.questions.sensitivity.steps import LEVELS, SEEDS
from calibrate.questions.sensitivity.study import Asked
from calibrate.runs.executors.run_options import RunOptions
from calibrate.study.data import StudyData, load_data

__all__ = ["LoadedStudy", "load"]


@dataclass(frozen=True, repr=False)
class LoadedStudy:
    """A study with its data, ready for questions.

    Attributes
    ----------
    data : StudyData
    """

    data: StudyData

    def __repr__(self) -> str:
        """Return one line: the study, and how much is measured and free in it."""
        study = self.data.study
        return (
            f"LoadedStudy({study.title!r}: {len(study.targets)} targets, {len(study.free)} "
            f"unknowns; see .identify(out), .calibrate(out))"
        )

    def identify(self, out: str | Path, *, workers: int = 0) -> Identification:
        """Say what the data can determine, from a few runs of every place.

        Parameters
        ----------
        out : path
            Directory for the runs; those that are there already are used.
        workers : int
            Processes, 0 for what the study says, or one per core.

        Raises
        ------
        CalibrationError, liggghts_io.CaseError
            As `calibrate`.
        """
        how = self._how(workers)
        return run_pilot(self.data, Path(out), "the same call", how, console=Console())

    def calibrate(self, out: str | Path, *, workers: int = 0) -> JointResult:
        """Calibrate all materials against all targets at once.

        Parameters
        ----------
        out : path
            Directory for the runs, the record and the report; started again, the work goes on
            where it was.
        workers : int
            Processes, 0 for what the study says, or one per core.

        Raises
        ------
        CalibrationError, liggghts_io.CaseError
            For what cannot be run, when too few runs succeed, and for a script without
            ``if __name__ == "__main__":``.
        """
        how = self._how(workers)
        return calibrate_jointly_into(self.data, Path(out), "the same call", how, console=Console())

    def diagnose(
        self,
        out: str | Path,
        *,
        twins: int | None = None,
        more: int | None = None,
        further: int | None = None,
        workers: int = 0,
    ) -> StudyDiagnosis:
        """Say what the calibrated simulation still gets wrong, and which cause fits.

        Parameters
        ----------
        out : path
            Directory of `calibrate`; where it holds no joint calibration, that is made first.
        twins : int, optional
            Most runs of each effect in each emulator; 12 where it is left out.
        more : int, optional
            Most runs added where the evidence of leading causes is uncertain, and as many where
            a strength is; 64 where it is left out.
        further : int, optional
            Most runs of further experiments, which tell what to try next where it is open which
            cause it is; 60 where it is left out.
        workers : int
            Processes, 0 for what the study says, or one per core.

        Returns
        -------
        StudyDiagnosis
            With `sentences`, `table()` and `figure()`.

        Raises
        ------
        CalibrationError, liggghts_io.CaseError
            As `calibrate`, and for a record that was changed.
        """
        how = self._how(workers)
        return diagnose_study(
            self.data, Path(out), "the same call", how, twins=twins, more=more, further=further,
            console=Console(),
        )  # fmt: skip

    def sensitivity(
        self,
        out: str | Path,
        *,
        levels: int = LEVELS,
        seeds: int = SEEDS,
        points: int | None = None,
        baseline: str | Path | None = None,
        workers: int = 0,
    ) -> SensitivityResult:
        """Say what moves what: one parameter at a time, and Sobol indices over all ranges.

        Parameters
        ----------
        out : path
            Directory for the runs; those that are there already are used.
        levels : int
            Values over each range; 0 for Sobol indices only.
        seeds : int
            Runs of each value.
        points : int, optional
            Points of the design behind the Sobol indices, 0 for none; where it is left out, as
            many as `calibrate` begins with.
        baseline : path, optional
            Table quantity,value,unit; without it ``baseline.csv`` beside the study, then the
            values of the study, then the middle of a range.
        workers : int
            Processes, 0 for what the study says, or one per core.

        Returns
        -------
        SensitivityResult
            With `table()`, `figure()`, `indices_figure()` and `sentences`.

        Raises
        ------
        CalibrationError, liggghts_io.CaseError
            As `calibrate`, and for a baseline that cannot be used.
        """
        how = self._how(workers)
        asked = Asked(levels, seeds, points, None if baseline is None else Path(baseline))
        return study_sensitivity(
            self.data, Path(out), "the same call", how, asked=asked, console=Console()
        )

    def _how(self, workers: int) -> RunOptions:
        """Return how the runs are made: what the call leaves open, the study says."""
        run = self.data.study.run
        how = RunOptions(workers).filled(
            RunOptions(run.workers, run.executor, limit_s=run.time_limit_s)
        )
        if how.executor == LOCAL:
            _refuse_bare_script()
        return how


def load(path: str | Path) -> LoadedStudy:
    """Read a study and its data.

    Raises
    ------
    CalibrationError
        With all that is wrong in the study and its data.
    """
    return LoadedStudy(load_data(Path(path)))


def _refuse_bare_script() -> None:
    """Refuse a script that worker processes would run once more when they start.

    Raises
    ------
    CalibrationError
        When the main program is a file without ``if __name__ == "__main__":``.
    """
    main = sys.modules["__main__"]
    file = getattr(main, "__file__", None)
    if file is None or getattr(main, "__spec__", None) is not None:
        return  # a notebook, a prompt, or python -m
    try:
        lines = ast.parse(Path(file).read_bytes()).body
    except (OSError, SyntaxError, ValueError):
        return  # no script that could be read again
    if any(isinstance(one, ast.If) and "__main__" in ast.dump(one.test) for one in lines):
        return
    msg = (
        f"{file}: worker processes read this file when they start, and would begin the same work "
        'again; put what it does under  if __name__ == "__main__":'
    )
    raise CalibrationError(msg)
