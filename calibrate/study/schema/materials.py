"""Materials and surfaces of a study."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, model_validator

from calibrate.study.schema.words import Kind, Label, Table
from liggghts_io.bulk import Bulk
from liggghts_io.materials import FLAT, GLUED, SURFACES, Particle

__all__ = ["FLAT", "GLUED", "Material", "Surface"]


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
        Bare, or laminated with grains; without it a surface is glued when its name is that word.
    """

    name: Label
    kind: Kind = FLAT

    @model_validator(mode="before")
    @classmethod
    def _kind(cls, data: Any) -> Any:
        if isinstance(data, dict) and str(data.get("name")).casefold() == GLUED:
            return {"kind": GLUED, **data}
        return data

    @property
    def is_guessed(self) -> bool:
        """Whether it is taken for a flat wall though neither its kind nor its name says so."""
        return "kind" not in self.model_fields_set and self.name.casefold() not in SURFACES
