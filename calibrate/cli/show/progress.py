"""Progress of campaigns: of a whole calibration, and of a diagnosis."""

from __future__ import annotations

from typing import Final

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn

from calibrate.cli.show.waiting import Shown, clock
from calibrate.runs.campaign import Progress
from calibrate.study.cases import planned
from calibrate.study.model import Study

__all__ = ["DiagnosisBar", "JointBar", "RunsBar", "StudyBar", "planned_runs"]


WORK: Final = {
    "imagined studies": "what chance does: imagined studies without any effect",
    "left out": "residuals: every reading predicted from all others",
}
"""Last steps of a diagnosis in words for who waits."""


def planned_runs(study: Study) -> int:
    """Return how many runs a calibration of `study` asks for."""
    return sum(planned(study).values())


class StudyBar(Shown):
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
        super().__init__(console, "starting", BarColumn(bar_width=24), MofNCompleteColumn())
        self._total = planned_runs(study)
        self._finished = 0  # runs of finished campaigns
        self._stored = 0
        self.bar.update(self.task, total=self._total, left="time left: after the first run")

    def __call__(self, progress: Progress) -> None:
        """Draw the state of a campaign."""
        if progress.elapsed_s == 0.0:
            self._stored += progress.done
        done = self._finished + progress.done
        fresh = done - self._stored
        left = "time left: after the first run"
        if fresh or done >= self._total:
            pace = self.elapsed_s / max(fresh, 1)
            left = f"time left {clock(pace * max(self._total - done, 0))}"
        failed = f", {progress.failed} failed" if progress.failed else ""
        self.bar.update(
            self.task,
            description=f"{progress.label} ({progress.done}/{progress.total}{failed})",
            completed=done,
            left=left,
        )
        if progress.done == progress.total:
            self._finished += progress.total

    def line(self) -> str:
        """Return the state in words, with the runs of the whole study."""
        task = self.bar.tasks[0]
        return (
            f"{task.description}: {task.completed:.0f} of {self._total} runs after "
            f"{clock(self.elapsed_s)}, {task.fields['left']}"
        )


class RunsBar(Shown):
    """Progress of work whose campaigns nobody can count beforehand; a `ProgressCallback` as well.

    Parameters
    ----------
    label : str
        What is being done between campaigns.
    console : Console
        Where to draw, normally stderr.
    """

    def __init__(self, label: str, console: Console) -> None:
        super().__init__(console, label, BarColumn(bar_width=24), MofNCompleteColumn())
        self._label = label

    def __call__(self, progress: Progress) -> None:
        """Draw the state of a campaign, or that it is over."""
        if progress.done >= progress.total:
            self.bar.update(self.task, description=self._label, completed=0, left="")
            self.bar.tasks[0].total = None  # `update` takes None for no change
            return
        left = "" if progress.left_s is None else f"time left {clock(progress.left_s)}"
        failed = f", {progress.failed} failed" if progress.failed else ""
        self.bar.update(
            self.task,
            description=f"{progress.label} ({progress.done}/{progress.total}{failed})",
            completed=progress.done,
            total=progress.total,
            left=left,
        )


class JointBar(Shown):
    """Progress of a joint calibration, of which only the budget is known beforehand.

    The time left is the most that it can be: an answer that is settled ends the work earlier.

    Parameters
    ----------
    budget : int
        Most runs, without those of the final check.
    console : Console
        Where to draw, normally stderr.
    """

    def __init__(self, budget: int, console: Console) -> None:
        super().__init__(console, "starting", BarColumn(bar_width=24), MofNCompleteColumn())
        self._budget = budget
        self._finished = 0  # runs of finished campaigns
        self._stored = 0
        self.bar.update(self.task, total=budget, left="time left: after the first run")

    def __call__(self, progress: Progress) -> None:
        """Draw the state of a campaign, or what follows it."""
        if progress.elapsed_s == 0.0:
            self._stored += progress.done
        done = self._finished + progress.done
        fresh = done - self._stored
        self._budget = max(self._budget, self._finished + progress.total)
        left = "time left: after the first run"
        if fresh:
            pace = self.elapsed_s / fresh
            left = f"time left {clock(pace * max(self._budget - done, 0))} at most"
        failed = f", {progress.failed} failed" if progress.failed else ""
        label = f"{progress.label} ({progress.done}/{progress.total}{failed})"
        if progress.done == progress.total:
            self._finished += progress.total
            label = f"learning from {done} runs: emulators, posterior, next runs"
        self.bar.update(self.task, description=label, completed=done, total=self._budget, left=left)

    def line(self) -> str:
        """Return the state in words, with the runs made so far."""
        task = self.bar.tasks[0]
        return (
            f"{task.description}: {task.completed:.0f} of up to {self._budget} runs after "
            f"{clock(self.elapsed_s)}, {task.fields['left']}"
        )


class DiagnosisBar(RunsBar):
    """Progress of a diagnosis: of its campaigns, and of the causes that are weighed.

    Parameters
    ----------
    console : Console
        Where to draw, normally stderr.
    """

    def __init__(self, console: Console) -> None:
        super().__init__("learning what effects do", console)
        self._weighed_from = 0.0

    def weighing(self, what: str, share: float) -> None:
        """Draw which cause is weighed, and which part of all is done."""
        if share == 0.0:
            self._weighed_from = self.elapsed_s
        taken = self.elapsed_s - self._weighed_from
        left = f"time left {clock(taken / share * (1.0 - share))}" if 0.0 < share < 1.0 else ""
        label = f"weighing {what}" if share < 1.0 else WORK.get(what, what)
        self.bar.update(self.task, description=label, completed=share, total=1.0, left=left)
        if share >= 1.0:  # how long the last steps take is not known
            self.bar.tasks[0].total = None
