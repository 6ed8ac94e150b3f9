"""A study that may hold mistakes: its valid parts, so that all mistakes can be found at once."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from calibrate.study.model import Curve, Known, Stage, Target
from liggghts_io.bulk import Bulk
from liggghts_io.materials import Particle

__all__ = ["Draft", "draft_of", "numbers_in"]

_Part = TypeVar("_Part", bound=BaseModel)


@dataclass(frozen=True)
class Draft:
    """The parts of a study that are valid on their own.

    Attributes
    ----------
    data : mapping
        What the file holds, the particle described.
    particle : Particle or None
    targets, curves, stages : mapping
        By their number in the file.
    known : mapping
        By effect.
    """

    data: Mapping[str, Any]
    particle: Particle | None
    targets: Mapping[int, Target]
    curves: Mapping[int, Curve]
    stages: Mapping[int, Stage]
    known: Mapping[str, Known]

    @property
    def places(self) -> dict[tuple[str, str], tuple[str, int]]:
        """Experiment and surface of every target and curve, with the key of the first."""
        found: dict[tuple[str, str], tuple[str, int]] = {}
        for number, target in self.targets.items():
            found.setdefault((target.experiment, target.surface), ("target", number))
        for number, curve in self.curves.items():
            found.setdefault((curve.experiment, curve.surface), ("curve", number))
        return found

    def numbers(self, table: str) -> dict[str, float]:
        """Return the finite numbers of a table of the file; others are told by the schema."""
        return numbers_in(self.data.get(table))

    def table(self, name: str) -> dict[str, Any]:
        """Return a table of the file, empty where it is none."""
        value = self.data.get(name)
        return value if isinstance(value, dict) else {}


def draft_of(data: Mapping[str, Any]) -> Draft:
    """Return the valid parts of what a study file holds."""
    bulk = _valid(Bulk, data.get("bulk"))
    known = data.get("known")
    entries = known.items() if isinstance(known, dict) else ()
    return Draft(
        data=data,
        particle=bulk.particle if bulk else None,
        targets=_items(Target, data.get("target")),
        curves=_items(Curve, data.get("curve")),
        stages=_items(Stage, data.get("stage")),
        known={name: one for name, raw in entries if (one := _valid(Known, raw))},
    )


def _valid(model: type[_Part], raw: object) -> _Part | None:
    try:
        return model.model_validate(raw)
    except ValidationError:
        return None


def _items(model: type[_Part], raw: object) -> dict[int, _Part]:
    listed = raw if isinstance(raw, list) else []
    found = ((number, _valid(model, one)) for number, one in enumerate(listed))
    return {number: one for number, one in found if one is not None}


def numbers_in(table: object) -> dict[str, float]:
    """Return the finite numbers of a table, empty where it is none."""
    found = {}
    for name, value in table.items() if isinstance(table, dict) else ():
        if isinstance(value, float) and math.isfinite(value):
            found[name] = value
        elif isinstance(value, int) and not isinstance(value, bool) and abs(value) < 1 << 63:
            found[name] = float(value)
    return found
