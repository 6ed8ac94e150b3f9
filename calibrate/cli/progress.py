"""Progress on stderr: of a single run, and of a whole calibration."""

from __future__ import annotations

import time
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, ProgressColumn, TextColumn
from rich.progress import Progress as Bar

from calibrate.runs.campaign import Progress
from calibrate.study.cases import planned
from calibrate.study.model import Study

__all__ = ["StepBar", "StudyBar", "planned_runs"]


def clock(seconds: float | None) -> str:
    """Return the time left as text."""
    if seconds is None:
        return "time left: after the first run"
    minutes, rest = divmod(round(seconds), 60)
    return f"time left {minutes}:{rest:02d}"


class _Shown:
    """What is on the screen while a ``with`` block lasts.

    Parameters
    ----------
    console : Console
        Where to draw, normally stderr.
    count : ProgressColumn
        How much is done, as text.
    """

    def __init__(self, console: Console, count: ProgressColumn) -> None:
        self._started = time.monotonic()
        self._bar = Bar(
            TextColumn("{task.description}"),
            BarColumn(bar_width=24),
            count,
            TextColumn("{task.fields[left]}"),
            console=console,
        )

    def __enter__(self) -> Self:
        """Show the bar."""
        self._bar.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Leave the bar as it stands."""
        self._bar.stop()


class StepBar(_Shown):
    """Progress of one run, in time steps; an instance is what the engine's `progress` wants."""

    def __init__(self, label: str, console: Console) -> None:
        super().__init__(console, TextColumn("{task.percentage:.0f} %"))
        self._task = self._bar.add_task(label, total=None, left="")

    def __call__(self, done: int, total: int) -> None:
        """Draw the steps done."""
        elapsed = time.monotonic() - self._started
        left = elapsed / done * (total - done) if done else None
        self._bar.update(self._task, completed=done, total=max(total, 1), left=clock(left))


def planned_runs(study: Study) -> int:
    """Return how many runs a calibration of `study` asks for."""
    return sum(planned(study).values())


class StudyBar(_Shown):
    """Progress of a whole calibration; an instance is a `campaign.ProgressCallback`.

    The time left counts all runs that the study still asks for, at the pace of the runs that ran
    in this session; stored cases cost nothing and do not count.

    Parameters
    ----------
    study : Study
    console : Console
        Where to draw, normally stderr.
    """

    def __init__(self, study: Study, console: Console) -> None:
        self._total = planned_runs(study)
        self._finished = 0  # runs of finished campaigns
        self._stored = 0
        super().__init__(console, MofNCompleteColumn())
        self._task = self._bar.add_task("starting", total=self._total, left=clock(None))

    def __call__(self, progress: Progress) -> None:
        """Draw the state of a campaign."""
        if progress.elapsed_s == 0.0:
            self._stored += progress.done
        done = self._finished + progress.done
        fresh = done - self._stored
        left = None
        if fresh:
            pace = (time.monotonic() - self._started) / fresh
            left = pace * (self._total - done)
        failed = f", {progress.failed} failed" if progress.failed else ""
        self._bar.update(
            self._task,
            description=f"{progress.label} ({progress.done}/{progress.total}{failed})",
            completed=done,
            left=clock(0.0 if done >= self._total else left),
        )
        if progress.done == progress.total:
            self._finished += progress.total

    def say(self, line: str) -> None:
        """Print a line above the bar."""
        self._bar.console.print(line, highlight=False, markup=False, soft_wrap=True)
