"""Commands for whole studies: calibrate, demo and diagnose.

What they do is imported late: smt, scipy and matplotlib cost seconds that `bulkcal --help` should
not.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from calibrate.cli.arguments import AsJson
from calibrate.cli.output import say, say_json, stdout
from calibrate.runs.stored import DIAGNOSIS, FIGURE, RECORD, REPORT
from calibrate.study.resources import bundled_study

__all__ = ["calibrate_command", "demo", "diagnose"]

Workers = Annotated[int, typer.Option(help="Processes; 0: one per core.")]


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


def _finish(study: Path, out: Path, command: str, workers: int, as_json: bool) -> None:
    from calibrate.cli.calibrate_study import calibrate_study
    from calibrate.report.tables import result_tables
    from calibrate.study.data import load_data

    started = time.monotonic()
    result = calibrate_study(load_data(study), out, command, workers)
    if as_json:
        say((out / RECORD).read_text(encoding="utf-8").rstrip())
        return
    console = stdout()
    for table in result_tables(result):
        console.print(table)
    for stage in result.stages:
        for sentence in result.sentences(stage):
            say(f"{stage.stage.title}: {sentence}")
    minutes = (time.monotonic() - started) / 60.0
    say(f"report: {out / REPORT}   ({len(result.runs)} runs, {minutes:.1f} min this time)")
    say(f"next: open {out / REPORT}, or look for what the model misses: bulkcal diagnose {study}")


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
    from calibrate.cli.diagnose_study import diagnose_study
    from calibrate.report.record import as_data
    from calibrate.report.tables import show_diagnosis
    from calibrate.study.data import load_data

    target = out or Path(study.stem)
    command = f"bulkcal diagnose {study} --out {target}"
    found = diagnose_study(load_data(study), target, command, start=start, workers=workers)
    if as_json:
        say_json(as_data(found))
        return
    show_diagnosis(found, Console(file=sys.stdout))
    say(f"figure: {target / FIGURE}, record: {target / DIAGNOSIS}")
