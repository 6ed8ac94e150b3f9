"""The command `apparatus`: every number of an experiment that a study may change."""

from __future__ import annotations

import math
from typing import Any, Final

from calibrate.cli.arguments import AsJson, ExperimentName, chosen_experiment
from calibrate.cli.show.output import Screen, stdout, table
from liggghts_io.effects import effects_in
from liggghts_io.experiments import (
    EXPERIMENTS,
    SCALES,
    Experiment,
    bundled_folder,
    own_experiment,
)

__all__ = ["apparatus"]


def apparatus(
    experiment: ExperimentName,
    as_json: AsJson = False,
) -> None:
    """Show what can be changed in an experiment: parameters with unit, meaning and limits.

    The experiment is one of the known ones, or the folder of one of your own.

    A parameter goes after -a of 'bulkcal generate', or in a study under [[experiment]] or, to free
    it, under [parameter]; an effect after -e, or under [effects].

    Example: bulkcal apparatus heap
    """
    name, own = chosen_experiment(experiment)
    found = own_experiment(own) if own else EXPERIMENTS[name]
    screen = Screen()
    if as_json:
        screen.json(_plain(found))
        return
    plain = _plain(found)
    narrow = stdout().width < _WIDE
    screen.result(f"{found.title} ({found.name})")
    for title, heading, rows in (
        ("Apparatus parameters", "parameter", plain["parameters"]),
        ("Observables", "observable", plain["observables"]),
        ("Curves", "curve", plain["curves"]),
        ("Effects that act in it", "effect", plain["effects"]),
    ):
        if rows:
            screen.table(_table(title, heading, rows, narrow=narrow))
    if narrow:
        screen.hint(f"limits and sources are shown from {_WIDE} columns on, and by --json")
    folder = None if own else bundled_folder(name)
    if folder is not None:
        screen.result(f"A folder, to be copied and changed: {folder}")


def _plain(experiment: Experiment) -> dict[str, Any]:
    return {
        "experiment": experiment.name,
        "title": experiment.title,
        "parameters": [
            {
                "name": one.name,
                "unit": one.unit,
                "meaning": one.meaning,
                **{scale: getattr(one, scale) for scale in SCALES},
                "lowest": _finite(one.limits[0]),
                "highest": _finite(one.limits[1]),
                "source": one.source,
            }
            for one in experiment.parameters
        ],
        "observables": [
            {
                "name": one.name,
                "unit": one.unit,
                "meaning": one.meaning,
                "lowest": _finite(one.low),
                "highest": _finite(one.high),
            }
            for one in experiment.observables
        ],
        "curves": [
            {
                "name": one.name,
                "unit": one.unit,
                "meaning": one.meaning,
                "over": f"{one.x_name} ({one.x_unit})",
                "levels": " ".join(f"{level:g}" for level in one.levels),
            }
            for one in experiment.curves
        ],
        "effects": [
            {
                "name": one.name,
                "unit": one.unit,
                "meaning": one.meaning,
                "lowest": _finite(one.low),
                "highest": _finite(one.high),
            }
            for one in effects_in(experiment).values()
        ],
    }


_WIDE: Final = 140
"""Columns of a window from which all of a table is shown; in a narrower one words would be cut."""
_LEFT_OUT: Final = ("lowest", "highest", "source")
_TEXTS: Final = ("unit", "meaning", "source", "over", "levels")


def _finite(value: float) -> float | None:
    """Return a limit, or None where there is none; JSON knows no infinity."""
    return value if math.isfinite(value) else None


def _table(title: str, heading: str, rows: list[dict[str, Any]], *, narrow: bool) -> Any:
    left_out = ("name", *(_LEFT_OUT if narrow else ()))
    keys = [key for key in rows[0] if key not in left_out and any(row[key] != "" for row in rows)]
    numbers = [key for key in keys if key not in _TEXTS]
    shown = table([heading, *keys], numbers, title)
    for column in shown.columns:
        column.no_wrap = column.header in (heading, *numbers)
    for row in rows:
        cells = (row["name"], *(row[key] for key in keys))
        shown.add_row(*(_cell(one) for one in cells))
    return shown


def _cell(value: float | str | None) -> str:
    if value is None:
        return "any"
    return value if isinstance(value, str) else f"{value:g}"
