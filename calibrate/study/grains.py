"""The grains of a study: rows of a table beside it, or described in the study itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final

from calibrate.errors import CalibrationError
from liggghts_io.bulk import Bulk
from liggghts_io.errors import CaseError
from liggghts_io.particles import bulk_named

__all__ = ["NAMED", "PARTICLES", "described"]

PARTICLES: Final = "particles.csv"
"""Table in which a study looks a material up where it names no other."""

NAMED: Final = "particles"
"""Key of a material that names the table; it is gone when the row has been read."""

SIMULATED: Final = ("sizes", "coarse_graining")
"""How grains are simulated: a material may say it beside a row of a table, and goes before it."""

_BESIDE: Final = ("name", *SIMULATED)


def described(material: Mapping[str, Any], locate: Callable[[str], Path]) -> dict[str, Any]:
    """Return a material with its numbers, from a table if it gives none itself.

    So everything that reads or writes a study meets one form of it, and a study that was written
    again needs no table.

    Parameters
    ----------
    material : mapping
        A ``[[material]]`` of the file.
    locate : callable
        Name of a data file to its path; refuses files outside the study's directory.

    Raises
    ------
    CalibrationError
        When it both names a table and has numbers, or the table does not hold it.
    """
    numbers = [key for key in material if key in Bulk.model_fields and key not in _BESIDE]
    if numbers:
        if NAMED in material:
            msg = f"'{NAMED}' and '{numbers[0]}' both say what the grains are; keep one"
            raise CalibrationError(msg)
        return dict(material)
    name = material.get("particle", material.get("name"))
    file = material.get(NAMED, PARTICLES)
    if not isinstance(name, str) or not isinstance(file, str):
        if NAMED not in material and "particle" not in material:
            return dict(material)  # its name is missing or none, which the schema says
        msg = f"particle = {name!r}, {NAMED} = {file!r}: name a row of a table beside the study"
        raise CalibrationError(msg)
    try:
        bulk = bulk_named(name, locate(file))
    except (CalibrationError, CaseError) as err:
        msg = f"material '{name}': {err}; or give its numbers (d32_um, density_kg_m3, ...) here"
        raise CalibrationError(msg) from err
    rest = {key: value for key, value in material.items() if key != NAMED}
    return {"particle": name, **bulk.model_dump(exclude_unset=True, exclude={"name"}), **rest}
