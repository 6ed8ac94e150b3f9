"""A study's tables with what goes without saying: descriptions of materials, the only material."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from calibrate.study.grains import NAMED, described
from calibrate.study.mistakes import Mistakes

__all__ = ["filled"]


def filled(
    data: Mapping[str, Any], locate: Callable[[str], Path], mistakes: Mistakes
) -> dict[str, Any]:
    """Return a study's tables, materials described and the only material and surface named.

    Parameters
    ----------
    data : mapping
        What the TOML file holds.
    locate : callable
        Name of a data file to its path; refuses files outside the study's directory.
    mistakes : Mistakes
        Takes materials that cannot be described; they are left out of the result.
    """
    whole = dict(data)
    materials = data.get("material")
    if isinstance(materials, list):
        whole["material"] = [
            _described(number, one, locate, mistakes) for number, one in enumerate(materials)
        ]
    for what in ("material", "surface"):
        only = _only(data.get(what))
        if only is None:
            continue
        for table in ("target", "stage") if what == "material" else ("target",):
            if isinstance(whole.get(table), list):
                whole[table] = [
                    {what: only, **one} if isinstance(one, dict) else one for one in whole[table]
                ]
    return whole


def _described(
    number: int, material: Any, locate: Callable[[str], Path], mistakes: Mistakes
) -> Any:
    """Return a material with its numbers; with none where they cannot be found, which is noted."""
    if not isinstance(material, dict):
        return material
    # Where it is refused, without the key that the schema does not know.
    found = {key: value for key, value in material.items() if key != NAMED}
    with mistakes.noting(("material", number)):
        found.update(described(material, locate))
    return found


def _only(listed: Any) -> str | None:
    """Return the name of the only table of a list, None where there are more or none."""
    if isinstance(listed, list) and len(listed) == 1 and isinstance(listed[0], dict):
        name = listed[0].get("name")
        return name if isinstance(name, str) else None
    return None
