"""What pydantic finds wrong in a study, in words: key, value, nearest key and remedy."""

from __future__ import annotations

import re
import reprlib
from collections.abc import Collection, Mapping, Sequence
from datetime import date, time
from typing import Any, Final

from pydantic import BaseModel, ValidationError

from calibrate.errors import suggest
from calibrate.study.draft import tables_in
from calibrate.study.grains import NAMED
from calibrate.study.mistakes import Key, Mistakes
from calibrate.study.model import Study
from calibrate.study.schema.materials import Material, Surface
from calibrate.study.schema.parameters import Parameter, Prior
from calibrate.study.schema.settings import Apparatus, Design, Known, Likelihood, Run, Shared
from calibrate.study.schema.stages import Stage
from calibrate.study.schema.targets import Target
from liggghts_io.errors import told

__all__ = ["note"]

_INNER: Final[dict[str, type[BaseModel]]] = {
    "run": Run, "design": Design, "likelihood": Likelihood, "material": Material,
    "surface": Surface, "experiment": Apparatus, "target": Target, "shared": Shared,
    "parameter": Parameter, "known": Known, "stage": Stage,
}  # fmt: skip

_KIND: Final = re.compile(
    r"constrained-|function-|(?:dict|list|tuple|literal|union)\[|(?:int|str|float|bool)$"
)
"""How pydantic names one of several kinds of a value."""
_DECLARED: Final = ("material", "surface")
"""Keys of targets and stages that name a table of the study."""


def note(
    err: ValidationError,
    data: Mapping[str, Any],
    mistakes: Mistakes,
    *,
    materials_told: bool,
    unread: Collection[str] = (),
) -> None:
    """Note what pydantic found in a study, with key, value and remedy.

    Parameters
    ----------
    err : ValidationError
    data : mapping
        The study's tables.
    mistakes : Mistakes
    materials_told : bool
        Whether it was noted already that a material has no description.
    unread : collection of str
        Own experiments whose folders are wrong, which is told there.
    """
    findings = err.errors(include_url=False)
    meant = set()  # keys that are missing because they are misspelt
    for found in findings:
        loc = tuple(found["loc"])
        if found["type"] == "extra_forbidden":
            near = suggest(str(loc[-1]), _keys_at(loc[:-1]))
            meant |= {(*loc[:-1], key) for key in _keys_at(loc[:-1]) if f"'{key}'" in near}
    for found in findings:
        loc = tuple(found["loc"])
        if found["type"] == "missing" and loc in meant:
            continue
        if (
            found["type"] == "missing"
            and loc[1:]
            and _table_of(loc)
            and not data.get(_table_of(loc))
        ):
            continue  # the table itself is missing, which is told
        if materials_told and loc[:1] == ("material",) and found["type"] != "extra_forbidden":
            continue
        if loc[:1] == ("target",) and loc[-1] == "experiment" and str(found["input"]) in unread:
            continue
        mistakes.add(loc, _describe(found, data))


def _describe(found: Mapping[str, Any], data: Mapping[str, Any]) -> str:
    """Return one finding in words."""
    loc: Key = tuple(found["loc"])
    table, key = _place(loc, data)
    if found["type"] == "extra_forbidden":
        known = _keys_at(loc[:-1])
        near = suggest(str(loc[-1]), known) or f"; known keys: {', '.join(known)}"
        return f"{table}unknown key '{key}'{near}"
    if found["type"] == "missing":
        return f"{table}key '{key}' is missing; {_remedy(loc, data)}"
    given = found["input"]
    shown = str(given) if isinstance(given, date | time) else reprlib.repr(given)
    value = "" if found["type"] == "value_error" else f" = {shown}"
    return f"{table}{key}{value}: {told(found)}" if key else f"{table}{told(found)}"


def _place(loc: Key, data: Mapping[str, Any]) -> tuple[str, str]:
    """Return which of several tables is meant, by its name, and the key in it."""
    table = ""
    if len(loc) > 1 and isinstance(loc[1], int):
        one = data[str(loc[0])][loc[1]]
        name = one.get("name") if isinstance(one, dict) else None
        table = f"{loc[0]} {reprlib.repr(name) if isinstance(name, str) else loc[1] + 1}: "
        loc = loc[2:]
    keys = [str(part) for part in loc if part != ""]
    # Which of several kinds of a value was tried is no key.
    return table, ".".join(key for key in keys if not _KIND.match(key))


def _remedy(loc: Key, data: Mapping[str, Any]) -> str:
    """Return what to do about a missing key."""
    what = str(loc[-1])
    if len(loc) == 1 and what in (*_DECLARED, "target"):
        return f"add a [[{what}]], see cases/README.md"
    if what in _DECLARED:
        named = [one.get("name") for one in tables_in(data.get(what))]
        words = [one for one in named if isinstance(one, str)]
        if len(words) > 1:
            return f"the study has several, say which: {', '.join(words)}"
    return "add it"


def _table_of(loc: Key) -> str:
    """Return which of the study's tables a key names, such as `material` of a target."""
    return str(loc[-1]) if loc[-1] in _DECLARED else ""


def _keys_at(loc: Key) -> Sequence[str]:
    """Return the keys that are known at `loc`."""
    if not loc:
        return sorted(field.alias or name for name, field in Study.model_fields.items())
    model = Prior if loc[-1] == "prior" else _INNER.get(str(loc[0]), Study)
    keys = [field.alias or name for name, field in model.model_fields.items()]
    return sorted([*keys, *((NAMED,) if model is Material else ())])
