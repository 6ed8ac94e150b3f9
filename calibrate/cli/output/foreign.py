"""Look at output without our records: tell what it is, or measure it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from calibrate.cli.arguments import new_file
from calibrate.cli.output.options import Request, extractors_of, part_of
from calibrate.cli.show.output import Screen, table
from calibrate.cli.show.waiting import StepBar, Waiting
from calibrate.errors import CalibrationError
from liggghts_io.errors import DamagedFile
from liggghts_io.files import shell_word, write_text
from liggghts_io.foreign import (
    DumpFacts,
    Output,
    facts_of,
    measure_definition,
    measure_frames,
    read_output,
    thermo_facts,
)

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["look_at"]

_ENDS: Final = 6  # rows of a long table that are shown at its begin and at its end
_CSV: Final = ".csv"
_DIGITS: Final = "%.12g"  # of numbers in a file


def look_at(place: Path, request: Request, screen: Screen, as_json: bool) -> None:
    """Do what a request asks of a folder or file of dumps.

    Raises
    ------
    CalibrationError, liggghts_io.CaseError
        For words that mean nothing, and files that cannot be measured.
    """
    extractors, part = extractors_of(request), part_of(request.frames)
    _check_out(request)
    with Waiting(screen.console, f"looking at {place}"):
        output = read_output(place, request.dump, request.units, request.timestep)
        measured = bool(extractors or request.folder) and output.dump
    for note in output.notes if measured else output.remarks:
        screen.remark(note)
    if request.folder:
        _definition(output, request, screen, as_json)
    elif request.thermo:
        _thermo(output, request, screen, as_json)
    elif extractors:
        name = output.dump.name
        with StepBar(f"measuring {name}", screen.console) as bar:
            found = measure_frames(output, extractors, part, request.grains, bar)
        for note in found.notes:
            screen.remark(f"left empty: {note}")
        facts = {"dump": name, "units": output.units, "notes": [*output.notes, *found.notes]}
        _give(found.table, facts, request, screen, as_json)
        if not as_json:
            _means(found.table, screen)
    else:
        _overview(output, place, screen, as_json)


def _check_out(request: Request) -> None:
    """Refuse a table nobody can write, before anything is read."""
    out = request.out
    if out is None:
        return
    if not (request.measures or request.thermo or request.folder):
        msg = f"--out {out}: nothing is measured; add --angle, --column NAME, --count or --thermo"
        raise CalibrationError(msg)
    if out.suffix != _CSV or out.is_dir():
        msg = f"--out {out}: name a file that ends in .csv"
        raise CalibrationError(msg)
    if not out.parent.is_dir():
        msg = f"--out {out}: there is no directory {out.parent}; make it first"
        raise CalibrationError(msg)
    new_file("--out", out)


def _give(
    found: pd.DataFrame, facts: Mapping[str, Any], request: Request, screen: Screen, as_json: bool
) -> None:
    """Print a table, or write it where it was asked for."""
    if request.out is not None:
        write_text(request.out, _csv(found))
    if as_json:
        screen.json({**facts, "table": _plain(found)})
        return
    if request.out is not None:
        screen.result(f"wrote {request.out}: {len(found)} rows of {', '.join(map(str, found))}")
        return
    names = [str(name) for name in found]
    shown = table(names, names)
    rows = [[_number(value) for value in row] for row in found.itertuples(index=False)]
    cut = len(rows) > 2 * _ENDS + 1
    for row in rows[:_ENDS] if cut else rows:
        shown.add_row(*row)
    if cut:
        shown.add_row(*["..."] * len(names))
        for row in rows[-_ENDS:]:
            shown.add_row(*row)
    screen.table(shown)


def _csv(found: pd.DataFrame) -> str:
    return str(found.to_csv(index=False, lineterminator="\n", float_format=_DIGITS))


def _means(found: pd.DataFrame, screen: Screen) -> None:
    """Say the mean over the frames of every number that was measured."""
    if len(found) > 1:
        numbers = found.drop(columns=["step", "time_s"], errors="ignore")
        means, counts = numbers.mean(), numbers.count()  # a frame may have none
        frames = "" if (counts == len(found)).all() else f"up to {counts.max()} of "
        words = ", ".join(f"{name} {value:.6g}" for name, value in means.items())
        screen.hint(f"mean of {frames}{len(found)} frames: {words}")


def _thermo(output: Output, request: Request, screen: Screen, as_json: bool) -> None:
    if output.log is None or output.thermo.empty:
        msg = f"{output.root}: no log with a thermo table (log.liggghts)"
        raise CalibrationError(msg)
    _give(output.thermo, {"log": output.log.name}, request, screen, as_json)


def _definition(output: Output, request: Request, screen: Screen, as_json: bool) -> None:
    with Waiting(screen.console, f"measuring {output.dump.name}"):
        found = measure_definition(output, Path(request.folder), request.apparatus, request.grains)
    values = found.observables.rename_axis("observable").reset_index()
    facts = {
        "dump": output.dump.name,
        "units": output.units,
        "notes": list(output.notes),
        "curves": {name: _plain(curve) for name, curve in found.curves.items()},
    }
    out = request.out
    beside = {n: out.with_name(f"{out.stem}_{n}{_CSV}") for n in found.curves} if out else {}
    for path in beside.values():
        new_file("--out", path)
    _give(values, facts, request, screen, as_json)
    for name, curve in {} if as_json else found.curves.items():
        if name not in beside:
            screen.hint(f"curve {name}: {len(curve)} points; --out FILE.csv writes it beside")
            continue
        write_text(beside[name], _csv(curve))
        screen.result(f"wrote {beside[name]}")


def _overview(output: Output, place: Path, screen: Screen, as_json: bool) -> None:
    """Tell what there is, and the next command."""
    if output.thermo.empty:
        output.first()
    facts, damaged = [], []
    for series in output.series:
        try:
            with StepBar(f"reading {series.name}", screen.console) as bar:
                facts.append(facts_of(series, output.units, bar))
        except DamagedFile as err:  # the other dumps are told all the same
            damaged.append(str(err))
    thermo = thermo_facts(output)
    if damaged and not facts:
        raise CalibrationError(damaged[0])
    notes = [*(note for one in facts for note in one.notes), *damaged]
    for note in notes:
        screen.remark(note)
    if as_json:
        screen.json(_plain_overview(output, facts, thermo, notes))
        return
    step = f", time step {output.dt:g} s" if output.dt is not None else ""
    screen.hint(f"{place}: units {output.units}{step}")
    _show_dumps(facts, screen)
    if output.log is not None and not thermo.empty:
        names = [str(name) for name in thermo]
        shown = table(["column", *names], names, f"{output.log.name}: {len(output.thermo)} rows")
        for name, row in thermo.iterrows():
            shown.add_row(str(name), *(_number(value) for value in row))
        screen.table(shown)
    screen.hint(f"next: {_next(facts, place)}")


def _show_dumps(facts: Sequence[DumpFacts], screen: Screen) -> None:
    shown = table(["dump", "kind", "files", "frames", "steps", "grains"], ["files", "frames"])
    for one in facts:
        shown.add_row(
            one.name, one.kind, str(one.files), str(one.frames), _range(*one.steps),
            _range(*one.grains),
        )  # fmt: skip
    if facts:
        screen.table(shown)
    for one in facts[:1]:
        columns = table(["column", "unit", "least", "largest"], ["least", "largest"], one.name)
        for name, unit, least, largest in one.columns.itertuples():
            columns.add_row(str(name), unit, _number(least), _number(largest))
        screen.table(columns)
    for one in facts[1:]:
        screen.hint(f"{one.name}: {', '.join(map(str, one.columns.index))}")


def _next(facts: Sequence[DumpFacts], place: Path) -> str:
    """Return the command that a person would type next."""
    if not facts:
        return f"bulkcal post {shell_word(place)} --thermo"
    columns = set(facts[0].columns.index)
    if {"radius", "diameter"} & columns:
        return f"bulkcal post {shell_word(place)} --angle --frames last"
    fast = "speed" if {"vx", "vy", "vz"} <= columns else "z"
    return f"bulkcal post {shell_word(place)} --column {fast}"


def _range(low: int, high: int) -> str:
    return f"{low}" if low == high else f"{low} to {high}"


def _number(value: Any) -> str:
    if isinstance(value, str):
        return value
    return "" if math.isnan(value) else f"{value:.6g}"


def _plain(found: pd.DataFrame) -> list[dict[str, Any]]:
    """Return the rows of a table as JSON holds them; what is no finite number is null."""
    return [
        {str(name): value if _is_told(value) else None for name, value in row.items()}
        for row in found.to_dict("records")
    ]


def _is_told(value: Any) -> bool:
    return not isinstance(value, float) or math.isfinite(value)


def _plain_overview(
    output: Output, facts: Sequence[DumpFacts], thermo: pd.DataFrame, notes: Sequence[str]
) -> dict[str, Any]:
    return {
        "units": output.units,
        "dt_s": output.dt,
        "dumps": [
            {
                "name": one.name,
                "kind": one.kind,
                "files": one.files,
                "frames": one.frames,
                "steps": list(one.steps),
                "grains": list(one.grains),
                "columns": _plain(one.columns.rename_axis("name").reset_index()),
            }
            for one in facts
        ],
        "thermo": _plain(thermo.rename_axis("name").reset_index()),
        "notes": [*output.remarks, *notes],
    }
