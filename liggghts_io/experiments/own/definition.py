"""What `experiment.toml` may hold: the schema of an own experiment."""

from __future__ import annotations

import math
from typing import Annotated, Any, Final, Literal

from pydantic import AfterValidator, BaseModel, Discriminator, Field, Tag, model_validator

from liggghts_io.experiments.own.effect_table import EffectTable, Name, Table, Text
from liggghts_io.materials import CONTACT_PARAMETERS, GLUED_PARAMETERS
from liggghts_io.measure.extract.base import Amount, FileName, Number, Word

NEEDS: Final = {
    "flow_flat_g_s": "flow_flat_kg_s",
    "flow_glued_g_s": "flow_glued_kg_s",
    "impact_mass_g": "impact_mass_kg",
    "size_classes": "size_classes",
}
"""What an experiment may need of the particle, and the field of `Particle` that holds it."""

_Need = Literal["flow_flat_g_s", "flow_glued_g_s", "impact_mass_g", "size_classes"]
_Contact = Annotated[str, AfterValidator(lambda word: _known_contact(word))]


def _known_contact(word: str) -> str:
    if word not in CONTACT_PARAMETERS:
        msg = f"no contact parameter; there are {', '.join(CONTACT_PARAMETERS)}"
        raise ValueError(msg)
    return word


def _check_bounds(low: float, high: float) -> None:
    """Refuse bounds between which no value lies."""
    if not low < high:
        msg = f"low = {low:g} is not below high = {high:g}; every value lies between them"
        raise ValueError(msg)


class ContactTable(Table):
    """Contact parameters that act, by the kind of the wall under test.

    Attributes
    ----------
    flat, glued : tuple of str
    """

    flat: tuple[_Contact, ...] = CONTACT_PARAMETERS
    glued: tuple[_Contact, ...] = GLUED_PARAMETERS


_Acting = Annotated[
    Annotated[tuple[_Contact, ...], Tag("list")] | Annotated[ContactTable, Tag("table")],
    # One of both is told what is wrong, not each.
    Discriminator(lambda value: "table" if isinstance(value, dict | ContactTable) else "list"),
]


class ParameterTable(Table):
    """A parameter of the apparatus.

    Attributes
    ----------
    unit, meaning : str
    default : float, optional
        For all scales; a plain script may hold it itself.
    quick, lab, paper : float, optional
        One for each scale, instead.
    limits : (float, float)
    whole : bool
        Whether it counts something.
    variable : str
        Name of the script's variable, where it is another one.
    source : str
        Where the value comes from.
    """

    unit: Word
    meaning: Text
    source: Text = ""
    default: Number | None = None
    quick: Number | None = None
    lab: Number | None = None
    paper: Number | None = None
    limits: tuple[Number, Number] = (0.0, math.inf)
    whole: Annotated[bool, Field(strict=True)] = False
    variable: Name | None = None

    @model_validator(mode="after")
    def _check(self) -> ParameterTable:
        scales = [one for one in (self.quick, self.lab, self.paper) if one is not None]
        if scales and (len(scales) < 3 or self.default is not None):
            msg = "give default, or one value for each of quick, lab and paper"
            raise ValueError(msg)
        low, high = self.limits
        if not low < high:
            msg = f"limits = [{low:g}, {high:g}]: the lower one comes first"
            raise ValueError(msg)
        for value in (*scales, *([] if self.default is None else [self.default])):
            if not low <= value <= high:
                msg = f"the value {value:g} lies outside its limits, {low:g} to {high:g}"
                raise ValueError(msg)
        return self


class MeshTable(Table):
    """A mesh of the folder.

    Attributes
    ----------
    file : str
        `meshes/NAME.stl`.
    opacity : float
        In the picture, from 0 (not drawn) to 1.
    """

    file: FileName
    opacity: Annotated[float, Field(ge=0.0, le=1.0)] = 1.0


