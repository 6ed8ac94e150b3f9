"""The command `apparatus`: every number of an experiment that a study may change."""

from __future__ import annotations

import math
from typing import Any

from calibrate.cli.arguments import AsJson, ExperimentName, one_of
from calibrate.cli.show.output import Screen, table
from liggghts_io.effects import EFFECTS
from liggghts_io.experiments import EXPERIMENTS, SCALES, Experiment

__all__ = ["apparatus"]


def apparatus(
    experiment: ExperimentName,
    as_json: AsJson = False,
) -> None:
    """Show what can be changed in an experiment: parameters with unit, meaning and limits.

    A parameter goes after -a of 'bulkcal generate', or in a study under [[experiment]] or, to free
    it, under [parameter]; an effect after -e, or under [effects].

    Example: bulkcal apparatus heap
    """
    found = EXPERIMENTS[one_of("EXPERIMENT", experiment, EXPERIMENTS)]
    screen = Screen()
    if as_json:
        screen.json(_plain(found))
        return
    plain = _plain(found)
    screen.result(f"{found.title} ({found.name})")
    for title, heading, rows in (
        ("Apparatus parameters", "parameter", plain["parameters"]),
        ("Observables", "observable", plain["observables"]),
        ("Effects that act in it", "effect", plain["effects"]),
    ):
        screen.table(_table(title, heading, rows))


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
        "effects": [
            {
                "name": one.name,
                "unit": one.unit,
                "meaning": one.meaning,
                "lowest": _finite(one.low),
                "highest": _finite(one.high),
            }
            for one in EFFECTS.values()
            if one.acts_in(experiment.name)
        ],
    }


def _finite(value: float) -> float | None:
    """Return a limit, or None where there is none; JSON knows no infinity."""
    return value if math.isfinite(value) else None


def _table(title: str, heading: str, rows: list[dict[str, Any]]) -> Any:
    keys = [key for key in rows[0] if key != "name"] if rows else []
    numbers = [key for key in keys if key not in ("unit", "meaning")]
    shown = table([heading, *keys], numbers, title)
    for row in rows:
        cells = (row["name"], *(row[key] for key in keys))
        shown.add_row(*(_cell(one) for one in cells))
    return shown


def _cell(value: float | str | None) -> str:
    if value is None:
        return "any"
    return value if isinstance(value, str) else f"{value:g}"
