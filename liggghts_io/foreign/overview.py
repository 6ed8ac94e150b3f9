"""Tell what a run left: dumps, frames, grains, and what every column ranges over."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import pandas as pd

from liggghts_io.foreign.columns import unit_of
from liggghts_io.foreign.dump import Series, frames_of, index_of
from liggghts_io.foreign.output import Output


@dataclass(frozen=True)
class DumpFacts:
    """What a dump holds.

    Attributes
    ----------
    name, kind : str
    files, frames : int
    steps : (int, int)
        Of the first and the last frame.
    grains : (int, int)
        Least and largest number in a frame.
    columns : DataFrame
        A row for each column: `unit`, `least` and `largest` over all frames.
    notes : tuple of str
        What was left out.
    """

    name: str
    kind: str
    files: int
    frames: int
    steps: tuple[int, int]
    grains: tuple[int, int]
    columns: pd.DataFrame
    notes: tuple[str, ...]


def facts_of(
    series: Series, units: str, tell: Callable[[int, int], None] | None = None
) -> DumpFacts:
    """Read a dump once and return what it holds.

    Parameters
    ----------
    series : Series
    units : str
        System of units of the run.
    tell : callable, optional
        Receives the number of frames that were read, and of all.

    Raises
    ------
    DamagedFile
        If a frame cannot be read, with file and line.
    """
    dump = index_of(series)
    least, largest = pd.Series(dtype=float), pd.Series(dtype=float)
    counts = []
    for number, frame in enumerate(frames_of(dump, units), start=1):
        counts.append(len(frame.grains))
        least = pd.concat([least, frame.grains.min()], axis=1).min(axis=1)
        largest = pd.concat([largest, frame.grains.max()], axis=1).max(axis=1)
        if tell is not None:
            tell(number, len(dump.steps))
    columns = pd.DataFrame({"least": least, "largest": largest})
    columns.insert(0, "unit", [unit_of(str(name), units) for name in columns.index])
    return DumpFacts(
        dump.name,
        series.kind,
        len(series.files),
        len(dump.steps),
        (dump.steps[0], dump.steps[-1]),
        (min(counts), max(counts)),
        columns,
        dump.notes,
    )


def thermo_facts(output: Output) -> pd.DataFrame:
    """Return `first`, `last`, `least` and `largest` value of every thermo column."""
    thermo = output.thermo
    if thermo.empty:
        return pd.DataFrame(columns=["first", "last", "least", "largest"])
    ends = {"first": thermo.iloc[0], "last": thermo.iloc[-1]}
    return pd.DataFrame(ends | {"least": thermo.min(), "largest": thermo.max()})
