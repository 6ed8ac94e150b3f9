"""Diagnose a study in the directory of its joint calibration, which is made first if need be."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console

from calibrate.causes.diagnosis import Options
from calibrate.causes.studies.extend import write_extended
from calibrate.causes.studies.from_study import with_effects
from calibrate.causes.studies.further.ranking import FURTHER
from calibrate.causes.studies.further.registry import entries_of
from calibrate.causes.studies.result import StudyDiagnosis
from calibrate.causes.studies.study_diagnosis import diagnose_runs
from calibrate.causes.studies.what_if import diagnose_stored
from calibrate.cli.ending import result_directory, said_how_to_continue
from calibrate.cli.joint.study import calibrate_jointly_into
from calibrate.cli.running import running
from calibrate.cli.show.progress import DiagnosisBar
from calibrate.cli.show.streams import Terminal
from calibrate.cli.show.waiting import Waiting
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import Runs
from calibrate.questions.core.stored import stored_runs, tabled_runs
from calibrate.report.diagnosis.section import add_diagnosis_section, page_html, section_html
from calibrate.report.drawing import opaque_png
from calibrate.report.record import provenance, write_diagnosis
from calibrate.report.record_file import read_record
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.failures import failure_lines
from calibrate.runs.stored import (
    DIAGNOSIS,
    DIAGNOSIS_START,
    EXTENDED,
    FIGURE,
    RECORD,
    REPORT,
    RUNS,
    SECTION,
)
from calibrate.study.data import StudyData
from liggghts_io.files import shell_word, write_bytes, write_text

__all__ = ["base_runs_stored", "diagnose_study", "diagnose_tables"]

_HERE = RunOptions()


def diagnose_study(
    data: StudyData,
    out: Path,
    command: str,
    how: RunOptions = _HERE,
    *,
    twins: int | None = None,
    more: int | None = None,
    further: int | None = None,
    options: Options | None = None,
    console: Console | None = None,
) -> StudyDiagnosis:
    """Diagnose a study and write all results into the directory of its joint calibration.

    Parameters
    ----------
    data : StudyData
        The study and what was measured.
    out : Path
        Directory of its results; without a joint calibration in it, that is made first.
    command : str
        Command that continues this work.
    how : RunOptions
        What runs the cases, how many at once and for how long.
    twins, more, further : int, optional
        Most runs of each effect in each emulator, of those added where the evidence of leading
        causes is uncertain (and as many where a strength is), and of further experiments.
    options : Options, optional
        Error rates, and how much is computed.
    console : Console, optional
        Where progress and remarks go, stderr by default.

    Raises
    ------
    CalibrationError, liggghts_io.CaseError
        For mistakes in the study or its data, a record that was changed, too many failed runs, a
        full or read-only disk.
    BugError
        For a fault of this program.
    """
    result_directory(out)
    console = console or Terminal(stderr=True)
    if further != 0:
        entries_of(data)  # a mistake in one is told before the first run
    base = _base_runs(data, out, command, how, console)
    _begun(data, base, out)
    shown = DiagnosisBar(console)
    with said_how_to_continue(out, command, shown.say):
        with running(out, how, shown) as campaign:
            found = diagnose_runs(
                data, base, campaign, twins=twins, more=more,
                further=FURTHER if further is None else further, options=options,
                tell=shown.say, progress=shown.weighing,
            )  # fmt: skip
        with Waiting(console, "writing the report"):
            _write(found, out, command)
    for line in failure_lines(found.runs.table):
        shown.say(line)
    return found


def diagnose_tables(
    data: StudyData,
    tables: Sequence[Path],
    out: Path,
    command: str,
    how: RunOptions | None = None,
    *,
    options: Options | None = None,
    console: Console | None = None,
) -> StudyDiagnosis:
    """Diagnose a study from the runs of tables and write all results.

    Parameters
    ----------
    data : StudyData
    tables : sequence of Path
        Runs of the study without causes and the same with single causes on.
    out : Path
        Directory of the results.
    command : str
        Command that does this again.
    how : RunOptions, optional
        What runs the engine at the best values, without and with the leading cause; nothing is run
        where it is left out.
    options : Options, optional
    console : Console, optional
        Where progress and remarks go, stderr by default.

    Raises
    ------
    CalibrationError, liggghts_io.CaseError
        For a file that is no such table, runs of another study or too few of them, and for a full
        or read-only disk.
    """
    console = console or Terminal(stderr=True)
    names = " and ".join(map(str, tables))
    with Waiting(console, f"learning from the runs of {names}") as wait:
        runs = tabled_runs(data, forms_of(with_effects(data)), *tables)
        result_directory(out)
        if how is None:
            found = diagnose_stored(
                data, runs, options=options, progress=lambda what, _share: wait.tell(what)
            )
            wait.tell("writing the report")
            _write(found, out, command)
            return found
    shown = DiagnosisBar(console)
    with said_how_to_continue(out, command, shown.say):
        with running(out, how, shown) as campaign:
            found = diagnose_stored(
                data, runs, checker=campaign, options=options, progress=shown.weighing
            )
        with Waiting(console, "writing the report"):
            _write(found, out, command)
    return found


def base_runs_stored(data: StudyData, out: Path) -> tuple[Runs | None, dict[str, Any]]:
    """Return the runs of the joint calibration in a directory, and its record.

    Parameters
    ----------
    data : StudyData
    out : Path

    Returns
    -------
    runs : Runs or None
        In the order of their names; None where there is no joint calibration, or where some of
        its runs are gone or are none of this study any more.
    record : dict
        Empty where there is no calibration.

    Raises
    ------
    CalibrationError
        When the record is damaged.
    """
    path = out / RECORD
    if not path.exists():
        return None, {}
    record = read_record(path)
    names = frozenset(record.get("joint", {}).get("runs", ()))
    if not names:
        return None, record
    runs = stored_runs(data, forms_of(data), out / RUNS, names)
    whole = runs is not None and set(runs.table["case_id"]) == names
    return (runs if whole else None), record


def _base_runs(data: StudyData, out: Path, command: str, how: RunOptions, console: Console) -> Runs:
    """Return the runs of the joint calibration, made first where it is not there."""

    def say(line: str) -> None:
        console.print(line, highlight=False, markup=False, soft_wrap=True)

    runs, record = base_runs_stored(data, out)
    if runs is not None:
        say(f"{len(runs)} runs of the joint calibration in {out} are used")
        if record["joint"]["provenance"]["study_sha256"] != data.sha256:
            say(
                "the study was changed since, and these runs still fit; "
                f"'bulkcal calibrate {shell_word(data.path)}' would choose them anew"
            )
        return runs
    if "joint" in record:
        say(f"{out}: the joint calibration is of another study or has lost runs; it is made again")
    else:
        say(f"{out} holds no joint calibration; it is made first, with all runs that are there")
    joint = calibrate_jointly_into(data, out, command, how, console=console)
    order = np.argsort(joint.runs.table["case_id"].to_numpy(dtype=str), kind="stable")
    table = joint.runs.table.iloc[order].reset_index(drop=True)
    return Runs(tuple(joint.runs.specs[k] for k in order), table)


def _begun(data: StudyData, base: Runs, out: Path) -> None:
    """Note that a diagnosis has begun; `status` compares it with what has ended."""
    note = {"study_sha256": data.sha256, "runs": len(base)}
    write_text(out / DIAGNOSIS_START, json.dumps(note) + "\n")


def _write(found: StudyDiagnosis, out: Path, command: str) -> None:
    """Write figure, section, record and the extended study; add the section to the report."""
    written = write_extended(found.found, found.data, out / EXTENDED)
    follows = f"bulkcal calibrate {shell_word(written[0])} --mode joint" if written else ""
    facts = {
        "extended": [str(path) for path in written],
        "next": follows,
        "provenance": provenance(found.data.study, command),
    }
    record = write_diagnosis(found, out / DIAGNOSIS, facts)
    figure = opaque_png(found.figure())
    write_bytes(out / FIGURE, figure)
    write_text(out / SECTION, page_html(section_html(record, figure)))
    if (out / REPORT).exists():
        add_diagnosis_section(record, figure, out / REPORT)
    (out / DIAGNOSIS_START).unlink(missing_ok=True)
