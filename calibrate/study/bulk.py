"""The grains of a study: a row of a table beside it, or described in the study itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from calibrate.errors import CalibrationError
from liggghts_io.errors import CaseError
from liggghts_io.particles import bulk_named

__all__ = ["NAMED_BULK", "NAME_OR_DESCRIBE", "with_bulk"]

PARTICLES = "particles.csv"
"""Table in which a study looks its particle up where it names no other."""

NAMED_BULK = ("particle", "particles")
"""Keys with which a study names its grains instead of describing them under [bulk]."""


NAME_OR_DESCRIBE = (
    f"name a row of {PARTICLES} beside the study, or describe the grains under [bulk]"
)


def with_bulk(data: Mapping[str, Any], locate: Callable[[str], Path]) -> dict[str, Any]:
    """Return a study's data with the named particle replaced by its description.

    So everything that reads or writes a study meets one form of it, and a study that was written
    again needs no table.

    Parameters
    ----------
    data : mapping
        What the TOML file holds; `particle` is the name of a row of `particles`, a CSV file beside
        the study.
    locate : callable
        Name of a data file to its path; refuses files outside the study's directory.

    Raises
    ------
    CalibrationError
        When the grains are both named and described, or the table does not hold them.
    """
    named = [key for key in NAMED_BULK if key in data]
    if "bulk" in data:
        if named:
            msg = f"'{named[0]}' and [bulk] both say what the grains are; keep one"
            raise CalibrationError(msg)
        return dict(data)
    if "particle" not in data:
        return dict(data)  # the check of all keys says what is wrong, a misspelt key perhaps
    name, file = data["particle"], data.get("particles", PARTICLES)
    if not isinstance(name, str) or not isinstance(file, str):
        msg = f"particle = {name!r}, particles = {file!r}: {NAME_OR_DESCRIBE}"
        raise CalibrationError(msg)
    try:
        bulk = bulk_named(name, locate(file))
    except CalibrationError as err:
        msg = f"{err}; or describe the grains under [bulk] in place of particle = {name!r}"
        raise CalibrationError(msg) from err
    except CaseError as err:
        msg = f"particle = {name!r}: {err}"
        raise CalibrationError(msg) from err
    rest = {key: value for key, value in data.items() if key not in NAMED_BULK}
    return {**rest, "bulk": bulk.model_dump(exclude_unset=True)}
