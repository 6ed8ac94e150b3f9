"""What all tables of a study have in common, and the kinds of words and numbers in them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Annotated, Any, Literal, TypeAlias

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, Strict

from calibrate.errors import unknown_name
from liggghts_io.case.runner import ENGINES
from liggghts_io.experiments import SCALES

__all__ = [
    "Bounds",
    "EngineName",
    "File",
    "Label",
    "Name",
    "NumberByInstance",
    "RangeByInstance",
    "ScaleName",
    "Table",
    "Unit",
    "Words",
    "also_named",
    "one_of",
]


class Table(BaseModel):
    """A table of the study: no unknown keys, no text for numbers, no infinite numbers."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


def one_of(known: Callable[[], Iterable[str]]) -> AfterValidator:
    """Accept a name of a registry, read when it is needed; else say the nearest one."""

    def check(word: str) -> str:
        names = list(known())
        if word not in names:
            raise ValueError(unknown_name(word, names))
        return word

    return AfterValidator(check)


def also_named(data: Any, key: str, by: str) -> Any:
    """Return a table as read, where a key that is not given has the value of another one."""
    return {key: data[by], **data} if isinstance(data, dict) and by in data else data


ScaleName = Annotated[str, one_of(lambda: SCALES)]
EngineName = Annotated[str, one_of(lambda: ENGINES)]
Name = Annotated[str, Field(min_length=1, max_length=80, pattern=r"^[A-Za-z0-9_]+$")]
Words = Annotated[str, Field(min_length=1, max_length=200)]
Unit = Annotated[str, Field(min_length=1, max_length=20)]
File = Annotated[str, Field(min_length=1, max_length=1000)]
Bounds = Annotated[tuple[float, float], Strict(strict=False)]  # TOML has lists only


def _plain_label(word: str) -> str:
    if "/" in word or not word.isprintable() or word != word.strip():
        msg = "is no name; leave out '/', line breaks and spaces at its ends"
        raise ValueError(msg)
    return word


Label = Annotated[str, Field(min_length=1, max_length=80), AfterValidator(_plain_label)]
"""Name of a material or surface; '/' separates the two in the name of an instance."""


def _by_instance(given: Any) -> Any:
    """Return a table by instance; what is given without one holds for all of them."""
    return given if isinstance(given, dict) else {"": given}


NumberByInstance: TypeAlias = Annotated[dict[str, float], BeforeValidator(_by_instance)]
RangeByInstance: TypeAlias = Annotated[dict[str, Bounds], BeforeValidator(_by_instance)]
"""Value by instance, such as ``HSP13/steel``; the instance ``""`` stands for all others."""

Kind: TypeAlias = Literal["flat", "glued"]
