"""Measure somebody else's run with the extractors that experiments of one's own have."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import pandas as pd

from liggghts_io.errors import CaseError, nearest
from liggghts_io.experiments.own.definition import ParameterTable
from liggghts_io.experiments.own.reading import read_definition
from liggghts_io.foreign.columns import sizes_of
from liggghts_io.foreign.dump import FrameTable
from liggghts_io.foreign.output import Output
from liggghts_io.foreign.run import ForeignRun, Grains, part_of
from liggghts_io.measure.extract import Extractor, Run

_DEFINITION: Final = "experiment.toml"


@dataclass(frozen=True)
class Measured:
    """Numbers of a run, frame by frame.

    Attributes
    ----------
    table : DataFrame
        A row for each frame: `step`, `time_s` where the time step is known, and one column for
        each number; empty cells where a frame does not determine it.
    notes : tuple of str
        Why a cell is empty, each reason once.
    """

    table: pd.DataFrame
    notes: tuple[str, ...]


def measure_frames(
    output: Output,
    extractors: Mapping[str, Extractor],
    part: tuple[float, float] | None,
    grains: Grains,
    tell: Callable[[int, int], None] | None = None,
) -> Measured:
    """Measure every frame in a part of a dump; only one is in memory.

    Parameters
    ----------
    output : Output
    extractors : Mapping[str, Extractor]
        By the name of the column of the table.
    part : (float, float), optional
        Part of the frames, from 0 to 1; the last one where it is not given.
    grains : Grains
    tell : callable, optional
        Receives the number of frames that were measured, and of all.

    Raises
    ------
    CaseError
        If a number is determined in no frame, with the reason of the last one.
    """
    wanted = part_of(len(output.dump.steps), part)
    rows = []
    reasons: dict[str, str] = {}
    for done, frame in enumerate(output.frames(wanted), start=1):
        run = ForeignRun(output, grains, {}, frame, whole=False)
        row: dict[str, float] = {"step": frame.step}
        time = output.time_of(frame.step) if frame.time_s is None else frame.time_s
        if time is not None:
            row["time_s"] = time
        for name, extractor in extractors.items():
            try:
                row[name] = _read(name, extractor, run)
            except CaseError as err:
                said = str(err).replace(f": step {frame.step}: ", ": ")
                row[name], reasons[name] = math.nan, f"step {frame.step}: {said}"
        rows.append(row)
        if tell is not None:
            tell(done, len(wanted))
    table = pd.DataFrame(rows)
    for name, reason in reasons.items():
        if table[name].isna().all():
            raise CaseError(reason)
    return Measured(table, tuple(reasons.values()))


@dataclass(frozen=True)
class Observed:
    """What a definition says of a run.

    Attributes
    ----------
    observables : DataFrame
        A row for each observable: `value`, `unit`, `meaning`.
    curves : Mapping[str, DataFrame]
        Curves by name, with `x` and `y`.
    """

    observables: pd.DataFrame
    curves: Mapping[str, pd.DataFrame]


def measure_definition(
    output: Output, folder: Path, apparatus: Mapping[str, float], grains: Grains
) -> Observed:
    """Measure the observables and curves of an `experiment.toml`.

    Parameters
    ----------
    output : Output
    folder : Path
        With `experiment.toml`; a script is not needed.
    apparatus : Mapping[str, float]
        Values of its parameters where they are not the default ones.
    grains : Grains

    Raises
    ------
    CaseError
        With every mistake in the definition, or why the run does not determine a number.
    """
    path = folder / _DEFINITION
    try:
        text = path.read_bytes().decode("utf-8")
    except (OSError, UnicodeDecodeError) as err:
        why = getattr(err, "strerror", None) or "not a text in UTF-8"
        msg = f"{path}: cannot be read ({why}); --experiment DIR names a folder with it"
        raise CaseError(msg) from err
    found, mistakes = read_definition(text, str(path))
    mistakes.tell()
    last = next(output.frames([len(output.dump.steps) - 1]))
    names = _names(found.parameters, apparatus, path) | {"d32_m": _sauter(last, grains)}
    run = ForeignRun(output, grains, names, last, whole=True)
    rows = {}
    for one, extractor in found.observables:
        rows[one.name] = (_read(one.name, extractor, run), one.unit, one.meaning)
    curves = {}
    for curve, curved in found.curves:
        x, y = curved.read(run)
        curves[curve.name] = pd.DataFrame({"x": x * curved.x_factor, "y": y * curved.factor})
    values = pd.DataFrame.from_dict(rows, orient="index", columns=["value", "unit", "meaning"])
    return Observed(values, curves)


def _read(name: str, extractor: Extractor, run: Run) -> float:
    """Return a number, or say with its name why it is not determined."""
    try:
        value = extractor.factor * extractor.read(run)
    except CaseError as err:
        msg = f"{name}: {err}"
        raise CaseError(msg) from err
    if not math.isfinite(value):
        msg = (
            f"{name}: not determined, a value is missing or not finite; a mass needs --density "
            "KG_M3 where the dump has no masses"
        )
        raise CaseError(msg)
    return value


def _names(
    parameters: Mapping[str, ParameterTable], given: Mapping[str, float], path: Path
) -> dict[str, float]:
    for name in given:
        if name not in parameters:
            msg = f"{path}: unknown apparatus parameter {name!r}{nearest(name, list(parameters))}"
            raise CaseError(msg)
    defaults = {
        name: one.default if one.default is not None else one.quick
        for name, one in parameters.items()
    }
    return {name: value for name, value in defaults.items() if value is not None} | dict(given)


def _sauter(table: FrameTable, grains: Grains) -> float:
    """Return the Sauter diameter of the grains of a frame [m], NaN where it is not known."""
    try:
        radius = sizes_of(table.grains, grains.diameter, table.place)
    except CaseError:
        return math.nan
    square = float((radius**2).sum())
    return 2.0 * float((radius**3).sum()) / square if square else math.nan
