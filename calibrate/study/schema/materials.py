"""Materials and surfaces of a study."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, model_validator

from calibrate.study.schema.words import Kind, Label, Table
from liggghts_io.bulk import Bulk
from liggghts_io.materials import GLUED, Particle

__all__ = ["FLAT", "GLUED", "Material", "Surface"]

FLAT = "flat"


class Material(Bulk):
    """A bulk solid, with the numbers of `Bulk` right here.

    A file may leave them out and name a row of a table (`particle`, `particles`); they are filled
    in before this is made.

    Attributes
    ----------
    name : str
        What the study calls it.
    called : str
        What the tables of measurements and of particles call it, `particle` in the file; without
        it, as the study does.
    """

    name: Label
    called: Annotated[str, Field(alias="particle", min_length=1, max_length=80)]

    @model_validator(mode="before")
    @classmethod
    def _named(cls, data: Any) -> Any:
        if isinstance(data, dict) and "name" in data:
            return {"particle": data["name"], **data}
        return data

    @property
    def bulk(self) -> Bulk:
        """The numbers alone, under the name that the tables give."""
        numbers = self.model_dump(exclude_unset=True, exclude={"name", "called"})
        return Bulk(name=self.called, **numbers)

    @property
    def particle(self) -> Particle:
        """The same in SI units."""
        return self.bulk.particle


class Surface(Table):
    """A wall under test.

    Attributes
    ----------
    name : str
        What the study and the tables of measurements call it.
    kind : {"flat", "glued"}
        Bare, or laminated with grains; without it a surface is glued when its name says so.
    """

    name: Label
    kind: Kind

    @model_validator(mode="before")
    @classmethod
    def _kind(cls, data: Any) -> Any:
        if isinstance(data, dict):
            return {"kind": GLUED if data.get("name") == GLUED else FLAT, **data}
        return data
