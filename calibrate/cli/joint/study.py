"""Calibrate a study jointly into a directory: cases, table of runs, record, draws, report."""

from __future__ import annotations

import contextlib
import json
from pathlib import Path

from rich.console import Console

from calibrate.cli.ending import result_directory, said_how_to_continue
from calibrate.cli.joint.first import check_design
from calibrate.cli.kept import kept_in
from calibrate.cli.running import running
from calibrate.cli.show.progress import JointBar
from calibrate.cli.show.streams import Terminal
from calibrate.cli.show.waiting import Waiting
from calibrate.questions.core.forms import Form, FormKey
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import Runs
from calibrate.questions.core.stored import stored_runs, tabled_runs
from calibrate.questions.joint.calibration import calibrate_jointly
from calibrate.questions.joint.knowledge import fit_jointly
from calibrate.questions.joint.result import JointResult
from calibrate.report.gallery import Drawings
from calibrate.report.joint.record import write_joint
from calibrate.report.joint.section import add_joint_section, write_joint_page
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.failures import failure_lines
from calibrate.runs.others import older_runs
from calibrate.runs.stored import RECORD, REPORT, RUNS, SAMPLES, START, TABLE
from calibrate.study.data import StudyData
from liggghts_io import render_case, scene_of_case
from liggghts_io.files import write_text

__all__ = ["calibrate_jointly_into", "fit_jointly_into"]

_HERE = RunOptions()


def calibrate_jointly_into(
    data: StudyData,
    out: Path,
    command: str,
    how: RunOptions = _HERE,
    *,
    after_stages: bool = False,
    console: Console | None = None,
) -> JointResult:
    """Calibrate all targets of a study at once into a directory.

    The runs that are there already, of stages for example, are used as well. Started again with
    the same study it makes the same decisions, and so finds its own runs.

    Parameters
    ----------
    data : StudyData
        The study and what was measured.
    out : Path
        Directory of the result; what it holds already is continued, nothing is deleted. To a
        report by stages on the same study file and data it adds a section.
    command : str
        Command that continues this work.
    how : RunOptions
        What runs the cases, how many at once and for how long.
    after_stages : bool
        Whether the stages have just run there, and said what older runs it holds.
    console : Console, optional
        Where progress and remarks go, stderr by default.

    Raises
    ------
    CalibrationError, liggghts_io.CaseError
        For mistakes in the study or its data, too few good runs, a full or read-only disk.
    BugError
        For a fault of this program.
    """
    check_design(data, out)
    result_directory(out)
    console = console or Terminal(stderr=True)

    def say(line: str) -> None:
        console.print(line, highlight=False, markup=False, soft_wrap=True)

    say(_intended(data, how))
    if not after_stages and (older := older_runs(out / RUNS)):
        say(older)
    with said_how_to_continue(out, command, say):
        with Waiting(console, "looking through the runs that are there"):
            earlier = _earlier(data, forms_of(data), out)
        if earlier is not None:
            say(f"{len(earlier)} finished runs are used as well")
        result = _found(data, earlier, out, how, console)
        _write(result, out, command, console)
    for line in failure_lines(result.runs.table):
        say(line)
    return result


def fit_jointly_into(
    data: StudyData, table: Path, out: Path, command: str, *, console: Console | None = None
) -> JointResult:
    """Fit all targets of a study to the runs of a table, into a directory; nothing is run.

    Parameters
    ----------
    data : StudyData
        The study and what was measured.
    table : Path
        From `bulkcal runs`.
    out : Path
        Directory of the result, as for `calibrate_jointly_into`.
    command : str
        Command that does this again.
    console : Console, optional
        Where remarks go, stderr by default.

    Raises
    ------
    CalibrationError, liggghts_io.CaseError
        For a file that is no such table, runs of another study or too few of them, and for a full
        or read-only disk.
    """
    console = console or Terminal(stderr=True)
    with Waiting(console, f"fitting to the runs of {table}"):
        runs = tabled_runs(data, forms_of(data), table)
        result_directory(out)
        result = fit_jointly(data, runs)
    _write(result, out, command, console)
    return result


def _intended(data: StudyData, how: RunOptions) -> str:
    """Return what will be done."""
    design, scale = data.study.design, data.study.run.scale
    return (
        f"{data.study.title}, all targets at once: up to {design.runs} runs and those of the "
        f"final check, at scale '{scale}' on {how.place}"
    )


def _found(
    data: StudyData, earlier: Runs | None, out: Path, how: RunOptions, console: Console
) -> JointResult:
    """Run and learn, with what goes on shown."""
    bar = JointBar(data.study.design.runs, console)
    with running(out, how, bar) as campaign:
        return calibrate_jointly(data, campaign, earlier=earlier, tell=bar.say)


def _earlier(data: StudyData, forms: dict[FormKey, Form], out: Path) -> Runs | None:
    """Return the runs that were there when the joint calibration of this study began.

    Their names are kept: runs that it makes itself must not change its decisions when it is
    started again.
    """
    note = out / START
    with contextlib.suppress(OSError, ValueError, KeyError, TypeError, AttributeError):
        kept = json.loads(note.read_text(encoding="utf-8"))
        if kept["study_sha256"] == data.sha256:
            return stored_runs(data, forms, out / RUNS, frozenset(kept["runs"]))
    found = stored_runs(data, forms, out / RUNS)
    names = [] if found is None else list(found.table["case_id"])
    text = json.dumps({"study_sha256": data.sha256, "runs": names}, indent=1)
    write_text(note, text + "\n")
    return found


def _write(result: JointResult, out: Path, command: str, console: Console) -> None:
    """Write table of runs, draws, record and report; what stages of the same study left stays."""
    kept = kept_in(out, result.data.sha256)
    table = result.runs.table.assign(stage="joint").drop(columns="log_tail")
    write_text(out / TABLE, kept.with_runs_of_stages(table).to_csv(index=False))
    write_joint(result, out / RECORD, out / SAMPLES, command)
    with Waiting(console, "writing the report"):
        if not kept.staged_page:
            write_joint_page(result, out / REPORT, command, Drawings(render_case, scene_of_case))
            kept.put_sections_back()
        add_joint_section(result, out / REPORT, kept.staged_values)
