"""The command `status`: how far the runs in a directory are."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from calibrate.cli.arguments import AsJson
from calibrate.cli.show.output import Screen
from calibrate.cli.show.waiting import Waiting, clock
from calibrate.errors import CalibrationError
from calibrate.runs.stored import DIAGNOSIS, DIAGNOSIS_START, RUNS, START, WHAT_IF
from calibrate.runs.stored import RECORD as RESULT
from liggghts_io.case.directory import RECORD
from liggghts_io.files import shell_word

if TYPE_CHECKING:
    from calibrate.runs.status import Status

__all__ = ["status"]

MOST_SHOWN: Final = 10
"""Lines of each kind; --json has them all."""


def status(
    directory: Annotated[
        Path, typer.Argument(metavar="DIR", help="Directory of a calibration, or of cases.")
    ],
    as_json: AsJson = False,
) -> None:
    """Say how far the runs are: done, failed and why, running and where, still to come.

    Also while they go on, from any machine that sees the directory. Nothing is changed; an index
    beside the cases makes the next time faster.

    Example: bulkcal status hsp13
    """
    from calibrate.runs.status import status_of  # what --help does not need

    if not directory.is_dir():
        msg = f"{directory}: no such directory; name the --out of a calibration"
        raise CalibrationError(msg)
    if (directory / RECORD).exists():
        command = f"bulkcal run {shell_word(directory)} --dry-run"
        msg = f"{directory}: is a single case; see it with '{command}'"
        raise CalibrationError(msg)
    root = directory / RUNS if (directory / RUNS).is_dir() else directory
    screen = Screen()
    with Waiting(screen.console, f"reading {root}"):
        found = status_of(root)
    results, calibrated = _results(directory)
    if as_json:
        screen.json({**_as_data(found), "results": results})
        return
    for line in [*_lines(found), *results]:
        screen.result(line)
    if follows := _next(directory, found, calibrated):
        screen.hint(f"next: {follows}")


def _next(directory: Path, found: Status, calibrated: bool) -> str:
    """Return what follows; nothing while runs go on."""
    place = shell_word(directory)
    if found.campaigns:
        return ""
    if found.failures:
        return f"bulkcal retry {place}, to let failed runs run again"
    return f"bulkcal export {place}" if calibrated else ""


def _results(directory: Path) -> tuple[list[str], bool]:
    """Say which results of a study are there, and whether one has begun and not ended.

    Returns
    -------
    (list of str, bool)
        Also whether there is a calibration that can be read.
    """
    from calibrate.report.record_file import of_this_version, read_record

    lines: list[str] = []
    record: dict[str, Any] = {}
    if (directory / RESULT).exists():
        try:
            record = read_record(directory / RESULT)
            with of_this_version(directory / RESULT):
                lines += _calibrated(directory / RESULT, record)
        except CalibrationError as err:
            record = {}
            lines.append(str(err))
    joint = record.get("joint")
    try:
        began = json.loads((directory / START).read_text(encoding="utf-8"))
        open_ = joint is None or joint["provenance"]["study_sha256"] != began["study_sha256"]
        if open_:
            lines.append(
                f"joint calibration: began with {len(began['runs'])} runs that were there, and has "
                "not ended; the same command goes on"
            )
    except (OSError, ValueError, KeyError, TypeError):
        pass  # none was begun here
    lines += _diagnosis(directory, record.get("study_sha256"))
    return lines, bool(record)


def _calibrated(path: Path, record: Mapping[str, Any]) -> list[str]:
    """Say what a record of a calibration holds, and whether its data changed since."""
    from calibrate.report.record_file import outdated

    lines = list(filter(None, [outdated(path, record)]))
    if "stages" in record:
        lines.append(f"calibrated by stages: {record['runs']} runs")
    joint = record.get("joint")
    if joint is not None:
        spent = joint["provenance"]["runs_of_budget"]
        loose = sum(not one["determined"] for one in joint["unknowns"])
        lines.append(
            f"calibrated jointly: {len(joint['runs'])} runs, {spent} of them of the budget; "
            f"{len(joint['unknowns']) - loose} unknowns determined, {loose} not"
        )
    return lines


def _diagnosis(directory: Path, study_sha256: str | None) -> list[str]:
    """Say what a diagnosis found, whether of other data, and whether one has not ended."""
    from calibrate.report.record_file import read_record

    def headline(path: Path) -> str:
        found = read_record(path)
        other = study_sha256 not in (None, found.get("study_sha256"))
        return f"{found['headline']}{' (of other data than the calibration)' if other else ''}"

    lines = []
    if (directory / DIAGNOSIS).exists():
        try:
            lines.append(f"diagnosed: {headline(directory / DIAGNOSIS)}")
        except (CalibrationError, KeyError):
            lines.append(
                f"{directory / DIAGNOSIS}: holds no diagnosis; run 'bulkcal diagnose' again"
            )
    for path in sorted((directory / WHAT_IF).glob(f"*/{DIAGNOSIS}")):
        with suppress(CalibrationError, KeyError):
            lines.append(f"what if {path.parent.name}: {headline(path)}")
    if (directory / DIAGNOSIS_START).exists():
        lines.append("diagnosis: has begun and not ended; the same command goes on")
    return lines


def _as_data(found: Status) -> dict[str, Any]:
    return {
        "directory": str(found.root),
        "done": found.done,
        "failed": found.failures,
        "failures": [asdict(group) for group in found.failed],
        "damaged": [{"case": one.name, "reason": one.reason} for one in found.damaged],
        "running": [{"case": one.name, "who": one.reason} for one in found.running],
        "unfinished": found.unfinished,
        "waiting": found.waiting,
        "per_hour": found.per_hour,
        "left_s": found.left_s,
        "campaigns": [asdict(plan) for plan in found.campaigns],
    }


def _lines(found: Status) -> list[str]:
    counts = [f"{found.done} done", f"{found.failures} failed"]
    further = {
        "running": len(found.running),
        "waiting": found.waiting,
        "unfinished": found.unfinished,
        "damaged": len(found.damaged),
    }
    counts += [f"{count} {name}" for name, count in further.items() if count]
    lines = [f"{found.root}: {', '.join(counts)}"]
    lines += _some(
        f"  failed, {group.failure}: {group.reason} "
        f"({f'{group.runs} runs like this, first ' if group.runs > 1 else ''}{group.first})"
        for group in found.failed
    )
    lines += _some(f"  damaged: {one.name}: {one.reason}" for one in found.damaged)
    lines += _some(f"  running: {one.name}: {one.reason}" for one in found.running)
    for plan in found.campaigns:
        lines.append(f"  campaign '{plan.label}', {plan.done} of {plan.total} runs: {plan.who}")
    if not found.campaigns:
        lines.append("no campaign is at work here")
    elif found.left_s is None or found.per_hour is None:
        lines.append("rate and time left: after the next runs")
    else:
        lines.append(
            f"{found.per_hour:.3g} runs per hour, time left for them {clock(found.left_s)}"
        )
    return lines


def _some(lines: Iterable[str]) -> list[str]:
    """Return the first lines, and how many there are beside."""
    every = list(lines)
    more = [f"  and {len(every) - MOST_SHOWN} more"] if len(every) > MOST_SHOWN else []
    return every[:MOST_SHOWN] + more
