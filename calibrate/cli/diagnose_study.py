"""`bulkcal diagnose study.toml`."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich.console import Console

from calibrate.diagnose import pipeline
from calibrate.diagnose.extend import baseline_digest, write_extended
from calibrate.diagnose.from_study import problem_of
from calibrate.diagnose.local_design import DesignOptions
from calibrate.diagnose.pipeline import Diagnosis, Options
from calibrate.errors import CalibrationError
from calibrate.report.diagnosis_screen import show
from calibrate.report.record import as_data, write_record
from calibrate.runs.campaign import Campaign
from calibrate.runs.reuse import StoredRunner
from calibrate.staged.calibration import Calibration
from calibrate.study.model import Study, load_study

__all__ = ["diagnose", "diagnose_study"]

RECORD, FIGURE, SECTION = "diagnosis.json", "diagnosis.png", "diagnosis.html"
# Runs of an ordinary study: about two hundred in the first design.
ENGINE_DESIGN = DesignOptions(seeds=1, centre_seeds=4, effect_seeds=2, axial_later=False)
_OPTIONS = Options(design=ENGINE_DESIGN, check_seeds=3, rounds=4)


def start_of(record: Path) -> dict[str, float]:
    """Read the staged result from a calibration's record.

    Raises
    ------
    CalibrationError
        When the file does not hold one.
    """
    try:
        data = json.loads(record.read_text(encoding="utf-8"))
        return {str(k): float(v) for k, v in data["parameters"].items()}
    except (OSError, ValueError, KeyError, AttributeError, TypeError) as err:
        msg = f"{record}: holds no calibration ({err}); run 'bulkcal calibrate' again"
        raise CalibrationError(msg) from err


def diagnose_study(
    path: Path,
    start: Mapping[str, float],
    out: Path,
    console: Console,
    *,
    workers: int = 0,
    options: Options = _OPTIONS,
) -> Diagnosis:
    """Diagnose a study around `start` and write all results into a directory.

    Parameters
    ----------
    path : Path
        Study file.
    start : mapping
        Contact parameters, usually the staged result.
    out : Path
        Directory of the study's results; finished runs in it are reused.
    console : Console
        Receives progress.
    workers : int
        Processes, 0 for one per core.

    Raises
    ------
    CalibrationError
        For mistakes in the study or its data, or too many failed runs.
    """
    from calibrate.cli.studies import RUNS, stored_case
    from liggghts_io import execute

    study = load_study(path)
    problem = problem_of(study, path, start)
    rng = np.random.default_rng([study.seed, 3])

    def tell(line: str) -> None:
        console.print(line, markup=False, highlight=False, soft_wrap=True)

    with Campaign(out / RUNS, execute, stored=stored_case, workers=workers) as campaign:
        runner = StoredRunner(
            campaign,
            lambda spec: stored_case(spec, campaign.root),
            tell,
            workers=campaign.workers,
        )
        found = pipeline.diagnose(problem, runner, rng=rng, options=options, progress=tell)
    _write(found, study, path, out)
    return found


def _write(found: Diagnosis, study: Study, path: Path, out: Path) -> None:
    """Write record, figure, report section and the extended study."""
    from calibrate.report.diagnosis_figure import diagnosis_figure
    from calibrate.report.diagnosis_section import page_html

    (out / FIGURE).write_bytes(diagnosis_figure(found))
    (out / SECTION).write_text(page_html(found), encoding="utf-8")
    written = write_extended(found, study, path, out / "extended")
    facts: dict[str, Any] = {
        "study": study.name,
        "study_sha256": baseline_digest(path),
        "extended": [str(p) for p in written],
    }
    write_record(found, out / RECORD, facts)


def diagnose(
    study: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="Study file.")],
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Directory of its calibration; default: name."),
    ] = None,
    start: Annotated[
        Path | None,
        typer.Option("--start", metavar="JSON", help="Start from this record, do not calibrate."),
    ] = None,
    workers: Annotated[int, typer.Option(help="Processes; 0: one per core.")] = 0,
    as_json: Annotated[bool, typer.Option("--json", help="Print the record as JSON.")] = False,
) -> None:
    """Say what the calibrated simulation still gets wrong and which cause fits.

    Starts from the calibration, which is done first where it is missing; the report gets a
    section. Finished runs are reused, missing ones announced with their cost.

    Example: bulkcal diagnose cases/proppants/hsp13_steel.toml --out hsp13
    """
    target = out or Path(study.stem)
    console = Console(stderr=True)
    command = f"bulkcal diagnose {study} --out {target}"
    calibration: Calibration | None = None
    if start is None:
        from calibrate.cli.studies import run_study

        calibration = run_study(study, target, command, workers)
        parameters = dict(calibration.parameters)
    else:
        parameters = start_of(start)
    target.mkdir(parents=True, exist_ok=True)
    found = diagnose_study(study, parameters, target, console, workers=workers)
    if calibration is not None:
        _report(calibration, found, target, command)
    if as_json:
        sys.stdout.write(json.dumps(as_data(found), indent=1) + "\n")
        return
    show(found, Console(file=sys.stdout))
    sys.stdout.write(f"figure: {target / FIGURE}, record: {target / RECORD}\n")


def _report(calibration: Calibration, found: Diagnosis, out: Path, command: str) -> None:
    """Write the calibration's report again, with the diagnosis in it."""
    from calibrate.cli.studies import REPORT
    from calibrate.report.diagnosis_section import TITLE, section_html
    from calibrate.report.page import Section, write_report
    from liggghts_io import render_case

    section = Section(TITLE, section_html(found))
    write_report(calibration, out / REPORT, command=command, render=render_case, extra=[section])
