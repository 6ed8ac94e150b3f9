"""What if something had been measured: the diagnosis once more from the runs that are there."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from rich.console import Console

from calibrate.causes.diagnosis import Options
from calibrate.causes.studies.from_study import with_effects
from calibrate.causes.studies.result import StudyDiagnosis
from calibrate.causes.studies.suppose import Supposed
from calibrate.causes.studies.what_if import diagnose_again
from calibrate.cli.diagnose_study import diagnose_study
from calibrate.cli.ending import result_directory, said_how_to_continue
from calibrate.cli.plans.diagnosis import plan_of_diagnosis
from calibrate.cli.plans.study import heading
from calibrate.cli.show.streams import Terminal
from calibrate.cli.show.waiting import Waiting
from calibrate.errors import CalibrationError
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import Runs
from calibrate.questions.core.stored import runs_named
from calibrate.report.diagnosis.section import page_html, section_html
from calibrate.report.drawing import opaque_png
from calibrate.report.record import provenance, write_diagnosis
from calibrate.report.record_file import kept_part
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.stored import DIAGNOSIS, FIGURE, RUNS, SECTION, WHAT_IF, stored_case
from calibrate.study.data import StudyData
from liggghts_io.files import write_bytes, write_text

__all__ = ["folder_of", "plan_of_what_if", "what_if_study"]

LONGEST: Final = 120
"""Letters of a folder's name; file systems take twice as many."""
_HERE = RunOptions()


def folder_of(supposed: Sequence[Supposed]) -> str:
    """Return the name of the folder of a supposition, whatever the order.

    Examples
    --------
    >>> folder_of([Supposed("plate_period", "", 0.0, 0.005)])
    'plate_period=0+-0.005'
    """
    whole = "_".join(sorted(one.word for one in supposed))
    plain = re.sub(r"[^A-Za-z0-9_.=+@-]", "-", whole.replace(":", "@"))
    if len(plain) <= LONGEST:
        return plain
    return f"{plain[:LONGEST]}_{hashlib.sha256(whole.encode()).hexdigest()[:8]}"


def plan_of_what_if(
    data: StudyData, supposed: Sequence[Supposed], out: Path, how: RunOptions,
    twins: int | None, more: int | None, further: int | None,
) -> dict[str, Any]:  # fmt: skip
    """Return what `what_if_study` would do; parameters as there."""
    place = f"{WHAT_IF}/{folder_of(supposed)}"
    writes = [f"{place}/{name}" for name in (DIAGNOSIS, FIGURE, SECTION)]
    asked = {"what if": [one.word for one in supposed]}
    stored = _stored(data, out, how)
    if stored is None:
        facts = plan_of_diagnosis(data, out, how, twins, more, further) | asked
        facts["would write"] = [*facts["would write"], *writes]
        return facts
    used = f"no run; the {len(stored[1])} runs of the diagnosis in {out} are used"
    return {**heading(data, out, how), **asked, "diagnosis": [used], "would write": writes}


def what_if_study(
    data: StudyData,
    wanted: StudyData,
    supposed: Sequence[Supposed],
    out: Path,
    command: str,
    how: RunOptions = _HERE,
    *,
    twins: int | None = None,
    more: int | None = None,
    further: int | None = None,
    options: Options | None = None,
    console: Console | None = None,
) -> Path:
    """Diagnose a study as if more had been measured, and write that beside its diagnosis.

    Parameters
    ----------
    data : StudyData
        The study as it is.
    wanted, supposed
        From `calibrate.causes.studies.suppose.suppose`.
    out : Path
        Directory of the diagnosis; without one of this study in it, that is made first.
    command : str
        Command that continues this work.
    how : RunOptions
        What runs the cases of a diagnosis that is made first.
    twins, more, further, options
        Of that diagnosis, see `diagnose_study`.
    console : Console, optional
        Where progress and remarks go, stderr by default.

    Returns
    -------
    Path
        The folder with `diagnosis.json`, `.png` and `.html`.

    Raises
    ------
    CalibrationError, liggghts_io.CaseError
        As `diagnose_study`.
    """
    console = console or Terminal(stderr=True)
    result_directory(out)
    asked = {"twins": twins, "more": more, "further": further, "options": options}
    before, runs = _made(data, out, command, how, console, asked)
    with (
        said_how_to_continue(out, command, lambda line: _say(console, line)),
        Waiting(console, "learning from the runs") as wait,
    ):
        found = diagnose_again(
            wanted, runs, twins=before["twins"], added=before["added"], few=before["few_twins"],
            options=options, progress=lambda what, _share: wait.tell(what),
        )  # fmt: skip
        wait.tell("writing the page")
        folder = out / WHAT_IF / folder_of(supposed)
        _write(found, supposed, before, folder, command)
    return folder


def _made(
    data: StudyData, out: Path, command: str, how: RunOptions, console: Console,
    asked: dict[str, Any],
) -> tuple[dict[str, Any], Runs]:  # fmt: skip
    """Return the diagnosis of a directory and its runs, made first where it is not there."""
    stored = _stored(data, out, how)
    if stored is None:
        _say(console, f"{out} holds no diagnosis of this study with all its runs; it is made first")
        diagnose_study(data, out, command, how, console=console, **asked)
        stored = _stored(data, out, how)
    if stored is None:
        msg = f"{out}: not every run of the diagnosis has ended; go on with: {command}"
        raise CalibrationError(msg)
    _say(console, f"{len(stored[1])} runs of the diagnosis in {out} are used, none is made")
    return stored


def _write(
    found: StudyDiagnosis, supposed: Sequence[Supposed], before: Mapping[str, Any], folder: Path,
    command: str,
) -> None:  # fmt: skip
    """Write record, figure and page."""
    told = ("verdict", "names", "headline", "probabilities", "pairs", "inclusion")
    facts = {
        "extended": [],
        "next": "",
        "supposed": [{"name": s.called, "value": s.value, "se": s.se} for s in supposed],
        "before": {key: before[key] for key in told},
        "provenance": provenance(found.data.study, command),
    }
    folder.mkdir(parents=True, exist_ok=True)
    record = write_diagnosis(found, folder / DIAGNOSIS, facts)
    figure = opaque_png(found.figure())
    write_bytes(folder / FIGURE, figure)
    write_text(folder / SECTION, page_html(section_html(record, figure)))


def _say(console: Console, line: str) -> None:
    console.print(line, highlight=False, markup=False, soft_wrap=True)


def _stored(data: StudyData, out: Path, how: RunOptions) -> tuple[dict[str, Any], Runs] | None:
    """Return the diagnosis of a directory and its runs; None where it is of another study."""
    record = kept_part(out / DIAGNOSIS, data.sha256)
    if "inclusion" not in record:  # there is none, or one of an earlier version
        return None
    forms = forms_of(with_effects(data))
    runs = runs_named(record["runs"], forms, out / RUNS, how.limited(stored_case))
    return None if runs is None else (record, runs)
