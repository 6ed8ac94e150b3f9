"""A study that may hold mistakes: its valid parts, so that all mistakes can be found at once."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from calibrate.study.model import places_of
from calibrate.study.places import Layout, Place
from calibrate.study.schema.materials import Material, Surface
from calibrate.study.schema.parameters import Parameter
from calibrate.study.schema.settings import Apparatus, Known, Run, Shared
from calibrate.study.schema.stages import Stage
from calibrate.study.schema.targets import Target
from liggghts_io.experiments import Experiment

__all__ = ["Draft", "draft_of", "numbers_in", "tables_in"]

_Part = TypeVar("_Part", bound=BaseModel)


@dataclass(frozen=True)
class Draft:
    """The parts of a study that are valid on their own.

    Attributes
    ----------
    data : mapping
        What the file holds, materials described and what is clear filled in.
    experiments : mapping
        By name, those of the program and of the study.
    run : Run
        As the file says, or with all defaults where that is wrong.
    materials, surfaces, rigs, targets, shared, stages : mapping
        By their number in the file.
    parameters : mapping
        By name.
    known : mapping
        Parameter or effect to its measurements by number.
    """

    data: Mapping[str, Any]
    experiments: Mapping[str, Experiment]
    run: Run
    materials: Mapping[int, Material]
    surfaces: Mapping[int, Surface]
    rigs: Mapping[int, Apparatus]
    targets: Mapping[int, Target]
    shared: Mapping[int, Shared]
    stages: Mapping[int, Stage]
    parameters: Mapping[str, Parameter]
    known: Mapping[str, Mapping[int, Known]]

    @property
    def declared(self) -> dict[int, Target]:
        """Targets whose material and surface the study has."""
        materials = {one.name for one in self.materials.values()}
        surfaces = {one.name for one in self.surfaces.values()}
        return {
            number: one
            for number, one in self.targets.items()
            if one.material in materials and one.surface in surfaces
        }

    @property
    def layout(self) -> Layout:
        """What is measured where, of the targets that are right."""
        scopes = {name: one.scope for name, one in self.parameters.items() if one.scope}
        kinds = {surface.name: surface.kind for surface in self.surfaces.values()}
        return Layout(
            places_of(self.declared.values()), kinds, self.experiments, scopes,
            frozenset(self.parameters),
        )  # fmt: skip

    @property
    def places(self) -> dict[Place, tuple[str, int]]:
        """Every place with the key of its first target."""
        found: dict[Place, tuple[str, int]] = {}
        for number, one in self.declared.items():
            found.setdefault(Place(one.material, one.surface, one.experiment), ("target", number))
        return found

    @property
    def complete(self) -> bool:
        """Whether every target of the file is right, so that something can be said to be unused."""
        listed = self.data.get("target")
        return isinstance(listed, list) and len(self.declared) == len(listed)

    @property
    def unread(self) -> set[str]:
        """Own experiments whose folders are wrong, which is told there."""
        tables = [one for one in tables_in(self.data.get("experiment")) if "folder" in one]
        names = {one["name"] for one in tables if isinstance(one.get("name"), str)}
        return names - self.experiments.keys()

    def lacks(self, name: str) -> bool:
        """Whether a parameter or effect is unknown, and may be that of a folder that is wrong."""
        return bool(self.unread) and not self.layout.knows(name)

    def material_named(self, name: str) -> Material:
        """Return a material of a place."""
        return next(one for one in self.materials.values() if one.name == name)

    def numbers(self, table: str) -> dict[str, float]:
        """Return the finite numbers of a table of the file; others are told by the schema."""
        return numbers_in(self.data.get(table))

    def table(self, name: str) -> dict[str, Any]:
        """Return a table of the file, empty where it is none."""
        value = self.data.get(name)
        return value if isinstance(value, dict) else {}

    def names(self, table: str) -> list[str]:
        """Return the names in a list of tables of the file, those of mistaken ones too."""
        given = [one.get("name") for one in tables_in(self.data.get(table))]
        return [name for name in given if isinstance(name, str)]


def draft_of(data: Mapping[str, Any], experiments: Mapping[str, Experiment]) -> Draft:
    """Return the valid parts of what a study file holds."""
    context = {"experiments": experiments}

    def items(model: type[_Part], raw: object) -> dict[int, _Part]:
        listed = raw if isinstance(raw, list) else [raw] if isinstance(raw, dict) else []
        found = ((number, _valid(model, one, context)) for number, one in enumerate(listed))
        return {number: one for number, one in found if one is not None}

    known = data.get("known")
    parameters = data.get("parameter")
    return Draft(
        data=data,
        experiments=experiments,
        run=_valid(Run, data.get("run", {}), context) or Run(),
        materials=items(Material, data.get("material")),
        surfaces=items(Surface, data.get("surface")),
        rigs=items(Apparatus, data.get("experiment")),
        targets=items(Target, data.get("target")),
        shared=items(Shared, data.get("shared")),
        stages=items(Stage, data.get("stage")),
        parameters={
            name: one
            for name, raw in (parameters.items() if isinstance(parameters, dict) else ())
            if (one := _valid(Parameter, raw, context)) is not None
        },
        known={
            name: items(Known, raw)
            for name, raw in (known.items() if isinstance(known, dict) else ())
        },
    )


def _valid(model: type[_Part], raw: object, context: Mapping[str, Any]) -> _Part | None:
    try:
        return model.model_validate(raw, context=dict(context))
    except ValidationError:
        return None


def tables_in(listed: object) -> list[dict[str, Any]]:
    """Return the tables of a list, empty where it is none."""
    return [one for one in listed if isinstance(one, dict)] if isinstance(listed, list) else []


def numbers_in(table: object) -> dict[str, float]:
    """Return the finite numbers of a table, empty where it is none."""
    found = {}
    for name, value in table.items() if isinstance(table, dict) else ():
        if isinstance(value, float) and math.isfinite(value):
            found[name] = value
        elif isinstance(value, int) and not isinstance(value, bool) and abs(value) < 1 << 63:
            found[name] = float(value)
    return found
