"""Commands for whole studies: calibrate and demo."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from calibrate.cli.cases import AsJson, say, stdout
from calibrate.runs.stored import RECORD, REPORT, RUNS, stored_case
from calibrate.study.resources import bundled_study

if TYPE_CHECKING:
    from calibrate.staged.calibration import Calibration

__all__ = ["REPORT", "RUNS", "calibrate_command", "demo", "diagnose", "run_study", "stored_case"]

Workers = Annotated[int, typer.Option(help="Processes; 0: one per core.")]


def run_study(study_path: Path, out: Path, command: str, workers: int = 0) -> Calibration:
    """Calibrate a study into a directory; see `study_run.run_study`.

    Imported late: smt, scipy and matplotlib cost seconds that `bulkcal --help` should not.
    """
    from calibrate.cli.calibrate_study import run_study as run

    return run(study_path, out, command, workers)


def calibrate_command(
    study: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="Study file.")],
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Default: the study's name.")
    ] = None,
    workers: Workers = 0,
    as_json: AsJson = False,
) -> None:
    """Calibrate a study: runs, surrogates, parameters with intervals, check, report.

    Started again, it goes on where it was.

    Example: bulkcal calibrate cases/proppants/hsp13_steel.toml --out hsp13
    """
    target = out or Path(study.stem)
    extra = f" --workers {workers}" if workers else ""
    _finish(study, target, f"bulkcal calibrate {study} --out {target}{extra}", workers, as_json)


def demo(
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Where to work.")] = Path(
        "demo"
    ),
    workers: Workers = 0,
    as_json: AsJson = False,
) -> None:
    """Calibrate the bundled study, Carbo HSP13 on steel, within some minutes.

    Interrupted and started again, it goes on where it was.

    Example: bulkcal demo
    """
    _finish(bundled_study(), out, f"bulkcal demo --out {out}", workers, as_json)


def diagnose(
    study: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="Study file.")],
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Directory of its calibration; default: name."),
    ] = None,
    start: Annotated[
        Path | None,
        typer.Option("--start", metavar="JSON", help="Start from this record; no calibration."),
    ] = None,
    workers: Workers = 0,
    as_json: AsJson = False,
) -> None:
    """Say what the calibrated simulation still gets wrong and which cause fits.

    Calibrates first if that has not been done. Finished runs are reused; missing ones are
    announced with their cost.

    Example: bulkcal diagnose cases/proppants/hsp13_steel.toml --out hsp13
    """
    from calibrate.cli import diagnose_study as command

    command.diagnose(study, out, start, workers, as_json)


def _finish(study: Path, out: Path, command: str, workers: int, as_json: bool) -> None:
    from calibrate.report.tables import result_tables

    started = time.monotonic()
    result = run_study(study, out, command, workers)
    if as_json:
        say((out / RECORD).read_text(encoding="utf-8").rstrip())
        return
    console = stdout()
    for table in result_tables(result):
        console.print(table)
    for stage in result.stages:
        for sentence in stage.verdict.sentences:
            say(f"{stage.stage.title}: {sentence}")
    minutes = (time.monotonic() - started) / 60.0
    say(f"report: {out / REPORT}   ({len(result.runs)} runs, {minutes:.1f} min this time)")
    say(f"next: open {out / REPORT}, or look for what the model misses: bulkcal diagnose {study}")
