"""Running the cases of a study in a directory, with what goes on shown."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from calibrate.cli.show.progress import JointBar, RunsBar, StudyBar
from calibrate.runs.campaign import Campaign
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.others import held_case
from calibrate.runs.stored import RUNS, stored_case
from liggghts_io import execute

__all__ = ["running"]


@contextmanager
def running(out: Path, how: RunOptions, bar: StudyBar | RunsBar | JointBar) -> Iterator[Campaign]:
    """Open what runs the cases; yields the campaign, which reads finished runs.

    Parameters
    ----------
    out : Path
        Directory of the result.
    how : RunOptions
        What runs the cases, how many at once and for how long.
    bar : StudyBar, RunsBar or JointBar
        Shows progress and remarks, as long as this is open.

    Raises
    ------
    CalibrationError
        If the executor cannot be reached, or the directory cannot be written.
    """
    with (
        bar,
        how.open() as executor,
        Campaign(
            out / RUNS, how.limited(execute), stored=how.limited(stored_case), held=held_case,
            workers=executor.workers, progress=bar, tell=bar.say, executor=executor,
        ) as campaign,
    ):  # fmt: skip
        yield campaign