class ObservableTable(Table):
    """An observable; its other keys are options of the extractor.

    Attributes
    ----------
    name : str
    unit, meaning : str
    extract : str
        Name of the extractor.
    low, high : float
        Between them lies every value that such a measurement can have.
    part_of : str
        Curve that holds it too.
    """

    name: Name
    unit: Word
    meaning: Text
    extract: Word
    low: Number = 0.0
    high: Number = math.inf
    part_of: str = ""

    @model_validator(mode="after")
    def _check(self) -> ObservableTable:
        _check_bounds(self.low, self.high)
        return self


class CurveTable(Table):
    """A curve; its other keys are options of the extractor.

    Attributes
    ----------
    name : str
    unit, meaning : str
        Of what is compared.
    x_name, x_unit : str
        Of what the levels are levels of.
    levels : tuple of float
        Where it is compared where nobody asks for others.
    extract : str
        Name of the extractor.
    scale : str
        "linear", "log" or "sqrt".
    low, high : float
        Between them lies every value that such a measurement can have.
    """

    name: Name
    unit: Word
    meaning: Text
    x_name: Word
    x_unit: Word
    levels: Annotated[tuple[Number, ...], Field(min_length=1, max_length=1000)]
    extract: Word
    scale: Literal["linear", "log", "sqrt"] = "linear"
    low: Number = 0.0
    high: Number = math.inf

    @model_validator(mode="after")
    def _check(self) -> CurveTable:
        if list(self.levels) != sorted(set(self.levels)):
            msg = "levels must rise"
            raise ValueError(msg)
        _check_bounds(self.low, self.high)
        return self


class PictureTable(Table):
    """What the picture shows.

    Attributes
    ----------
    at : float
        Part of the run whose frame is drawn, from 0 to 1.
    window : (float or str, float or str, float or str, float or str), optional
        Left, right, bottom and top [m].
    """

    at: Annotated[float, Field(ge=0.0, le=1.0)] = 1.0
    window: tuple[Amount, Amount, Amount, Amount] | None = None


class Head(Table):
    """The keys of the definition outside its lists.

    Attributes
    ----------
    name : str
    title, caption : str
    contact : tuple of str or ContactTable
        Contact parameters that act; a list is for flat walls, and without those of the wall for
        glued ones.
    needs : tuple of str
        What the experiment needs to know of the particle.
    seeds : tuple of str
        Variables of a plain script that get different seeds.
    variables : dict of str to str
        What a plain script calls a contact parameter, or a number of the particle.
    picture : PictureTable
    """

    name: Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]{0,39}$")]
    title: Word
    caption: str = ""
    contact: _Acting = ContactTable()
    needs: tuple[
        Literal["flow_flat_g_s", "flow_glued_g_s", "impact_mass_g", "size_classes"], ...
    ] = ()
    seeds: Annotated[tuple[Name, ...], Field(max_length=20)] = ()
    variables: dict[str, Name] = Field(default_factory=dict)
    picture: PictureTable = PictureTable()

    @property
    def acting(self) -> dict[str, tuple[str, ...]]:
        """Contact parameters that act, by the kind of the wall under test."""
        if isinstance(self.contact, ContactTable):
            return {"flat": self.contact.flat, "glued": self.contact.glued}
        glued = tuple(word for word in self.contact if word in GLUED_PARAMETERS)
        return {"flat": self.contact, "glued": glued}


LISTS: Final[dict[str, type[Table]]] = {
    "mesh": MeshTable,
    "observable": ObservableTable,
    "curve": CurveTable,
    "effect": EffectTable,
}
"""Lists of tables of the definition."""


def field_names(model: type[BaseModel]) -> list[str]:
    """Return the keys of a table."""
    return list(model.model_fields)


def plain_value(value: Any) -> str:
    """Return a value as a message shows it, cut where it is long."""
    text = repr(value)
    return text if len(text) <= 80 else f"{text[:77]}..."
