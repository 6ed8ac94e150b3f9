"""What a whole calibration shows: progress on stderr, tables on stdout."""

from __future__ import annotations

import time
from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn
from rich.progress import Progress as Bar
from rich.table import Table

from calibrate.cli.progress import clock
from calibrate.report.numbers import band, plus_minus, signed
from calibrate.runs.campaign import Progress
from calibrate.runs.cases import bench
from calibrate.staged.calibration import Calibration
from calibrate.staged.stages import StageResult
from calibrate.study.model import Study

__all__ = ["StudyBar", "planned_runs", "result_tables"]


def planned_runs(study: Study) -> int:
    """Return how many runs a calibration of `study` asks for."""
    total = len(bench(study.target)) * study.check_seeds
    for stage in study.stage:
        places = bench([study.target_named(name) for name in stage.targets])
        total += (stage.points + stage.repeats + stage.infill) * len(places)
    return total


class StudyBar:
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
        self._started = time.monotonic()
        self._bar = Bar(
            TextColumn("{task.description}"),
            BarColumn(bar_width=24),
            MofNCompleteColumn(),
            TextColumn("{task.fields[left]}"),
            console=console,
        )
        self._task = self._bar.add_task("starting", total=self._total, left=clock(None))

    def __enter__(self) -> StudyBar:
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

    def stage_done(self, result: StageResult) -> None:
        """Print the result of a stage above the bar."""
        found = ", ".join(
            f"{name} = {value:.3f} ({band(result.intervals[name][0.9])})"
            for name, value in result.found.items()
        )
        self._bar.console.print(
            f"{result.stage.title}: {found}", highlight=False, markup=False, soft_wrap=True
        )


def result_tables(result: Calibration) -> list[Table]:
    """Return the parameters with intervals, and measured against simulated."""
    return [_parameter_table(result), _check_table(result)]


def _parameter_table(result: Calibration) -> Table:
    table = Table(title=f"{result.study.title}: parameters", title_justify="left")
    table.add_column("parameter")
    for heading in ("value", "68 % interval", "90 % interval", "published"):
        table.add_column(heading, justify="right")
    table.add_column("remark")
    for stage in result.stages:
        for name, value in stage.found.items():
            levels = stage.intervals[name]
            published = result.study.published.get(name)
            table.add_row(
                name,
                f"{value:.3f}",
                band(levels[0.68]),
                band(levels[0.90]),
                "" if published is None else f"{published:.3f}",
                "" if stage.verdict.is_point else "nearest approach, no solution",
            )
    return table


def _check_table(result: Calibration) -> Table:
    table = Table(
        title=f"Check with the simulator, {result.study.check_seeds} seeds", title_justify="left"
    )
    table.add_column("observable")
    for heading in ("unit", "measured", "simulated", "deviation", "z"):
        table.add_column(heading, justify="right")
    for row in result.check:
        table.add_row(
            row.label if row.used else f"{row.label} (not used)",
            row.unit,
            plus_minus(row.measured, row.measured_se),
            plus_minus(row.simulated, row.simulated_se),
            signed(row.deviation_percent, " %"),
            signed(row.z),
        )
    return table
