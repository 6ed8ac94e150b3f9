"""Diagnose a study into the directory of its calibration, which is made first."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console

from calibrate.cli.calibrate_study import calibrate_study
from calibrate.cli.ending import result_directory, said_how_to_continue
from calibrate.cli.show.progress import RunsBar
from calibrate.diagnose import pipeline
from calibrate.diagnose.extend import write_extended
from calibrate.diagnose.from_study import levels_of, problem_of
from calibrate.diagnose.local.design import DesignOptions
from calibrate.diagnose.pipeline import Diagnosis, Options
from calibrate.report.diagnosis_figure import diagnosis_figure
from calibrate.report.diagnosis_section import TITLE, page_html, section_html
from calibrate.report.record import start_of, write_diagnosis
from calibrate.report.sections import Section, add_section
from calibrate.runs.campaign import Campaign
from calibrate.runs.others import held_case
from calibrate.runs.reuse import StoredRunner
from calibrate.runs.stored import DIAGNOSIS, EXTENDED, FIGURE, REPORT, RUNS, SECTION, stored_case
from calibrate.study.data import StudyData
from liggghts_io import execute
from liggghts_io.files import write_bytes, write_text

__all__ = ["ENGINE_DESIGN", "diagnose_study"]

# Runs of an ordinary study: about two hundred in the first design.
ENGINE_DESIGN = DesignOptions(seeds=1, centre_seeds=4, effect_seeds=2, axial_later=False)
_OPTIONS = Options(design=ENGINE_DESIGN, check_seeds=3, rounds=4)


def diagnose_study(
    data: StudyData,
    out: Path,
    command: str,
    *,
    start: Path | None = None,
    workers: int = 0,
    options: Options = _OPTIONS,
    console: Console | None = None,
) -> Diagnosis:
    """Diagnose a study and write all results into the directory of its calibration.

    Parameters
    ----------
    data : StudyData
        The study and what was measured.
    out : Path
        Directory of the study's results; finished runs in it are reused.
    command : str
        Command that continues this work.
    start : Path, optional
        Record of a calibration to start from; without one the study is calibrated first, and its
        report gets a section.
    workers : int
        Processes, 0 for one per core.
    options : Options
        How much work the diagnosis does.
    console : Console, optional
        Where progress and remarks go, stderr by default.

    Raises
    ------
    CalibrationError, liggghts_io.CaseError
        For mistakes in the study or its data, too many failed runs, a full or read-only disk.
    BugError
        For a fault of this program.
    """
    if start is None:
        result = calibrate_study(data, out, command, workers, console=console)
        parameters = dict(result.parameters)
    else:
        parameters = start_of(start)
    result_directory(out)
    problem = problem_of(data, parameters)
    rng = np.random.default_rng([data.study.run.seed, 3])
    shown = RunsBar("diagnosing", console or Console(stderr=True))
    with said_how_to_continue(out, command, shown.say):
        with shown, _campaign(out, workers, shown) as campaign:
            runner = StoredRunner(
                campaign,
                lambda spec: stored_case(spec, campaign.root),
                shown.say,
                workers=campaign.workers,
                levels=levels_of(data.study),
            )
            found = pipeline.diagnose(problem, runner, rng=rng, options=options, progress=shown.say)
        _write(found, data, out, reported=start is None)
    return found


def _campaign(out: Path, workers: int, shown: RunsBar) -> Campaign:
    return Campaign(
        out / RUNS, execute, stored=stored_case, held=held_case, workers=workers, progress=shown,
        tell=shown.say,
    )  # fmt: skip


def _write(found: Diagnosis, data: StudyData, out: Path, *, reported: bool) -> None:
    """Write figure, section, record and the extended study; add the section to the report."""
    figure = diagnosis_figure(found)
    section = section_html(found, figure)
    write_bytes(out / FIGURE, figure)
    write_text(out / SECTION, page_html(section))
    written = write_extended(found, data, out / EXTENDED)
    facts: dict[str, Any] = {
        "study": data.study.name,
        "study_sha256": data.sha256,
        "extended": [str(p) for p in written],
    }
    write_diagnosis(found, out / DIAGNOSIS, facts)
    if reported:
        add_section(out / REPORT, Section(TITLE, section))
